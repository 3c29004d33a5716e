// SPDX-License-Identifier: MIT
// The service's log, on stderr: one line per event, as text or as JSON.
#pragma once

#include <cstdint>
#include <initializer_list>
#include <memory>
#include <string>
#include <string_view>
#include <variant>

#include "server/service/config.h"

namespace spdlog {
class logger;
}

namespace penumbra {

struct LogField {
    std::string_view name;
    std::variant<std::string, std::int64_t, double> value;
};

class Log {
public:
    explicit Log(LogFormat format);

    void info(std::string_view message, std::initializer_list<LogField> fields = {}) const;
    void warning(std::string_view message, std::initializer_list<LogField> fields = {}) const;
    void error(std::string_view message, std::initializer_list<LogField> fields = {}) const;
    void flush() const;

private:
    std::string line(std::string_view message, std::initializer_list<LogField> fields) const;

    LogFormat format_;
    std::shared_ptr<spdlog::logger> logger_;
};

}  // namespace penumbra
