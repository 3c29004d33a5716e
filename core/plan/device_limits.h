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

// Of a device that says this of itself; 0: it says nothing.
inline DeviceLimits device_limits(int max_texture_side, int max_buffer_texels, int max_loop_iterations, bool software) {
    DeviceLimits limits;
    if (max_texture_side > 0) limits.max_texture_side = max_texture_side;
    if (max_buffer_texels > 0) limits.max_buffer_texels = static_cast<std::size_t>(max_buffer_texels);
    limits.max_loop_iterations = max_loop_iterations;
    limits.software = software;
    if (!software) limits.max_texture_bytes = std::size_t(8) << 30;
    return limits;
}

}  // namespace penumbra
