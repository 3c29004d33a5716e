// SPDX-License-Identifier: MIT
// Files of the command line, with "-" for the standard streams. Failures are exceptions with a sentence.
#pragma once

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>

namespace penumbra {

// Bad input: exit code 2.
class InputError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

// Throws InputError when there is no such file or it is longer than max_bytes.
std::string read_text(const std::string& path, std::size_t max_bytes);

// Whole or not at all: written beside its place and renamed. Throws std::runtime_error.
// What is no regular file (a pipe, /dev/stdout) is written directly.
void write_file(const std::string& path, std::span<const unsigned char> bytes);
void write_text(const std::string& path, const std::string& text);

bool stdout_is_terminal();

}  // namespace penumbra
