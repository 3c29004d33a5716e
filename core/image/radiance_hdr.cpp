// SPDX-License-Identifier: MIT
// Radiance's picture format (Ward, "Real Pixels", Graphics Gems II, 1991): three mantissas of 8 bits and one exponent a
// pixel; each row run-length encoded channel by channel where it is from 8 to 32767 pixels wide.
#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstring>
#include <string>
#include <string_view>

#include "core/image/codec.h"

namespace penumbra {

namespace {

using Rgbe = std::array<std::uint8_t, 4>;

constexpr int kFewestPacked = 8;  // pixels of a row
constexpr int kMostPacked = 32767;
constexpr int kMostLiteral = 128;
constexpr int kLongestRun = 127;
constexpr int kShortestRun = 4;  // a shorter one is cheaper among literals
constexpr int kBias = 128;
constexpr int kMaxSide = 1 << 20;

// Mantissas are rounded, not cut: half the error, and no bias. Negative values and NaN are 0.
Rgbe to_rgbe(const float* rgb) {
    std::array<double, 3> c{};
    double largest = 0;
    for (std::size_t i = 0; i < 3; ++i) {
        c[i] = rgb[i] > 0 ? double(rgb[i]) : 0.0;
        largest = std::max(largest, c[i]);
    }
    int exponent = 0;
    std::frexp(largest, &exponent);
    if (std::lround(std::ldexp(largest, 8 - exponent)) > 255) {
        ++exponent;
    }
    if (largest == 0 || exponent < -127) {
        return {0, 0, 0, 0};
    }
    if (exponent > 127) {
        exponent = 127;
    }
    Rgbe out{0, 0, 0, std::uint8_t(exponent + kBias)};
    for (std::size_t i = 0; i < 3; ++i) {
        out[i] = std::uint8_t(std::min(std::lround(std::ldexp(c[i], 8 - exponent)), 255l));
    }
    return out;
}

void from_rgbe(const Rgbe& in, float* rgb) {
    for (std::size_t i = 0; i < 3; ++i) {
        rgb[i] = in[3] == 0 ? 0.0f : float(std::ldexp(double(in[i]), int(in[3]) - kBias - 8));
    }
}

void pack_channel(const std::vector<Rgbe>& row, std::size_t channel, Bytes& file) {
    const std::size_t width = row.size();
    const auto run_at = [&](std::size_t at) {
        std::size_t end = at + 1;
        while (end < width && end - at < std::size_t(kLongestRun) && row[end][channel] == row[at][channel]) {
            ++end;
        }
        return end - at;
    };
    std::size_t at = 0;
    while (at < width) {
        std::size_t literal = at;
        std::size_t run = 0;
        while (literal < width && literal - at < std::size_t(kMostLiteral)) {
            run = run_at(literal);
            if (run >= std::size_t(kShortestRun)) {
                break;
            }
            literal += run;
            run = 0;
        }
        literal = std::min(literal, at + std::size_t(kMostLiteral));
        if (literal > at) {
            file.push_back(std::uint8_t(literal - at));
            for (; at < literal; ++at) {
                file.push_back(row[at][channel]);
            }
        }
        if (run >= std::size_t(kShortestRun) && at < width) {
            file.push_back(std::uint8_t(128 + run));
            file.push_back(row[at][channel]);
            at += run;
        }
    }
}

// Reads rows; `good` is false once the bytes run out or make no sense.
class Reader {
public:
    explicit Reader(std::span<const std::uint8_t> bytes) : bytes_(bytes) {}

    bool good() const { return good_; }
    bool at_end() const { return at_ == bytes_.size(); }

