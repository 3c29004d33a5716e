// SPDX-License-Identifier: MIT
// What a debug view reads back while a frame is made: cascades, probes, steps, cells.
#pragma once

#include <cstddef>
#include <vector>

#include "core/gl/handles.h"
#include "core/image/image.h"
#include "core/plan/plan.h"
#include "core/views/light_views.h"

namespace penumbra {

class FrameLook {
public:
    explicit FrameLook(const Plan& plan);

    // Once a cascade is merged with those above it.
    void see_cascade(const Plan& plan, std::size_t level, const gl::Texture2D& merged);
    // Once a level's fluence is.
    void see_level(const Plan& plan, const HrcQuadrant& quadrant, int level, const gl::Texture2D& fluence);
    // Once `exact` has filled a band: its cells (ExactPass::SeeCells).
    void see_cells(const gl::Texture2D& cells, int first_row, int rows);

    // Whether what is still to be made shows nowhere in the view.
    bool seen_all() const { return seen_all_; }

    // The view, of the part that is shown.
    Image8 draw(const Plan& plan) const;

private:
    std::size_t index(int x, int y) const { return static_cast<std::size_t>(y) * static_cast<std::size_t>(canvas_.x) + static_cast<std::size_t>(x); }
    HeatField shown(const Plan& plan) const;

    glm::ivec2 canvas_{0};
    std::vector<float> values_;     // by pixel of the canvas: steps, shares left out
    ImageF light_;                  // a cascade's
    ProbeField probes_;
    int probe_level_ = 0;
    bool seen_all_ = false;
};

// The nearest cascade whose probes stand so far apart that their directions can be told in a picture.
int shown_probes(const std::vector<CascadePlan>& cascades);

}  // namespace penumbra
