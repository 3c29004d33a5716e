// SPDX-License-Identifier: MIT
// One renderer for a whole test program: a context and its shaders take longer than most tests.
// PENUMBRA_TEST_DEVICE chooses the device; PENUMBRA_TEST_SHADERS names a folder of (broken) shaders, to see
// that the tests can fail.
#pragma once

#include <string>

#include "core/renderer.h"

namespace penumbra::test {

RendererOptions test_options();

// Made at the first call, on the thread of that call; destroyed when all tests have run.
Renderer& shared_renderer();

ImageF render_linear(Scene scene);
Image8 render_display(Scene scene);

}  // namespace penumbra::test
