// SPDX-License-Identifier: MIT
// The font that text is set in: a file of the operator's choice, else Debian's DejaVu Sans. Read when the first text asks for it.
#pragma once

#include <mutex>
#include <optional>
#include <string>

#include "core/outline/text.h"

namespace penumbra {

class FontSource {
public:
    explicit FontSource(std::string path = {}) : path_(std::move(path)) {}

    // nullptr when there is none; why() says so then. For any thread.
    const Font* font() const;
    const std::string& why() const;

private:
    void load() const;

    std::string path_;  // empty: where Debian puts its font
    mutable std::once_flag once_;
    mutable std::optional<Font> font_;
    mutable std::string why_;
};

}  // namespace penumbra
