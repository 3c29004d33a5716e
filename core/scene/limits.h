// SPDX-License-Identifier: MIT
// Every limit on a scene, each with its reason. Operators may lower them; tests stand on both sides.
#pragma once

#include <cstddef>

namespace penumbra {

struct Limits {
    // llvmpipe's textures end at 16384; the margin needs the rest. Also the README's promise.
    int max_canvas_side_px = 8192;
    // One 8192 x 8192 picture. The working set is about 40 bytes a pixel.
    double max_canvas_pixels = 8192.0 * 8192.0;
    // Canvas plus margin on both sides, in pixels: the distance field covers it all.
    double max_domain_side_px = 16384;
    double max_domain_pixels = 8192.0 * 8192.0 * 1.5;
    // The packed scene stays far under a buffer texture's 128 MiB (llvmpipe).
    std::size_t max_shapes = 20000;
    std::size_t max_points_per_shape = 16384;  // one loop of a shader; Mesa 22 ends loops at 65535
    std::size_t max_points = 200000;
    std::size_t max_lights = 1000;
    std::size_t max_sky_stops = 256;
    // Of translucent shapes, in all: a ray asks each of them. A polygon has as many as points, others one, a polyline as segments.
    std::size_t max_medium_edges = 256;
    // Of a stroke with a gradient: rays that meet it look their place up, sixteen of them in one invocation at most.
    std::size_t max_emission_stops = 64;
    std::size_t max_gradient_points = 1024;
    // One atlas; a picture is decoded to 4 bytes a texel.
    int max_bitmap_side_px = 8192;
    double max_bitmap_texels = 4096.0 * 4096.0;  // of all bitmaps together
    // Beyond these single precision and squared lengths lose meaning.
    double max_coordinate = 1e9;   // world units, absolute
    double min_view_side = 1e-6;   // world units
    double max_radiance = 1e9;     // linear; products of three stay finite in single precision
    double min_light_height = 1e-6;  // world units: light at the floor below stays finite
    double min_lumens_angle_deg = 0.01;  // half angle of a spot in lumens: its intensity stays finite
    double max_exposure_ev = 64;   // absolute
    // A camera's settings: all of them together stay within max_exposure_ev.
    double min_aperture = 0.1, max_aperture = 1000;  // f-number
    double min_shutter_s = 1e-6, max_shutter_s = 1e5;
    double min_iso = 1, max_iso = 1e7;
    double max_compensation_ev = 16;  // absolute
    double min_key = 1e-3, max_key = 10;
    double min_white = 1e-3, max_white = 1e9;  // as radiance
    int max_bounces = 64;          // the format's own bound
    int max_converging_bounces = 256;  // of bounces: "converged"
};

}  // namespace penumbra
