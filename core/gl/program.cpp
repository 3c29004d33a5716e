// SPDX-License-Identifier: MIT
#include "core/gl/program.h"

#include <algorithm>
#include <limits>

#include "core/device_error.h"
#include "core/gl/checkpoint.h"
#include "core/gl/shader_source.h"

namespace penumbra::gl {
namespace {

std::string shader_log(GLuint shader) {
    GLint length = 0;
    glGetShaderiv(shader, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
    glGetShaderInfoLog(shader, length, nullptr, log.data());
    return log.c_str();
}

std::string program_log(GLuint program) {
    GLint length = 0;
    glGetProgramiv(program, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(std::max(length, 1)), '\0');
    glGetProgramInfoLog(program, length, nullptr, log.data());
    return log.c_str();
}

}  // namespace

ComputeProgram::ComputeProgram(const std::string& name, std::size_t params_bytes, const std::string& shader_dir,
                               const ShaderConstants& constants)
    : name_(name), params_(params_bytes) {
    const FlatShader source = flatten_shader(name, shader_dir, constants);
    const GLuint shader = glCreateShader(GL_COMPUTE_SHADER);
    const char* text = source.text.c_str();
    glShaderSource(shader, 1, &text, nullptr);
    glCompileShader(shader);
    GLint ok = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &ok);
    if (ok == 0) {
        const std::string log = translate_log(source, shader_log(shader));
        glDeleteShader(shader);
        throw DeviceError("The shader " + name + " does not compile:\n" + log);
    }
    id_ = glCreateProgram();
    glAttachShader(id_, shader);
    glLinkProgram(id_);
    glDeleteShader(shader);
    glGetProgramiv(id_, GL_LINK_STATUS, &ok);
    const std::string log = ok == 0 ? translate_log(source, program_log(id_)) : std::string();
    GLint group[3] = {};
    GLint block_bytes = 0;
    if (ok != 0) {
        glGetProgramiv(id_, GL_COMPUTE_WORK_GROUP_SIZE, group);
        glGetActiveUniformBlockiv(id_, 0, GL_UNIFORM_BLOCK_DATA_SIZE, &block_bytes);
    }
    group_ = {group[0], group[1]};
    if (ok == 0 || static_cast<std::size_t>(block_bytes) != params_bytes) {
        glDeleteProgram(id_);
        id_ = 0;
        if (ok == 0) throw DeviceError("The shader " + name + " does not link:\n" + log);
        throw DeviceError("The parameters of " + name + " have " + std::to_string(params_bytes) +
                          " bytes here and " + std::to_string(block_bytes) + " in the shader.");
    }
}

ComputeProgram::~ComputeProgram() {
    if (id_ != 0) glDeleteProgram(id_);
}

int ComputeProgram::rows_per_band(glm::ivec2 extent, std::size_t slice) const {
    // Group counts end at 65535 an axis, and llvmpipe multiplies them as an int.
    constexpr std::size_t kMostInvocations = std::size_t(1) << 28;
    if (slice == 0 || slice > kMostInvocations) slice = kMostInvocations;
    const auto width = static_cast<std::size_t>(std::max(extent.x, 1));
    const auto groups = std::clamp<std::size_t>(slice / (width * static_cast<std::size_t>(group_.y)), 1, 65535);
    return static_cast<int>(groups) * group_.y;
}

// What the next pass may read: images, textures, storage, and counts of groups; and what it may be given anew between two.
constexpr GLbitfield kPassBarrier = GL_SHADER_IMAGE_ACCESS_BARRIER_BIT | GL_TEXTURE_FETCH_BARRIER_BIT |
                                    GL_SHADER_STORAGE_BARRIER_BIT | GL_COMMAND_BARRIER_BIT | GL_BUFFER_UPDATE_BARRIER_BIT |
                                    GL_TEXTURE_UPDATE_BARRIER_BIT | GL_FRAMEBUFFER_BARRIER_BIT;

void ComputeProgram::run(const void* params, std::size_t bytes, glm::ivec2 extent) {
    checkpoint();
    params_.write(params, bytes);
    params_.bind(0);
    glUseProgram(id_);
    glDispatchCompute(static_cast<GLuint>((extent.x + group_.x - 1) / group_.x),
                      static_cast<GLuint>((extent.y + group_.y - 1) / group_.y), 1);
    glMemoryBarrier(kPassBarrier);
}

void ComputeProgram::run_indirect(const void* params, std::size_t bytes, std::size_t offset) {
    checkpoint();
    params_.write(params, bytes);
    params_.bind(0);
    glUseProgram(id_);
    glDispatchComputeIndirect(static_cast<GLintptr>(offset));
    glMemoryBarrier(kPassBarrier);
}

}  // namespace penumbra::gl
