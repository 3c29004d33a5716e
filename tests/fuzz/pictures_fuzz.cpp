// SPDX-License-Identifier: MIT
// Any bytes as one of the linear formats, the first byte saying which: refused with a sentence, or floats that our own
// encoder keeps.
#include <cmath>
#include <cstring>

#include "check.h"
#include "core/image/codec.h"

using namespace penumbra;
using fuzz::check;

namespace {

using Decoded = std::variant<ImageF, DecodeError>;

void take(const Decoded& decoded, Decoded (*decode)(std::span<const std::uint8_t>), Bytes (*encode)(const ImageF&)) {
    if (const auto* error = std::get_if<DecodeError>(&decoded)) {
        check(!error->message.empty(), "a refusal says why");
        return;
    }
    const ImageF& image = std::get<ImageF>(decoded);
    check(image.width >= 1 && image.height >= 1, "a picture has pixels");
    check(image.data.size() == std::size_t(image.width) * std::size_t(image.height) * std::size_t(image.channels), "a value a channel");
    if (encode == nullptr || (image.channels != 1 && image.channels != 3)) return;
    const Decoded again = decode(encode(image));
    check(std::holds_alternative<ImageF>(again), "what we write we read");
    const ImageF& kept = std::get<ImageF>(again);
    check(kept.data.size() == image.data.size(), "writing keeps the size");
    for (std::size_t i = 0; i < kept.data.size(); ++i) {
        check(kept.data[i] == image.data[i] || (std::isnan(kept.data[i]) && std::isnan(image.data[i])), "writing keeps the values");
    }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    if (size == 0) return 0;
    const std::span<const std::uint8_t> bytes(data + 1, size - 1);
    switch (data[0] % 4) {
        case 0: take(decode_pfm(bytes), decode_pfm, encode_pfm); break;
        case 1: take(decode_exr(bytes), decode_exr, [](const ImageF& image) { return encode_exr(image, ExrSamples::full); }); break;
        case 2: take(decode_hdr(bytes), decode_hdr, nullptr); break;  // rounds
        default: take(decode_npy(bytes), decode_npy, encode_npy); break;
    }
    return 0;
}
