// SPDX-License-Identifier: MIT
// OpenEXR ("OpenEXR File Layout", openexr.com): one part of scan lines, half or float, ZIP. Written whole; read as far as
// pictures of this kind go: scan lines without compression or with ZIP or ZIPS.
#include <libdeflate.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cassert>
#include <memory>
#include <new>
#include <optional>
#include <string>
#include <string_view>

#include "core/image/byte_order.h"
#include "core/image/codec.h"
#include "core/image/half.h"

namespace penumbra {

namespace {

constexpr std::uint32_t kMagic = 20000630;
constexpr std::uint32_t kVersion = 2;        // and no flags: one part, scan lines, short names
constexpr std::uint32_t kLongNames = 0x400;  // a flag that changes nothing for us
constexpr std::int32_t kHalf = 1;
constexpr std::int32_t kFloat = 2;
constexpr std::uint8_t kNoCompression = 0;
constexpr std::uint8_t kZips = 2;
constexpr std::uint8_t kZip = 3;
constexpr int kZipLines = 16;  // in a block
constexpr int kCompressionLevel = 1;
constexpr int kMaxSide = 1 << 20;
constexpr double kMostInflation = 1032;  // deflate cannot do better

template <auto Free>
struct Deleter {
    template <class T>
    void operator()(T* object) const {
        Free(object);
    }
};
using Compressor = std::unique_ptr<libdeflate_compressor, Deleter<libdeflate_free_compressor>>;
using Decompressor = std::unique_ptr<libdeflate_decompressor, Deleter<libdeflate_free_decompressor>>;

void append_text(Bytes& file, std::string_view text) {
    file.insert(file.end(), text.begin(), text.end());
    file.push_back(0);
}

void append_attribute(Bytes& file, std::string_view name, std::string_view type, const Bytes& value) {
    append_text(file, name);
    append_text(file, type);
    append_little(file, std::uint32_t(value.size()));
    file.insert(file.end(), value.begin(), value.end());
}

Bytes floats(std::initializer_list<float> values) {
    Bytes bytes;
    for (const float value : values) {
        append_little(bytes, std::bit_cast<std::uint32_t>(value));
    }
    return bytes;
}

// Where each channel of the file stands in a pixel: names in the order of the alphabet.
struct FileChannel {
    std::string_view name;
    int channel;
};
std::span<const FileChannel> channels_of(const ImageF& image) {
    static constexpr std::array<FileChannel, 3> kColour{{{"B", 2}, {"G", 1}, {"R", 0}}};
    static constexpr std::array<FileChannel, 1> kGrey{{{"Y", 0}}};
    return image.channels == 3 ? std::span<const FileChannel>(kColour) : std::span<const FileChannel>(kGrey);
}

Bytes header_of(const ImageF& image, bool half) {
    Bytes file;
    append_little(file, kMagic);
    append_little(file, kVersion);
    Bytes channels;
    for (const FileChannel& channel : channels_of(image)) {
        append_text(channels, channel.name);
        append_little(channels, std::uint32_t(half ? kHalf : kFloat));
        append_little(channels, std::uint32_t(0));  // not perceptually linear, and three reserved
        append_little(channels, std::uint32_t(1));  // every column
        append_little(channels, std::uint32_t(1));  // every row
    }
    channels.push_back(0);
    Bytes window;
    for (const int corner : {0, 0, image.width - 1, image.height - 1}) {
        append_little(window, std::uint32_t(corner));
    }
    append_attribute(file, "channels", "chlist", channels);
    // Rec. 709 and D65: what sRGB's linear values are measured in.
    append_attribute(file, "chromaticities", "chromaticities",
                     floats({0.64f, 0.33f, 0.30f, 0.60f, 0.15f, 0.06f, 0.3127f, 0.3290f}));
    append_attribute(file, "compression", "compression", {kZip});
    append_attribute(file, "dataWindow", "box2i", window);
    append_attribute(file, "displayWindow", "box2i", window);
    append_attribute(file, "lineOrder", "lineOrder", {0});  // from the top
    append_attribute(file, "pixelAspectRatio", "float", floats({1}));
    append_attribute(file, "screenWindowCenter", "v2f", floats({0, 0}));
    append_attribute(file, "screenWindowWidth", "float", floats({1}));
    file.push_back(0);
    return file;
}

// What ZIP does before it deflates: low bytes apart from high ones, then differences.
Bytes rearranged(const Bytes& raw) {
    Bytes out(raw.size());
    const std::size_t half = (raw.size() + 1) / 2;
    for (std::size_t i = 0; i < raw.size(); ++i) {
        out[i / 2 + (i % 2) * half] = raw[i];
    }
    for (std::size_t i = out.size(); i-- > 1;) {
        out[i] = std::uint8_t(out[i] - out[i - 1] + 128);
    }
    return out;
}

Bytes restored(Bytes in) {
    for (std::size_t i = 1; i < in.size(); ++i) {
        in[i] = std::uint8_t(in[i - 1] + in[i] - 128);
    }
    Bytes out(in.size());
    const std::size_t half = (in.size() + 1) / 2;
    for (std::size_t i = 0; i < in.size(); ++i) {
        out[i] = in[i / 2 + (i % 2) * half];
    }
    return out;
}

// Reads numbers and names one after the other; nullopt once the bytes run out.
class Cursor {
public:
    Cursor(std::span<const std::uint8_t> bytes, std::size_t at) : bytes_(bytes), at_(at) {}

