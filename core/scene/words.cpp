// SPDX-License-Identifier: MIT
#include "core/scene/words.h"

#include <algorithm>
#include <charconv>

namespace penumbra {

namespace {

constexpr std::string_view kMethods[] = {"auto",  "rc",     "rc_fix",   "hrc",
                                         "exact", "hybrid", "reference"};
constexpr std::string_view kViews[] = {"final", "distance", "normals", "tiles",  "cascade0", "probes",
                                       "steps", "skipped",  "light0",  "shape0", "sky",      "error"};
constexpr std::string_view kFormats[] = {"png", "pfm", "exr", "hdr", "npy"};
constexpr std::string_view kTonemaps[] = {
    "none", "reinhard", "reinhard_extended", "aces", "aces_narkowicz", "agx", "pbr_neutral", "tony"};
constexpr std::string_view kLooks[] = {"none", "golden", "punchy"};

constexpr int kMaxCascade = 15;  // 4^15 pixels across: more than any canvas has
constexpr int kMaxLight = 999, kMaxShape = 19999;  // as many as a scene may have

}  // namespace

std::span<const std::string_view> known_methods() { return kMethods; }
std::span<const std::string_view> known_views() { return kViews; }
std::span<const std::string_view> known_formats() { return kFormats; }
std::span<const std::string_view> known_tonemaps() { return kTonemaps; }
std::span<const std::string_view> known_looks() { return kLooks; }

bool is_known_word(std::string_view word, std::span<const std::string_view> known) {
    return std::find(known.begin(), known.end(), word) != known.end();
}

std::span<const int> bit_depths_of(std::string_view format) {
    static constexpr int kPng[] = {8, 16};
    static constexpr int kExr[] = {32, 16};
    if (format == "png") return kPng;
    if (format == "exr") return kExr;
    return {};
}

int bit_depth_of(std::string_view format, std::optional<int> asked) {
    const std::span<const int> depths = bit_depths_of(format);
    if (asked && std::find(depths.begin(), depths.end(), *asked) != depths.end()) return *asked;
    return depths.empty() ? 0 : depths.front();
}

std::optional<int> view_number(std::string_view view, std::string_view kind) {
    if (!view.starts_with(kind)) return std::nullopt;
    const std::string_view digits = view.substr(kind.size());
    int number = -1;
    const auto end = std::from_chars(digits.data(), digits.data() + digits.size(), number);
    const bool canonical = digits.size() == 1 || (digits.size() > 1 && digits[0] != '0');
    if (!canonical || end.ec != std::errc() || end.ptr != digits.data() + digits.size() || number < 0) return std::nullopt;
    return number;
}

bool is_known_view(std::string_view word) {
    if (is_known_word(word, kViews)) return true;
    const auto within = [&](std::string_view kind, int most) {
        const std::optional<int> number = view_number(word, kind);
        return number && *number <= most;
    };
    return within("cascade", kMaxCascade) || within("light", kMaxLight) || within("shape", kMaxShape);
}

}  // namespace penumbra
