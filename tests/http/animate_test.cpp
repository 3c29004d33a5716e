// SPDX-License-Identifier: MIT
// Many pictures of one scene, in one answer.
#include <gmock/gmock.h>

#include <cstring>
#include <future>
#include <thread>

#include "core/image/codec.h"
#include "core/image/gzip.h"
#include "server/service/animation.h"
#include "server_fixture.h"

namespace penumbra::test {
namespace {

using testing::HasSubstr;

std::string with(const std::string& animate, const std::string& more = "") {
    return R"({"version": 1, "canvas": {"width": 40, "height": 30}, )" + more + R"("animate": )" + animate + R"(, "sky": {"radiance": 0.5}})";
}
const std::string kMoving = with(R"({"frames": 5, "fps": 10, "tracks": [{"pointer": "/canvas/margin", "keys": [[0, 0], [1, 8]]}]})");
const std::string kSweep =
    with(R"({"vary": [{"pointer": "/canvas/width", "values": [10, 20]}, {"pointer": "/render", "values": [{"quality": "draft"}, {"quality": "high"}, {}]}]})");

std::vector<std::string> values_of(const std::string& text) {
    const ParsedAnimation parsed = parse_animation(text, {}, {});
    for (const LocatedProblem& problem : parsed.problems) ADD_FAILURE() << to_string(problem);
    return parsed.animation ? parsed.animation->values : std::vector<std::string>();
}
std::string first_problem(const std::string& text) {
    const ParsedAnimation parsed = parse_animation(text, {}, {});
    return parsed.problems.empty() ? "none" : to_string(parsed.problems.front());
}

TEST(Animation, TracksGoFromKeyToKey) {
    EXPECT_THAT(values_of(kMoving), testing::ElementsAre(R"({"/canvas/margin": 0})", R"({"/canvas/margin": 2})", R"({"/canvas/margin": 4})",
                                                         R"({"/canvas/margin": 6})", R"({"/canvas/margin": 8})"));
    const auto eased = [](const std::string& ease) {
        return values_of(with(R"({"frames": 5, "tracks": [{"pointer": "/a", "ease": ")" + ease + R"(", "keys": [[0, [0, 4]], [0.5, [8, 4]], [1, [8, 0]]]}]})"));
    };
    EXPECT_THAT(eased("linear"), testing::ElementsAre(R"({"/a": [0, 4]})", R"({"/a": [4, 4]})", R"({"/a": [8, 4]})", R"({"/a": [8, 2]})", R"({"/a": [8, 0]})"));
    EXPECT_THAT(eased("step"), testing::ElementsAre(R"({"/a": [0, 4]})", R"({"/a": [0, 4]})", R"({"/a": [8, 4]})", R"({"/a": [8, 4]})", R"({"/a": [8, 0]})"));
    EXPECT_THAT(eased("smooth")[1], R"({"/a": [4, 4]})") << "half way";
    EXPECT_THAT(values_of(with(R"({"frames": 2, "tracks": [{"pointer": "/a", "keys": [[0.5, 7]]}]})")), testing::ElementsAre(R"({"/a": 7})", R"({"/a": 7})"));
    EXPECT_EQ(values_of(with(R"({"frames": 1, "tracks": [{"pointer": "/a", "keys": [[0, 1], [1, 2]]}]})")).size(), 1u);
}

TEST(Animation, ASweepHasAFrameForEachCombination) {
    const auto values = values_of(kSweep);
    ASSERT_EQ(values.size(), 6u);
    EXPECT_EQ(values[0], R"({"/canvas/width": 10, "/render": {"quality": "draft"}})");
    EXPECT_EQ(values[2], R"({"/canvas/width": 10, "/render": {}})");
    EXPECT_EQ(values[5], R"({"/canvas/width": 20, "/render": {}})");
    EXPECT_THAT(values_of(with(R"({"vary": [{"pointer": "/x", "values": ["a\"]}", -1.5e3 , true,null, [[1],{"b":"}"}]]}]})")),
                testing::ElementsAre(R"({"/x": "a\"]}"})", R"({"/x": -1.5e3})", R"({"/x": true})", R"({"/x": null})", R"({"/x": [[1],{"b":"}"}]})"));
}

