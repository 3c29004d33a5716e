// SPDX-License-Identifier: MIT
// What is wrong with a scene, and where. Bad input is a value, never an exception.
#pragma once

#include <string>
#include <vector>

namespace penumbra {

struct Problem {
    std::string pointer;  // JSON pointer (RFC 6901) into the scene document, "" for the whole
    std::string code;     // stable and short, e.g. "out_of_range", "not_supported_yet"
    std::string message;  // one sentence for a person
};

using Problems = std::vector<Problem>;

}  // namespace penumbra
