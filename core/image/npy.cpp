// SPDX-License-Identifier: MIT
// NumPy's file format, version 1.0 (NEP 1): a header that is a Python dictionary, then the samples.
#include <bit>
#include <cassert>
#include <charconv>
#include <string>
#include <string_view>
#include <utility>

#include "core/image/byte_order.h"
#include "core/image/codec.h"

namespace penumbra {

namespace {

constexpr std::string_view kMagic = "\x93NUMPY";
constexpr std::size_t kAlignment = 64;  // of the samples, as NumPy writes them
constexpr int kMaxSide = 1 << 20;

// The text after a key of the dictionary.
std::string_view value_of(std::string_view header, std::string_view key) {
    const std::size_t at = header.find("'" + std::string(key) + "'");
    if (at == header.npos) {
        return {};
    }
    const std::size_t colon = header.find(':', at);
    if (colon == header.npos) {
        return {};
    }
    const std::size_t start = header.find_first_not_of(' ', colon + 1);
    return start == header.npos ? std::string_view() : header.substr(start);
}

// "(3, 4, 3)" as numbers; empty when it is none.
std::vector<long long> shape_of(std::string_view text) {
    std::vector<long long> sides;
    if (!text.starts_with('(')) {
        return sides;
    }
    text = text.substr(1, text.find(')') - 1);
    while (!text.empty()) {
        const std::size_t start = text.find_first_not_of(" ,");
        if (start == text.npos) {
            break;
        }
        text.remove_prefix(start);
        long long side = 0;
        const auto end = std::from_chars(text.data(), text.data() + text.size(), side);
        if (end.ec != std::errc() || side < 0) {
            return {};
        }
        sides.push_back(side);
        text.remove_prefix(std::size_t(end.ptr - text.data()));
    }
    return sides;
}

}  // namespace

Bytes encode_npy(const ImageF& image) {
    assert(image.width > 0 && image.height > 0);
    std::string header = "{'descr': '<f4', 'fortran_order': False, 'shape': (" +
                         std::to_string(image.height) + ", " + std::to_string(image.width) + ", " +
                         std::to_string(image.channels) + "), }";
    const std::size_t before = kMagic.size() + 4;
    while ((before + header.size() + 1) % kAlignment != 0) {
        header += ' ';
    }
    header += '\n';
    Bytes file(kMagic.begin(), kMagic.end());
    file.push_back(1);
    file.push_back(0);
    append_little(file, std::uint16_t(header.size()));
    file.insert(file.end(), header.begin(), header.end());
    const std::size_t start = file.size();
    file.resize(start + image.data.size() * sizeof(float));
    for (std::size_t i = 0; i < image.data.size(); ++i) {
        put_little(file.data() + start + i * sizeof(float),
                   std::bit_cast<std::uint32_t>(image.data[i]));
    }
    return file;
}

std::variant<ImageF, DecodeError> decode_npy(std::span<const std::uint8_t> bytes) {
    const std::string_view text(reinterpret_cast<const char*>(bytes.data()), bytes.size());
    if (!text.starts_with(kMagic) || bytes.size() < 12) {
        return DecodeError{"is not an NPY file"};
    }
    const bool first = bytes[6] == 1;
    const std::size_t length_bytes = first ? 2 : 4;
    const std::size_t header_length =
        first ? read_little<std::uint16_t>(bytes, 8) : read_little<std::uint32_t>(bytes, 8);
    const std::size_t start = 8 + length_bytes + header_length;
    if (start > bytes.size()) {
        return DecodeError{"is cut off in its header"};
    }
    const std::string_view header = text.substr(8 + length_bytes, header_length);
    const bool single = value_of(header, "descr").starts_with("'<f4'");
    if (!single && !value_of(header, "descr").starts_with("'<f8'")) {
        return DecodeError{"must hold numbers of type '<f4' or '<f8'"};
    }
    if (!value_of(header, "fortran_order").starts_with("False")) {
        return DecodeError{"must be in C order (rows first)"};
    }
    const auto shape = shape_of(value_of(header, "shape"));
    const bool grey = shape.size() == 2;
    const bool good = grey || (shape.size() == 3 && (shape[2] == 1 || shape[2] == 3));
    if (!good || shape[0] < 1 || shape[1] < 1 || shape[0] > kMaxSide || shape[1] > kMaxSide) {
        return DecodeError{"must have the shape (height, width), with 1 or 3 channels or none"};
    }
    const int channels = grey ? 1 : int(shape[2]);
    const std::size_t sample = single ? 4 : 8;
    const std::size_t count = std::size_t(shape[0]) * std::size_t(shape[1]) * std::size_t(channels);
    if (bytes.size() - start != count * sample) {
        return DecodeError{"holds " + std::to_string(bytes.size() - start) +
                           " bytes of samples where its header promises " +
                           std::to_string(count * sample)};
    }
    const auto [height, width] = std::pair(int(shape[0]), int(shape[1]));
    ImageF image(width, height, channels);
    for (std::size_t i = 0; i < count; ++i) {
        const std::size_t at = start + i * sample;
        image.data[i] =
            single ? std::bit_cast<float>(read_little<std::uint32_t>(bytes, at))
                   : float(std::bit_cast<double>(read_little<std::uint64_t>(bytes, at)));
    }
    return image;
}

}  // namespace penumbra
