// SPDX-License-Identifier: MIT
// A service with the fake renderer on a free port, and the checks that every test of it uses.
#pragma once

#include <gtest/gtest.h>

#include <memory>
#include <string>

#include <httplib.h>
#include <nlohmann/json.hpp>

#include "fake_engine.h"
#include "raw_client.h"
#include "server/http/http_server.h"

namespace penumbra::test {

inline const std::string kScene =
    R"({"version": 1, "canvas": {"width": 40, "height": 30}, "sky": {"radiance": 0.5}})";
inline const char* const kJson = "application/json";

// One of many scenes that render alike and have nothing else in common.
inline std::string scene_number(int n) {
    return R"({"version": 1, "canvas": {"width": 40, "height": 30, "margin": )" + std::to_string(n) + "}}";
}

class Service {
public:
    explicit Service(Config config = {}, std::shared_ptr<FakeControl> the_control = std::make_shared<FakeControl>())
        : control(std::move(the_control)), engine(fake_engine(control)), settings(local(std::move(config))) {
        worker = std::make_unique<RenderWorker>([this] { return engine.make_backend({}); },
                                                settings.queue_capacity, log, warm_up_scenes(settings.warm_up));
        service = std::make_unique<RenderService>(*worker, engine.unsupported_with({}), settings);
        server = std::make_unique<HttpServer>(*service, settings, log);
        const std::string why = server->start();
        if (!why.empty()) ADD_FAILURE() << why;
    }
    ~Service() {
        control->open_gate();
        control->open_start();
        server->stop();
    }
    Service(const Service&) = delete;
    Service& operator=(const Service&) = delete;

    int port() const { return server->port(); }
    httplib::Client client() const {
        httplib::Client client("127.0.0.1", port());
        client.set_read_timeout(20);
        return client;
    }
    httplib::Result post(const std::string& body, const httplib::Headers& headers = {},
                         const char* type = kJson) const {
        return client().Post("/v1/render", headers, body, type);
    }

    std::shared_ptr<FakeControl> control;
    Engine engine;
    Config settings;
    Log log{LogFormat::text};
    std::unique_ptr<RenderWorker> worker;
    std::unique_ptr<RenderService> service;
    std::unique_ptr<HttpServer> server;

private:
    static Config local(Config config) {
        config.host = "127.0.0.1";
        config.port = 0;
        // Renders are counted; tests of the warm-up make their own worker.
        config.warm_up = WarmUp::none;
        return config;
    }
};

// A whole problem of RFC 9457 with this status, and its members.
inline nlohmann::json expect_problem(const std::string& body, int status, const std::string& name) {
    const nlohmann::json json = nlohmann::json::parse(body, nullptr, false);
    EXPECT_TRUE(json.is_object()) << body;
    if (!json.is_object()) return nlohmann::json::object();
    EXPECT_EQ(json.value("type", ""), "/problems/" + name) << body;
    EXPECT_EQ(json.value("status", 0), status);
    EXPECT_FALSE(json.value("title", "").empty());
    EXPECT_FALSE(json.value("detail", "").empty());
    EXPECT_FALSE(json.value("instance", "").empty());
    return json;
}

inline nlohmann::json expect_problem(const httplib::Result& result, int status, const std::string& name) {
    if (!result) {
        ADD_FAILURE() << "no answer: " << httplib::to_string(result.error());
        return nlohmann::json::object();
    }
    EXPECT_EQ(result->status, status) << result->body;
    EXPECT_EQ(result->get_header_value("Content-Type"), "application/problem+json");
    EXPECT_EQ(result->get_header_value("Cache-Control"), "no-store");
    EXPECT_FALSE(result->get_header_value("X-Request-Id").empty());
    nlohmann::json json = expect_problem(result->body, status, name);
    EXPECT_EQ(json.value("instance", ""), result->get_header_value("X-Request-Id"));
    return json;
}

inline void expect_alive(const Service& service) {
    const auto result = service.post(kScene);
    ASSERT_TRUE(result);
    EXPECT_EQ(result->status, 200) << result->body;
}

}  // namespace penumbra::test
