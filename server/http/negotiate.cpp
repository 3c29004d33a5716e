// SPDX-License-Identifier: MIT
#include "server/http/negotiate.h"

#include <algorithm>
#include <cctype>
#include <cstdio>
#include <random>

namespace penumbra {
namespace {

std::string lower_trimmed(std::string_view text) {
    const auto is_space = [](char c) { return c == ' ' || c == '\t'; };
    while (!text.empty() && is_space(text.front())) text.remove_prefix(1);
    while (!text.empty() && is_space(text.back())) text.remove_suffix(1);
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(),
                   [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
    return out;
}

std::vector<std::string> split(std::string_view text, char separator) {
    std::vector<std::string> parts;
    while (true) {
        const std::size_t end = text.find(separator);
        parts.push_back(lower_trimmed(text.substr(0, end)));
        if (end == std::string_view::npos) return parts;
        text.remove_prefix(end + 1);
    }
}

struct MediaRange {
    std::string type;
    double q = 1;
};

// "0", "0.5", "1.000"; anything else counts as 0, so that nonsense wins nothing.
double parse_q(const std::string& text) {
    if (text.empty() || text.size() > 5 || (text[0] != '0' && text[0] != '1')) return 0;
    double value = text[0] - '0';
    if (text.size() > 1 && text[1] != '.') return 0;
    double digit = 0.1;
    for (std::size_t i = 2; i < text.size(); ++i, digit /= 10) {
        if (text[i] < '0' || text[i] > '9') return 0;
        value += digit * (text[i] - '0');
    }
    return std::min(value, 1.0);
}

std::vector<MediaRange> parse_ranges(std::string_view accept) {
    std::vector<MediaRange> ranges;
    for (const std::string& entry : split(accept, ',')) {
        if (entry.empty()) continue;
        const std::vector<std::string> parts = split(entry, ';');
        MediaRange range{parts[0], 1};
        for (std::size_t i = 1; i < parts.size(); ++i) {
            if (parts[i].starts_with("q=")) range.q = parse_q(parts[i].substr(2));
        }
        ranges.push_back(range);
    }
    return ranges;
}

// The most specific range that matches decides, not the gladdest.
double quality(const std::vector<MediaRange>& ranges, std::string_view type) {
    const std::string group = std::string(type.substr(0, type.find('/'))) + "/*";
    for (const std::string_view candidate : {type, std::string_view(group), std::string_view("*/*")}) {
        for (const MediaRange& range : ranges) {
            if (range.type == candidate) return range.q;
        }
    }
    return 0;
}

bool is_token_char(char c) {
    return std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' || c == '.';
}

}  // namespace

FormatWishes parse_accept(std::string_view accept) {
    const std::vector<MediaRange> ranges = parse_ranges(accept);
    if (ranges.empty()) return any_format();
    FormatWishes wishes;
    for (const PictureFormat& format : picture_formats()) {
        wishes.wishes.push_back({std::string(format.name), quality(ranges, format.media_type)});
    }
    wishes.any_q = quality(ranges, "image/*");
    return wishes;
}

std::optional<std::size_t> choose_media_type(std::string_view accept, const std::vector<std::string_view>& types) {
    const std::vector<MediaRange> ranges = parse_ranges(accept);
    if (ranges.empty()) return 0;
    std::optional<std::size_t> best;
    double best_q = 0;
    for (std::size_t i = 0; i < types.size(); ++i) {
        const double q = quality(ranges, types[i]);
        if (q <= best_q) continue;
        best = i;
        best_q = q;
    }
    return best;
}

std::string refuse_content_type(std::string_view content_type) {
    const std::vector<std::string> parts = split(content_type, ';');
    const std::string& type = parts[0];
    if (type.empty()) return "";  // no header: the body speaks for itself
    const bool json = type == "application/json" ||
                      (type.find('/') != std::string::npos && type.size() > 5 && type.ends_with("+json"));
    if (!json) {
        return "The body is declared as " + type + "; send it as Content-Type: application/json.";
    }
    for (std::size_t i = 1; i < parts.size(); ++i) {
        if (!parts[i].starts_with("charset=")) continue;
        std::string charset = parts[i].substr(8);
        std::erase(charset, '"');
        if (charset != "utf-8" && charset != "utf8") {
            return "The body is declared as " + charset + "; JSON is sent in UTF-8.";
        }
    }
    return "";
}

bool EntityTags::has(std::string_view tag) const {
    return any || std::find(tags.begin(), tags.end(), tag) != tags.end();
}

EntityTags parse_entity_tags(std::string_view list) {
    EntityTags result;
    if (lower_trimmed(list) == "*") {
        result.any = true;
        return result;
    }
    // A tag may hold commas: the quotes divide.
    while (true) {
        const std::size_t start = list.find_first_not_of(" \t,");
        if (start == std::string_view::npos) return result;
        list.remove_prefix(start);
        if (list.starts_with("W/")) list.remove_prefix(2);
        const std::size_t end = list.starts_with('"') ? list.find('"', 1) : std::string_view::npos;
        if (end == std::string_view::npos) return {};
        result.tags.emplace_back(list.substr(1, end - 1));
        list.remove_prefix(end + 1);
        const std::size_t next = list.find_first_not_of(" \t");
        if (next != std::string_view::npos && list[next] != ',') return {};
    }
}

bool has_directive(std::string_view list, std::string_view name) {
    for (const std::string& part : split(list, ',')) {
        if (part.substr(0, part.find('=')) == name) return true;
    }
    return false;
}

std::optional<double> parse_wait(std::string_view prefer) {
    for (const std::string& preference : split(prefer, ',')) {
        std::string value = preference.substr(0, preference.find(';'));
        if (!value.starts_with("wait=")) continue;
        value = lower_trimmed(std::string_view(value).substr(5));
        std::erase(value, '"');
        const bool number = !value.empty() && value.size() <= 12 && std::count(value.begin(), value.end(), '.') <= 1 &&
                            value.front() != '.' &&
                            std::all_of(value.begin(), value.end(), [](char c) { return c == '.' || (c >= '0' && c <= '9'); });
        if (number) return std::stod(value);
    }
    return std::nullopt;
}

bool has_preference(std::string_view prefer, std::string_view name, std::string_view value) {
    for (const std::string& preference : split(prefer, ',')) {
        const std::string entry = lower_trimmed(preference.substr(0, preference.find(';')));
        const std::size_t equals = entry.find('=');
        if (equals == std::string::npos || lower_trimmed(entry.substr(0, equals)) != name) continue;
        std::string given = lower_trimmed(entry.substr(equals + 1));
        std::erase(given, '"');
        if (given == value) return true;
    }
    return false;
}

bool accepts_gzip(std::string_view accept_encoding) {
    double gzip = -1, any = -1;
    for (const MediaRange& coding : parse_ranges(accept_encoding)) {
        if (coding.type == "gzip" || coding.type == "x-gzip") gzip = std::max(gzip, coding.q);
        if (coding.type == "*") any = coding.q;
    }
    return gzip >= 0 ? gzip > 0 : any > 0;
}

bool is_request_id(std::string_view id) {
    return !id.empty() && id.size() <= 64 && std::all_of(id.begin(), id.end(), is_token_char);
}

std::string new_request_id() {
    // Making one asks the processor what it can, which takes longer on a virtual machine than all the rest of a refusal.
    thread_local std::random_device device;
    char id[33];
    std::snprintf(id, sizeof id, "%08x%08x", unsigned(device()), unsigned(device()));
    return id;
}

std::string refuse_framing(const std::vector<std::string>& content_lengths,
                           const std::vector<std::string>& transfer_encodings) {
    if (content_lengths.size() > 1) return "There is more than one Content-Length.";
    if (transfer_encodings.size() > 1) return "There is more than one Transfer-Encoding.";
    if (!content_lengths.empty() && !transfer_encodings.empty()) {
        return "There is a Content-Length as well as a Transfer-Encoding.";
    }
    if (!transfer_encodings.empty() && lower_trimmed(transfer_encodings[0]) != "chunked") {
        return "The only Transfer-Encoding taken is chunked.";
    }
    if (!content_lengths.empty()) {
        const std::string& length = content_lengths[0];
        // 18 digits fit in 64 bits.
        if (length.empty() || length.size() > 18 ||
            !std::all_of(length.begin(), length.end(), [](char c) { return c >= '0' && c <= '9'; })) {
            return "Content-Length is not a number of bytes.";
        }
    }
    return "";
}

std::string timing_name(std::string_view name) {
    std::string out(name);
    std::replace_if(out.begin(), out.end(), [](char c) { return !is_token_char(c); }, '-');
    return out.empty() ? "pass" : out;
}

std::string timing_entry(std::string_view name, double ms) {
    char number[40];
    std::snprintf(number, sizeof number, "%.2f", ms);
    return timing_name(name) + ";dur=" + number;
}

}  // namespace penumbra