    void row(std::vector<Rgbe>& pixels) {
        const int width = int(pixels.size());
        const bool packed = width >= kFewestPacked && width <= kMostPacked && left() >= 4 &&
                            bytes_[at_] == 2 && bytes_[at_ + 1] == 2 && bytes_[at_ + 2] < 128;
        if (!packed) {
            for (Rgbe& pixel : pixels) {
                for (std::uint8_t& byte : pixel) {
                    byte = next();
                }
            }
            return;
        }
        good_ = good_ && bytes_[at_ + 2] * 256 + bytes_[at_ + 3] == width;
        at_ += 4;
        for (std::size_t c = 0; c < 4; ++c) {
            std::size_t x = 0;
            while (good_ && x < pixels.size()) {
                const int count = next();
                const bool run = count > 128;
                const std::size_t length = std::size_t(run ? count - 128 : count);
                if (length == 0 || length > pixels.size() - x) {
                    good_ = false;
                    return;
                }
                const std::uint8_t value = run ? next() : std::uint8_t(0);
                for (std::size_t i = 0; i < length; ++i, ++x) {
                    pixels[x][c] = run ? value : next();
                }
            }
        }
    }

private:
    std::size_t left() const { return bytes_.size() - at_; }
    std::uint8_t next() {
        if (at_ >= bytes_.size()) {
            good_ = false;
            return 0;
        }
        return bytes_[at_++];
    }

    std::span<const std::uint8_t> bytes_;
    std::size_t at_ = 0;
    bool good_ = true;
};

}  // namespace

Bytes encode_hdr(const ImageF& image) {
    assert(image.width > 0 && image.height > 0 && image.channels == 3);
    const std::string header = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n-Y " +
                               std::to_string(image.height) + " +X " +
                               std::to_string(image.width) + "\n";
    Bytes file(header.begin(), header.end());
    const bool packed = image.width >= kFewestPacked && image.width <= kMostPacked;
    std::vector<Rgbe> row(std::size_t(image.width));
    for (int y = 0; y < image.height; ++y) {
        for (int x = 0; x < image.width; ++x) {
            row[std::size_t(x)] = to_rgbe(image.at(x, y));
        }
        if (!packed) {
            for (const Rgbe& pixel : row) {
                file.insert(file.end(), pixel.begin(), pixel.end());
            }
            continue;
        }
        file.insert(file.end(),
                    {2, 2, std::uint8_t(image.width >> 8), std::uint8_t(image.width & 255)});
        for (std::size_t c = 0; c < 4; ++c) {
            pack_channel(row, c, file);
        }
    }
    return file;
}

std::variant<ImageF, DecodeError> decode_hdr(std::span<const std::uint8_t> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    const std::size_t header_end = text.find("\n\n");
    if (!text.starts_with("#?") || header_end == text.npos ||
        text.substr(0, header_end).find("FORMAT=32-bit_rle_rgbe") == text.npos) {
        return DecodeError{"is not a Radiance HDR file in RGBE"};
    }
    const std::size_t line_end = text.find('\n', header_end + 2);
    if (line_end == text.npos) {
        return DecodeError{"is cut off in its header"};
    }
    std::string_view line = text.substr(header_end + 2, line_end - header_end - 2);
    int height = 0;
    int width = 0;
    const auto side = [&](std::string_view before, int& to) {
        if (!line.starts_with(before)) {
            return false;
        }
        line.remove_prefix(before.size());
        const auto end = std::from_chars(line.data(), line.data() + line.size(), to);
        line.remove_prefix(std::size_t(end.ptr - line.data()));
        return end.ec == std::errc() && to >= 1 && to <= kMaxSide;
    };
    if (!side("-Y ", height) || !side(" +X ", width) || !line.empty()) {
        return DecodeError{"must hold rows from top to bottom, pixels from left to right"};
    }
    // A run of 127 equal pixels takes two bytes a channel.
    if (double(width) * double(height) > 127.0 * double(bytes.size())) {
        return DecodeError{"promises more pixels than its bytes can hold"};
    }
    Reader reader(bytes.subspan(line_end + 1));
    ImageF image(width, height, 3);
    std::vector<Rgbe> row(std::size_t(width), Rgbe{});
    for (int y = 0; y < height && reader.good(); ++y) {
        reader.row(row);
        for (int x = 0; x < width; ++x) {
            from_rgbe(row[std::size_t(x)], image.at(x, y));
        }
    }
    if (!reader.good() || !reader.at_end()) {
        return DecodeError{reader.good() ? "has bytes after its last row" : "is damaged or cut off"};
    }
    return image;
}

}  // namespace penumbra
