// SPDX-License-Identifier: MIT
// The bounded queue, seen through HTTP and at the worker itself.
#include <future>
#include <thread>
#include <vector>

#include "server_fixture.h"

namespace penumbra::test {
namespace {

void wait_for_waiting(const RenderWorker& worker, std::size_t count) {
    for (int i = 0; i < 2000 && worker.status().waiting < count; ++i) {
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    ASSERT_EQ(worker.status().waiting, count);
}

TEST(Queue, BeyondItsPlacesIs503WithRetryAfterAndTheRestIsServed) {
    Config config;
    config.queue_capacity = 2;
    const Service service(config);
    service.worker->wait_until_started();
    service.control->close_gate();
    std::vector<std::future<int>> answers;
    const auto ask = [&](int n) {
        answers.push_back(std::async(std::launch::async, [&, n] {
            const auto result = service.post(scene_number(n));
            return result ? result->status : 0;
        }));
    };
    ask(0);
    service.control->wait_for_begun(1);
    ask(1);
    ask(2);
    wait_for_waiting(*service.worker, 2);

    const auto refused = service.post(kScene);
    expect_problem(refused, 503, "queue-full");
    EXPECT_GE(std::stoi(refused->get_header_value("Retry-After")), 1);
    // Health never waits for renders.
    EXPECT_EQ(service.client().Get("/healthz")->status, 200);
    EXPECT_EQ(service.client().Get("/readyz")->status, 200);

    service.control->open_gate();
    for (auto& answer : answers) EXPECT_EQ(answer.get(), 200);
    expect_alive(service);
}

TEST(Queue, RetryAfterFollowsTheMeasuredRate) {
    auto control = std::make_shared<FakeControl>();
    const Engine engine = fake_engine(control);
    const Log log(LogFormat::text);
    RenderWorker worker([&] { return engine.make_backend({}); }, 8, log);
    EXPECT_EQ(worker.retry_after_s(), 1);
    auto scene = std::make_shared<Scene>();
    scene->canvas.width = scene->canvas.height = 2;
    worker.wait_until_started();
    control->close_gate();
    auto first = worker.submit(scene);
    control->wait_for_begun(1);
    std::this_thread::sleep_for(std::chrono::milliseconds(400));
    control->open_gate();
    ASSERT_TRUE(first.outcome.get().result);
    control->close_gate();
    std::vector<RenderWorker::Ticket> tickets;
    for (int i = 0; i < 7; ++i) tickets.push_back(worker.submit(scene));
    control->wait_for_begun(2);
    // Six wait behind one, 0.4 s each.
    EXPECT_GE(worker.retry_after_s(), 2);
    EXPECT_LE(worker.retry_after_s(), 30);
    control->open_gate();
    for (auto& ticket : tickets) {
        const RenderOutcome outcome = ticket.outcome.get();
        EXPECT_TRUE(outcome.result);
        EXPECT_GE(outcome.wait_ms, 0);
    }
}

TEST(Queue, TheWorkerFinishesWhatIsQueuedBeforeItEnds) {
    auto control = std::make_shared<FakeControl>();
    const Engine engine = fake_engine(control);
    const Log log(LogFormat::text);
    std::vector<RenderWorker::Ticket> tickets;
    {
        RenderWorker worker([&] { return engine.make_backend({}); }, 8, log);
        auto scene = std::make_shared<Scene>();
        scene->canvas.width = scene->canvas.height = 2;
        for (int i = 0; i < 5; ++i) tickets.push_back(worker.submit(scene));
    }
    for (auto& ticket : tickets) EXPECT_TRUE(ticket.outcome.get().result);
}

TEST(Queue, StoppingTheServerAnswersWhatWasAsked) {
    const Service service;
    service.worker->wait_until_started();
    service.control->close_gate();
    std::vector<std::future<int>> answers;
    for (int i = 0; i < 3; ++i) {
        answers.push_back(std::async(std::launch::async, [&, i] {
            const auto result = service.post(scene_number(i));
            return result ? result->status : 0;
        }));
    }
    service.control->wait_for_begun(1);
    wait_for_waiting(*service.worker, 2);
    auto stopped = std::async(std::launch::async, [&] { service.server->stop(); });
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    service.control->open_gate();
    for (auto& answer : answers) EXPECT_EQ(answer.get(), 200);
    stopped.get();
    EXPECT_FALSE(service.server->listening());
}

TEST(Queue, ManyClientsAtOnceAllGetAnAnswer) {
    Config config;
    config.queue_capacity = 4;
    const Service service(config);
    std::vector<std::future<int>> answers;
    for (int i = 0; i < 24; ++i) {
        answers.push_back(std::async(std::launch::async, [&, i] {
            int bad = 0;
            for (int n = 0; n < 5; ++n) {
                const auto result = service.post(scene_number(5 * i + n));
                if (!result || (result->status != 200 && result->status != 503)) ++bad;
            }
            return bad;
        }));
    }
    for (auto& answer : answers) EXPECT_EQ(answer.get(), 0);
    expect_alive(service);
}

}  // namespace
}  // namespace penumbra::test
