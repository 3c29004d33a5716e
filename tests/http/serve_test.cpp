// SPDX-License-Identifier: MIT
// penumbra serve as a process: its port, its signals, its exit codes.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <future>
#include <sstream>
#include <thread>

#include <httplib.h>
#include <nlohmann/json.hpp>

#include "process.h"

namespace penumbra::test {
namespace {

using testing::HasSubstr;

const std::string kScene = R"({"version": 1, "canvas": {"width": 40, "height": 30}})";

struct Served {
    explicit Served(const Environment& environment = {}, std::vector<std::string> arguments = {})
        : program(PENUMBRA_FAKE_PROGRAM, full(std::move(arguments)), environment),
          port(wait_for_port(folder.path("port"))) {}

    std::vector<std::string> full(std::vector<std::string> more) const {
        std::vector<std::string> all{"serve", "--port", "0", "--port-file", folder.path("port"), "--warm-up", "none"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    std::string url() const { return "http://127.0.0.1:" + std::to_string(port); }

    TemporaryFolder folder;
    Running program;
    int port;
};

TEST(Serve, TellsItsPortServesAndEndsAtSigterm) {
    Served served;
    ASSERT_GT(served.port, 0) << served.program.err();
    httplib::Client client("127.0.0.1", served.port);
    const auto result = client.Post("/v1/render", kScene, "application/json");
    ASSERT_TRUE(result);
    EXPECT_EQ(result->status, 200);
    EXPECT_EQ(run_program(PENUMBRA_FAKE_PROGRAM, {"health", "--url", served.url()}).exit_code, 0);
    EXPECT_EQ(run_program(PENUMBRA_FAKE_PROGRAM, {"health", "--url", served.url() + "/nothing"}).exit_code, 1);
    served.program.signal(SIGTERM);
    EXPECT_EQ(served.program.wait(), 0);
    const std::string log = served.program.err();
    EXPECT_THAT(log, HasSubstr("listening on " + served.url()));
    EXPECT_THAT(log, HasSubstr("request method=POST path=/v1/render status=200"));
    EXPECT_THAT(log, HasSubstr("stopped"));
}

TEST(Serve, FinishesARenderThatRunsWhenTheSignalComes) {
    Served served(Environment{{"FAKE_RENDER_MS", "600"}});
    ASSERT_GT(served.port, 0);
    auto answer = std::async(std::launch::async, [&] {
        httplib::Client client("127.0.0.1", served.port);
        const auto result = client.Post("/v1/render", kScene, "application/json");
        return result ? result->status : 0;
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    served.program.signal(SIGINT);
    EXPECT_EQ(answer.get(), 200);
    EXPECT_EQ(served.program.wait(), 0);
}

TEST(Serve, ASecondSignalEndsItAtOnce) {
    Served served(Environment{{"FAKE_RENDER_MS", "30000"}});
    ASSERT_GT(served.port, 0);
    auto answer = std::async(std::launch::async, [&] {
        httplib::Client client("127.0.0.1", served.port);
        client.set_read_timeout(20);
        return bool(client.Post("/v1/render", kScene, "application/json"));
    });
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    served.program.signal(SIGTERM);
    while (served.program.err().find("stopping") == std::string::npos) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    served.program.signal(SIGTERM);
    EXPECT_EQ(served.program.wait(), 1);
    EXPECT_FALSE(answer.get());
}

TEST(Serve, LogsJsonLines) {
    Served served({}, {"--log", "json"});
    ASSERT_GT(served.port, 0);
    httplib::Client client("127.0.0.1", served.port);
    ASSERT_TRUE(client.Get("/a\"b%0Ac"));
    served.program.signal(SIGTERM);
    EXPECT_EQ(served.program.wait(), 0);
    std::istringstream lines(served.program.err());
    int requests = 0;
    for (std::string line; std::getline(lines, line);) {
        const auto json = nlohmann::json::parse(line, nullptr, false);
        ASSERT_TRUE(json.is_object()) << line;
        if (json["message"] != "request") continue;
        ++requests;
        EXPECT_EQ(json["path"], "/a\"b\nc");
        EXPECT_EQ(json["status"], 404);
        EXPECT_TRUE(json["ms"].is_number());
        EXPECT_TRUE(json["id"].is_string());
    }
    EXPECT_EQ(requests, 1);
}

TEST(Serve, WithoutADeviceItEndsWith1) {
    Served served(Environment{{"FAKE_START_ERROR", "There is no device."}});
    EXPECT_EQ(served.program.wait(), 1);
    EXPECT_THAT(served.program.err(), HasSubstr("penumbra: There is no device."));
}

TEST(Serve, WithAWrongPictureItLivesButIsNotReady) {
    Served served(Environment{{"FAKE_SELF_TEST", "too dark"}});
    ASSERT_GT(served.port, 0);
    const Finished health = run_program(PENUMBRA_FAKE_PROGRAM, {"health", "--url", served.url()});
    EXPECT_EQ(health.exit_code, 1);
    EXPECT_THAT(health.err, HasSubstr("not ready"));
    served.program.signal(SIGTERM);
    EXPECT_EQ(served.program.wait(), 0);
}

TEST(Serve, ATakenPortIsExitCode1) {
    const Served first;
    ASSERT_GT(first.port, 0);
    const Finished second = run_program(PENUMBRA_FAKE_PROGRAM, {"serve", "--port", std::to_string(first.port)});
    EXPECT_EQ(second.exit_code, 1);
    EXPECT_THAT(second.err, HasSubstr("Cannot listen on 127.0.0.1 port " + std::to_string(first.port) + ": Address already in use"));
}

TEST(Serve, TheSystemsReasonIsToldWhenItCannotListen) {
    const auto reason = [](const std::string& host) {
        return run_program(PENUMBRA_FAKE_PROGRAM, {"serve", "--port", "0", "--host", host}).err;
    };
    EXPECT_THAT(reason("192.0.2.1"), HasSubstr("Cannot assign requested address"));
    EXPECT_THAT(reason("300.1.1.1.invalid"), HasSubstr("300.1.1.1.invalid"));
    EXPECT_THAT(reason("300.1.1.1.invalid"), testing::AnyOf(HasSubstr("not known"), HasSubstr("resolution")));
}

TEST(Serve, TakesItsOptionsFromTheEnvironment) {
    Served served(Environment{{"PENUMBRA_MAX_BODY_MB", "1"}, {"PENUMBRA_MAX_PIXELS", "1000"}});
    ASSERT_GT(served.port, 0);
    httplib::Client client("127.0.0.1", served.port);
    const auto large = client.Post("/v1/render", kScene, "application/json");
    ASSERT_TRUE(large);
    EXPECT_EQ(large->status, 422) << large->body;
    const auto info = client.Get("/v1/info");
    ASSERT_TRUE(info);
    const auto json = nlohmann::json::parse(info->body);
    EXPECT_EQ(json["limits"]["max_body_bytes"], 1 << 20);
    EXPECT_EQ(json["limits"]["max_canvas_pixels"], 1000);
}

}  // namespace
}  // namespace penumbra::test
