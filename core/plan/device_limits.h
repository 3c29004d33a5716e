// SPDX-License-Identifier: MIT
#pragma once

#include <cstddef>

namespace penumbra {

// What the plan must know of a device. The defaults are llvmpipe's (docs/operations.md).
struct DeviceLimits {
    int max_texture_side = 16384;
    std::size_t max_texture_bytes = (std::size_t(1) << 30) - 1;  // llvmpipe: LP_MAX_TEXTURE_SIZE
    std::size_t max_buffer_texels = std::size_t(1) << 27;
    int max_loop_iterations = 65535;  // of one invocation, all loops together; Mesa before 25; 0: no limit
    bool software = true;
};

}  // namespace penumbra
