// SPDX-License-Identifier: MIT
#include "server/cli/picture_input.h"

#include <cstdint>
#include <span>
#include <string_view>

#include "core/image/codec.h"
#include "server/cli/files.h"

namespace penumbra {
namespace {

template <class T>
T expect(std::variant<T, DecodeError>&& decoded, const std::string& path) {
    if (const auto* error = std::get_if<DecodeError>(&decoded)) throw InputError(path + ": " + error->message);
    return std::move(std::get<T>(decoded));
}

}  // namespace

Picture read_picture(const std::string& path) {
    const std::string text = read_text(path, std::size_t(4) << 30);
    const std::span<const std::uint8_t> bytes(reinterpret_cast<const std::uint8_t*>(text.data()), text.size());
    const std::string_view start(text);
    if (start.starts_with("PF") || start.starts_with("Pf")) return expect(decode_pfm(bytes), path);
    if (start.starts_with("\x76\x2f\x31\x01")) return expect(decode_exr(bytes), path);
    if (start.starts_with("#?")) return expect(decode_hdr(bytes), path);
    if (start.starts_with("\x93NUMPY")) return expect(decode_npy(bytes), path);
    constexpr DecodeLimits kLimits{.max_side_px = 16384, .max_pixels = 16384.0 * 16384.0};
    if (is_png16(bytes)) return expect(decode_png16(bytes, kLimits), path);
    Texels texels = expect(decode_png(bytes, kLimits), path);
    Image8 image;
    image.width = texels.width;
    image.height = texels.height;
    image.channels = 4;
    image.data = std::move(texels.rgba);
    return image;
}

Image16 widened(const Image8& image) {
    Image16 wide(image.width, image.height, image.channels);
    for (std::size_t i = 0; i < wide.data.size(); ++i) wide.data[i] = std::uint16_t(image.data[i] * 257);
    return wide;
}

Image8 narrowed(const Image16& image) {
    Image8 narrow(image.width, image.height, image.channels);
    for (std::size_t i = 0; i < narrow.data.size(); ++i) narrow.data[i] = std::uint8_t((image.data[i] + 128) / 257);
    return narrow;
}

}  // namespace penumbra
