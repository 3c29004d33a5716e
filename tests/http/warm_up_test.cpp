// SPDX-License-Identifier: MIT
// Programs are compiled before a client waits for them.
#include <future>
#include <set>

#include "core/scene/validate.h"
#include "process.h"
#include "server/service/warm_up.h"
#include "server_fixture.h"

namespace penumbra::test {
namespace {

RenderWorker worker_with(const Engine& engine, const Log& log, std::vector<WarmUpScene> scenes) {
    return RenderWorker([&engine] { return engine.make_backend({}); }, 4, log, std::move(scenes));
}

std::shared_ptr<const Scene> tiny() {
    auto scene = std::make_shared<Scene>();
    scene->canvas.width = scene->canvas.height = 2;
    return scene;
}

TEST(WarmUp, ScenesAreRightDifferentAndMore) {
    EXPECT_TRUE(warm_up_scenes(WarmUp::none).empty());
    const auto common = warm_up_scenes(WarmUp::common), all = warm_up_scenes(WarmUp::all);
    EXPECT_GE(common.size(), 10u);
    EXPECT_GE(all.size(), 3 * common.size());
    std::set<std::string> names;
    for (const auto& [name, scene] : all) {
        EXPECT_TRUE(validate(scene).empty()) << name;
        EXPECT_TRUE(names.insert(name).second) << name;
        EXPECT_LE(scene.canvas.width * scene.canvas.height, 80 * 80) << "they compile, they do not work";
    }
    for (const auto& [name, scene] : common) EXPECT_EQ(names.count(name), 1u) << name;
}

TEST(WarmUp, IsDoneBeforeItIsReady) {
    auto control = std::make_shared<FakeControl>();
    control->close_gate();
    const Engine engine = fake_engine(control);
    const Log log(LogFormat::text);
    RenderWorker worker = worker_with(engine, log, warm_up_scenes(WarmUp::common));
    control->wait_for_begun(1);
    EXPECT_EQ(worker.status().state, RenderWorker::State::starting);
    control->open_gate();
    EXPECT_EQ(worker.wait_until_started(), RenderWorker::State::ready);
    EXPECT_EQ(control->begun(), int(warm_up_scenes(WarmUp::common).size()));
    EXPECT_EQ(worker.status().rendered, 0u) << "for clients";
    EXPECT_EQ(worker.status().render_ms, 0) << "not a measure of what clients wait";
}

TEST(WarmUp, ARequestThatCannotWaitGoesFirst) {
    auto control = std::make_shared<FakeControl>();
    control->close_gate();
    const Engine engine = fake_engine(control);
    const Log log(LogFormat::text);
    RenderWorker worker = worker_with(engine, log, warm_up_scenes(WarmUp::common));
    control->wait_for_begun(1);
    std::promise<int> begun_then;
    ASSERT_FALSE(worker.submit({.scene = tiny(), .done = [&](const RenderOutcome& outcome) {
        EXPECT_TRUE(outcome.result);
        begun_then.set_value(control->begun());
    }}));
    control->open_gate();
    EXPECT_EQ(begun_then.get_future().get(), 2) << "after one scene of the warm-up";
    EXPECT_EQ(worker.wait_until_started(), RenderWorker::State::ready);
}

TEST(WarmUp, ASceneThatFailsIsNoReasonNotToStart) {
    auto control = std::make_shared<FakeControl>();
    const Engine engine = fake_engine(control);
    const Log log(LogFormat::text);
    Scene bad = *tiny();
    bad.sky.radiance = Colour(13, 0, 0);
    RenderWorker worker = worker_with(engine, log, {{"bad", bad}, {"good", *tiny()}});
    EXPECT_EQ(worker.wait_until_started(), RenderWorker::State::ready);
    EXPECT_EQ(control->begun(), 2);
}

TEST(WarmUp, IsLeftOutAfterAWrongSelfTest) {
    auto control = std::make_shared<FakeControl>();
    control->set_self_test("too dark");
    const Engine engine = fake_engine(control);
    const Log log(LogFormat::text);
    RenderWorker worker = worker_with(engine, log, warm_up_scenes(WarmUp::common));
    EXPECT_EQ(worker.wait_until_started(), RenderWorker::State::failing);
    EXPECT_EQ(control->begun(), 0);
}

TEST(WarmUp, EndsWithTheWorker) {
    auto control = std::make_shared<FakeControl>();
    control->close_gate();
    const Engine engine = fake_engine(control);
    const Log log(LogFormat::text);
    std::future<void> opened;
    {
        RenderWorker worker = worker_with(engine, log, warm_up_scenes(WarmUp::all));
        control->wait_for_begun(1);
        opened = std::async(std::launch::async, [&] {
            std::this_thread::sleep_for(std::chrono::milliseconds(100));  // the worker is told to end by then
            control->open_gate();
        });
    }
    EXPECT_LE(control->begun(), 2) << "the rest is not rendered for nobody";
}

}  // namespace
}  // namespace penumbra::test