    template <class T>
    std::optional<T> number() {
        if (bytes_.size() - at_ < sizeof(T)) {
            return std::nullopt;
        }
        const T value = read_little<T>(bytes_, at_);
        at_ += sizeof(T);
        return value;
    }
    std::optional<std::string> name() {
        const auto end = std::find(bytes_.begin() + std::ptrdiff_t(at_), bytes_.end(), std::uint8_t(0));
        if (end == bytes_.end()) {
            return std::nullopt;
        }
        std::string text(bytes_.begin() + std::ptrdiff_t(at_), end);
        at_ += text.size() + 1;
        return text;
    }
    std::optional<std::span<const std::uint8_t>> take(std::size_t count) {
        if (bytes_.size() - at_ < count) {
            return std::nullopt;
        }
        at_ += count;
        return bytes_.subspan(at_ - count, count);
    }

private:
    std::span<const std::uint8_t> bytes_;
    std::size_t at_;
};

struct Channel {
    std::string name;
    std::int32_t type = 0;
    std::size_t bytes() const { return type == kHalf ? 2 : 4; }
};

struct Header {
    std::vector<Channel> channels;
    int compression = -1;
    std::array<std::int32_t, 4> window{0, 0, -1, -1};
    int width() const { return window[2] - window[0] + 1; }
    int height() const { return window[3] - window[1] + 1; }
    std::size_t line_bytes() const {
        std::size_t pixel = 0;
        for (const Channel& channel : channels) {
            pixel += channel.bytes();
        }
        return pixel * std::size_t(width());
    }
};

const DecodeError kCutOff{"is cut off or damaged in its header"};

std::optional<DecodeError> read_channels(std::span<const std::uint8_t> value, Header& header) {
    Cursor cursor(value, 0);
    while (true) {
        const auto name = cursor.name();
        if (!name) {
            return kCutOff;
        }
        if (name->empty()) {
            return std::nullopt;
        }
        const auto type = cursor.number<std::uint32_t>();
        cursor.number<std::uint32_t>();
        const auto x = cursor.number<std::uint32_t>();
        const auto y = cursor.number<std::uint32_t>();
        if (!type || !y) {
            return kCutOff;
        }
        if ((*type != std::uint32_t(kHalf) && *type != std::uint32_t(kFloat)) || *x != 1 || *y != 1) {
            return DecodeError{"must hold half or float channels of full resolution"};
        }
        header.channels.push_back({*name, std::int32_t(*type)});
    }
}

std::optional<DecodeError> read_header(Cursor& cursor, Header& header) {
    while (true) {
        const auto name = cursor.name();
        if (!name) {
            return kCutOff;
        }
        if (name->empty()) {
            break;
        }
        const auto type = cursor.name();
        const auto size = cursor.number<std::uint32_t>();
        const auto value = type && size ? cursor.take(*size) : std::nullopt;
        if (!value) {
            return kCutOff;
        }
        if (*name == "channels") {
            if (auto error = read_channels(*value, header)) {
                return error;
            }
        } else if (*name == "compression" && value->size() == 1) {
            header.compression = (*value)[0];
        } else if (*name == "dataWindow" && value->size() == 16) {
            for (std::size_t i = 0; i < 4; ++i) {
                header.window[i] = std::int32_t(read_little<std::uint32_t>(*value, 4 * i));
            }
        }
    }
    constexpr std::int32_t kFar = 1 << 28;
    for (const std::int32_t corner : header.window) {
        if (corner < -kFar || corner > kFar) {
            return kCutOff;
        }
    }
    if (header.width() < 1 || header.height() < 1 || header.width() > kMaxSide || header.height() > kMaxSide) {
        return DecodeError{"has a bad width or height in its header"};
    }
    if (header.compression != kNoCompression && header.compression != kZips && header.compression != kZip) {
        return DecodeError{"must be without compression or with ZIP or ZIPS"};
    }
    return std::nullopt;
}

}  // namespace

Bytes encode_exr(const ImageF& image, ExrSamples samples) {
    assert(image.width > 0 && image.height > 0);
    assert(image.channels == 1 || image.channels == 3);
    const bool half = samples == ExrSamples::half;
    Bytes file = header_of(image, half);
    const Compressor compressor(libdeflate_alloc_compressor(kCompressionLevel));
    if (!compressor) {
        throw std::bad_alloc();
    }
    const int blocks = (image.height + kZipLines - 1) / kZipLines;
    std::size_t table = file.size();
    file.resize(file.size() + 8 * std::size_t(blocks));
    Bytes packed;
    for (int first = 0; first < image.height; first += kZipLines, table += 8) {
        put_little(file.data() + table, std::uint64_t(file.size()));
        Bytes raw;
        const int end = std::min(first + kZipLines, image.height);
        raw.reserve(std::size_t(end - first) * std::size_t(image.width) * std::size_t(image.channels) * (half ? 2 : 4));
        for (int y = first; y < end; ++y) {
            for (const FileChannel& channel : channels_of(image)) {
                for (int x = 0; x < image.width; ++x) {
                    const float value = image.at(x, y)[channel.channel];
                    if (half) {
                        append_little(raw, to_half(value));
                    } else {
                        append_little(raw, std::bit_cast<std::uint32_t>(value));
                    }
                }
            }
        }
        const Bytes ready = rearranged(raw);
        packed.resize(raw.size());
        const std::size_t size = libdeflate_zlib_compress(compressor.get(), ready.data(), ready.size(), packed.data(),
                                                          packed.size() - 1);  // as large as raw is no gain: 0
        append_little(file, std::uint32_t(first));
        append_little(file, std::uint32_t(size > 0 ? size : raw.size()));
        if (size > 0) {
            file.insert(file.end(), packed.begin(), packed.begin() + std::ptrdiff_t(size));
        } else {
            file.insert(file.end(), raw.begin(), raw.end());
        }
    }
    return file;
}

std::variant<ImageF, DecodeError> decode_exr(std::span<const std::uint8_t> bytes) {
    if (bytes.size() < 8 || read_little<std::uint32_t>(bytes, 0) != kMagic) {
        return DecodeError{"is not an OpenEXR file"};
    }
    if ((read_little<std::uint32_t>(bytes, 4) & ~kLongNames) != kVersion) {
        return DecodeError{"must be an OpenEXR file of one part in scan lines"};
    }
    Cursor cursor(bytes, 8);
    Header header;
    if (auto error = read_header(cursor, header)) {
        return *error;
    }
    const auto place = [&](std::string_view name) {
        const auto found = std::find_if(header.channels.begin(), header.channels.end(),
                                        [&](const Channel& channel) { return channel.name == name; });
        return found == header.channels.end() ? -1 : int(found - header.channels.begin());
    };
    std::vector<int> wanted{place("R"), place("G"), place("B")};
    if (wanted[0] < 0 || wanted[1] < 0 || wanted[2] < 0) {
        wanted = {place("Y")};
    }
    if (wanted[0] < 0) {
        return DecodeError{"must hold the channels R, G and B, or Y"};
    }
    const int lines = header.compression == kZip ? kZipLines : 1;
    const int blocks = (header.height() + lines - 1) / lines;
    const double promised = double(header.line_bytes()) * double(header.height());
    if (promised > kMostInflation * double(bytes.size()) || !cursor.take(8 * std::size_t(blocks))) {
        return DecodeError{"promises more pixels than its bytes can hold"};
    }
    const Decompressor decompressor(libdeflate_alloc_decompressor());
    if (!decompressor) {
        throw std::bad_alloc();
    }
    ImageF image(header.width(), header.height(), int(wanted.size()));
    for (int block = 0; block < blocks; ++block) {
        const auto line = cursor.number<std::uint32_t>();
        const auto size = cursor.number<std::uint32_t>();
        const auto data = line && size ? cursor.take(*size) : std::nullopt;
        const int first = line ? int(*line) - header.window[1] : -1;
        if (!data || first < 0 || first >= header.height() || first % lines != 0) {
            return DecodeError{"is cut off or damaged in its pixels"};
        }
        const int end = std::min(first + lines, header.height());
        Bytes raw(header.line_bytes() * std::size_t(end - first));
        if (data->size() == raw.size()) {
            std::copy(data->begin(), data->end(), raw.begin());
        } else {
            if (header.compression == kNoCompression ||
                libdeflate_zlib_decompress(decompressor.get(), data->data(), data->size(), raw.data(), raw.size(),
                                           nullptr) != LIBDEFLATE_SUCCESS) {
                return DecodeError{"is cut off or damaged in its pixels"};
            }
            raw = restored(std::move(raw));
        }
        std::size_t at = 0;
        for (int y = first; y < end; ++y) {
            for (std::size_t c = 0; c < header.channels.size(); ++c) {
                const auto to = std::find(wanted.begin(), wanted.end(), int(c));
                const bool half = header.channels[c].type == kHalf;
                for (int x = 0; x < header.width(); ++x, at += header.channels[c].bytes()) {
                    if (to == wanted.end()) {
                        continue;
                    }
                    image.at(x, y)[to - wanted.begin()] =
                        half ? from_half(read_little<std::uint16_t>(raw, at))
                             : std::bit_cast<float>(read_little<std::uint32_t>(raw, at));
                }
            }
        }
    }
    return image;
}

}  // namespace penumbra
