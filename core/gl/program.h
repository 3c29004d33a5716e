// SPDX-License-Identifier: MIT
// A compute program with one block of parameters, dispatched by extent in invocations.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <utility>

#include <glm/ext/vector_int2.hpp>

#include "core/gl/handles.h"
#include "core/gl/shader_source.h"

namespace penumbra::gl {

class ComputeProgram : public Handle {
public:
    ComputeProgram() = default;
    // Builds glsl/<name> and checks that its parameter block has `params_bytes` bytes.
    // Throws DeviceError with "glsl/x.comp:LINE:COL: error: ..." lines.
    ComputeProgram(const std::string& name, std::size_t params_bytes, const std::string& shader_dir = {},
                   const ShaderConstants& constants = {});
    ComputeProgram(ComputeProgram&&) noexcept = default;
    ComputeProgram& operator=(ComputeProgram&&) noexcept = default;
    ~ComputeProgram();

    const std::string& name() const { return name_; }

    // Covers `extent` invocations, the last groups in part, in bands of rows of about `slice` invocations each
    // (0: one dispatch), so that no dispatch hogs the device; rows before `first_row` are left out. `Params::origin` is set per band.
    // Returns the number of dispatches.
    template <class Params>
    int dispatch(Params params, glm::ivec2 extent, std::size_t slice = 0, int first_row = 0) {
        int dispatches = 0;
        const int rows = rows_per_band(extent, slice);
        for (int y = first_row; y < extent.y; y += rows) {
            params.origin = {0, y};
            const int height = y + rows < extent.y ? rows : extent.y - y;
            run(&params, sizeof(Params), {extent.x, height});
            ++dispatches;
        }
        return dispatches;
    }

    // As many groups as three uints at `offset` of the bound indirect buffer say.
    template <class Params>
    void dispatch_indirect(const Params& params, std::size_t offset) {
        run_indirect(&params, sizeof(Params), offset);
    }

private:
    int rows_per_band(glm::ivec2 extent, std::size_t slice) const;
    void run(const void* params, std::size_t bytes, glm::ivec2 extent);
    void run_indirect(const void* params, std::size_t bytes, std::size_t offset);

    std::string name_;
    glm::ivec2 group_{1};
    UniformBuffer params_;
};

// One program in the forms that its constants give it, each built when it is first asked for; the general form at once, so
// that a shader that does not build is found at the start.
class ProgramForms {
public:
    ProgramForms(std::string name, std::size_t params_bytes, std::string shader_dir)
        : name_(std::move(name)), params_bytes_(params_bytes), shader_dir_(std::move(shader_dir)) {
        of({});
    }
    ComputeProgram& of(const ShaderConstants& constants) {
        const auto found = forms_.find(constants);
        if (found != forms_.end()) return found->second;
        return forms_.emplace(constants, ComputeProgram(name_, params_bytes_, shader_dir_, constants)).first->second;
    }

private:
    std::string name_;
    std::size_t params_bytes_;
    std::string shader_dir_;
    std::map<ShaderConstants, ComputeProgram> forms_;
};

}  // namespace penumbra::gl
