// SPDX-License-Identifier: MIT
#include <bit>
#include <cassert>
#include <charconv>
#include <cmath>
#include <cstring>
#include <optional>
#include <string>
#include <string_view>

#include "core/image/codec.h"

namespace penumbra {

namespace {

constexpr int kMaxSide = 1 << 20;

std::uint32_t swap_bytes(std::uint32_t v) {
    return (v >> 24) | ((v >> 8) & 0xff00u) | ((v << 8) & 0xff0000u) | (v << 24);
}

// The three header lines, read token by token; the samples start one whitespace after the last.
class Header {
public:
    explicit Header(std::string_view text) : text_(text) {}

    std::string_view token() {
        while (at_ < text_.size() && is_space(text_[at_])) {
            ++at_;
        }
        const std::size_t start = at_;
        while (at_ < text_.size() && !is_space(text_[at_])) {
            ++at_;
        }
        return text_.substr(start, at_ - start);
    }

    template <class T>
    std::optional<T> number() {
        const std::string_view word = token();
        T value{};
        const auto end = std::from_chars(word.data(), word.data() + word.size(), value);
        if (end.ec != std::errc() || end.ptr != word.data() + word.size()) {
            return std::nullopt;
        }
        return value;
    }

    std::size_t samples_start() const { return at_ + 1; }

private:
    static bool is_space(char c) { return c == ' ' || c == '\n' || c == '\r' || c == '\t'; }

    std::string_view text_;
    std::size_t at_ = 0;
};

}  // namespace

Bytes encode_pfm(const ImageF& image) {
    assert(image.width > 0 && image.height > 0);
    assert(image.channels == 1 || image.channels == 3);
    const std::string header = std::string(image.channels == 3 ? "PF" : "Pf") + "\n" +
                               std::to_string(image.width) + " " + std::to_string(image.height) +
                               "\n-1.0\n";
    const std::size_t row = std::size_t(image.width) * std::size_t(image.channels);
    Bytes file(header.size() + row * std::size_t(image.height) * sizeof(float));
    std::memcpy(file.data(), header.data(), header.size());
    std::uint8_t* to = file.data() + header.size();
    for (int y = image.height - 1; y >= 0; --y) {
        const float* from = image.at(0, y);
        if constexpr (std::endian::native == std::endian::little) {
            std::memcpy(to, from, row * sizeof(float));
        } else {
            for (std::size_t i = 0; i < row; ++i) {
                const std::uint32_t bits = swap_bytes(std::bit_cast<std::uint32_t>(from[i]));
                std::memcpy(to + i * sizeof(float), &bits, sizeof bits);
            }
        }
        to += row * sizeof(float);
    }
    return file;
}

std::variant<ImageF, DecodeError> decode_pfm(std::span<const std::uint8_t> bytes) {
    Header header(std::string_view(reinterpret_cast<const char*>(bytes.data()), bytes.size()));
    const std::string_view magic = header.token();
    if (magic != "PF" && magic != "Pf") {
        return DecodeError{"is not a PFM file: it does not start with PF or Pf"};
    }
    const auto width = header.number<int>();
    const auto height = header.number<int>();
    const auto scale = header.number<double>();
    if (!width || !height || *width < 1 || *height < 1 || *width > kMaxSide || *height > kMaxSide) {
        return DecodeError{"has a bad width or height in its header"};
    }
    if (!scale || !std::isfinite(*scale) || *scale == 0) {
        return DecodeError{"has a bad scale in its header"};
    }
    const int channels = magic == "PF" ? 3 : 1;
    const std::size_t row = std::size_t(*width) * std::size_t(channels);
    const std::size_t needed = row * std::size_t(*height) * sizeof(float);
    const std::size_t start = header.samples_start();
    if (bytes.size() < start || bytes.size() - start != needed) {
        return DecodeError{"holds " +
                           std::to_string(bytes.size() < start ? 0 : bytes.size() - start) +
                           " bytes of samples where its header promises " + std::to_string(needed)};
    }
    const bool little =
        *scale < 0;  // the sign is the byte order; the size is a unit of no use here
    const bool swap = little != (std::endian::native == std::endian::little);
    ImageF image(*width, *height, channels);
    const std::uint8_t* from = bytes.data() + start;
    for (int y = *height - 1; y >= 0; --y) {
        float* to = image.at(0, y);
        std::memcpy(to, from, row * sizeof(float));
        for (std::size_t i = 0; swap && i < row; ++i) {
            to[i] = std::bit_cast<float>(swap_bytes(std::bit_cast<std::uint32_t>(to[i])));
        }
        from += row * sizeof(float);
    }
    return image;
}

}  // namespace penumbra
