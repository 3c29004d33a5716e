// SPDX-License-Identifier: MIT
// What the tests of the scene format share.
#pragma once

#include <gtest/gtest.h>

#include <algorithm>
#include <fstream>
#include <iterator>
#include <string>
#include <vector>

#include "core/image/codec.h"
#include "core/scene/validate.h"
#include "server/json/scene_json.h"

namespace penumbra {

// A document with a small canvas and `rest`: `, "shapes": [...]`.
inline std::string document(const std::string& rest = {}) {
    return R"({"version": 1, "canvas": {"width": 32, "height": 24})" + rest + "}";
}

inline std::string with_shape(const std::string& shape) {
    return document(R"(, "shapes": [)" + shape + "]");
}

inline Scene small_scene() {
    Scene scene;
    scene.canvas.width = 32;
    scene.canvas.height = 24;
    return scene;
}

// "pointer code" of each problem: what tests compare.
inline std::vector<std::string> brief(const Problems& problems) {
    std::vector<std::string> lines;
    for (const Problem& p : problems) {
        lines.push_back(p.pointer + " " + p.code);
    }
    return lines;
}

inline std::vector<std::string> brief(const ParsedScene& parsed) {
    Problems problems;
    for (const LocatedProblem& p : parsed.problems) {
        problems.push_back(p.problem);
    }
    return brief(problems);
}

inline std::string all_text(const ParsedScene& parsed) {
    std::string text;
    for (const LocatedProblem& p : parsed.problems) {
        text += to_string(p) + "\n";
    }
    return text;
}

inline std::string read_file(const std::string& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

inline std::string to_base64(const Bytes& bytes) {
    static const std::string kAlphabet =
        "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string text;
    for (std::size_t i = 0; i < bytes.size(); i += 3) {
        std::uint32_t group = 0;
        for (std::size_t k = 0; k < 3; ++k) {
            group = group << 8 | (i + k < bytes.size() ? bytes[i + k] : 0u);
        }
        for (std::size_t k = 0; k < 4; ++k) {
            text += i + k > bytes.size() ? '=' : kAlphabet[group >> (18 - 6 * k) & 63];
        }
    }
    return text;
}

inline std::string data_url(const Bytes& png) { return "data:image/png;base64," + to_base64(png); }

}  // namespace penumbra