TEST(Animation, TheRestOfTheSceneStaysAtItsPlace) {
    for (const char* text : {"{\"a\": 1,\n \"animate\": {\"frames\": 1, \"tracks\": [{\"pointer\": \"/a\", \"keys\": [[0, 1]]}]},\n \"b\": 2}",
                             "{\"a\": 1,\n \"animate\": {\"frames\": 1,\n \"tracks\": [{\"pointer\": \"/a\", \"keys\": [[0, 1]]}]} }",
                             "{\"animate\": {\"frames\": 1, \"tracks\": [{\"pointer\": \"/a\", \"keys\": [[0, 1]]}]}}",
                             "{\n\"animate\": {\"frames\": 1, \"tracks\": [{\"pointer\": \"/a\", \"keys\": [[0, 1]]}]}  ,  \"z\": [1]}"}) {
        const ParsedAnimation parsed = parse_animation(text, {}, {});
        ASSERT_TRUE(parsed.animation) << text;
        const auto json = nlohmann::json::parse(parsed.animation->scene, nullptr, false);
        EXPECT_TRUE(json.is_object()) << parsed.animation->scene;
        auto expected = nlohmann::json::parse(text);
        expected.erase("animate");
        EXPECT_EQ(json, expected);
        EXPECT_EQ(parsed.animation->scene.size(), std::string(text).size());
        EXPECT_EQ(std::count(parsed.animation->scene.begin(), parsed.animation->scene.end(), '\n'), std::count(text, text + std::strlen(text), '\n'));
    }
}

TEST(Animation, WhatIsWrongIsToldWithItsPlace) {
    for (const auto& [animate, problem] : std::vector<std::pair<std::string, std::string>>{
             {"5", "/animate (line 1"},
             {"{}", "either \"tracks\""},
             {R"({"fames": 5})", "did you mean \"frames\""},
             {R"({"frames": 0})", "/animate/frames"},
             {R"({"frames": 601})", "from 1 to 600, is 601"},
             {R"({"frames": 2.5})", "whole number"},
             {R"({"fps": 0})", "/animate/fps"},
             {R"({"tracks": [{"pointer": "/a", "keys": [[0, 1]]}]})", "/animate/frames"},
             {R"({"frames": 2, "tracks": []})", "something in it"},
             {R"({"frames": 2, "tracks": [{"pointer": "a", "keys": [[0, 1]]}]})", "/animate/tracks/0/pointer"},
             {R"({"frames": 2, "tracks": [{"keys": [[0, 1]]}]})", "/animate/tracks/0/pointer"},
             {R"({"frames": 2, "tracks": [{"pointer": "/a"}]})", "/animate/tracks/0/keys"},
             {R"({"frames": 2, "tracks": [{"pointer": "/a", "keys": [[0, 1], [0.5, 1], [0.4, 1]]}]})", "/animate/tracks/0/keys/2/0"},
             {R"({"frames": 2, "tracks": [{"pointer": "/a", "keys": [[0, 1], [1.5, 1]]}]})", "to 1, is 1.5"},
             {R"({"frames": 2, "tracks": [{"pointer": "/a", "keys": [[0, 1], [1, [1]]]}]})", "/animate/tracks/0/keys/1/1"},
             {R"({"frames": 2, "tracks": [{"pointer": "/a", "keys": [[0, "x"]]}]})", "vary"},
             {R"({"frames": 2, "tracks": [{"pointer": "/a", "keys": [0]}]})", "[time, value]"},
             {R"({"frames": 2, "tracks": [{"pointer": "/a", "keys": [[0, 1]], "ease": "bouncy"}]})", "/animate/tracks/0/ease"},
             {R"({"frames": 2, "tracks": [{"pointer": "/a", "keys": [[0, 1]], "key": 1}]})", "/animate/tracks/0/key"},
             {R"({"frames": 2, "vary": [{"pointer": "/a", "values": [1]}]})", "/animate/frames"},
             {R"({"vary": [{"pointer": "/a", "values": []}]})", "/animate/vary/0/values"},
             {R"({"vary": [{"pointer": "/a"}]})", "/animate/vary/0/values"},
         }) {
        EXPECT_THAT(first_problem(with(animate)), HasSubstr(problem)) << animate;
    }
    EXPECT_THAT(first_problem(kScene), HasSubstr("/animate"));
    EXPECT_THAT(first_problem("{"), testing::Not(HasSubstr("none")));
    std::string many = "[";
    for (int i = 0; i < 30; ++i) many += (i ? "," : "") + std::to_string(i);
    EXPECT_THAT(first_problem(with(R"({"vary": [{"pointer": "/a", "values": )" + many + R"(]}, {"pointer": "/b", "values": )" + many + "]}]}")), HasSubstr("900 frames"));
}

