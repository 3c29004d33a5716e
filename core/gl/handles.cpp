// SPDX-License-Identifier: MIT
#include "core/gl/handles.h"

#include <algorithm>
#include <bit>
#include <string>
#include <vector>

#include "core/device_error.h"

namespace penumbra::gl {
namespace {

// A texture unit that no pass reads from: the last of the 96 that GL 4.3 has at least, passes use the first 16.
constexpr GLenum kScratchUnit = 95;

std::size_t texel_bytes(GLenum format) {
    switch (format) {
        case GL_RGBA32F: return 16;
        case GL_RGBA16:
        case GL_RGBA16F: return 8;
        case GL_RGBA8:
        case GL_R32F:
        case GL_R32I:
        case GL_R32UI:
        case GL_RG16I: return 4;
        case GL_R8UI: return 1;
        default: return 0;
    }
}

const char* error_name(GLenum error) {
    switch (error) {
        case GL_INVALID_ENUM: return "invalid enum";
        case GL_INVALID_VALUE: return "invalid value";
        case GL_INVALID_OPERATION: return "invalid operation";
        case GL_INVALID_FRAMEBUFFER_OPERATION: return "invalid framebuffer operation";
        case GL_OUT_OF_MEMORY: return "out of memory";
        default: return "unknown error";
    }
}

}  // namespace

void check_errors(const char* where) {
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) return;
    throw DeviceError(std::string("The device reported '") + error_name(error) + "' in " + where + ".");
}

Texture2D::Texture2D(GLenum internal_format, glm::ivec2 size, Filter filter)
    : format_(internal_format), size_(size), filter_(filter) {
    glGenTextures(1, &id_);
    glBindTexture(GL_TEXTURE_2D, id_);
    glTexStorage2D(GL_TEXTURE_2D, 1, internal_format, size.x, size.y);
    const GLint mode = filter == Filter::linear ? GL_LINEAR : GL_NEAREST;
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MIN_FILTER, mode);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_MAG_FILTER, mode);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_S, GL_CLAMP_TO_EDGE);
    glTexParameteri(GL_TEXTURE_2D, GL_TEXTURE_WRAP_T, GL_CLAMP_TO_EDGE);
    const GLenum error = glGetError();
    if (error != GL_NO_ERROR) {
        glDeleteTextures(1, &id_);
        id_ = 0;
        throw DeviceError("The device has no room for a texture of " + std::to_string(size.x) + " x " +
                          std::to_string(size.y) + " (" + std::to_string(bytes() >> 20) +
                          " MiB): " + error_name(error) + ".");
    }
}

Texture2D::~Texture2D() {
    if (id_ != 0) glDeleteTextures(1, &id_);
}

std::size_t Texture2D::bytes() const {
    return texel_bytes(format_) * static_cast<std::size_t>(size_.x) * static_cast<std::size_t>(size_.y);
}

void Texture2D::bind_texture(int unit) const {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_2D, id_);
}

void Texture2D::bind_image(int unit, GLenum access) const {
    glBindImageTexture(static_cast<GLuint>(unit), id_, 0, GL_FALSE, 0, access, format_);
}

void Texture2D::read(GLenum format, GLenum type, void* out) const {
    glMemoryBarrier(GL_TEXTURE_UPDATE_BARRIER_BIT);
    glBindTexture(GL_TEXTURE_2D, id_);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glGetTexImage(GL_TEXTURE_2D, 0, format, type, out);
    check_errors("reading a texture back");
}

void Texture2D::write(GLenum format, GLenum type, const void* in) {
    glBindTexture(GL_TEXTURE_2D, id_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    glTexSubImage2D(GL_TEXTURE_2D, 0, 0, 0, size_.x, size_.y, format, type, in);
    check_errors("writing a texture");
}

void Texture2D::fill(GLenum format, GLenum type, const void* value) {
    // glClearTexImage is GL 4.4; a framebuffer clear is in 4.3, but one upload row by row is simplest and
    // this is for tests and small textures only.
    const std::size_t texel = texel_bytes(format_);
    std::vector<unsigned char> row(texel * static_cast<std::size_t>(size_.x));
    for (int x = 0; x < size_.x; ++x)
        std::copy_n(static_cast<const unsigned char*>(value), texel, row.data() + texel * static_cast<std::size_t>(x));
    glBindTexture(GL_TEXTURE_2D, id_);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
    for (int y = 0; y < size_.y; ++y) glTexSubImage2D(GL_TEXTURE_2D, 0, 0, y, size_.x, 1, format, type, row.data());
    check_errors("filling a texture");
}

template <class Value, class Clear>
void Texture2D::clear_by(Value value, Clear clear_buffer) {
    GLuint framebuffer = 0;
    glGenFramebuffers(1, &framebuffer);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, framebuffer);
    glFramebufferTexture2D(GL_DRAW_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, id_, 0);
    const Value values[4] = {value, value, value, value};
    clear_buffer(GL_COLOR, 0, values);
    glBindFramebuffer(GL_DRAW_FRAMEBUFFER, 0);
    glDeleteFramebuffers(1, &framebuffer);
    glMemoryBarrier(GL_SHADER_IMAGE_ACCESS_BARRIER_BIT);
    check_errors("clearing a texture");
}

