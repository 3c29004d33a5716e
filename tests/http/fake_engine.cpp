// SPDX-License-Identifier: MIT
#include "fake_engine.h"

#include <chrono>
#include <csignal>
#include <thread>

namespace penumbra::test {

void FakeControl::close_gate() {
    const std::lock_guard lock(mutex_);
    gate_open_ = false;
}
void FakeControl::open_gate() {
    {
        const std::lock_guard lock(mutex_);
        gate_open_ = true;
    }
    changed_.notify_all();
}
void FakeControl::wait_for_begun(int count) {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return begun_ >= count; });
}
int FakeControl::begun() const {
    const std::lock_guard lock(mutex_);
    return begun_;
}
void FakeControl::set_self_test(std::string sentence) {
    const std::lock_guard lock(mutex_);
    self_test_ = std::move(sentence);
}
void FakeControl::set_start_error(std::string sentence) {
    const std::lock_guard lock(mutex_);
    start_error_ = std::move(sentence);
}
void FakeControl::close_start() {
    const std::lock_guard lock(mutex_);
    start_open_ = false;
}
void FakeControl::open_start() {
    {
        const std::lock_guard lock(mutex_);
        start_open_ = true;
    }
    changed_.notify_all();
}
void FakeControl::on_start() {
    std::unique_lock lock(mutex_);
    changed_.wait(lock, [&] { return start_open_; });
    if (!start_error_.empty()) throw DeviceError(start_error_);
}
void FakeControl::on_render(const StopCheck& stop) {
    std::unique_lock lock(mutex_);
    ++begun_;
    changed_.notify_all();
    while (!changed_.wait_for(lock, std::chrono::milliseconds(5), [&] { return gate_open_; })) {
        if (!stop || !stop()) continue;
        ++stopped_;
        throw RenderStopped();
    }
}
void FakeControl::count_stopped() {
    const std::lock_guard lock(mutex_);
    ++stopped_;
}
int FakeControl::stopped() const {
    const std::lock_guard lock(mutex_);
    return stopped_;
}
std::string FakeControl::self_test() const {
    const std::lock_guard lock(mutex_);
    return self_test_;
}

namespace {

class FakeBackend final : public RenderBackend {
public:
    explicit FakeBackend(std::shared_ptr<FakeControl> control) : control_(std::move(control)) {
        control_->on_start();
        device_.kind = "cpu";
        device_.platform = "none";
        device_.renderer = "fake renderer";
        device_.max_texture_side = 16384;
    }

    RenderResult render(const Scene& scene, const StopCheck& stop) override {
        slices_ = 0;
        control_->on_render(stop);
        const double red = scene.sky.radiance.x;
        if (red == 13) throw DeviceError(kThrownSecret);
        if (red == 14) std::raise(SIGSEGV);
        while (red == 15) std::this_thread::sleep_for(std::chrono::seconds(1));
        const double steps = 2 * (red - 100) * (scene.render.quality == Quality::draft ? 0.1 : 1);
        for (int i = 0; red >= 100 && i < steps; ++i) {
            std::this_thread::sleep_for(std::chrono::milliseconds(5));
            ++slices_;
            if (stop && stop()) {
                control_->count_stopped();
                throw RenderStopped();
            }
        }
        RenderResult result;
        const int width = scene.canvas.width, height = scene.canvas.height;
        if (scene.output.format != "png") {
            ImageF picture(width, height, 3);
            for (std::size_t i = 0; i < picture.data.size(); ++i) picture.data[i] = float(i % 7);
            result.picture = std::move(picture);
        } else {
            Image8 picture(width, height, 3);
            for (std::size_t i = 0; i < picture.data.size(); ++i) picture.data[i] = std::uint8_t(i % 251);
            result.picture = std::move(picture);
        }
        result.stats.device = device_.renderer;
        result.stats.method = "rc";
        result.stats.method_reason = "the only one";
        result.stats.width = width;
        result.stats.height = height;
        result.stats.total_ms = 2;
        result.stats.passes = {{"distance", 0.5, 1, width, height, 1, 0, 64}, {"cascade 0", 0.5, 1, 8, 8, 1, 64, 64}};
        result.stats.skipped = {{"bounces", "the scene asks for none", 0}};
        return result;
    }

    std::uint64_t slices() const override { return slices_; }
    std::string self_test() override { return control_->self_test(); }
    const DeviceInfo& device() const override { return device_; }

private:
    std::shared_ptr<FakeControl> control_;
    DeviceInfo device_;
    std::uint64_t slices_ = 0;
};

}  // namespace

Engine fake_engine(std::shared_ptr<FakeControl> control) {
    Engine engine;
    engine.make_backend = [control](const RendererOptions&) -> std::unique_ptr<RenderBackend> {
        return std::make_unique<FakeBackend>(control);
    };
    engine.unsupported = [](const Scene& scene, const Features&) {
        Problems problems;
        // As if this build wrote no more than these two.
        if (scene.output.format != "png" && scene.output.format != "pfm") {
            problems.push_back({"/output/format", "not_supported_yet", "this format is not supported yet"});
        }
        if (scene.output.tonemap != "none") {
            problems.push_back({"/output/tonemap", "not_supported_yet", "this tone map is not supported yet"});
        }
        return problems;
    };
    engine.list_devices = [] { return std::vector<DeviceListing>{{0, "fake renderer", true}}; };
    return engine;
}

}  // namespace penumbra::test