httplib::Result animate(const Service& service, const std::string& body, const std::string& accept) {
    return service.client().Post("/v1/animate", {{"Accept", accept}}, body, kJson);
}

std::uint32_t big(const std::string& text, std::size_t at) {
    std::uint32_t value = 0;
    for (std::size_t i = 0; i < 4; ++i) value = value << 8 | std::uint8_t(text[at + i]);
    return value;
}

TEST(Animate, AnApngHasEveryFrameInOrder) {
    const Service service;
    const auto result = animate(service, kMoving, "image/apng");
    ASSERT_TRUE(result);
    ASSERT_EQ(result->status, 200) << result->body;
    EXPECT_EQ(result->get_header_value("Content-Type"), "image/apng");
    EXPECT_EQ(result->get_header_value("Penumbra-Frames"), "5");
    const std::string& png = result->body;
    ASSERT_EQ(png.substr(0, 8), "\x89PNG\r\n\x1a\n");
    std::string kinds;
    std::uint32_t sequence = 0;
    for (std::size_t at = 8; at < png.size();) {
        const std::uint32_t size = big(png, at);
        ASSERT_LE(at + 12 + size, png.size());
        const std::string type = png.substr(at + 4, 4);
        EXPECT_EQ(big(png, at + 8 + size), crc32(std::string_view(png).substr(at + 4, size + 4))) << type;
        if (type == "acTL") {
            EXPECT_EQ(big(png, at + 8), 5u);
        }
        if (type == "fcTL") {
            EXPECT_EQ(big(png, at + 8), sequence++);
            EXPECT_EQ(std::uint8_t(png[at + 8 + 21]), 100) << "a tenth of a second";
        }
        if (type == "fdAT") {
            EXPECT_EQ(big(png, at + 8), sequence++);
        }
        kinds += type + " ";
        at += 12 + size;
    }
    EXPECT_EQ(kinds, "IHDR sRGB acTL fcTL IDAT fcTL fdAT fcTL fdAT fcTL fdAT fcTL fdAT IEND ");
    // Readers that know no animations see the first frame.
    const auto still = service.post(kScene);
    const auto decode = [](const std::string& bytes) { return decode_png({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()}); };
    const auto apng = decode(png), one = decode(still->body);
    ASSERT_TRUE(std::holds_alternative<Texels>(apng));
    EXPECT_EQ(std::get<Texels>(apng).rgba, std::get<Texels>(one).rgba);
}

TEST(Animate, AZipHasAFileForEachFrame) {
    const Service service;
    const auto result = animate(service, kSweep, "application/zip");
    ASSERT_EQ(result->status, 200) << result->body;
    const std::string& zip = result->body;
    EXPECT_EQ(zip.substr(0, 4), "PK\x03\x04");
    const std::size_t end = zip.rfind("PK\x05\x06");
    ASSERT_NE(end, std::string::npos);
    EXPECT_EQ(std::uint8_t(zip[end + 10]), 7) << "six frames, and what they are";
    for (const char* name : {"frame-0001.png", "frame-0006.png", "values.json"}) EXPECT_THAT(zip, HasSubstr(name));
    EXPECT_THAT(zip, HasSubstr(R"({"/canvas/width": 20, "/render": {}})"));
}

