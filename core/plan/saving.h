// SPDX-License-Identifier: MIT
// Work that a render may leave out, each kind by itself: `render.skip: "none"` leaves out none of it, and a benchmark or a
// test all but one.
#pragma once

#include <cstdint>
#include <string_view>

#include "core/scene/scene.h"

namespace penumbra {

enum class Saving : std::uint32_t {
    constant = 1u << 0,  // all passes of a picture whose pixels are all the same
    shapes = 1u << 1,    // shapes that nothing can see
    lists = 1u << 2,     // distances to shapes that are not near a tile
    distance = 1u << 3,  // the distance pass of a scene without shapes
    flooding = 1u << 4,  // jump flooding of a scene without bitmaps
    levels = 1u << 5,    // cascades farther than anything that matters
    resolve = 1u << 6,   // the resolve pass, where cascade 0 already is the picture
    programs = 1u << 8,  // what programs do for kinds of shapes and curves that the scene has not
    closed = 1u << 9,    // pixels that outlines close off from all light (the method `exact`)
    sampling = 1u << 10, // light of other lamps than those solved, where there are none (the method `hybrid`)
    reach = 1u << 11,    // distances farther than the method asks (the method `exact`)
    cells = 1u << 7,     // pixels between the corners of cells that tell all of them (the method `exact`)
};

struct SavingName {
    Saving saving;
    std::string_view name;
};
inline constexpr SavingName kSavings[] = {
    {Saving::constant, "constant picture"}, {Saving::shapes, "unseen shapes"},   {Saving::lists, "lists of near shapes"},
    {Saving::distance, "distance pass"},    {Saving::flooding, "jump flooding"}, {Saving::levels, "far cascades"},
    {Saving::programs, "programs for all kinds"}, {Saving::resolve, "resolve pass"},      {Saving::closed, "closed-off pixels"},
    {Saving::sampling, "sampling"},         {Saving::reach, "far distances"}, {Saving::cells, "cells"}};

// Whether this render may leave that work out.
inline bool saves(const RenderSettings& render, Saving saving) {
    return render.skip == Skip::all && (render.keep & static_cast<std::uint32_t>(saving)) == 0;
}

}  // namespace penumbra
