// SPDX-License-Identifier: MIT
#include "server/json/font_source.h"

#include <fstream>
#include <iterator>

namespace penumbra {
namespace {

// fonts-dejavu-core on Debian 12 and 13; then where other systems have it.
constexpr const char* kPlaces[] = {
    "/usr/share/fonts/truetype/dejavu/DejaVuSans.ttf",
    "/usr/share/fonts/TTF/DejaVuSans.ttf",
    "/usr/share/fonts/dejavu-sans-fonts/DejaVuSans.ttf",
};
constexpr std::size_t kMostBytes = 64u << 20;

std::optional<std::vector<std::uint8_t>> read_bytes(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    if (!file) return std::nullopt;
    std::vector<std::uint8_t> bytes{std::istreambuf_iterator<char>(file), {}};
    if (bytes.empty() || bytes.size() > kMostBytes) return std::nullopt;
    return bytes;
}

}  // namespace

void FontSource::load() const {
    std::optional<std::vector<std::uint8_t>> bytes;
    std::string found = path_;
    if (!path_.empty()) {
        bytes = read_bytes(path_);
        if (!bytes) why_ = "cannot be set: the font " + path_ + " cannot be read";
    } else {
        for (const char* place : kPlaces) {
            bytes = read_bytes(found = place);
            if (bytes) break;
        }
        if (!bytes) why_ = "cannot be set: this service has no font (package fonts-dejavu-core, or --font)";
    }
    if (!bytes) return;
    auto loaded = load_font(std::move(*bytes));
    if (const auto* why = std::get_if<std::string>(&loaded)) {
        why_ = "cannot be set: " + found + " " + *why;
    } else {
        font_ = std::move(std::get<Font>(loaded));
    }
}

const Font* FontSource::font() const {
    std::call_once(once_, [this] { load(); });
    return font_ ? &*font_ : nullptr;
}

const std::string& FontSource::why() const {
    font();
    return why_;
}

}  // namespace penumbra
