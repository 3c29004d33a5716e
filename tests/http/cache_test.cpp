// SPDX-License-Identifier: MIT
// Pictures that need not be rendered: kept, asked for twice at once, or had by the client already.
#include <future>
#include <set>
#include <thread>
#include <vector>

#include "server/http/negotiate.h"
#include "server/service/answer_cache.h"
#include "server_fixture.h"

namespace penumbra::test {
namespace {

using nlohmann::json;

httplib::Headers had(const std::string& tags) { return {{"If-None-Match", tags}}; }

// The same scene as kScene in other words.
const std::string kOtherWords =
    R"({"sky":{"radiance":[5e-1,0.5,0.50]},"canvas":{"height":30,"margin":0,"width":40.0},"render":{"method":"auto"},"version":1})";
const std::string kFailing = R"({"version": 1, "canvas": {"width": 4, "height": 4}, "sky": {"radiance": [13, 0, 0]}})";

json figures(const Service& service) { return json::parse(service.client().Get("/readyz")->body)["cache"]; }

struct Started : Service {
    explicit Started(const Config& config = {}) : Service(config) { worker->wait_until_started(); }
};

TEST(Cache, ARepeatedRequestIsNotRendered) {
    const Started service;
    const auto first = service.post(kScene), again = service.post(kScene), rewritten = service.post(kOtherWords);
    ASSERT_TRUE(first && again && rewritten);
    EXPECT_EQ(first->get_header_value("Cache-Status"), "penumbra; fwd=miss; stored");
    EXPECT_EQ(first->get_header_value("Cache-Control"), "no-cache");
    for (const auto* other : {&again, &rewritten}) {
        EXPECT_EQ((*other)->status, 200);
        EXPECT_EQ((*other)->get_header_value("Cache-Status"), "penumbra; hit");
        EXPECT_EQ((*other)->get_header_value("ETag"), first->get_header_value("ETag"));
        EXPECT_EQ((*other)->get_header_value("Content-Type"), "image/png");
        EXPECT_EQ((*other)->get_header_value("Vary"), "Accept");
        EXPECT_EQ((*other)->get_header_value("Server-Timing").find("distance"), std::string::npos) << "it did not run";
        EXPECT_TRUE((*other)->body == first->body);
    }
    EXPECT_EQ(service.control->begun(), 1);
    EXPECT_EQ(service.post(scene_number(1))->get_header_value("Cache-Status"), "penumbra; fwd=miss; stored");
    EXPECT_EQ(service.control->begun(), 2);
    const json counted = figures(service);
    EXPECT_EQ(counted["hits"], 2);
    EXPECT_EQ(counted["misses"], 2);
    EXPECT_EQ(counted["pictures"], 2);
    EXPECT_GT(counted["bytes"], first->body.size());
}

TEST(Cache, TagsAreStrongAndOfOnePictureEach) {
    const Started service;
    const auto png = service.post(kScene), pfm = service.post(kScene, {{"Accept", "image/x-pfm"}}), other = service.post(scene_number(1));
    std::set<std::string> tags;
    for (const auto* result : {&png, &pfm, &other}) {
        ASSERT_TRUE(*result);
        const std::string tag = (*result)->get_header_value("ETag");
        EXPECT_EQ(tag.size(), 66u) << tag;
        EXPECT_TRUE(tag.starts_with('"') && tag.ends_with('"')) << tag;
        tags.insert(tag);
    }
    EXPECT_EQ(tags.size(), 3u);
    EXPECT_EQ(service.control->begun(), 3);
}

TEST(Cache, NoCacheRendersAnew) {
    const Started service;
    const auto first = service.post(kScene);
    ASSERT_TRUE(first);
    httplib::Headers headers = had(first->get_header_value("ETag"));
    headers.emplace("Cache-Control", "max-age=0, No-Cache");
    const auto anew = service.post(kScene, headers);
    ASSERT_TRUE(anew);
    EXPECT_EQ(anew->status, 200);
    EXPECT_EQ(anew->get_header_value("Cache-Status"), "penumbra; fwd=request; stored");
    EXPECT_EQ(service.control->begun(), 2);
    EXPECT_EQ(figures(service)["pictures"], 1) << "in its old place";
}

TEST(Cache, AClientThatHasThePictureIsToldSoBeforeTheQueue) {
    const Started service;
    const auto first = service.post(kScene);
    ASSERT_TRUE(first);
    const std::string tag = first->get_header_value("ETag");
    // Nothing may wait for the renderer from here on.
    service.control->close_gate();
    for (const std::string& list : {tag, "W/" + tag, "\"a\", W/\"b,c\"," + tag, std::string("*"), " , " + tag + " ,"}) {
        RawClient client(service.port());
        client.send("POST /v1/render HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\nIf-None-Match: " + list +
                    "\r\nContent-Length: " + std::to_string(kOtherWords.size()) + "\r\n\r\n" + kOtherWords +
                    "GET /healthz HTTP/1.1\r\nHost: x\r\n\r\n");
        const std::string answer = client.receive();
        EXPECT_EQ(status_of(answer), 304) << list << "\n" << answer;
        EXPECT_EQ(body_of(answer), "");
        for (const std::string& line : {"ETag: " + tag, std::string("Vary: Accept"), std::string("Cache-Control: no-cache"),
                                        std::string("Cache-Status: penumbra; hit"), std::string("X-Request-Id: ")}) {
            EXPECT_NE(answer.find("\r\n" + line), std::string::npos) << line << " in\n" << answer;
        }
        EXPECT_EQ(answer.find("Content-Length"), std::string::npos) << answer;
        EXPECT_EQ(answer.find("Content-Type"), std::string::npos) << answer;
        EXPECT_EQ(status_of(client.receive()), 200) << "the connection goes on";
    }
    EXPECT_EQ(figures(service)["not_modified"], 5);
    service.control->open_gate();
    for (const std::string& list : {std::string("\"other\""), tag.substr(1), tag.substr(0, 65), std::string("\"x\" ") + tag, std::string("w/") + tag}) {
        const auto whole = service.post(kScene, had(list));
        ASSERT_TRUE(whole);
        EXPECT_EQ(whole->status, 200) << list;
    }
    // Another representation has another tag.
    EXPECT_EQ(service.post(kScene, {{"If-None-Match", tag}, {"Accept", "image/x-pfm"}})->status, 200);
}

TEST(Cache, AWrongSceneIsRefusedWhateverTheClientHas) {
    const Started service;
    expect_problem(service.post("{\"version\": 1}", had("*")), 422, "invalid-scene");
    expect_problem(service.post(kScene, {{"If-None-Match", "*"}, {"Accept", "text/html"}}), 406, "not-acceptable");
}

TEST(Cache, TheLongestUnusedGoFirst) {
    Config config;
    config.cache_bytes = 20'000;  // some ten of the fake renderer's pictures
    const Started service(config);
    const auto status = [&](int n) { return service.post(scene_number(n))->get_header_value("Cache-Status"); };
    for (int n = 0; n < 40; ++n) {
        EXPECT_EQ(status(n), "penumbra; fwd=miss; stored");
        EXPECT_EQ(status(0), "penumbra; hit") << "asked for all the time, after " << n;
    }
    EXPECT_EQ(status(1), "penumbra; fwd=miss; stored");
    EXPECT_EQ(status(39), "penumbra; hit");
    const json counted = figures(service);
    EXPECT_LE(counted["bytes"], 20'000);
    EXPECT_GT(counted["pictures"], 2);
    EXPECT_EQ(counted["evicted"].get<int>() + counted["pictures"].get<int>(), 41);
}

TEST(Cache, WhatIsLargerThanItIsNotKept) {
    Config config;
    config.cache_bytes = 1000;
    const Started service(config);
    for (int i = 1; i <= 2; ++i) {
        const auto result = service.post(R"({"version": 1, "canvas": {"width": 400, "height": 300}})");
        ASSERT_TRUE(result);
        EXPECT_EQ(result->get_header_value("Cache-Status"), "penumbra; fwd=miss");
        EXPECT_EQ(service.control->begun(), i);
    }
}

TEST(Cache, SwitchedOffItStillKnowsTags) {
    Config config;
    config.cache_bytes = 0;
    const Started service(config);
    const auto first = service.post(kScene), second = service.post(kScene);
    ASSERT_TRUE(first && second);
    EXPECT_EQ(second->get_header_value("Cache-Status"), "penumbra; fwd=miss");
    EXPECT_EQ(service.control->begun(), 2);
    RawClient client(service.port());
    client.send("POST /v1/render HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\nIf-None-Match: " +
                first->get_header_value("ETag") + "\r\nContent-Length: " + std::to_string(kScene.size()) + "\r\n\r\n" + kScene);
    EXPECT_EQ(status_of(client.receive()), 304);
    EXPECT_EQ(service.control->begun(), 2);
}

TEST(Cache, WhatIsKeptIsGivenThoughTheQueueIsFull) {
    Config config;
    config.queue_capacity = 1;
    const Started service(config);
    ASSERT_EQ(service.post(kScene)->status, 200);
    service.control->close_gate();
    std::vector<std::future<int>> answers;
    for (int n = 1; n <= 2; ++n) {
        answers.push_back(std::async(std::launch::async, [&, n] { return service.post(scene_number(n))->status; }));
        service.control->wait_for_begun(2);
    }
    while (service.worker->status().waiting < 1) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    expect_problem(service.post(scene_number(3)), 503, "queue-full");
    EXPECT_EQ(service.post(kScene)->get_header_value("Cache-Status"), "penumbra; hit");
    service.control->open_gate();
    for (auto& answer : answers) EXPECT_EQ(answer.get(), 200);
}

// ---- equal requests at once

struct Crowd {
    Crowd(const Service& service, int count, const std::string& scene) {
        for (int i = 0; i < count; ++i) {
            answers.push_back(std::async(std::launch::async, [&service, scene] { return service.post(scene); }));
        }
    }
    std::vector<std::future<httplib::Result>> answers;
};

void wait_for_shared(const Service& service, int count) {
    for (int i = 0; i < 2000 && figures(service)["shared"] < count; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    ASSERT_EQ(figures(service)["shared"], count);
}

TEST(Sharing, EqualRequestsUnderWayAreRenderedOnce) {
    Config config;
    config.queue_capacity = 1;  // those that share take no place
    const Started service(config);
    service.control->close_gate();
    Crowd first(service, 1, kScene);
    service.control->wait_for_begun(1);
    auto other = std::async(std::launch::async, [&] { return service.post(scene_number(1))->status; });
    while (service.worker->status().waiting < 1) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    Crowd crowd(service, 11, kScene);  // the queue is full
    wait_for_shared(service, 11);
    service.control->open_gate();
    EXPECT_EQ(other.get(), 200);
    crowd.answers.push_back(std::move(first.answers[0]));
    std::multiset<std::string> statuses;
    std::set<std::string> bodies;
    for (auto& answer : crowd.answers) {
        const auto result = answer.get();
        ASSERT_TRUE(result);
        EXPECT_EQ(result->status, 200) << result->body;
        EXPECT_FALSE(result->get_header_value("ETag").empty());
        statuses.insert(result->get_header_value("Cache-Status"));
        bodies.insert(result->body);
    }
    EXPECT_EQ(service.control->begun(), 2) << "one for these, and the other";
    EXPECT_EQ(bodies.size(), 1u);
    EXPECT_EQ(statuses.count("penumbra; fwd=miss; stored"), 1u);
    EXPECT_EQ(statuses.count("penumbra; fwd=miss; stored; collapsed"), 11u);
}

TEST(Sharing, AFailedRenderFailsForAllAndIsTriedAgainByTheNext) {
    const Started service;
    service.control->close_gate();
    Crowd crowd(service, 4, kFailing);
    wait_for_shared(service, 3);
    service.control->open_gate();
    for (auto& answer : crowd.answers) {
        const auto result = answer.get();
        expect_problem(result, 500, "internal");
        EXPECT_EQ(result->body.find("secret"), std::string::npos);
    }
    EXPECT_EQ(service.control->begun(), 1);
    expect_problem(service.post(kFailing), 500, "internal");
    EXPECT_EQ(service.control->begun(), 2);
    EXPECT_EQ(figures(service)["pictures"], 0);
    expect_alive(service);
}

TEST(Sharing, AClientThatLeavesTakesNothingFromTheOthers) {
    const Started service;
    service.control->close_gate();
    {
        RawClient gone(service.port());  // the one whose request began the render
        gone.send("POST /v1/render HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\nContent-Length: " +
                  std::to_string(kScene.size()) + "\r\n\r\n" + kScene);
        service.control->wait_for_begun(1);
    }
    Crowd crowd(service, 2, kScene);
    wait_for_shared(service, 2);
    service.control->open_gate();
    for (auto& answer : crowd.answers) {
        const auto result = answer.get();
        ASSERT_TRUE(result);
        EXPECT_EQ(result->status, 200);
    }
    EXPECT_EQ(service.control->begun(), 1);
}

TEST(Sharing, WorksBeforeTheRendererHasStarted) {
    auto control = std::make_shared<FakeControl>();
    control->close_start();
    const Service service({}, control);
    std::vector<std::future<httplib::Result>> early;
    for (int i = 0; i < 3; ++i) early.push_back(std::async(std::launch::async, [&] { return service.post(kScene); }));
    while (service.service->cache_figures().shared < 2) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    control->open_start();
    for (auto& one : early) {
        const auto result = one.get();
        ASSERT_TRUE(result);
        EXPECT_EQ(result->status, 200);
        EXPECT_FALSE(result->get_header_value("ETag").empty()) << "the device is known by now";
    }
    EXPECT_EQ(service.post(kScene)->get_header_value("Cache-Status"), "penumbra; hit");
    EXPECT_EQ(control->begun(), 1);
}

// ---- the parts

TEST(EntityTags, AreReadByTheGrammar) {
    EXPECT_TRUE(parse_entity_tags("").empty());
    EXPECT_TRUE(parse_entity_tags("*").has("anything"));
    EXPECT_FALSE(parse_entity_tags("\"*\"").has("anything"));
    const EntityTags tags = parse_entity_tags(R"("a",W/"b" , "c,\"d")");
    EXPECT_TRUE(tags.empty()) << "no escapes: the quote ends the tag, and what follows is wrong";
    const EntityTags right = parse_entity_tags(R"("a",W/"b" ,, "c, d","")");
    EXPECT_EQ(right.tags, (std::vector<std::string>{"a", "b", "c, d", ""}));
    for (const char* wrong : {"a", "\"a", "W/a", "\"a\" \"b\"", "\"a\", b", "*, \"a\""}) EXPECT_TRUE(parse_entity_tags(wrong).empty()) << wrong;
}

TEST(AnswerCache, CountsWhatItHolds) {
    AnswerCache cache(10'000);
    const auto answer = [](std::size_t size) {
        auto made = std::make_shared<Answer>();
        made->picture.resize(size);
        return made;
    };
    EXPECT_FALSE(cache.put("large", answer(10'000)));
    EXPECT_TRUE(cache.put("a", answer(4'000)));
    EXPECT_TRUE(cache.put("a", answer(2'000)));
    EXPECT_EQ(cache.figures().entries, 1u);
    EXPECT_LT(cache.figures().bytes, 3'000u);
    EXPECT_TRUE(cache.put("b", answer(4'000)));
    EXPECT_TRUE(cache.put("c", answer(4'000)));
    EXPECT_FALSE(cache.find("a"));
    EXPECT_TRUE(cache.find("b"));
    const SharedAnswer held = cache.find("c");
    EXPECT_TRUE(cache.put("d", answer(9'000)));
    EXPECT_EQ(cache.figures().entries, 1u);
    EXPECT_EQ(held->picture.size(), 4'000u) << "those that have it keep it";
    EXPECT_EQ(cache.figures().evicted, 3u);
}

TEST(TextMemo, ForgetsTheLongestUnused) {
    TextMemo memo(2);
    memo.put("a", "1");
    memo.put("b", "2");
    EXPECT_EQ(memo.find("a"), "1");
    memo.put("c", "3");
    EXPECT_EQ(memo.find("b"), "");
    EXPECT_EQ(memo.find("a"), "1");
    memo.put("a", "4");
    EXPECT_EQ(memo.find("a"), "4");
    EXPECT_EQ(memo.find("c"), "3");
}

}  // namespace
}  // namespace penumbra::test
