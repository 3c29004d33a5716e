// SPDX-License-Identifier: MIT
// Which program on which device makes a picture: two that agree in both make the same bytes.
#pragma once

#include <string>

#include "core/renderer.h"

namespace penumbra {

// A digest of the program's own file; of its version where that cannot be read.
const std::string& build_id();

// What of a device shows in a picture's last digits: the driver and its version, the hardware, and for a software
// renderer the instructions that the processor offers (a fused multiply-add rounds once). "" for no device.
std::string device_class(const DeviceInfo& device);

}  // namespace penumbra
