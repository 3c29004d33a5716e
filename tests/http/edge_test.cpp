// SPDX-License-Identifier: MIT
// The edge of the network: clients that are slow, silent, many or gone take no thread from those who ask.
#include <gmock/gmock.h>

#include <fcntl.h>
#include <sys/resource.h>
#include <unistd.h>

#include <chrono>
#include <future>
#include <thread>
#include <vector>

#include "server_fixture.h"

namespace penumbra::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::steady_clock;
using Clients = std::vector<std::unique_ptr<RawClient>>;

const std::string kHead = "POST /v1/render HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\n";
const std::string kLive = "GET /livez HTTP/1.1\r\nHost: x\r\n\r\n";
const std::string kInfo = "GET /v1/info HTTP/1.1\r\nHost: x\r\n\r\n";
const char* const kProbes[] = {"/livez", "/healthz", "/readyz", "/startupz"};

std::string post_of(const std::string& body) { return kHead + "Content-Length: " + std::to_string(body.size()) + "\r\n\r\n" + body; }

// Four threads in all.
Config four_threads() {
    Config config;
    config.queue_capacity = 1;
    config.spare_http_threads = 2;
    return config;
}

Clients connect(const Service& service, int count, const std::string& bytes) {
    Clients clients;
    for (int i = 0; i < count; ++i) {
        clients.push_back(std::make_unique<RawClient>(service.port()));
        clients.back()->send(bytes);
    }
    return clients;
}

milliseconds since(steady_clock::time_point start) { return std::chrono::duration_cast<milliseconds>(steady_clock::now() - start); }

// ---- slow clients

TEST(Edge, DrippersTakeNoThreadAtTheDefaultOptions) {
    const Service service;
    Clients slow = connect(service, 150, "POST /v1/render HT");
    for (auto& client : connect(service, 150, kHead + "Content-Length: 5000\r\n\r\n{")) slow.push_back(std::move(client));
    for (auto& client : connect(service, 100, "")) slow.push_back(std::move(client));
    for (int i = 0; i < 20; ++i) {
        for (auto& client : slow) client->send(i % 2 ? "" : "x");
        const auto start = steady_clock::now();
        EXPECT_EQ(service.post(scene_number(i))->status, 200);
        EXPECT_EQ(service.client().Get("/livez")->status, 200);
        EXPECT_LT(since(start), milliseconds(1500));
    }
}

TEST(Edge, ThoseWhoReadSlowlyTakeNoThread) {
    const Service service(four_threads());
    service.worker->wait_until_started();
    // 18 MB, more than the system's buffers: asked for by more clients than there are threads, and read by none.
    const std::string scene = R"({"version": 1, "canvas": {"width": 1500, "height": 1000}, "output": {"format": "pfm"}})";
    const Clients slow = connect(service, 6, post_of(scene));
    for (int tries = 0; service.service->cache_figures().hits + service.service->cache_figures().shared < 5 && tries < 500; ++tries) {
        std::this_thread::sleep_for(milliseconds(20));
    }
    const auto start = steady_clock::now();
    for (int i = 0; i < 4; ++i) EXPECT_EQ(service.client().Get("/v1/info")->status, 200);
    EXPECT_LT(since(start), milliseconds(3000));
    for (const auto& client : slow) {
        const std::string answer = client->receive();
        EXPECT_EQ(status_of(answer), 200);
        EXPECT_GT(body_of(answer).size(), 1500u * 1000 * 12);
        client->send(kLive);  // and the connection goes on
        EXPECT_EQ(status_of(client->receive()), 200);
    }
}

TEST(Edge, WhatHasNoRoomInMemoryIsWrittenAllTheSame) {
    Config config = four_threads();
    config.max_body_bytes = 1u << 20;
    config.held_bytes = 1u << 20;
    const Service service(config);
    RawClient client(service.port());
    client.send(post_of(R"({"version": 1, "canvas": {"width": 1500, "height": 1000}, "output": {"format": "pfm"}})"));
    std::this_thread::sleep_for(milliseconds(300));
    const std::string answer = client.receive();
    EXPECT_EQ(status_of(answer), 200);
    EXPECT_GT(body_of(answer).size(), 1500u * 1000 * 12);
}

// ---- many connections

