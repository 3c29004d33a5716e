// SPDX-License-Identifier: MIT
#include "core/gl/storage_buffer.h"

#include <algorithm>
#include <string>
#include <utility>

#include "core/device_error.h"

namespace penumbra::gl {

StorageBuffer::StorageBuffer(GLenum texel_format, std::size_t bytes) : bytes_(std::max<std::size_t>(bytes, 16)) {
    glGenBuffers(1, &buffer_);
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer_);
    glBufferData(GL_SHADER_STORAGE_BUFFER, static_cast<GLsizeiptr>(buffer_texture_bytes(bytes_)), nullptr, GL_DYNAMIC_COPY);
    glGenTextures(1, &id_);
    glBindTexture(GL_TEXTURE_BUFFER, id_);
    glTexBuffer(GL_TEXTURE_BUFFER, texel_format, buffer_);
    const GLenum error = glGetError();
    if (error == GL_NO_ERROR) return;
    glDeleteTextures(1, &id_);
    glDeleteBuffers(1, &buffer_);
    id_ = buffer_ = 0;
    throw DeviceError("The device has no room for a buffer of " + std::to_string(bytes_ >> 20) + " MiB.");
}

StorageBuffer::StorageBuffer(StorageBuffer&& other) noexcept
    : Handle(std::move(other)), buffer_(std::exchange(other.buffer_, 0)), bytes_(std::exchange(other.bytes_, 0)) {}

StorageBuffer& StorageBuffer::operator=(StorageBuffer&& other) noexcept {
    Handle::operator=(std::move(other));
    std::swap(buffer_, other.buffer_);
    std::swap(bytes_, other.bytes_);
    return *this;
}

StorageBuffer::~StorageBuffer() {
    if (id_ != 0) glDeleteTextures(1, &id_);
    if (buffer_ != 0) glDeleteBuffers(1, &buffer_);
}

void StorageBuffer::bind_storage(int binding) const {
    glBindBufferBase(GL_SHADER_STORAGE_BUFFER, static_cast<GLuint>(binding), buffer_);
}

void StorageBuffer::bind_texture(int unit) const {
    glActiveTexture(GL_TEXTURE0 + static_cast<GLenum>(unit));
    glBindTexture(GL_TEXTURE_BUFFER, id_);
}

void StorageBuffer::bind_indirect() const { glBindBuffer(GL_DISPATCH_INDIRECT_BUFFER, buffer_); }

void StorageBuffer::clear(std::size_t bytes) {
    const GLuint zero = 0;
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer_);
    glClearBufferSubData(GL_SHADER_STORAGE_BUFFER, GL_R32UI, 0, static_cast<GLsizeiptr>(bytes), GL_RED_INTEGER, GL_UNSIGNED_INT, &zero);
}

void StorageBuffer::write(std::size_t offset, const void* data, std::size_t bytes) {
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer_);
    glBufferSubData(GL_SHADER_STORAGE_BUFFER, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), data);
}

void StorageBuffer::read(std::size_t offset, void* out, std::size_t bytes) const {
    glMemoryBarrier(GL_BUFFER_UPDATE_BARRIER_BIT);
    // One driver (NVIDIA 580) reads counters that were the group counts of an indirect dispatch as they were before it, whatever the
    // barrier, and after glFinish too: what is read must lie in another buffer (docs/decisions/0079).
    glBindBuffer(GL_SHADER_STORAGE_BUFFER, buffer_);
    glGetBufferSubData(GL_SHADER_STORAGE_BUFFER, static_cast<GLintptr>(offset), static_cast<GLsizeiptr>(bytes), out);
    check_errors("reading a buffer back");
}

}  // namespace penumbra::gl