void Texture2D::clear(GLuint value) { clear_by(value, glClearBufferuiv); }
void Texture2D::clear(GLint value) { clear_by(value, glClearBufferiv); }
void Texture2D::clear(GLfloat value) { clear_by(value, glClearBufferfv); }

std::size_t buffer_texture_bytes(std::size_t bytes) {
    std::size_t padded = std::max<std::size_t>((bytes + 15) / 16 * 16, 272);
    if ((padded & 0xff00) == 0) padded += 256;
    return std::has_single_bit(padded) ? padded + 16 : padded;
}

BufferTexture::BufferTexture(GLenum internal_format, const void* data, std::size_t bytes) : bytes_(bytes) {
    glGenBuffers(1, &buffer_);
    glBindBuffer(GL_TEXTURE_BUFFER, buffer_);
    glBufferData(GL_TEXTURE_BUFFER, static_cast<GLsizeiptr>(buffer_texture_bytes(bytes)), nullptr, GL_STATIC_DRAW);
    // What is shorter than a texel is filled up: the driver would read on behind it.
    static constexpr unsigned char kNothing[16] = {};
    if (bytes < sizeof(kNothing)) glBufferSubData(GL_TEXTURE_BUFFER, 0, sizeof(kNothing), kNothing);
    if (bytes > 0) glBufferSubData(GL_TEXTURE_BUFFER, 0, static_cast<GLsizeiptr>(bytes), data);
    glGenTextures(1, &id_);
    // Not on a unit whose buffer texture a pass is about to read.
    glActiveTexture(GL_TEXTURE0 + kScratchUnit);
    glBindTexture(GL_TEXTURE_BUFFER, id_);
    glTexBuffer(GL_TEXTURE_BUFFER, internal_format, buffer_);
    const GLenum error = glGetError();
    if (error != GL_NO_ERROR) {
        glDeleteTextures(1, &id_);
        glDeleteBuffers(1, &buffer_);
        id_ = buffer_ = 0;
        throw DeviceError("The device has no room for " + std::to_string(bytes >> 10) +
                          " KiB of scene data: " + error_name(error) + ".");
    }
}

BufferTexture& BufferTexture::operator=(BufferTexture&& other) noexcept {
    Handle::operator=(std::move(other));
    std::swap(buffer_, other.buffer_);
    std::swap(bytes_, other.bytes_);
    return *this;
}

BufferTexture::~BufferTexture() {
    if (id_ != 0) glDeleteTextures(1, &id_);
    if (buffer_ != 0) glDeleteBuffers(1, &buffer_);
}

void BufferTexture::bind_texture(int unit) const {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_BUFFER, id_);
}

UniformBuffer::UniformBuffer(std::size_t bytes) {
    glGenBuffers(1, &id_);
    glBindBuffer(GL_UNIFORM_BUFFER, id_);
    glBufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(bytes), nullptr, GL_DYNAMIC_DRAW);
}

UniformBuffer::~UniformBuffer() {
    if (id_ != 0) glDeleteBuffers(1, &id_);
}

void UniformBuffer::write(const void* data, std::size_t bytes) {
    glBindBuffer(GL_UNIFORM_BUFFER, id_);
    glBufferData(GL_UNIFORM_BUFFER, static_cast<GLsizeiptr>(bytes), data, GL_DYNAMIC_DRAW);
}

void UniformBuffer::bind(int binding) const {
    glBindBufferBase(GL_UNIFORM_BUFFER, static_cast<GLuint>(binding), id_);
}

}  // namespace penumbra::gl
