// SPDX-License-Identifier: MIT
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <compare>
#include <functional>
#include <map>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "core/device_error.h"
#include "core/gl/program.h"
#include "core/gl/storage_buffer.h"
#include "core/passes/delta_pass.h"
#include "core/passes/frame.h"
#include "core/plan/plan.h"
#include "glsl/exact.h"

namespace penumbra {

// A scene that the method `exact` cannot take on this device; others can.
class TooDense : public DeviceError {
public:
    using DeviceError::DeviceError;
};

// Reads the distance. Writes the mean radiance of each pixel by the method `exact`: lists of what each tile may see, the
// light at corners of cells, cells split where that is not enough, and what lies between.
// Keeps its buffers from frame to frame.
class ExactPass {
public:
    explicit ExactPass(const std::string& shader_dir);
    // On a device that ends no long loops: a point that has much to see is done in one dispatch, or a few.
    void allow_long_loops() { long_loops_ = true; }
    // Threads that share the sectors of a point, before the first frame: many keep a GPU busy. With one, a thread solves four points at
    // once, as llvmpipe wants it.
    void share_sectors(int lanes) { lanes_ = lanes; }

    // `record(name, extent, run)` times each step: lists, points, cells, fill.
    using Record = std::function<void(const char* name, glm::ivec2 extent, const std::function<PassWork()>& run)>;
    // What is found of each pixel: the mean of radiance, and where the plan asks for them of radiance times direction.
    struct Light {
        gl::Texture2D mean, moment_x, moment_y;
    };
    // Once a band is filled: the texture of cells (glsl/exact.h), the band's first row and how many.
    using SeeCells = std::function<void(const gl::Texture2D& cells, int first_row, int rows)>;
    // `delta` lights surfaces where light bounces.
    void run(const Plan& plan, const Sky& sky, const DistanceField& field, const PassSettings& settings, DeltaPass& delta,
             const Record& record, Light& out, const SeeCells& see_cells = {});

    // What surfaces shine with after all bounces: by element, as glsl/exact.h lays them out. For methods that sample.
    std::vector<glm::vec4> surfaces(const Plan& plan, const Sky& sky, const PassSettings& settings, DeltaPass& delta, const Record& record);

    std::size_t bytes() const;

private:
    struct Band;
    Band prepare(const Plan& plan, const Sky& sky) const;
    PassWork make_lists(const Plan& plan, Band& band);
    // Whether the lists had room, where that is asked at the end of the frame; if not, the next lists will have it.
    bool lists_fit();
    void check_spent(const char* points) const;
    // Of the solver's groups.
    int group_jobs() const { return lanes_ > 1 ? std::max(32 / lanes_, 1) : glsl::kExactSolveGroupX; }
    // Threads that share a list: many where there are few lists.
    int list_lanes(std::size_t lists) const;
    int group_threads() const { return lanes_ > 1 ? 4 * group_jobs() * lanes_ : glsl::kExactSolveThreads; }
    PassWork solve(const Plan& plan, const DistanceField& field, Band& band, int level, int moment = 0);
    // Lets the light bounce between surfaces: afterwards `elements_` tells what each shines with.
    void bounce(const Plan& plan, const PassSettings& settings, DeltaPass& delta, const Record& record, Band& band);
    PassWork reflect(const Plan& plan, Band& band, bool first);
    void run_solver(glsl::ExactParams params, Band& band, PassWork& work, int moment,
                    const std::function<int(const glsl::ExactParams&)>& dispatch);
    // Whether the solver is cut into short dispatches, between which a render stops and says that it lives: on a processor, a dense scene takes
    // seconds.
    bool in_slices() const { return !long_loops_ && lanes_ == 1; }

    // A program for what a scene has, compiled when first asked for.
    struct Needs {
        bool arcs, ellipses;
        int sky;
        bool slopes, surfaces, nodes;
        int moment;  // 0: mean radiance; 1, 2: times the direction's x or y
        auto operator<=>(const Needs&) const = default;
    };
    gl::ComputeProgram& lists_for(const ExactPlan& exact, int lanes);
    gl::ComputeProgram& solver_for(const Needs& needs);

    std::string shader_dir_;
    int lanes_ = 1;
    bool long_loops_ = false;
    std::map<std::tuple<bool, bool, int>, gl::ComputeProgram> lists_;
    std::map<Needs, gl::ComputeProgram> solvers_;
    gl::ComputeProgram split_;
    gl::ProgramForms gather_;
    gl::ComputeProgram mean_;
    gl::ProgramForms fill_;
    gl::ComputeProgram reflect_;
    gl::StorageBuffer coarse_heads_, coarse_entries_, coarse_lights_;
    gl::StorageBuffer heads_, entries_, lights_;
    std::array<gl::StorageBuffer, 2> cells_;  // that were split, of this level and of the one before
    gl::StorageBuffer asks_, points_, jobs_, counters_, told_, means_;
    std::array<std::size_t, 2> list_texels_{};  // that tiles' and larger tiles' lists took
    gl::StorageBuffer elements_, elements_before_, change_;
};

}  // namespace penumbra
