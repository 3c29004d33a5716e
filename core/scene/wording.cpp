// SPDX-License-Identifier: MIT
#include "core/scene/wording.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <cstddef>

namespace penumbra {

namespace {

constexpr std::size_t kLongestQuote = 40;  // bytes; more is cut
constexpr std::size_t kLongestWord = 40;   // of words worth comparing; no known word comes near

char lower(char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; }

// Edits (insert, delete, replace, swap of neighbours) that turn one word into the other.
std::size_t edit_distance(std::string_view a, std::string_view b) {
    std::array<std::size_t, kLongestWord + 1> before{};
    std::array<std::size_t, kLongestWord + 1> last{};
    std::array<std::size_t, kLongestWord + 1> row{};
    for (std::size_t j = 0; j <= b.size(); ++j) {
        last[j] = j;
    }
    for (std::size_t i = 1; i <= a.size(); ++i) {
        row[0] = i;
        for (std::size_t j = 1; j <= b.size(); ++j) {
            const bool same = lower(a[i - 1]) == lower(b[j - 1]);
            row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (same ? 0 : 1)});
            const bool swapped = i > 1 && j > 1 && lower(a[i - 1]) == lower(b[j - 2]) &&
                                 lower(a[i - 2]) == lower(b[j - 1]);
            if (swapped) {
                row[j] = std::min(row[j], before[j - 2] + 1);
            }
        }
        before = last;
        last = row;
    }
    return last[b.size()];
}

bool begins_with(std::string_view text, std::string_view start) {
    return text.size() >= start.size() &&
           std::equal(start.begin(), start.end(), text.begin(),
                      [](char a, char b) { return lower(a) == lower(b); });
}

}  // namespace

std::string number_text(double value) {
    if (std::isnan(value)) {
        return "nan";
    }
    std::array<char, 32> buffer{};
    const auto end = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    return std::string(buffer.data(), end.ptr);
}

std::string in_quotes(std::string_view text) {
    std::size_t end = std::min(text.size(), kLongestQuote);
    const bool cut = end < text.size();
    // Do not cut inside a UTF-8 sequence.
    while (cut && end > 0 && (static_cast<unsigned char>(text[end]) & 0xc0u) == 0x80u) {
        --end;
    }
    static constexpr std::string_view kHex = "0123456789abcdef";
    std::string out = "\"";
    for (const char c : text.substr(0, end)) {
        const auto byte = static_cast<unsigned char>(c);
        if (byte < 0x20 || byte == 0x7f) {
            out += "\\x";
            out += kHex[byte >> 4];
            out += kHex[byte & 15];
        } else {
            out += c;
        }
    }
    out += cut ? "...\"" : "\"";
    return out;
}

std::string join_words(std::span<const std::string_view> words) {
    std::string out;
    for (std::size_t i = 0; i < words.size(); ++i) {
        if (i > 0) {
            out += i + 1 == words.size() ? " or " : ", ";
        }
        out += words[i];
    }
    return out;
}

bool same_letters(std::string_view a, std::string_view b) {
    return a.size() == b.size() && begins_with(a, b);
}

std::string_view nearest_word(std::string_view word, std::span<const std::string_view> known) {
    if (word.empty() || word.size() > kLongestWord) {
        return {};
    }
    std::string_view best;
    std::size_t best_distance = kLongestWord;
    for (const std::string_view candidate : known) {
        if (candidate.size() > kLongestWord) {
            continue;
        }
        const std::size_t distance = edit_distance(word, candidate);
        const std::size_t longer = std::max(word.size(), candidate.size());
        // A third of the letters may be wrong ("centre", "radii" for "radius"), one in short words.
        const bool near = distance <= std::max<std::size_t>(1, longer / 3) && distance < longer;
        // "pos" for "position", "gradients" for "gradient".
        const bool start = std::min(word.size(), candidate.size()) >= 3 &&
                           (begins_with(candidate, word) || begins_with(word, candidate));
        if ((near || start) && distance < best_distance) {
            best = candidate;
            best_distance = distance;
        }
    }
    return best;
}

std::string did_you_mean(std::string_view suggestion) {
    return suggestion.empty() ? std::string() : " (did you mean " + in_quotes(suggestion) + "?)";
}

}  // namespace penumbra
