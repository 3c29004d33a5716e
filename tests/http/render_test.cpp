// SPDX-License-Identifier: MIT
// POST /v1/render when all is well, and the small GET endpoints.
#include <cstdio>
#include <fstream>
#include <utility>

#include "core/image/codec.h"
#include "server_fixture.h"

namespace penumbra::test {
namespace {

TEST(Render, GivesAPngOfTheScenesSize) {
    const Service service;
    const auto result = service.post(kScene);
    ASSERT_TRUE(result);
    ASSERT_EQ(result->status, 200) << result->body;
    EXPECT_EQ(result->get_header_value("Content-Type"), "image/png");
    const auto picture = decode_png({reinterpret_cast<const std::uint8_t*>(result->body.data()), result->body.size()});
    ASSERT_TRUE(std::holds_alternative<Texels>(picture));
    EXPECT_EQ(std::get<Texels>(picture).width, 40);
    EXPECT_EQ(std::get<Texels>(picture).height, 30);
}

TEST(Render, TellsTimesOfQueueParsePassesAndEncode) {
    const Service service;
    const auto result = service.post(kScene);
    ASSERT_TRUE(result);
    const std::string timing = result->get_header_value("Server-Timing");
    for (const char* name : {"queue;dur=", "parse;dur=", "distance;dur=1.00", "cascade-0;dur=1.00", "render;dur=2.00", "encode;dur=", "total;dur="}) {
        EXPECT_NE(timing.find(name), std::string::npos) << name << " in " << timing;
    }
    EXPECT_EQ(result->get_header_value("Vary"), "Accept");
}

TEST(Render, AcceptChoosesTheFormat) {
    const Service service;
    const std::string pfm_scene =
        R"({"version": 1, "canvas": {"width": 4, "height": 3}, "output": {"format": "pfm"}})";
    struct Case {
        const char* accept;
        const std::string& scene;
        const char* type;
    };
    for (const Case& one : {Case{"image/x-pfm", kScene, "image/x-pfm"}, Case{"image/png", pfm_scene, "image/png"},
                            Case{"*/*", pfm_scene, "image/x-pfm"}, Case{"image/*", pfm_scene, "image/x-pfm"},
                            Case{"image/*", kScene, "image/png"},
                            Case{"image/png;q=0.5, image/x-pfm", kScene, "image/x-pfm"},
                            Case{"text/html, image/webp, */*;q=0.8", kScene, "image/png"}}) {
        const auto result = service.post(one.scene, {{"Accept", one.accept}});
        ASSERT_TRUE(result);
        EXPECT_EQ(result->status, 200) << one.accept << result->body;
        EXPECT_EQ(result->get_header_value("Content-Type"), one.type) << one.accept;
    }
    const auto silent = service.post(pfm_scene);
    ASSERT_TRUE(silent);
    EXPECT_EQ(silent->get_header_value("Content-Type"), "image/x-pfm");
}

TEST(Render, TakesJsonTypesAndUtf8) {
    const Service service;
    for (const char* type : {"application/json", "application/json; charset=utf-8", "Application/JSON;charset=\"UTF-8\"",
                             "application/vnd.penumbra.scene+json"}) {
        const auto result = service.post(kScene, {}, type);
        ASSERT_TRUE(result);
        EXPECT_EQ(result->status, 200) << type;
    }
}

TEST(Render, TakesAChunkedBody) {
    const Service service;
    RawClient client(service.port());
    char size[16];
    std::snprintf(size, sizeof size, "%zx\r\n", kScene.size());
    client.send("POST /v1/render HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\n"
                "Transfer-Encoding: chunked\r\n\r\n");
    client.send(size + kScene + "\r\n0\r\n\r\n");
    EXPECT_EQ(status_of(client.receive()), 200);
}

TEST(Render, KeepsAConnectionForManyRequestsAndPipelines) {
    const Service service;
    RawClient client(service.port());
    const std::string request = "POST /v1/render HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\nContent-Length: " +
                                std::to_string(kScene.size()) + "\r\n\r\n" + kScene;
    for (int i = 0; i < 8; ++i) {
        client.send(request);
        EXPECT_EQ(status_of(client.receive()), 200);
    }
    client.send(request + request + "GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n");
    EXPECT_EQ(status_of(client.receive()), 200);
    EXPECT_EQ(status_of(client.receive()), 200);
    EXPECT_EQ(body_of(client.receive()), "{\"status\": \"alive\"}\n");
}

TEST(Render, KeepsTheClientsRequestIdWhenItIsSound) {
    const Service service;
    const auto kept = service.post(kScene, {{"X-Request-Id", "abc-123_x.Y"}});
    ASSERT_TRUE(kept);
    EXPECT_EQ(kept->get_header_value("X-Request-Id"), "abc-123_x.Y");
    for (const std::string& bad : {std::string("two words"), std::string(65, 'a'), std::string("a\"b"), std::string("<x>")}) {
        const auto replaced = service.post(kScene, {{"X-Request-Id", bad}});
        ASSERT_TRUE(replaced);
        EXPECT_NE(replaced->get_header_value("X-Request-Id"), bad);
        EXPECT_EQ(replaced->get_header_value("X-Request-Id").size(), 16u);
    }
}

TEST(Render, IgnoresARangeBecausePicturesAreWhole) {
    const Service service;
    const auto whole = service.post(kScene);
    const auto ranged = service.post(kScene, {{"Range", "bytes=0-3"}});
    ASSERT_TRUE(whole && ranged);
    EXPECT_EQ(ranged->status, 200);
    EXPECT_EQ(ranged->body, whole->body);
}

TEST(Endpoints, AnswerGetAndHead) {
    const Service service;
    service.worker->wait_until_started();
    auto client = service.client();
    for (const char* path : {"/", "/healthz", "/readyz", "/v1/info", "/problems/queue-full"}) {
        const auto get = client.Get(path);
        ASSERT_TRUE(get) << path;
        EXPECT_EQ(get->status, 200) << path;
        EXPECT_FALSE(get->body.empty());
        const auto head = client.Head(path);
        ASSERT_TRUE(head) << path;
        EXPECT_EQ(head->status, 200) << path;
        EXPECT_TRUE(head->body.empty());
        EXPECT_FALSE(head->has_header("Accept-Ranges")) << "ranges are ignored";
    }
    EXPECT_NE(client.Get("/")->body.find("curl"), std::string::npos);
}

TEST(Endpoints, InfoListsWhatThereIs) {
    const Service service;
    service.worker->wait_until_started();
    const auto result = service.client().Get("/v1/info");
    ASSERT_TRUE(result);
    const auto json = nlohmann::json::parse(result->body);
    EXPECT_EQ(json["name"], "penumbra");
    EXPECT_EQ(json["device"]["renderer"], "fake renderer");
    EXPECT_EQ(json["limits"]["max_canvas_side_px"], 8192);
    ASSERT_EQ(json["formats"].size(), 2u);
    EXPECT_EQ(json["formats"][0]["media_type"], "image/png");
    EXPECT_EQ(json["tonemaps"], nlohmann::json::array({"none"}));
    EXPECT_EQ(json["methods"][0], "auto");
}

}  // namespace
}  // namespace penumbra::test
