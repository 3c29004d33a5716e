// SPDX-License-Identifier: MIT
#include <future>

#include "server_fixture.h"

namespace penumbra::test {
namespace {

TEST(Readiness, ComesOnlyAfterTheContextAndItsSelfTest) {
    auto control = std::make_shared<FakeControl>();
    control->close_start();
    const Service service({}, control);
    const auto before = service.client().Get("/readyz");
    expect_problem(before, 503, "not-ready");
    EXPECT_EQ(service.client().Get("/healthz")->status, 200);
    EXPECT_TRUE(nlohmann::json::parse(service.client().Get("/v1/info")->body)["device"].is_null());
    // A render asked for meanwhile waits for the start.
    auto early = std::async(std::launch::async, [&] { return service.post(kScene)->status; });
    control->open_start();
    service.worker->wait_until_started();
    const auto after = service.client().Get("/readyz");
    ASSERT_TRUE(after);
    EXPECT_EQ(after->status, 200);
    EXPECT_EQ(nlohmann::json::parse(after->body)["status"], "ready");
    EXPECT_EQ(early.get(), 200);
}

TEST(Readiness, IsRefusedByAWrongPicture) {
    auto control = std::make_shared<FakeControl>();
    control->set_self_test("the disc is too dark: secret driver text");
    const Service service({}, control);
    EXPECT_EQ(service.worker->wait_until_started(), RenderWorker::State::failing);
    const auto result = service.client().Get("/readyz");
    expect_problem(result, 503, "not-ready");
    EXPECT_EQ(result->body.find("secret"), std::string::npos);
    const auto render = service.post(kScene);
    expect_problem(render, 503, "not-ready");
    EXPECT_FALSE(render->get_header_value("Retry-After").empty());
    EXPECT_EQ(service.client().Get("/healthz")->status, 200);
}

TEST(Readiness, AWorkerThatCannotStartSaysWhy) {
    auto control = std::make_shared<FakeControl>();
    control->set_start_error("There is no device.");
    const Engine engine = fake_engine(control);
    const Log log(LogFormat::json);
    RenderWorker worker([&] { return engine.make_backend({}); }, 2, log);
    EXPECT_EQ(worker.wait_until_started(), RenderWorker::State::broken);
    EXPECT_EQ(worker.status().reason, "There is no device.");
    EXPECT_EQ(worker.submit(std::make_shared<Scene>()).refusal, RenderWorker::Refusal::not_ready);
}

TEST(Readiness, IsLostWhenTheSelfTestFailsAfterAnExceptionAndTheNewContextIsWrongToo) {
    const Service service;
    service.worker->wait_until_started();
    service.control->set_self_test("now it is wrong");
    const auto result = service.post(
        R"({"version": 1, "canvas": {"width": 4, "height": 4}, "sky": {"radiance": [13, 0, 0]}})");
    expect_problem(result, 500, "internal");
    EXPECT_EQ(service.client().Get("/readyz")->status, 503);
}

}  // namespace
}  // namespace penumbra::test
