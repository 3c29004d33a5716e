// SPDX-License-Identifier: MIT
// What a fuzz target promises of any input, beside not crashing.
#pragma once

#include <cstdint>
#include <cstdio>
#include <cstdlib>

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size);

namespace penumbra::fuzz {

// A broken promise ends the process, which libFuzzer and the replay both report with the input.
inline void check(bool holds, const char* promise) {
    if (holds) return;
    std::fprintf(stderr, "broken promise: %s\n", promise);
    std::abort();
}

}  // namespace penumbra::fuzz