TEST(Edge, AsManyConnectionsAsAllowedAndNotOneMore) {
    Config config = four_threads();
    config.max_waiting_connections = 4;
    const Service service(config);
    Clients begun = connect(service, 8, "GET /livez HT");
    std::this_thread::sleep_for(milliseconds(100));
    {
        RawClient late(service.port());
        late.send(post_of(kScene + std::string(300'000, ' ')));  // what it has sent does not destroy its answer
        const std::string answer = late.receive();
        expect_problem(body_of(answer), 503, "too-many-connections");
        EXPECT_THAT(answer, testing::HasSubstr("Retry-After: 1\r\n"));
        EXPECT_TRUE(late.closed_by_server());
    }
    for (auto& client : begun) {
        client->send("TP/1.1\r\nHost: x\r\n\r\n");
        EXPECT_EQ(status_of(client->receive()), 200) << "those who were there are served";
    }
    RawClient next(service.port());  // all others are idle now: one gives way
    next.send(kLive);
    EXPECT_EQ(status_of(next.receive()), 200);
    EXPECT_TRUE(begun.front()->closed_by_server()) << "the one that was idle for the longest time";
}

TEST(Edge, SilentConnectionsGiveWayAfterASecond) {
    Config config = four_threads();
    config.max_waiting_connections = 4;
    const Service service(config);
    const Clients silent = connect(service, 8, "");
    std::this_thread::sleep_for(milliseconds(100));
    EXPECT_EQ(status_of(RawClient(service.port()).receive()), 503);
    std::this_thread::sleep_for(milliseconds(1100));
    RawClient next(service.port());
    next.send(kLive);
    EXPECT_EQ(status_of(next.receive()), 200);
}

TEST(Edge, FileNumbersBeyondAThousandAreServed) {
    rlimit limit{};
    ::getrlimit(RLIMIT_NOFILE, &limit);
    if (limit.rlim_max < 4096) GTEST_SKIP() << "few files may be open here";
    limit.rlim_cur = std::max<rlim_t>(limit.rlim_cur, 4096);
    ::setrlimit(RLIMIT_NOFILE, &limit);
    std::vector<int> files;
    for (int i = 0; i < 1100; ++i) files.push_back(::open("/dev/null", O_RDONLY | O_CLOEXEC));
    {
        const Service service;
        RawClient client(service.port());
        client.send(post_of(kScene));
        EXPECT_EQ(status_of(client.receive()), 200);
    }
    for (const int file : files) ::close(file);
}

TEST(Edge, WhoHoldsMostIsRefusedWhenThereIsNoRoom) {
    Config config = four_threads();
    config.max_body_bytes = 1u << 20;
    config.held_bytes = 1;  // at least two bodies
    const Service service(config);
    RawClient most(service.port()), more(service.port()), less(service.port());
    const std::string head = kHead + "Content-Length: " + std::to_string(1u << 20) + "\r\n\r\n";
    for (const auto& [client, bytes] : {std::pair(&most, 900'000), std::pair(&more, 800'000), std::pair(&less, 700'000)}) {
        client->send(head + std::string(std::size_t(bytes), ' '));
        std::this_thread::sleep_for(milliseconds(200));
    }
    expect_problem(body_of(most.receive()), 503, "too-many-connections");
    EXPECT_EQ(service.post(kScene)->status, 200);
    for (const auto& [client, bytes] : {std::pair(&more, 800'000), std::pair(&less, 700'000)}) {
        client->send(kScene + std::string((1u << 20) - kScene.size() - std::size_t(bytes), ' '));
        EXPECT_EQ(status_of(client->receive()), 200);
    }
}

// ---- probes

TEST(Edge, ProbesAreAnsweredWhileEveryThreadIsTaken) {
    const Service service(four_threads());
    service.worker->wait_until_started();
    service.control->close_gate();
    const Clients waiting = connect(service, 12, post_of(kScene));  // of one picture: more than there are threads
    service.control->wait_for_begun(1);
    std::this_thread::sleep_for(milliseconds(100));
    RawClient other(service.port());
    other.send(kInfo);
    for (const char* probe : kProbes) {
        const auto start = steady_clock::now();
        const auto result = service.client().Get(probe);
        ASSERT_TRUE(result) << probe;
        EXPECT_EQ(result->status, 200) << probe;
        EXPECT_LT(since(start), milliseconds(1000)) << probe;
    }
    service.control->open_gate();
    for (const auto& client : waiting) EXPECT_EQ(status_of(client->receive()), 200);
    EXPECT_EQ(status_of(other.receive()), 200);
}

// ---- the protocol

TEST(Edge, PipelinedRequestsAreAnsweredInTheirOrder) {
    const Service service;
    const std::string chunked = kHead + "Transfer-Encoding: chunked\r\n\r\n" + "8;x=y\r\n" + kScene.substr(0, 8) + "\r\n3\r\n" + kScene.substr(8, 3) + "\r\n" +
                                [](std::size_t n) {
                                    char text[20];
                                    std::snprintf(text, sizeof text, "%zx\r\n", n);
                                    return std::string(text);
                                }(kScene.size() - 11) +
                                kScene.substr(11) + "\r\n0\r\nTrailer: x\r\n\r\n";
    const std::string all = kLive + post_of(kScene) + "GET /nothing HTTP/1.1\r\nHost: x\r\n\r\n" + "\r\n" + chunked + "HEAD /v1/info HTTP/1.1\r\nHost: x\r\n\r\n";
    for (const std::size_t piece : {all.size(), std::size_t(1)}) {
        RawClient client(service.port());
        for (std::size_t at = 0; at < all.size(); at += piece) client.send(all.substr(at, piece));
        for (const int status : {200, 200, 404, 200}) EXPECT_EQ(status_of(client.receive()), status);
    }
}

TEST(Edge, AnAnswerSurvivesWhatFollowsIt) {
    const Service service;
    for (int i = 0; i < 30; ++i) {
        RawClient client(service.port());
        client.send("GET /v1/schema HTTP/1.1\r\nHost: x\r\nConnection: close\r\n\r\n" + std::string(200'000, 'x'));
        const std::string answer = client.receive();
        ASSERT_EQ(status_of(answer), 200);
        EXPECT_GT(body_of(answer).size(), 1000u);
    }
}

TEST(Edge, ARefusedBodyIsNotAskedFor) {
    const Service service;
    for (const char* target : {"/nothing", "/livez"}) {
        RawClient client(service.port());
        client.send("POST " + std::string(target) + " HTTP/1.1\r\nHost: x\r\nExpect: 100-continue\r\nContent-Length: 100\r\n\r\n");
        EXPECT_THAT(status_of(client.receive()), testing::AnyOf(404, 405)) << target;
        EXPECT_TRUE(client.closed_by_server());
    }
}

TEST(Edge, IdleConnectionsEndWithoutAWord) {
    Config config;
    config.keep_alive_s = 1;
    const Service service(config);
    RawClient silent(service.port()), idle(service.port());
    idle.send(kLive);
    EXPECT_EQ(status_of(idle.receive()), 200);
    const auto start = steady_clock::now();
    EXPECT_EQ(silent.receive(), "");
    EXPECT_EQ(idle.receive(), "");
    EXPECT_LT(since(start), milliseconds(2500));
}

// ---- the end

TEST(Edge, TheEndIsPromptWithConnectionsThatIdle) {
    const Service service;
    const Clients idle = connect(service, 40, kLive), silent = connect(service, 20, "");
    for (const auto& client : idle) EXPECT_EQ(status_of(client->receive()), 200);
    const auto start = steady_clock::now();
    service.server->stop();
    EXPECT_LT(since(start), milliseconds(2000));
    for (const auto& client : idle) EXPECT_TRUE(client->closed_by_server());
}

TEST(Edge, TheEndWaitsForAnswersAndRefusesWhatHasOnlyBegun) {
    const Service service;
    service.worker->wait_until_started();
    service.control->close_gate();
    RawClient asked(service.port()), begun(service.port());
    asked.send(post_of(kScene));
    begun.send("GET /livez HT");
    service.control->wait_for_begun(1);
    const auto start = steady_clock::now();
    auto stopped = std::async(std::launch::async, [&] { service.server->stop(); });
    expect_problem(body_of(begun.receive()), 503, "not-ready");
    service.control->open_gate();
    const std::string answer = asked.receive();
    EXPECT_EQ(status_of(answer), 200);
    EXPECT_THAT(answer, testing::HasSubstr("Connection: close"));
    stopped.get();
    EXPECT_LT(since(start), milliseconds(6000));
}

}  // namespace
}  // namespace penumbra::test
