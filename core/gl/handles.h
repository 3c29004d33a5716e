// SPDX-License-Identifier: MIT
// GL objects as move-only values. A moved-from object holds 0. All need the current context.
#pragma once

#include <cstddef>
#include <utility>

#include <glm/ext/vector_int2.hpp>

#include "core/gl/gl.h"

namespace penumbra::gl {

class Handle {
public:
    Handle() = default;
    explicit Handle(GLuint id) : id_(id) {}
    Handle(Handle&& other) noexcept : id_(std::exchange(other.id_, 0)) {}
    Handle& operator=(Handle&& other) noexcept {
        std::swap(id_, other.id_);
        return *this;
    }
    GLuint id() const { return id_; }
    explicit operator bool() const { return id_ != 0; }

protected:
    ~Handle() = default;
    GLuint id_ = 0;
};

enum class Filter { nearest, linear };

class Texture2D : public Handle {
public:
    Texture2D() = default;
    // Immutable storage of one level, clamped to its edge. Throws DeviceError when there is no memory.
    Texture2D(GLenum internal_format, glm::ivec2 size, Filter filter = Filter::nearest);
    Texture2D(Texture2D&&) noexcept = default;
    Texture2D& operator=(Texture2D&& other) noexcept {
        Handle::operator=(std::move(other));
        std::swap(format_, other.format_);
        std::swap(size_, other.size_);
        std::swap(filter_, other.filter_);
        return *this;
    }
    ~Texture2D();

    GLenum format() const { return format_; }
    glm::ivec2 size() const { return size_; }
    Filter filter() const { return filter_; }
    std::size_t bytes() const;

    void bind_texture(int unit) const;
    void bind_image(int unit, GLenum access) const;
    // The whole level, rows from y = 0 down, tightly packed.
    void read(GLenum format, GLenum type, void* out) const;
    // As read(), the other way.
    void write(GLenum format, GLenum type, const void* in);
    void fill(GLenum format, GLenum type, const void* value);
    // All texels of a format of this kind, on the device.
    void clear(GLuint value);
    void clear(GLint value);
    void clear(GLfloat value);

private:
    template <class Value, class Clear>
    void clear_by(Value value, Clear clear_buffer);

    GLenum format_ = 0;
    glm::ivec2 size_{0};
    Filter filter_ = Filter::nearest;
};

// How long the buffer of a buffer texture is made, so that it holds `bytes`. llvmpipe compiles a program anew when a texture changes
// from a power of two to none, also by the bytes of a buffer, or when bits 8 to 15 of these change from none to some (it takes
// them for a number of levels). Lengths made here are alike in both.
std::size_t buffer_texture_bytes(std::size_t bytes);

// Immutable contents seen by shaders through a buffer texture: what scene data is read through, since
// storage buffers are 13 to 17 times slower in a loop on Mesa 22 (docs/operations.md).
class BufferTexture : public Handle {
public:
    BufferTexture() = default;
    BufferTexture(GLenum internal_format, const void* data, std::size_t bytes);
    BufferTexture(BufferTexture&& other) noexcept
        : Handle(std::move(other)), buffer_(std::exchange(other.buffer_, 0)), bytes_(std::exchange(other.bytes_, 0)) {}
    BufferTexture& operator=(BufferTexture&& other) noexcept;
    ~BufferTexture();

    std::size_t bytes() const { return bytes_; }
    void bind_texture(int unit) const;

private:
    GLuint buffer_ = 0;
    std::size_t bytes_ = 0;
};

// A pass's parameters.
class UniformBuffer : public Handle {
public:
    UniformBuffer() = default;
    explicit UniformBuffer(std::size_t bytes);
    UniformBuffer(UniformBuffer&&) noexcept = default;
    UniformBuffer& operator=(UniformBuffer&&) noexcept = default;
    ~UniformBuffer();
    void write(const void* data, std::size_t bytes);
    void bind(int binding) const;
};

// Throws DeviceError with `where` if GL reported an error since the last check.
void check_errors(const char* where);

}  // namespace penumbra::gl
