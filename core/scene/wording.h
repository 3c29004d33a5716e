// SPDX-License-Identifier: MIT
// How messages write numbers, texts and lists, so that every message sounds alike.
#pragma once

#include <span>
#include <string>
#include <string_view>

namespace penumbra {

// The shortest text that reads back as the same number: "0.1", "-3", "1e+10", "nan".
std::string number_text(double value);

// In double quotes; long texts are cut, bytes that a terminal could not show are escaped.
std::string in_quotes(std::string_view text);

// "a, b or c"
std::string join_words(std::span<const std::string_view> words);

// Whether two words differ in nothing but upper and lower case.
bool same_letters(std::string_view a, std::string_view b);

// The known word that was most likely meant, "" when none is near. Upper and lower case are alike.
std::string_view nearest_word(std::string_view word, std::span<const std::string_view> known);

// ` (did you mean "radius"?)`, or "" for an empty suggestion.
std::string did_you_mean(std::string_view suggestion);

}  // namespace penumbra
