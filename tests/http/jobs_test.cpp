// SPDX-License-Identifier: MIT
// Renders that outlive their request.
#include <gmock/gmock.h>

#include <future>
#include <map>
#include <sstream>
#include <thread>

#include "server/http/access.h"
#include "server_fixture.h"

namespace penumbra::test {
namespace {

using testing::HasSubstr;

nlohmann::json begin(const Service& service, const std::string& scene) {
    const auto result = service.client().Post("/v1/jobs", scene, kJson);
    EXPECT_TRUE(result);
    EXPECT_EQ(result->status, 202) << result->body;
    const auto json = nlohmann::json::parse(result->body);
    EXPECT_EQ(result->get_header_value("Location"), json["links"]["self"].get<std::string>());
    return json;
}
nlohmann::json tell(const Service& service, const nlohmann::json& job) {
    const auto result = service.client().Get(job["links"]["self"].get<std::string>());
    EXPECT_EQ(result->status, 200) << result->body;
    return nlohmann::json::parse(result->body, nullptr, false);
}
bool becomes(const Service& service, const nlohmann::json& job, const std::string& state) {
    for (int i = 0; i < 3000; ++i) {
        if (tell(service, job)["state"] == state) return true;
        std::this_thread::sleep_for(std::chrono::milliseconds(5));
    }
    ADD_FAILURE() << tell(service, job).dump();
    return false;
}
std::string lasting(int hundredths, int side = 40) {
    return R"({"version": 1, "canvas": {"width": )" + std::to_string(side) + R"(, "height": )" + std::to_string(side) + R"(}, "sky": {"radiance": [)" +
           std::to_string(100 + hundredths) + ", 0, 0]}}";
}

TEST(Jobs, TheResultIsTheOneOfARender) {
    const Service service;
    const auto job = begin(service, kScene);
    EXPECT_EQ(job["id"].get<std::string>().size(), 32u);
    EXPECT_TRUE(becomes(service, job, "done"));
    const auto result = service.client().Get(job["links"]["result"].get<std::string>());
    ASSERT_EQ(result->status, 200);
    const auto posted = service.post(kScene);
    EXPECT_EQ(result->body, posted->body);
    EXPECT_EQ(result->get_header_value("ETag"), posted->get_header_value("ETag"));
    EXPECT_EQ(service.client().Get(job["links"]["result"].get<std::string>(), {{"If-None-Match", result->get_header_value("ETag")}})->status, 304);
    const auto told = tell(service, job);
    EXPECT_EQ(told["share"], 1);
    EXPECT_GE(told["elapsed_ms"], 0);
}

TEST(Jobs, AreWatchedWithEventsAndAPreview) {
    const Service service;
    service.worker->wait_until_started();
    const auto job = begin(service, lasting(60, 300));
    httplib::Client client = service.client();
    const auto events = client.Get(job["links"]["events"].get<std::string>());
    ASSERT_TRUE(events);
    EXPECT_EQ(events->get_header_value("Content-Type"), "text/event-stream");
    EXPECT_EQ(events->get_header_value("X-Accel-Buffering"), "no");
    std::vector<std::string> names;
    std::map<std::string, nlohmann::json> last;
    std::istringstream lines(events->body);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("event: ")) names.push_back(line.substr(7));
        if (line.starts_with("data: ")) last[names.back()] = nlohmann::json::parse(line.substr(6));
    }
    EXPECT_EQ(names.back(), "done");
    EXPECT_EQ(std::count(names.begin(), names.end(), "preview"), 1);
    EXPECT_GE(std::count(names.begin(), names.end(), "progress"), 2);
    EXPECT_EQ(last["preview"]["size"], nlohmann::json({128, 128}));
    EXPECT_EQ(last["preview"]["base64"].get<std::string>().substr(0, 11), "iVBORw0KGgo");
    EXPECT_GT(last["progress"]["slices"], 10) << "of 120";
    EXPECT_EQ(last["done"]["size"], nlohmann::json({300, 300}));
    EXPECT_EQ(last["done"]["result"], job["links"]["result"]);
}

