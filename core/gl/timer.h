// SPDX-License-Identifier: MIT
// Device time between two points of the command stream, by timestamp queries.
#pragma once

#include <vector>

#include "core/gl/gl.h"

namespace penumbra::gl {

// begin(), end(), begin(), end(), ... then read() once everything has been sent.
class PassTimer {
public:
    PassTimer() = default;
    PassTimer(const PassTimer&) = delete;
    PassTimer& operator=(const PassTimer&) = delete;
    ~PassTimer();

    void reset() { used_ = 0; }
    void mark();
    // Milliseconds between marks 2i and 2i+1; waits for the device.
    std::vector<double> read();

private:
    std::vector<GLuint> queries_;
    std::size_t used_ = 0;
};

}  // namespace penumbra::gl
