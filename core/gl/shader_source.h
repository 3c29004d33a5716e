// SPDX-License-Identifier: MIT
// Shader files by name, embedded or live from a folder; includes flattened; errors led back to their line.
#pragma once

#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace penumbra::gl {

struct EmbeddedShader {
    const char* name;  // path below glsl/
    const char* text;
};
std::span<const EmbeddedShader> embedded_shaders();

using ShaderConstants = std::vector<std::pair<std::string, int>>;

// One text for the compiler. Each line knows where it came from: `#line` with a source number is lost in
// Mesa's semantic errors.
struct FlatShader {
    struct Origin {
        int file = 0;  // index into files
        int line = 0;  // 1-based
    };
    std::string text;
    std::vector<std::string> files;
    std::vector<Origin> lines;
};

// Reads `name` and, once each, what it includes. Names in `layout(...)` that a `const int` gives a number
// are replaced by it: GLSL 4.30 wants literals there. Reads from `folder` unless it is empty.
// `constants` replace the values of `const int`s and `#define`s of those names: a program for what a scene needs and no more, since
// Mesa 22 runs both sides of every branch. Throws DeviceError when a file is missing.
FlatShader flatten_shader(std::string_view name, const std::string& folder = {}, const ShaderConstants& constants = {});

// "glsl/cascade.comp:41:12: error: ..." from the driver's log (Mesa "0:LINE(COL)", NVIDIA "0(LINE)").
std::string translate_log(const FlatShader& shader, std::string_view log);

}  // namespace penumbra::gl
