// SPDX-License-Identifier: MIT
// The words that a scene's settings may hold. Knowing a word is not rendering it: the plan says
// what is supported.
#pragma once

#include <optional>
#include <span>
#include <string_view>

namespace penumbra {

std::span<const std::string_view> known_methods();
// "cascade0" stands for cascade0 to cascade15, "light0" and "shape0" for all of their kind.
std::span<const std::string_view> known_views();
std::span<const std::string_view> known_formats();
std::span<const std::string_view> known_tonemaps();
std::span<const std::string_view> known_looks();

bool is_known_word(std::string_view word, std::span<const std::string_view> known);
// The bit depths that a picture format may have, its own first; one that has no choice has none.
std::span<const int> bit_depths_of(std::string_view format);
// What the picture is written with: `asked` where the format has it (an Accept header may have chosen another format than
// the scene), else the format's own.
int bit_depth_of(std::string_view format, std::optional<int> asked);

bool is_known_view(std::string_view word);
// The number of a view of this kind ("cascade", "light", "shape"); none of another.
std::optional<int> view_number(std::string_view view, std::string_view kind);

}  // namespace penumbra
