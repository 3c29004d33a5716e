// SPDX-License-Identifier: MIT
#include "server/service/log.h"

#include <cstdio>

#include <nlohmann/json.hpp>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>

namespace penumbra {
namespace {

std::string to_json(const std::string& text) {
    // Bytes of clients may be no UTF-8; a log line always is.
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string number(double value) {
    char text[40];
    std::snprintf(text, sizeof text, "%.2f", value);
    return text;
}

// Quoted as soon as it could be mistaken for something else: a line stays a line.
std::string plain(const std::string& text) {
    bool simple = !text.empty();
    for (const char c : text) {
        simple = simple && c > ' ' && c < 0x7f && c != '"' && c != '=' && c != '\\';
    }
    return simple ? text : to_json(text);
}

}  // namespace

Log::Log(LogFormat format) : format_(format) {
    // Not registered under a name: several services may live in one process.
    logger_ = std::make_shared<spdlog::logger>(
        "penumbra", std::make_shared<spdlog::sinks::stderr_sink_mt>());
    logger_->set_pattern(format == LogFormat::json
                             ? R"({"time":"%Y-%m-%dT%H:%M:%S.%e%z","level":"%l",%v})"
                             : "%Y-%m-%dT%H:%M:%S.%e %l %v");
    logger_->flush_on(spdlog::level::info);
}

std::string Log::line(std::string_view message, std::initializer_list<LogField> fields) const {
    const bool json = format_ == LogFormat::json;
    std::string out = json ? "\"message\":" + to_json(std::string(message)) : std::string(message);
    for (const LogField& field : fields) {
        std::string value;
        if (const auto* text = std::get_if<std::string>(&field.value)) {
            if (text->empty()) continue;  // what there is not
            value = json ? to_json(*text) : plain(*text);
        } else if (const auto* whole = std::get_if<std::int64_t>(&field.value)) {
            value = std::to_string(*whole);
        } else {
            value = number(std::get<double>(field.value));
        }
        out += json ? "," + to_json(std::string(field.name)) + ":" : " " + std::string(field.name) + "=";
        out += value;
    }
    return out;
}

void Log::info(std::string_view message, std::initializer_list<LogField> fields) const {
    logger_->info(spdlog::string_view_t(line(message, fields)));
}
void Log::warning(std::string_view message, std::initializer_list<LogField> fields) const {
    logger_->warn(spdlog::string_view_t(line(message, fields)));
}
void Log::error(std::string_view message, std::initializer_list<LogField> fields) const {
    logger_->error(spdlog::string_view_t(line(message, fields)));
}
void Log::flush() const { logger_->flush(); }

}  // namespace penumbra
