// SPDX-License-Identifier: MIT
// Prices, who is refused because of them, and what is given instead.
#include <future>
#include <thread>

#include "server/service/client_budgets.h"
#include "server/service/pricing.h"
#include "server_fixture.h"

namespace penumbra::test {
namespace {

// Renders for n hundredths of a second, by the fake renderer.
std::string lasting(int hundredths, int width = 40) {
    return R"({"version": 1, "canvas": {"width": )" + std::to_string(width) + R"(, "height": 30}, "sky": {"radiance": [)" +
           std::to_string(100 + hundredths) + ", 0, 0]}}";
}

const httplib::Headers kAnew{{"Cache-Control", "no-cache"}};

httplib::Headers anew_within(const std::string& prefer) { return {{"Cache-Control", "no-cache"}, {"Prefer", prefer}}; }

nlohmann::json estimate(const Service& service, const std::string& scene, const httplib::Headers& headers = {}) {
    const auto result = service.client().Post("/v1/estimate", headers, scene, kJson);
    EXPECT_TRUE(result);
    EXPECT_EQ(result->status, 200) << result->body;
    return nlohmann::json::parse(result->body);
}

TEST(Estimate, TellsThePriceBeforeAndTheTimeAfter) {
    const Service service;
    service.worker->wait_until_started();
    const nlohmann::json before = estimate(service, lasting(30), {{"Prefer", "wait=5"}});
    EXPECT_GT(before["price_ms"], 0);
    EXPECT_LT(before["likely_ms"][0], before["price_ms"]);
    EXPECT_GT(before["likely_ms"][1], before["price_ms"]);
    EXPECT_EQ(before["measured"], false);
    EXPECT_EQ(before["cached"], false);
    EXPECT_EQ(before["in_time"], true);
    EXPECT_EQ(before["deadline_ms"], 5000);
    EXPECT_EQ(before["size"], nlohmann::json({40, 30}));
    EXPECT_EQ(before["format"], "png");
    EXPECT_EQ(before["work"]["render"], 1);
    EXPECT_EQ(service.control->begun(), 0) << "nothing was rendered";

    EXPECT_EQ(service.post(lasting(30))->status, 200);
    const nlohmann::json after = estimate(service, lasting(30));
    EXPECT_EQ(after["measured"], true);
    EXPECT_EQ(after["cached"], true);
    EXPECT_GE(after["price_ms"], 250);
    EXPECT_LE(after["price_ms"], 3000);
    EXPECT_EQ(estimate(service, lasting(30), {{"Prefer", "wait=0.1"}})["in_time"], true) << "it is there already";
    // What was learnt of one scene is a hint for others of its kind.
    EXPECT_GE(estimate(service, lasting(30, 41))["price_ms"], 100);
}

TEST(Estimate, RefusesWhatARenderWouldRefuse) {
    const Service service;
    const auto post = [&](const std::string& body) { return service.client().Post("/v1/estimate", body, kJson); };
    expect_problem(post("{"), 400, "not-json");
    expect_problem(post("{}"), 422, "invalid-scene");
    expect_problem(service.client().Post("/v1/estimate", kScene, "text/plain"), 415, "unsupported-media-type");
    expect_problem(service.client().Get("/v1/estimate"), 405, "method-not-allowed");
}

TEST(Admission, WhatAloneTakesLongerThanItMayIsRefusedAtOnce) {
    const Service service;
    EXPECT_EQ(service.post(lasting(60))->status, 200);
    const auto start = std::chrono::steady_clock::now();
    const auto refused = service.post(lasting(60), anew_within("wait=0.2"));
    EXPECT_LT(std::chrono::steady_clock::now() - start, std::chrono::milliseconds(190)) << "it is not waited for";
    const nlohmann::json problem = expect_problem(refused, 422, "too-expensive");
    EXPECT_GE(problem["price_ms"], 500);
    EXPECT_FALSE(refused->has_header("Retry-After")) << "it will not be better later";
    EXPECT_EQ(service.control->begun(), 1);
    EXPECT_EQ(service.post(lasting(60), {{"Prefer", "wait=0.2"}})->status, 200) << "it is in the cache";
    EXPECT_EQ(service.post(lasting(60), anew_within("wait=20"))->status, 200);
}

TEST(Admission, WhatComesTooLateBecauseOfOthersIsToldWhenToComeAgain) {
    const Service service;
    for (int i = 0; i < 4; ++i) EXPECT_EQ(service.post(lasting(50, 40 + i))->status, 200);
    std::vector<std::future<int>> others;
    for (int i = 0; i < 3; ++i) {
        others.push_back(std::async(std::launch::async, [&, i] { return service.post(lasting(50, 40 + i), kAnew)->status; }));
    }
    service.control->wait_for_begun(5);
    while (service.worker->status().waiting < 2) std::this_thread::sleep_for(std::chrono::milliseconds(2));
    const auto refused = service.post(lasting(50, 43), anew_within("wait=0.9"));
    expect_problem(refused, 503, "deadline-unreachable");
    EXPECT_GE(std::stoi(refused->get_header_value("Retry-After")), 1);
    EXPECT_LE(std::stoi(refused->get_header_value("Retry-After")), 4);
    for (auto& other : others) EXPECT_EQ(other.get(), 200);
    EXPECT_EQ(service.post(lasting(50, 43), anew_within("wait=5"))->status, 200);
}

TEST(Partial, TheBestThatIsDoneInTimeIsGivenAndMarked) {
    const Service service;
    EXPECT_EQ(service.post(lasting(100))->status, 200);
    const auto result = service.post(lasting(100), anew_within("wait=0.6, on-deadline=partial"));
    ASSERT_EQ(result->status, 200) << result->body;
    EXPECT_EQ(result->get_header_value("Penumbra-Partial"), "quality=draft; method=rc");
    EXPECT_EQ(result->get_header_value("Preference-Applied"), "wait=0.6, on-deadline=partial");
    EXPECT_EQ(result->get_header_value("Cache-Control"), "no-store");
    EXPECT_FALSE(result->has_header("ETag")) << "it is not the picture of this scene";
    // With time enough it is the whole.
    const auto whole = service.post(lasting(100), anew_within("wait=20, on-deadline=partial"));
    EXPECT_EQ(whole->status, 200);
    EXPECT_FALSE(whole->has_header("Penumbra-Partial"));
    EXPECT_TRUE(whole->has_header("ETag"));
    // What is kept is whole, whatever the deadline.
    EXPECT_FALSE(service.post(lasting(100), {{"Prefer", "wait=0.5, on-deadline=partial"}})->has_header("Penumbra-Partial"));
}

TEST(Partial, WithNothingInTimeItIsAFailure) {
    const Service service;
    service.worker->wait_until_started();
    service.control->close_gate();
    expect_problem(service.post(kScene, {{"Prefer", "wait=0.5, on-deadline=partial"}}), 504, "deadline-exceeded");
    expect_problem(service.post("{", {{"Prefer", "on-deadline=partial"}}), 400, "not-json");
}

TEST(Budget, EachClientHasItsShareOfAMinute) {
    Config config;
    config.client_budget_s = 1;
    config.trust_forwarded_for = true;
    const Service service(config);
    const auto ask = [&](const std::string& who, const std::string& scene) {
        return service.post(scene, {{"X-Forwarded-For", "1.2.3.4, " + who}, {"Cache-Control", "no-cache"}});
    };
    const auto first = ask("10.0.0.1", lasting(80));
    EXPECT_EQ(first->status, 200);
    EXPECT_EQ(first->get_header_value("RateLimit-Policy"), "\"compute\";q=1000;w=60");
    EXPECT_EQ(first->get_header_value("RateLimit").substr(0, 12), "\"compute\";r=");
    const auto second = ask("10.0.0.1", lasting(80));
    expect_problem(second, 429, "budget-spent");
    EXPECT_GE(std::stoi(second->get_header_value("Retry-After")), 20);
    EXPECT_LE(std::stoi(second->get_header_value("Retry-After")), 60);
    EXPECT_TRUE(second->has_header("RateLimit"));
    EXPECT_EQ(ask("10.0.0.2", lasting(80))->status, 200) << "another one's is another one's";
    EXPECT_EQ(service.post(lasting(80), {{"X-Forwarded-For", "10.0.0.1"}})->status, 200) << "the cache costs nothing";
    EXPECT_FALSE(Service().post(kScene)->has_header("RateLimit"));
}

TEST(Budget, ComesBackAsTimePassesAndIsSettled) {
    ClientBudgets budgets(60'000);  // a millisecond each
    EXPECT_TRUE(budgets.take("a", 59'990));
    EXPECT_FALSE(budgets.take("a", 1000));
    EXPECT_NEAR(budgets.seconds_until("a", 1000), 0.99, 0.05);
    budgets.settle("a", -30'000);  // it was less
    EXPECT_TRUE(budgets.take("a", 1000));
    EXPECT_TRUE(budgets.take("b", 100'000)) << "all of it, though the render is dearer than that";
    EXPECT_FALSE(budgets.take("b", 1));
    EXPECT_NEAR(budgets.state("b").left_ms, 0, 50);
    EXPECT_FALSE(ClientBudgets(0).limited());
}

TEST(Fairness, AClientWithMuchToDoDoesNotKeepOthersWaiting) {
    auto control = std::make_shared<FakeControl>();
    const Engine engine = fake_engine(control);
    const Log log(LogFormat::text);
    std::vector<std::string> order;
    {
        RenderWorker worker([&] { return engine.make_backend({}); }, 64, log);
        worker.wait_until_started();
        control->close_gate();
        auto scene = std::make_shared<Scene>();
        scene->canvas.width = scene->canvas.height = 2;
        const auto ask = [&](const std::string& who, double expected_ms) {
            RenderOrder one{.scene = scene, .done = [&order, who](const RenderOutcome&) { order.push_back(who); }};
            one.client = who;
            one.expected_ms = expected_ms;
            EXPECT_FALSE(worker.submit(std::move(one)));
        };
        ask("busy", 100);
        control->wait_for_begun(1);
        for (int i = 0; i < 6; ++i) ask("busy", 100);
        for (int i = 0; i < 4; ++i) ask("light", 50);
        ask("guest", 100);
        EXPECT_NEAR(worker.status().backlog_ms, 1000, 100) << "six of 100, four of 50, one of 100, and the rest of the first";
        control->open_gate();
    }
    // What is expected decides: two of 50 for one of 100. (What they took is next to nothing, so that turns advance by what waits.)
    ASSERT_EQ(order.size(), 12u);
    EXPECT_EQ(order[0], "busy");
    const auto place = [&](const std::string& who, int number) {
        for (std::size_t i = 0; i < order.size(); ++i) {
            if (order[i] == who && number-- == 0) return int(i);
        }
        return -1;
    };
    EXPECT_LE(place("guest", 0), 3) << "it came last";
    EXPECT_LT(place("light", 0), place("busy", 2));
    EXPECT_LT(place("light", 3), place("busy", 4)) << "four of 50 before the fifth of 100";
    EXPECT_EQ(order.back(), "busy");
}

TEST(Pricing, LearnsHowFastTheMachineIs) {
    Pricing pricing(2);
    Scene scene;
    scene.canvas.width = scene.canvas.height = 64;
    Shape lamp;
    lamp.geometry = Circle{{32, 32}, 6};
    lamp.emission = Colour(1);
    scene.shapes.push_back(lamp);
    const DeviceInfo device;
    const Pricing::Quote first = pricing.quote("a", scene, device);
    EXPECT_FALSE(first.measured);
    EXPECT_GT(first.high_ms / first.low_ms, 8);
    for (int i = 0; i < 50; ++i) pricing.learn("scene " + std::to_string(i), first, 4 * first.ms);
    const Pricing::Quote later = pricing.quote("a", scene, device);
    EXPECT_NEAR(later.ms / first.ms, 4, 0.2);
    EXPECT_LT(later.high_ms / later.low_ms, 4) << "it is surer now";
    pricing.learn("a", later, 10 * first.ms);
    EXPECT_NEAR(pricing.quote("a", scene, device).ms / first.ms, 10, 0.5) << "this one it knows";
    EXPECT_TRUE(pricing.quote("a", scene, device).measured);
}

}  // namespace
}  // namespace penumbra::test