TEST(Jobs, AreCancelledWithinASlice) {
    const Service service;
    service.worker->wait_until_started();
    const auto job = begin(service, lasting(3000));
    EXPECT_TRUE(becomes(service, job, "rendering"));
    service.control->wait_for_begun(1);
    const std::string self = job["links"]["self"];
    const auto early = service.client().Get(job["links"]["result"].get<std::string>());
    expect_problem(early, 409, "job-not-done");
    EXPECT_EQ(early->get_header_value("Retry-After"), "1");
    auto events = std::async(std::launch::async, [&] { return service.client().Get(job["links"]["events"].get<std::string>())->body; });
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    EXPECT_EQ(service.client().Delete(self)->status, 204);
    EXPECT_THAT(events.get(), testing::EndsWith("event: cancelled\ndata: {}\n\n"));
    for (int i = 0; i < 2000 && service.control->stopped() == 0; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(5));
    EXPECT_EQ(service.control->stopped(), 1);
    expect_problem(service.client().Get(self), 404, "not-found");
    expect_problem(service.client().Delete(self), 404, "not-found");
    expect_alive(service);
}

TEST(Jobs, FailuresAreToldAtOnceOrWithTheResult) {
    const Service service;
    expect_problem(service.client().Post("/v1/jobs", "{", kJson), 400, "not-json");
    expect_problem(service.client().Post("/v1/jobs", "{}", kJson), 422, "invalid-scene");
    expect_problem(service.client().Get("/v1/jobs"), 405, "method-not-allowed");
    expect_problem(service.client().Get("/v1/jobs/0123"), 404, "not-found");
    expect_problem(service.client().Get("/v1/jobs/0123/events"), 404, "not-found");
    expect_problem(service.client().Get("/v1/jobs/0123/else"), 404, "not-found");
    const auto job = begin(service, R"({"version": 1, "canvas": {"width": 40, "height": 30}, "sky": {"radiance": [13, 0, 0]}})");
    EXPECT_TRUE(becomes(service, job, "failed"));
    expect_problem(service.client().Get(job["links"]["result"].get<std::string>()), 500, "internal");
    EXPECT_THAT(service.client().Get(job["links"]["events"].get<std::string>())->body, HasSubstr("event: failed\ndata: {\"type\":\"/problems/internal\""));
}

TEST(Jobs, AreSoManyAndNoMore) {
    Config config;
    config.max_jobs = 2;
    const Service service(config);
    service.worker->wait_until_started();
    service.control->close_gate();
    const auto first = begin(service, scene_number(1));
    begin(service, scene_number(2));
    const auto refused = service.client().Post("/v1/jobs", scene_number(3), kJson);
    expect_problem(refused, 503, "too-many-jobs");
    EXPECT_GE(std::stoi(refused->get_header_value("Retry-After")), 1);
    service.control->open_gate();
    EXPECT_TRUE(becomes(service, first, "done"));
    begin(service, scene_number(3));  // in the place of one that has ended
    Config none;
    none.max_jobs = 0;
    expect_problem(Service(none).client().Post("/v1/jobs", kScene, kJson), 503, "too-many-jobs");
}

TEST(Jobs, WaitForAPlaceInAFullQueue) {
    Config config;
    config.queue_capacity = 1;
    const Service service(config);
    service.worker->wait_until_started();
    service.control->close_gate();
    auto first = std::async(std::launch::async, [&] { return service.post(scene_number(1))->status; });
    service.control->wait_for_begun(1);
    auto second = std::async(std::launch::async, [&] { return service.post(scene_number(2))->status; });
    while (service.worker->status().waiting < 1) std::this_thread::sleep_for(std::chrono::milliseconds(1));
    const auto job = begin(service, scene_number(3));
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    service.control->open_gate();
    EXPECT_TRUE(becomes(service, job, "done"));
    EXPECT_EQ(first.get(), 200);
    EXPECT_EQ(second.get(), 200);
}

TEST(Base64, IsTheStandardOne) {
    EXPECT_EQ(encode_base64(""), "");
    EXPECT_EQ(encode_base64("f"), "Zg==");
    EXPECT_EQ(encode_base64("fo"), "Zm8=");
    EXPECT_EQ(encode_base64("foo"), "Zm9v");
    EXPECT_EQ(encode_base64("\xff\xef\xbe"), "/+++");
}

}  // namespace
}  // namespace penumbra::test
