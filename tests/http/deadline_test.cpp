// SPDX-License-Identifier: MIT
// Renders that nobody waits for any longer: past their deadline, without a client, or at the service's end.
#include <future>
#include <thread>

#include "server/http/negotiate.h"
#include "server_fixture.h"

namespace penumbra::test {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

bool within(double seconds, const std::function<bool()>& condition) {
    const Clock::time_point start = Clock::now();
    while (!condition()) {
        if (seconds_since(start) > seconds) return false;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    return true;
}

std::string raw(const std::string& scene) {
    return "POST /v1/render HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\nContent-Length: " + std::to_string(scene.size()) +
           "\r\n\r\n" + scene;
}

struct Closed : Service {
    explicit Closed(const Config& config = {}) : Service(config) {
        worker->wait_until_started();
        control->close_gate();
    }
};

TEST(Deadline, TheClientsIsKeptAndEndsTheRender) {
    const Closed service;
    const Clock::time_point start = Clock::now();
    const auto result = service.post(kScene, {{"Prefer", "wait=0.2"}});
    EXPECT_GE(seconds_since(start), 0.15);
    EXPECT_LT(seconds_since(start), 15);
    expect_problem(result, 504, "deadline-exceeded");
    EXPECT_EQ(result->get_header_value("Preference-Applied"), "wait=0.2");
    EXPECT_TRUE(within(15, [&] { return service.control->stopped() == 1; }));
    service.control->open_gate();
    expect_alive(service);
}

TEST(Deadline, TheServersIsTheLongest) {
    Config config;
    config.max_deadline_s = 1;
    const Closed service(config);
    const Clock::time_point start = Clock::now();
    const auto result = service.post(kScene, {{"Prefer", "respond-async, wait=3600"}});
    expect_problem(result, 504, "deadline-exceeded");
    EXPECT_EQ(result->get_header_value("Preference-Applied"), "wait=1");
    EXPECT_LT(seconds_since(start), 15);
}

TEST(Deadline, WhatWaitsInTheQueueIsNotBegun) {
    const Closed service;
    auto first = std::async(std::launch::async, [&] { return service.post(scene_number(0))->status; });
    service.control->wait_for_begun(1);
    expect_problem(service.post(scene_number(1), {{"Prefer", "wait=0.1"}}), 504, "deadline-exceeded");
    service.control->open_gate();
    EXPECT_EQ(first.get(), 200);
    expect_alive(service);
    EXPECT_EQ(service.control->begun(), 2) << "the first, and the last of three";
}

TEST(Deadline, OfThoseWhoShareARenderEachHasItsOwn) {
    const Closed service;
    auto patient = std::async(std::launch::async, [&] { return service.post(kScene)->status; });
    service.control->wait_for_begun(1);
    expect_problem(service.post(kScene, {{"Prefer", "wait=0.1"}}), 504, "deadline-exceeded");
    service.control->open_gate();
    EXPECT_EQ(patient.get(), 200);
    EXPECT_EQ(service.control->stopped(), 0);
    EXPECT_EQ(service.control->begun(), 1);
}

TEST(Deadline, AnEqualRequestAfterItBeginsAnew) {
    const Closed service;
    expect_problem(service.post(kScene, {{"Prefer", "wait=0.1"}}), 504, "deadline-exceeded");
    auto next = std::async(std::launch::async, [&] { return service.post(kScene)->status; });
    service.control->wait_for_begun(2);
    service.control->open_gate();
    EXPECT_EQ(next.get(), 200);
}

TEST(Deadline, AClientThatLeavesEndsItsRender) {
    const Closed service;
    {
        RawClient gone(service.port());
        gone.send(raw(kScene));
        service.control->wait_for_begun(1);
    }
    EXPECT_TRUE(within(15, [&] { return service.control->stopped() == 1; }));
    service.control->open_gate();
    expect_alive(service);
}

TEST(Deadline, AClientThatPipelinesHasNotLeft) {
    const Closed service;
    RawClient client(service.port());
    client.send(raw(kScene) + "GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n");
    service.control->wait_for_begun(1);
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    service.control->open_gate();
    EXPECT_EQ(status_of(client.receive()), 200);
    EXPECT_EQ(status_of(client.receive()), 200);
    EXPECT_EQ(service.control->stopped(), 0);
}

TEST(Deadline, AtTheEndOfPatienceRendersAreEnded) {
    const Closed service;
    auto answer = std::async(std::launch::async, [&] { return service.post(kScene); });
    service.control->wait_for_begun(1);
    service.service->stop_all();
    expect_problem(answer.get(), 503, "not-ready");
    EXPECT_TRUE(within(15, [&] { return service.control->stopped() == 1; }));
}

TEST(Prefer, WaitIsReadByTheGrammar) {
    EXPECT_EQ(parse_wait("wait=10"), 10);
    EXPECT_EQ(parse_wait("respond-async, WAIT=0.25"), 0.25);
    EXPECT_EQ(parse_wait("foo; wait=3, wait=\"5\""), 5);
    EXPECT_EQ(parse_wait("wait=5; x=1"), 5);
    for (const char* wrong : {"", "wait", "wait=", "wait=-1", "wait=1e9", "wait=.5", "wait=1.2.3", "wait=soon", "wait=9999999999999"}) {
        EXPECT_EQ(parse_wait(wrong), std::nullopt) << wrong;
    }
}

}  // namespace
}  // namespace penumbra::test
