// SPDX-License-Identifier: MIT
#include "server/worker/wire.h"

#include "core/scene/archive.h"

namespace penumbra {

template <class A>
void fields(A& archive, Like<A, PassStats>& pass) {
    auto& [name, gpu_ms, wall_ms, width, height, dispatches, rays, bytes, cpu_ms, points] = pass;
    archive(name, gpu_ms, wall_ms, width, height, dispatches, rays, bytes, cpu_ms, points);
}
template <class A>
void fields(A& archive, Like<A, SkippedWork>& work) {
    auto& [what, why, saved] = work;
    archive(what, why, saved);
}
template <class A>
void fields(A& archive, Like<A, RenderStats>& stats) {
    auto& [device, method, reason, width, height, total_ms, gpu_bytes, lost_rays, passes, skipped] = stats;
    archive(device, method, reason, width, height, total_ms, gpu_bytes, lost_rays, passes, skipped);
}
template <class A>
void fields(A& archive, Like<A, DeviceInfo>& device) {
    auto& [kind, platform, vendor, renderer, gl, glsl, side, texels, group, loop] = device;
    archive(kind, platform, vendor, renderer, gl, glsl, side, texels, group, loop);
}
template <class A>
void fields(A& archive, Like<A, PictureHead>& head) {
    auto& [kind, width, height, channels, bytes] = head;
    archive(kind, width, height, channels, bytes);
}
template <class A>
void fields(A& archive, Like<A, RenderReport>& report) {
    auto& [stats, picture, memory] = report;
    archive(stats, picture, memory);
}

namespace {

template <class T>
std::string write(const T& value) {
    ByteWriter writer;
    writer(value);
    return writer.take();
}

template <class T>
std::optional<T> read(std::string_view bytes) {
    ByteReader reader(bytes);
    T value;
    reader(value);
    if (!reader.at_end()) return std::nullopt;
    return value;
}

// Longer sides than any device's.
constexpr int kMostSide = 1 << 16;

}  // namespace

std::string to_bytes(const DeviceInfo& device) { return write(device); }
std::optional<DeviceInfo> device_of(std::string_view bytes) { return read<DeviceInfo>(bytes); }
std::string to_bytes(const RenderReport& report) { return write(report); }
std::optional<RenderReport> report_of(std::string_view bytes) { return read<RenderReport>(bytes); }

PictureHead head_of(const RenderResult& result) {
    return std::visit(
        [&](const auto& picture) {
            return PictureHead{result.picture.index(), picture.width, picture.height, picture.channels,
                               picture.data.size() * sizeof(picture.data[0])};
        },
        result.picture);
}

const void* pixels_of(const RenderResult& result) {
    return std::visit([](const auto& picture) { return static_cast<const void*>(picture.data.data()); }, result.picture);
}
void* pixels_of(RenderResult& result) {
    return std::visit([](auto& picture) { return static_cast<void*>(picture.data.data()); }, result.picture);
}

std::optional<RenderResult> make_result(const PictureHead& head) {
    const bool sound = head.width > 0 && head.width <= kMostSide && head.height > 0 && head.height <= kMostSide &&
                       head.channels > 0 && head.channels <= 4;
    if (!sound) return std::nullopt;
    RenderResult result;
    const auto make = [&]<class T>(BasicImage<T>& picture) {
        const std::uint64_t values = std::uint64_t(head.width) * std::uint64_t(head.height) * std::uint64_t(head.channels);
        if (values * sizeof(T) != head.bytes) return false;
        picture = BasicImage<T>(head.width, head.height, head.channels);
        return true;
    };
    const auto make_kind = [&]<std::size_t I>(auto& self, std::integral_constant<std::size_t, I>) -> bool {
        using Pictures = decltype(result.picture);
        if constexpr (I < std::variant_size_v<Pictures>) {
            if (head.kind == I) return make(result.picture.template emplace<I>());
            return self(self, std::integral_constant<std::size_t, I + 1>());
        } else {
            return false;
        }
    };
    if (!make_kind(make_kind, std::integral_constant<std::size_t, 0>())) return std::nullopt;
    return result;
}

}  // namespace penumbra