TEST(Animate, PartsComeAsTheyAreDone) {
    const Service service;
    service.worker->wait_until_started();
    // Of two frames the second waits.
    const std::string two = with(R"({"vary": [{"pointer": "/sky/radiance", "values": [0.5, [3100, 0, 0]]}]})");
    std::string got;
    std::atomic<bool> first{false};
    const httplib::ContentReceiver receive = [&](const char* data, std::size_t size) {
        got.append(data, size);
        first = got.find("frame-0001.png") != std::string::npos;
        return !first;  // enough: the client leaves
    };
    httplib::Request request;
    request.method = "POST";
    request.path = "/v1/animate";
    request.headers = {{"Accept", "multipart/mixed"}, {"Content-Type", kJson}};
    request.body = two;
    request.content_receiver = [&](const char* data, std::size_t size, std::uint64_t, std::uint64_t) { return receive(data, size); };
    const auto start = std::chrono::steady_clock::now();
    {
        httplib::Client client = service.client();
        client.send(request);
    }
    EXPECT_TRUE(first);
    EXPECT_THAT(got, HasSubstr("Penumbra-Values: {\"/sky/radiance\": 0.5}"));
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::seconds(20)) << "the second takes thirty";
    for (int i = 0; i < 2000 && service.control->stopped() == 0; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_EQ(service.control->stopped(), 1) << "who leaves ends what is rendered for him";
    expect_alive(service);
}

TEST(Animate, WhatIsWrongIsToldBeforeAnythingIsSent) {
    const Service service;
    expect_problem(animate(service, "{", "image/apng"), 400, "not-json");
    expect_problem(animate(service, kScene, "image/apng"), 422, "invalid-scene");
    const auto bad = animate(service, with(R"({"frames": 3, "tracks": [{"pointer": "/canvas/margin", "keys": [[0, 1], [1, -1]]}]})"), "image/apng");
    const auto problem = expect_problem(bad, 422, "invalid-scene");
    EXPECT_THAT(problem["errors"][0]["message"].get<std::string>(), HasSubstr("(frame 3)"));
    expect_problem(animate(service, kSweep, "image/apng"), 422, "invalid-scene");  // of two sizes
    expect_problem(animate(service, kMoving, "image/png"), 406, "not-acceptable");
    expect_problem(animate(service, with(R"({"vary": [{"pointer": "/sky/radiance", "values": [[13, 0, 0]]}]})"), "*/*"), 500, "internal");
    EXPECT_EQ(service.post(kMoving)->status, 422) << "a single picture has no such key";
    // Later it is a part of its own.
    const auto late = animate(service, with(R"({"vary": [{"pointer": "/sky/radiance", "values": [0.25, [13, 0, 0], 0.5]}]})"), "multipart/mixed");
    EXPECT_EQ(late->status, 200);
    EXPECT_THAT(late->body, HasSubstr("application/problem+json"));
    EXPECT_THAT(late->body, testing::EndsWith("--penumbra-frame--\r\n"));
}

TEST(Animate, TheEndOfTheServiceWaitsForTheLastFrame) {
    const Service service;
    service.worker->wait_until_started();
    auto answer = std::async(std::launch::async, [&] {
        return animate(service, with(R"({"vary": [{"pointer": "/sky/radiance", "values": [[110, 0, 0], [111, 0, 0], [112, 0, 0], [113, 0, 0]]}]})"), "application/zip");
    });
    service.control->wait_for_begun(2);
    service.server->stop();
    const auto result = answer.get();
    ASSERT_TRUE(result);
    EXPECT_EQ(result->status, 200);
    EXPECT_THAT(result->body, HasSubstr("frame-0004.png"));
    EXPECT_THAT(result->body, HasSubstr("PK\x05\x06"));
}

}  // namespace
}  // namespace penumbra::test
