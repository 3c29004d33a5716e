// SPDX-License-Identifier: MIT
#include "server/service/formats.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdio>

namespace penumbra {
namespace {

constexpr std::array<PictureFormat, 5> kFormats{{
    {"png", "image/png", ".png"},
    {"pfm", "image/x-pfm", ".pfm"},
    {"exr", "image/x-exr", ".exr"},
    {"hdr", "image/vnd.radiance", ".hdr"},
    {"npy", "application/x-npy", ".npy"},
}};

bool ends_with_ignoring_case(std::string_view text, std::string_view end) {
    return text.size() >= end.size() &&
           std::equal(end.rbegin(), end.rend(), text.rbegin(), [](char a, char b) {
               return std::tolower(static_cast<unsigned char>(a)) ==
                      std::tolower(static_cast<unsigned char>(b));
           });
}

}  // namespace

std::span<const PictureFormat> picture_formats() { return kFormats; }

const PictureFormat* find_format(std::string_view name) {
    for (const PictureFormat& format : kFormats) {
        if (format.name == name) return &format;
    }
    return nullptr;
}

const PictureFormat* find_format_of_file(std::string_view path) {
    for (const PictureFormat& format : kFormats) {
        if (ends_with_ignoring_case(path, format.extension)) return &format;
    }
    return nullptr;
}

std::string format_names() {
    std::string names;
    for (const PictureFormat& format : kFormats) {
        if (!names.empty()) names += ", ";
        names += format.name;
    }
    return names;
}

bool FormatWishes::nothing_fits() const {
    return any_q <= 0 &&
           std::none_of(wishes.begin(), wishes.end(), [](const Wish& wish) { return wish.q > 0; });
}

std::string FormatWishes::choose(const std::string& scene_format) const {
    // A format that the list does not know stays the scene's choice as far as "*/*" reaches; that it
    // cannot be written is then told as a problem of the scene.
    std::string best = scene_format;
    double best_q = any_q;
    for (const Wish& wish : wishes) {
        if (wish.format == scene_format) best_q = wish.q;
    }
    for (const Wish& wish : wishes) {
        if (wish.q > best_q) {
            best = wish.format;
            best_q = wish.q;
        }
    }
    return best;
}

FormatWishes any_format() {
    FormatWishes wishes;
    for (const PictureFormat& format : kFormats) {
        wishes.wishes.push_back({std::string(format.name), 1});
    }
    return wishes;
}

FormatWishes only_format(std::string_view name) {
    FormatWishes wishes;
    wishes.wishes.push_back({std::string(name), 1});
    wishes.any_q = 0;
    return wishes;
}

std::string to_string(const FormatWishes& wishes) {
    std::string text;
    const auto add = [&](std::string_view name, double q) {
        char number[32];
        std::snprintf(number, sizeof number, ";q=%.3f", q);
        text += (text.empty() ? "" : ", ") + std::string(name) + number;
    };
    for (const FormatWishes::Wish& wish : wishes.wishes) add(wish.format, wish.q);
    add("*", wishes.any_q);
    return text;
}

Bytes encode_linear(const ImageF& image, std::string_view format, int bit_depth) {
    if (format == "exr") return encode_exr(image, bit_depth == 16 ? ExrSamples::half : ExrSamples::full);
    if (format == "hdr") return encode_hdr(image);
    if (format == "npy") return encode_npy(image);
    return encode_pfm(image);
}

Bytes encode_picture(const RenderResult& result, std::string_view format, int bit_depth) {
    if (const Image8* pixels = std::get_if<Image8>(&result.picture)) return encode_png(*pixels);
    if (const Image16* pixels = std::get_if<Image16>(&result.picture)) return encode_png(*pixels);
    return encode_linear(std::get<ImageF>(result.picture), format, bit_depth);
}

}  // namespace penumbra
