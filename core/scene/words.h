// SPDX-License-Identifier: MIT
// The words that a scene's settings may hold. Knowing a word is not rendering it: the plan says
// what is supported.
#pragma once

#include <span>
#include <string_view>

namespace penumbra {

std::span<const std::string_view> known_methods();
std::span<const std::string_view> known_views();  // "cascade0" stands for cascade0 to cascade15
std::span<const std::string_view> known_formats();
std::span<const std::string_view> known_tonemaps();

bool is_known_word(std::string_view word, std::span<const std::string_view> known);
bool is_known_view(std::string_view word);

}  // namespace penumbra
