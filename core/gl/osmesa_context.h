// SPDX-License-Identifier: MIT
// OSMesa, for systems without EGL. Deprecated upstream and gone from Mesa 25.1: off by default.
#pragma once

#include <memory>

#include "core/gl/context.h"
#include "core/gl/gl.h"

namespace penumbra::gl {

std::unique_ptr<Context::Backend> make_osmesa_backend();  // throws DeviceError
GLADloadfunc osmesa_load_function();

}  // namespace penumbra::gl
