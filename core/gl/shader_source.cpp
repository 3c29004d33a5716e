// SPDX-License-Identifier: MIT
#include "core/gl/shader_source.h"

#include <algorithm>
#include <cctype>
#include <fstream>
#include <map>
#include <sstream>

#include "core/device_error.h"

namespace penumbra::gl {
namespace {

std::string read_shader(std::string_view name, const std::string& folder) {
    if (folder.empty()) {
        for (const EmbeddedShader& shader : embedded_shaders())
            if (name == shader.name) return shader.text;
        throw DeviceError("No shader is embedded under the name '" + std::string(name) + "'.");
    }
    std::ifstream file(folder + "/" + std::string(name));
    if (!file) throw DeviceError("Cannot read the shader '" + folder + "/" + std::string(name) + "'.");
    std::ostringstream text;
    text << file.rdbuf();
    return text.str();
}

bool is_name_char(char c) { return std::isalnum(static_cast<unsigned char>(c)) != 0 || c == '_'; }

class Flattener {
public:
    Flattener(const std::string& folder, const ShaderConstants& given, FlatShader& out) : folder_(folder), given_(given), out_(out) {}

    void add(const std::string& name) {
        if (std::find(out_.files.begin(), out_.files.end(), name) != out_.files.end()) return;
        const int file = static_cast<int>(out_.files.size());
        out_.files.push_back(name);
        std::istringstream lines(read_shader(name, folder_));
        std::string line;
        for (int number = 1; std::getline(lines, line); ++number) {
            if (line.rfind("#include \"", 0) == 0) {
                const auto end = line.find('"', 10);
                add(resolve(name, line.substr(10, end - 10)));
                continue;
            }
            give_constant(line);
            remember_constant(line);
            if (line.find("layout(") != std::string::npos) line = substitute(line);
            out_.text += line + "\n";
            out_.lines.push_back({file, number});
        }
    }

private:
    // Includes are relative to glsl/ or to the including file's folder.
    std::string resolve(const std::string& from, const std::string& name) const {
        const auto slash = from.rfind('/');
        if (slash == std::string::npos) return name;
        if (!folder_.empty()) return std::ifstream(folder_ + "/" + name) ? name : from.substr(0, slash + 1) + name;
        for (const EmbeddedShader& shader : embedded_shaders())
            if (name == shader.name) return name;
        return from.substr(0, slash + 1) + name;
    }

    // `const int NAME = ...;` and `#define NAME ...` take the value given for NAME.
    void give_constant(std::string& line) const {
        for (const auto& [name, value] : given_) {
            const std::string start = "const int " + name + " = ";
            const std::string define = "#define " + name + " ";
            if (line.rfind(define, 0) == 0) line = define + std::to_string(value);
            if (line.rfind(start, 0) == 0) line = start + std::to_string(value) + line.substr(line.find(';'));
        }
    }

    void remember_constant(const std::string& line) {
        static const std::string kStart = "const int ";
        if (line.rfind(kStart, 0) != 0) return;
        std::size_t at = kStart.size();
        const std::size_t begin = at;
        while (at < line.size() && is_name_char(line[at])) ++at;
        const auto equals = line.find('=', at);
        const auto end = line.find(';', at);
        if (equals == std::string::npos || end == std::string::npos) return;
        std::string value = line.substr(equals + 1, end - equals - 1);
        value.erase(0, value.find_first_not_of(' '));
        constants_[line.substr(begin, at - begin)] = value;
    }

    std::string substitute(const std::string& line) const {
        const auto open = line.find("layout(");
        const auto close = line.find(')', open);
        std::string result = line.substr(0, open);
        for (std::size_t at = open; at < close;) {
            std::size_t end = at;
            while (end < close && is_name_char(line[end])) ++end;
            if (end == at) {
                result += line[at++];
                continue;
            }
            const auto found = constants_.find(line.substr(at, end - at));
            result += found == constants_.end() ? line.substr(at, end - at) : found->second;
            at = end;
        }
        return result + line.substr(close);
    }

    const std::string& folder_;
    const ShaderConstants& given_;
    FlatShader& out_;
    std::map<std::string, std::string> constants_;
};

struct LogLine {
    std::size_t number = 0;  // of the flattened text; 0: the line names none
    std::size_t column = 0;  // 0: none named
    std::string message;
};

// Mesa: "0:12(3): error: ..."; NVIDIA: "0(12) : error C1008: ...".
LogLine parse_log_line(const std::string& line) {
    std::size_t at = line.find_first_not_of(" \t");
    const auto digits = [&]() -> std::size_t {
        std::size_t value = 0;
        const std::size_t begin = at;
        while (at < line.size() && at - begin < 9 && std::isdigit(static_cast<unsigned char>(line[at])) != 0)
            value = value * 10 + static_cast<std::size_t>(line[at++] - '0');
        return at == begin ? std::string::npos : value;
    };
    const auto skip = [&](char c) { return at < line.size() && line[at] == c ? (++at, true) : false; };
    if (at == std::string::npos || digits() == std::string::npos) return {};
    LogLine result;
    const bool mesa = skip(':');
    if (mesa) result.number = digits();
    if (result.number == std::string::npos || !skip('(')) return {};
    (mesa ? result.column : result.number) = digits();
    if (result.number == std::string::npos || result.column == std::string::npos || !skip(')')) return {};
    while (skip(' ')) {
    }
    if (!skip(':')) return {};
    while (skip(' ')) {
    }
    result.message = line.substr(at);
    return result;
}

}  // namespace

FlatShader flatten_shader(std::string_view name, const std::string& folder, const ShaderConstants& constants) {
    FlatShader shader;
    Flattener(folder, constants, shader).add(std::string(name));
    return shader;
}

std::string translate_log(const FlatShader& shader, std::string_view log) {
    std::istringstream lines{std::string(log)};
    std::string line;
    std::string result;
    while (std::getline(lines, line)) {
        const auto [number, column, message] = parse_log_line(line);
        if (number >= 1 && number <= shader.lines.size()) {
            const FlatShader::Origin& origin = shader.lines[number - 1];
            result += "glsl/" + shader.files[static_cast<std::size_t>(origin.file)] + ":" +
                      std::to_string(origin.line) + (column > 0 ? ":" + std::to_string(column) : "") + ": " + message + "\n";
        } else if (!line.empty()) {
            result += line + "\n";
        }
    }
    return result;
}

}  // namespace penumbra::gl
