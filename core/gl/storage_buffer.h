// SPDX-License-Identifier: MIT
// A buffer that one pass writes as storage and the next reads through a buffer texture (storage is 13 to 17 times slower to
// read in a loop on Mesa 22: docs/operations.md).
#pragma once

#include <cstddef>

#include "core/gl/handles.h"

namespace penumbra::gl {

class StorageBuffer : public Handle {
public:
    StorageBuffer() = default;
    // Contents undefined. Throws DeviceError when there is no memory.
    StorageBuffer(GLenum texel_format, std::size_t bytes);
    StorageBuffer(StorageBuffer&& other) noexcept;
    StorageBuffer& operator=(StorageBuffer&& other) noexcept;
    ~StorageBuffer();

    std::size_t bytes() const { return bytes_; }
    GLuint buffer() const { return buffer_; }
    void bind_storage(int binding) const;
    void bind_texture(int unit) const;
    void bind_indirect() const;
    // Zeroes the first `bytes`.
    void clear(std::size_t bytes);
    void write(std::size_t offset, const void* data, std::size_t bytes);
    // Waits for the device.
    void read(std::size_t offset, void* out, std::size_t bytes) const;

private:
    GLuint buffer_ = 0;
    std::size_t bytes_ = 0;
};

}  // namespace penumbra::gl
