// SPDX-License-Identifier: MIT
// One renderer for a whole test program: a context and its shaders take longer than most tests.
// PENUMBRA_TEST_DEVICE chooses the device; PENUMBRA_TEST_SHADERS names a folder of (broken) shaders, to see
// that the tests can fail.
#pragma once

#include <string>

#include "core/film/tone_lut.h"
#include "core/renderer.h"

namespace penumbra::test {

RendererOptions test_options();

// A table of 5 texels on a side that holds their own places, which makes "tony" another name for Reinhard's curve: what the shared
// renderer has.
ToneLut table_of_places();

// Made at the first call, on the thread of that call; destroyed when all tests have run.
Renderer& shared_renderer();

ImageF render_linear(Scene scene);
Image8 render_display(Scene scene);
Image16 render_display16(Scene scene);

}  // namespace penumbra::test
