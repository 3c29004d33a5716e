// SPDX-License-Identifier: MIT
#pragma once

#include <stdexcept>

namespace penumbra {

// The world failed: no device, a shader that does not build, out of memory. Carries a full sentence.
class DeviceError : public std::runtime_error {
public:
    using std::runtime_error::runtime_error;
};

}  // namespace penumbra
