// SPDX-License-Identifier: MIT
// Every way to be refused: the status, the type and the places of the mistakes.
#include "server_fixture.h"

namespace penumbra::test {
namespace {

TEST(Problems, TextThatIsNoJsonIs400WithItsPlace) {
    const Service service;
    for (const std::string& text :
         {std::string(""), std::string("{"), std::string(R"({"version": 1, "canvas": {"width": 4)"), std::string("hello"),
          std::string(R"({"version": 1,, })"), std::string("{\"version\": 1, \"canvas\": {\"width\": NaN, \"height\": 1}}")}) {
        const auto json = expect_problem(service.post(text), 400, "not-json");
        ASSERT_FALSE(json["errors"].empty()) << text;
        EXPECT_GE(json["errors"][0].value("line", 0), 1) << json;
    }
    expect_alive(service);
}

TEST(Problems, AWrongSceneIs422WithAllProblemsAtOnce) {
    const Service service;
    const std::string scene = "{\"version\": 1,\n"
                              " \"canvas\": {\"widht\": 4, \"width\": 0, \"height\": 3},\n"
                              " \"shapes\": [{\"type\": \"circle\", \"center\": [0, 0], \"radius\": -1}]}";
    const auto json = expect_problem(service.post(scene), 422, "invalid-scene");
    ASSERT_GE(json["errors"].size(), 2u) << json;
    bool found_key = false;
    for (const auto& error : json["errors"]) {
        EXPECT_FALSE(error.value("code", "").empty());
        EXPECT_FALSE(error.value("message", "").empty());
        if (error.value("pointer", "") != "/canvas/widht") continue;
        found_key = true;
        EXPECT_EQ(error.value("line", 0), 2);
        EXPECT_EQ(error.value("suggestion", ""), "width");
    }
    EXPECT_TRUE(found_key) << json;
}

TEST(Problems, WhatIsNotBuiltYetIsNamed) {
    const Service service;
    const std::string scene = "{\"version\": 1, \"canvas\": {\"width\": 4, \"height\": 3},\n"
                              " \"output\": {\"tonemap\": \"aces\", \"format\": \"exr\"}}";
    const auto json = expect_problem(service.post(scene), 422, "not-supported-yet");
    ASSERT_EQ(json["errors"].size(), 2u) << json;
    for (const auto& error : json["errors"]) {
        EXPECT_EQ(error["code"], "not_supported_yet");
        EXPECT_EQ(error["line"], 2);
    }
    // Accept that asks for a format there is takes the scene's choice away.
    const auto one = expect_problem(service.post(scene, {{"Accept", "image/png"}}), 422, "not-supported-yet");
    EXPECT_EQ(one["errors"].size(), 1u) << one;
}

TEST(Problems, HalfAMillionBracketsAreRefused) {
    const Service service;
    for (const char* open : {"[", "{\"a\":"}) {
        std::string text;
        for (int i = 0; i < 500000; ++i) text += open;
        const auto result = service.post(text);
        ASSERT_TRUE(result);
        EXPECT_GE(result->status, 400);
        EXPECT_LT(result->status, 500);
        EXPECT_EQ(result->get_header_value("Content-Type"), "application/problem+json");
        EXPECT_LT(result->body.size(), 10000u);
    }
    std::string closed = "{\"version\": 1, \"x\": " + std::string(500000, '[') + std::string(500000, ']') + "}";
    const auto result = service.post(closed);
    ASSERT_TRUE(result);
    EXPECT_GE(result->status, 400);
    EXPECT_LT(result->status, 500);
    expect_alive(service);
}

TEST(Problems, UnknownPathsAre404) {
    const Service service;
    auto client = service.client();
    for (const char* path : {"/nothing", "/v1", "/v1/render/", "/healthz/x", "/problems/nothing", "//"}) {
        expect_problem(client.Get(path), 404, "not-found");
    }
    expect_problem(client.Post("/nothing", kScene, kJson), 404, "not-found");
}

TEST(Problems, WrongMethodsAre405AndSayTheRightOnes) {
    const Service service;
    auto client = service.client();
    const auto get = client.Get("/v1/render");
    expect_problem(get, 405, "method-not-allowed");
    EXPECT_EQ(get->get_header_value("Allow"), "POST, OPTIONS");
    for (const auto& result : {client.Put("/v1/render", kScene, kJson), client.Delete("/v1/render"),
                               client.Patch("/v1/render", kScene, kJson)}) {
        expect_problem(result, 405, "method-not-allowed");
    }
    for (const char* path : {"/", "/healthz", "/readyz", "/v1/info", "/problems/internal"}) {
        const auto post = service.client().Post(path, kScene, kJson);
        expect_problem(post, 405, "method-not-allowed");
        EXPECT_EQ(post->get_header_value("Allow"), "GET, HEAD, OPTIONS");
    }
}

TEST(Problems, AcceptThatFitsNothingIs406WithTheList) {
    const Service service;
    for (const char* accept : {"image/webp", "application/json", "image/png;q=0", "*/*;q=0"}) {
        const auto json = expect_problem(service.post(kScene, {{"Accept", accept}}), 406, "not-acceptable");
        EXPECT_NE(json.value("detail", "").find("image/png, image/x-pfm"), std::string::npos);
    }
}

TEST(Problems, OtherBodiesAre415) {
    const Service service;
    for (const char* type : {"text/plain", "application/x-www-form-urlencoded", "multipart/form-data; boundary=x",
                             "application/json; charset=latin1", "json", "+json"}) {
        expect_problem(service.post(kScene, {}, type), 415, "unsupported-media-type");
    }
    expect_problem(service.post(kScene, {{"Content-Encoding", "gzip"}}), 415, "unsupported-media-type");
    const auto identity = service.post(kScene, {{"Content-Encoding", "identity"}});
    ASSERT_TRUE(identity);
    EXPECT_EQ(identity->status, 200);
}

TEST(Problems, AConnectionThatIsClosedIsNotCalledKept) {
    const Service service;
    for (const char* type : {"text/plain", "application/json"}) {
        RawClient client(service.port());
        client.send("POST /v1/render HTTP/1.1\r\nHost: x\r\nContent-Type: " + std::string(type) +
                    "\r\nContent-Length: " + std::to_string(kScene.size()) + "\r\n\r\n" + kScene);
        const std::string answer = client.receive();
        const bool closes = std::string(type) == "text/plain";
        EXPECT_EQ(status_of(answer), closes ? 415 : 200);
        EXPECT_EQ(answer.find("Connection: close") != std::string::npos, closes) << answer;
        EXPECT_EQ(answer.find("Keep-Alive:") != std::string::npos, !closes) << answer;
        // Connections are not counted: no number of requests ends one.
        EXPECT_EQ(answer.find("max="), std::string::npos);
        if (closes) {
            EXPECT_TRUE(client.closed_by_server());
        } else {
            EXPECT_NE(answer.find("Keep-Alive: timeout=75\r\n"), std::string::npos) << answer;
        }
    }
}

TEST(Problems, QueryParametersAreNotPassedOverInSilence) {
    const Service service;
    expect_problem(service.client().Post("/v1/render?quality=high", kScene, kJson), 400, "bad-request");
}

TEST(Problems, AFailedRenderIs500WithoutInternalsAndTheServiceLivesOn) {
    const Service service;
    const std::string deadly = R"({"version": 1, "canvas": {"width": 4, "height": 4}, "sky": {"radiance": [13, 0, 0]}})";
    for (int i = 0; i < 3; ++i) {
        const auto result = service.post(deadly);
        expect_problem(result, 500, "internal");
        EXPECT_EQ(result->body.find("secret"), std::string::npos);
        for (const auto& [name, value] : result->headers) EXPECT_EQ(value.find("secret"), std::string::npos) << name;
        expect_alive(service);
    }
    EXPECT_EQ(service.client().Get("/readyz")->status, 200);
}

TEST(Problems, EveryTypeResolvesToItsExplanation) {
    const Service service;
    const auto result = service.post("{");
    ASSERT_TRUE(result);
    const std::string type = nlohmann::json::parse(result->body)["type"];
    const auto page = service.client().Get(type.c_str());
    ASSERT_TRUE(page);
    EXPECT_EQ(page->status, 200);
    EXPECT_NE(page->body.find("not JSON"), std::string::npos);
}

TEST(Problems, BytesThatAreNoUtf8ComeBackAsJsonAllTheSame) {
    const Service service;
    const auto result = service.post("{\"version\": 1, \"\xff\xfe\": 2}");
    ASSERT_TRUE(result);
    EXPECT_GE(result->status, 400);
    EXPECT_LT(result->status, 500);
    EXPECT_FALSE(nlohmann::json::parse(result->body, nullptr, false).is_discarded()) << result->body;
}

}  // namespace
}  // namespace penumbra::test
