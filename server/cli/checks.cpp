// SPDX-License-Identifier: MIT
#include "server/cli/checks.h"

#include <algorithm>
#include <cerrno>
#include <charconv>
#include <cmath>
#include <cstring>
#include <fstream>
#include <functional>
#include <optional>
#include <string_view>

#include "core/scene/wording.h"

namespace penumbra {
namespace {

template <class Number>
std::optional<Number> parse(const std::string& text) {
    Number value{};
    const auto end = std::from_chars(text.data(), text.data() + text.size(), value);
    if (end.ec != std::errc() || end.ptr != text.data() + text.size()) return std::nullopt;
    return value;
}

std::string refusal(const std::string& allowed, const std::string& text) {
    return "must be " + allowed + ", is " + in_quotes(text);
}

CLI::Validator number(const std::string& allowed, const std::string& brief, std::function<bool(double)> good) {
    return CLI::Validator(
        [=](const std::string& text) {
            const std::optional<double> value = parse<double>(text);
            return value && std::isfinite(*value) && good(*value) ? std::string() : refusal("a number " + allowed, text);
        },
        brief);
}

}  // namespace

CLI::Validator whole_number(long low, long high) {
    const std::string range = std::to_string(low) + " to " + std::to_string(high);
    return CLI::Validator(
        [=](const std::string& text) {
            const std::optional<long> value = parse<long>(text);
            return value && *value >= low && *value <= high ? std::string() : refusal("a whole number from " + range, text);
        },
        range);
}

CLI::Validator number_between(double low, double high) {
    const std::string range = number_text(low) + " to " + number_text(high);
    return number("from " + range, range, [=](double value) { return value >= low && value <= high; });
}

CLI::Validator number_of_at_least(double low) {
    const std::string text = "of at least " + number_text(low);
    return number(text, ">= " + number_text(low), [=](double value) { return value >= low; });
}

CLI::Validator number_of_more_than(double low) {
    const std::string text = "of more than " + number_text(low);
    return number(text, "> " + number_text(low), [=](double value) { return value > low; });
}

CLI::Validator one_of(std::vector<std::string> words) {
    const std::string brief = CLI::detail::join(words, "|");
    return CLI::Validator(
        [words](const std::string& text) {
            const auto same = [&](const std::string& word) { return same_letters(word, text); };
            if (std::any_of(words.begin(), words.end(), same)) return std::string();
            const std::vector<std::string_view> views(words.begin(), words.end());
            return refusal(join_words(views), text) + did_you_mean(nearest_word(text, views));
        },
        brief);
}

CLI::Validator readable_file() {
    return CLI::Validator(
        [](const std::string& path) {
            errno = 0;
            const std::ifstream file(path);
            return file ? std::string() : "cannot read " + path + ": " + std::strerror(errno);
        },
        "FILE");
}

CLI::Validator device_name() {
    return CLI::Validator(
        [](const std::string& device) {
            const bool index = !device.empty() && device.size() <= 4 &&
                               std::all_of(device.begin(), device.end(), [](char c) { return c >= '0' && c <= '9'; });
#ifdef PENUMBRA_HAS_OSMESA
            if (device == "osmesa") return std::string();
#endif
            if (index || device == "auto" || device == "cpu" || device == "gpu") return std::string();
            return refusal("auto, cpu, gpu or an index as `penumbra info` lists them", device);
        },
        "DEVICE");
}

}  // namespace penumbra
