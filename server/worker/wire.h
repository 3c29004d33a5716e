// SPDX-License-Identifier: MIT
// The values in messages between the service and its workers, as bytes.
#pragma once

#include <optional>
#include <string>
#include <string_view>

#include "core/renderer.h"

namespace penumbra {

// A picture without its pixels, which go through shared memory.
struct PictureHead {
    std::uint64_t kind = 0;  // which of RenderResult's pictures
    int width = 0, height = 0, channels = 0;
    std::uint64_t bytes = 0;
};

struct RenderReport {
    RenderStats stats;
    PictureHead picture;
    std::uint64_t memory_bytes = 0;  // that the worker has in use
};

std::string to_bytes(const DeviceInfo& device);
std::optional<DeviceInfo> device_of(std::string_view bytes);

std::string to_bytes(const RenderReport& report);
std::optional<RenderReport> report_of(std::string_view bytes);

PictureHead head_of(const RenderResult& result);
const void* pixels_of(const RenderResult& result);
// An empty picture of this size; nothing when the head is none of a picture.
std::optional<RenderResult> make_result(const PictureHead& head);
void* pixels_of(RenderResult& result);

}  // namespace penumbra
