// SPDX-License-Identifier: MIT
// What is HTTP and not a picture: probes, metrics, methods, origins, compression, traces, tokens, signed addresses.
#include <gmock/gmock.h>

#include <chrono>
#include <ctime>
#include <fstream>
#include <future>
#include <sstream>
#include <thread>

#include "process.h"
#include "server/http/access.h"
#include "server/http/negotiate.h"
#include "server/service/tokens.h"
#include "server_fixture.h"

namespace penumbra::test {
namespace {

using testing::HasSubstr;

// ---- probes and metrics

TEST(Probes, AreAnsweredOnBothPortsWhateverRenders) {
    Config config;
    config.admin_port = 0;
    config.queue_capacity = 1;
    const Service service(config);
    service.worker->wait_until_started();
    service.control->close_gate();
    auto first = std::async(std::launch::async, [&] { return service.post(kScene)->status; });
    service.control->wait_for_begun(1);
    auto second = std::async(std::launch::async, [&] { return service.post(scene_number(1))->status; });
    for (const int port : {service.port(), service.server->admin_port()}) {
        ASSERT_GT(port, 0);
        httplib::Client client("127.0.0.1", port);
        for (const char* path : {"/livez", "/healthz", "/readyz", "/startupz"}) {
            const auto result = client.Get(path);
            ASSERT_TRUE(result) << path;
            EXPECT_EQ(result->status, 200) << path << result->body;
        }
    }
    service.control->open_gate();
    EXPECT_EQ(first.get(), 200);
    EXPECT_EQ(second.get(), 200);
}

TEST(Probes, StartupIsToldOnceAndReadinessFollowsTheRenderer) {
    auto control = std::make_shared<FakeControl>();
    control->close_start();
    const Service service({}, control);
    expect_problem(service.client().Get("/startupz"), 503, "not-ready");
    control->open_start();
    service.worker->wait_until_started();
    EXPECT_EQ(service.client().Get("/startupz")->status, 200);
    control->set_self_test("wrong");
    service.post(R"({"version": 1, "canvas": {"width": 4, "height": 4}, "sky": {"radiance": [13, 0, 0]}})");
    EXPECT_EQ(service.client().Get("/readyz")->status, 503);
    EXPECT_EQ(service.client().Get("/startupz")->status, 200);
    EXPECT_EQ(service.client().Get("/livez")->status, 200);
}

TEST(Metrics, CountWhatHappenedAndAreForOperatorsAlone) {
    Config config;
    config.admin_port = 0;
    const Service service(config);
    service.worker->wait_until_started();
    expect_problem(service.client().Get("/metrics"), 404, "not-found");
    EXPECT_EQ(service.post(kScene)->status, 200);
    EXPECT_EQ(service.post(kScene)->status, 200);
    EXPECT_EQ(service.post("{")->status, 400);
    httplib::Client admin("127.0.0.1", service.server->admin_port());
    auto result = admin.Get("/metrics");
    // An answer is counted when it has been sent: its client may be quicker.
    for (int tries = 0; tries < 100 && result && result->body.find("status=\"400\"} 1") == std::string::npos; ++tries) {
        std::this_thread::sleep_for(std::chrono::milliseconds(10));
        result = admin.Get("/metrics");
    }
    ASSERT_TRUE(result);
    EXPECT_THAT(result->get_header_value("Content-Type"), HasSubstr("version=0.0.4"));
    for (const char* line : {"penumbra_http_requests_total{endpoint=\"/v1/render\",status=\"200\"} 2\n",
                             "penumbra_http_requests_total{endpoint=\"/v1/render\",status=\"400\"} 1\n",
                             "penumbra_cache_requests_total{source=\"cache\"} 1\n", "penumbra_cache_requests_total{source=\"render\"} 1\n",
                             "outcome=\"done\"} 1\n", "penumbra_queue_wait_seconds_count 1\n", "penumbra_workers_ready 1\n",
                             "penumbra_queue_capacity 16\n", "pass=\"cascade 0\"} 0.001\n", "# TYPE penumbra_render_seconds histogram\n",
                             "le=\"+Inf\"} 1\n"}) {
        EXPECT_THAT(result->body, HasSubstr(line));
    }
    expect_problem(admin.Post("/v1/render", kScene, kJson), 404, "not-found");
    // Every line is of the format: a comment, or a name, labels and a number.
    std::istringstream lines(result->body);
    for (std::string line; std::getline(lines, line);) {
        if (line.starts_with("#")) continue;
        const std::size_t space = line.rfind(' ');
        ASSERT_NE(space, std::string::npos) << line;
        EXPECT_NO_THROW((void)std::stod(line.substr(space + 1))) << line;
    }
}

// ---- methods, origins

TEST(Options, TellWhatAPathTakes) {
    const Service service;
    for (const auto& [path, allow] : std::vector<std::pair<std::string, std::string>>{
             {"/v1/estimate", "POST, OPTIONS"}, {"/v1/info", "GET, HEAD, OPTIONS"}, {"/problems/not-json", "GET, HEAD, OPTIONS"}}) {
        const auto result = service.client().Options(path);
        ASSERT_TRUE(result) << path;
        EXPECT_EQ(result->status, 204);
        EXPECT_EQ(result->get_header_value("Allow"), allow);
        EXPECT_EQ(result->body, "");
        EXPECT_FALSE(result->has_header("Access-Control-Allow-Origin"));
    }
    expect_problem(service.client().Options("/nothing"), 404, "not-found");
    const auto wrong = service.client().Put("/v1/info", "x", "text/plain");
    expect_problem(wrong, 405, "method-not-allowed");
    EXPECT_EQ(wrong->get_header_value("Allow"), "GET, HEAD, OPTIONS");
    EXPECT_EQ(service.client().Get("/v1/render")->get_header_value("Allow"), "POST, OPTIONS");
}

TEST(Cors, OnlyThoseWhoAreNamedMayRead) {
    Config config;
    config.cors_origins = {"https://a.example", "https://b.example"};
    const Service service(config);
    service.worker->wait_until_started();
    const auto allowed = service.post(kScene, {{"Origin", "https://b.example"}});
    EXPECT_EQ(allowed->get_header_value("Access-Control-Allow-Origin"), "https://b.example");
    EXPECT_THAT(allowed->get_header_value("Access-Control-Expose-Headers"), HasSubstr("ETag"));
    const auto values = allowed->headers.equal_range("Vary");
    EXPECT_EQ(std::distance(values.first, values.second), 2) << "by format and by origin";
    EXPECT_FALSE(service.post(kScene, {{"Origin", "https://c.example"}})->has_header("Access-Control-Allow-Origin"));
    const auto problem = service.post("{", {{"Origin", "https://a.example"}});
    EXPECT_EQ(problem->get_header_value("Access-Control-Allow-Origin"), "https://a.example") << "scripts read problems, too";
    const auto preflight = service.client().Options(
        "/v1/render", {{"Origin", "https://a.example"}, {"Access-Control-Request-Method", "POST"}, {"Access-Control-Request-Headers", "content-type"}});
    EXPECT_EQ(preflight->status, 204);
    EXPECT_THAT(preflight->get_header_value("Access-Control-Allow-Methods"), HasSubstr("POST"));
    EXPECT_THAT(preflight->get_header_value("Access-Control-Allow-Headers"), HasSubstr("Content-Type"));
    const auto stranger = service.client().Options("/v1/render", {{"Origin", "https://c.example"}, {"Access-Control-Request-Method", "POST"}});
    EXPECT_FALSE(stranger->has_header("Access-Control-Allow-Methods"));
    Config open;
    open.cors_origins = {"*"};
    EXPECT_EQ(Service(open).client().Get("/", {{"Origin", "https://c.example"}})->get_header_value("Access-Control-Allow-Origin"), "*");
}

// ---- compression, traces

TEST(Gzip, LongJsonIsPackedForThoseWhoTakeIt) {
    const Service service;
    httplib::Client client = service.client();
    client.set_decompress(false);
    const auto packed = client.Get("/openapi.json", {{"Accept-Encoding", "br, gzip"}});
    ASSERT_TRUE(packed);
    EXPECT_EQ(packed->get_header_value("Content-Encoding"), "gzip");
    EXPECT_EQ(packed->get_header_value("Vary"), "Accept-Encoding");
    EXPECT_EQ(packed->body.substr(0, 2), "\x1f\x8b");
    const auto plain = client.Get("/openapi.json", {{"Accept-Encoding", "gzip;q=0, identity"}});
    EXPECT_FALSE(plain->has_header("Content-Encoding"));
    EXPECT_EQ(plain->get_header_value("Vary"), "Accept-Encoding") << "whatever this one takes";
    EXPECT_LT(packed->body.size(), plain->body.size() / 3);
    client.set_decompress(true);
    EXPECT_EQ(client.Get("/openapi.json", {{"Accept-Encoding", "gzip"}})->body, plain->body);
    EXPECT_FALSE(client.Get("/livez", {{"Accept-Encoding", "gzip"}})->has_header("Content-Encoding")) << "it is short";
    const auto picture = client.Post("/v1/render", {{"Accept-Encoding", "gzip"}}, kScene, kJson);
    EXPECT_FALSE(picture->has_header("Content-Encoding")) << "pictures are packed already";
}

TEST(Gzip, AcceptEncodingIsReadByItsWeights) {
    EXPECT_TRUE(accepts_gzip("gzip"));
    EXPECT_TRUE(accepts_gzip("br;q=1.0, GZIP;q=0.5"));
    EXPECT_TRUE(accepts_gzip("*"));
    EXPECT_FALSE(accepts_gzip(""));
    EXPECT_FALSE(accepts_gzip("identity"));
    EXPECT_FALSE(accepts_gzip("gzip;q=0"));
    EXPECT_FALSE(accepts_gzip("gzip;q=0, *"));
}

TEST(Trace, ASoundParentIsEchoed) {
    const Service service;
    const std::string sound = "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01";
    EXPECT_EQ(service.client().Get("/livez", {{"traceparent", sound}})->get_header_value("traceparent"), sound);
    EXPECT_EQ(service.post("{", {{"traceparent", sound}})->get_header_value("traceparent"), sound);
    for (const char* wrong : {"", "00-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7", "01-4bf92f3577b34da6a3ce929d0e0e4736-00f067aa0ba902b7-01",
                              "00-4BF92F3577B34DA6A3CE929D0E0E4736-00f067aa0ba902b7-01", "00-00000000000000000000000000000000-00f067aa0ba902b7-01",
                              "00-4bf92f3577b34da6a3ce929d0e0e4736-0000000000000000-01", "00-4bf92f3577b34da6a3ce929d0e0e473g-00f067aa0ba902b7-01"}) {
        EXPECT_EQ(trace_id_of(wrong), "") << wrong;
        EXPECT_FALSE(service.client().Get("/livez", {{"traceparent", wrong}})->has_header("traceparent")) << wrong;
    }
    EXPECT_EQ(trace_id_of(sound), "4bf92f3577b34da6a3ce929d0e0e4736");
}

// ---- who may ask

TEST(Access, TokensAreNeededForWork) {
    Config config;
    config.tokens = Tokens::parse("# who\nalice aaaaaaaaaaaaaaaaaaaaaaaa\n\nbbbbbbbbbbbbbbbbbbbbbbbb  # no name\n");
    const Service service(config);
    service.worker->wait_until_started();
    const auto none = service.post(kScene);
    expect_problem(none, 401, "unauthorized");
    EXPECT_THAT(none->get_header_value("WWW-Authenticate"), HasSubstr("Bearer"));
    for (const char* wrong : {"Bearer", "Bearer ", "Bearer aaaaaaaaaaaaaaaaaaaaaaab", "Bearer aaaaaaaaaaaaaaaaaaaaaaaaa", "Basic aaaaaaaaaaaaaaaaaaaaaaaa",
                              "aaaaaaaaaaaaaaaaaaaaaaaa", "Bearer alice"}) {
        expect_problem(service.post(kScene, {{"Authorization", wrong}}), 401, "unauthorized");
    }
    EXPECT_EQ(service.post(kScene, {{"Authorization", "Bearer aaaaaaaaaaaaaaaaaaaaaaaa"}})->status, 200);
    EXPECT_EQ(service.post(kScene, {{"Authorization", "bearer   bbbbbbbbbbbbbbbbbbbbbbbb"}})->status, 200);
    expect_problem(service.client().Get("/v1/info"), 401, "unauthorized");
    for (const char* open : {"/", "/livez", "/readyz", "/startupz", "/openapi.json", "/v1/schema", "/problems/unauthorized"}) {
        EXPECT_EQ(service.client().Get(open)->status, 200) << open;
    }
}

TEST(Access, AFileOfTokensIsReadStrictly) {
    EXPECT_EQ(Tokens::parse("aaaaaaaaaaaaaaaa").name_of("Bearer aaaaaaaaaaaaaaaa"), "token-1");
    EXPECT_EQ(Tokens::parse("a-b \t aaaaaaaaaaaaaaaa\r\n").name_of("Bearer aaaaaaaaaaaaaaaa"), "a-b");
    EXPECT_THROW(Tokens::parse(""), std::runtime_error);
    EXPECT_THROW(Tokens::parse("# only this\n"), std::runtime_error);
    EXPECT_THROW(Tokens::parse("short"), std::runtime_error);
    EXPECT_THROW(Tokens::parse("name aaaaaaaaaaaaaaaa extra"), std::runtime_error);
    EXPECT_FALSE(Tokens().required());
}

std::string target_of(const std::string& url) { return url.substr(url.find("/v1/")); }

TEST(Access, SignedAddressesShowPictures) {
    Config config;
    config.url_key = "0123456789abcdef0123456789abcdef";
    config.tokens = Tokens::parse("aaaaaaaaaaaaaaaaaaaaaaaa");
    const Service service(config);
    service.worker->wait_until_started();
    const std::int64_t soon = std::time(nullptr) + 1000;
    const std::string target = signed_target(config.url_key, kScene, soon);
    const auto picture = service.client().Get(target, {{"Accept", "image/avif,image/webp,*/*;q=0.8"}});
    ASSERT_TRUE(picture);
    ASSERT_EQ(picture->status, 200) << picture->body << "without a token";
    EXPECT_EQ(picture->get_header_value("Content-Type"), "image/png");
    const auto posted = service.post(kScene, {{"Authorization", "Bearer aaaaaaaaaaaaaaaaaaaaaaaa"}});
    EXPECT_EQ(picture->body, posted->body);
    EXPECT_EQ(picture->get_header_value("ETag"), posted->get_header_value("ETag"));
    EXPECT_EQ(service.client().Get(target, {{"If-None-Match", picture->get_header_value("ETag")}})->status, 304);
    EXPECT_EQ(service.client().Head(target)->status, 200);
    EXPECT_EQ(service.client().Get(signed_target(config.url_key, kScene, 0))->status, 200) << "for ever";

    std::string changed = target;
    changed.replace(changed.find("expires="), 9, "expires=9");
    std::string other = signed_target("another key, which is long enough", kScene, soon);
    for (const std::string& wrong : {changed, other, target + "x", target + "&scene=x", target + "&more=x", target.substr(0, target.find("&signature")),
                                     std::string("/v1/render"), signed_target(config.url_key, kScene, 1000)}) {
        expect_problem(service.client().Get(wrong), 403, "bad-signature");
    }
    expect_problem(service.client().Get(signed_target(config.url_key, "{", soon)), 400, "not-json");
    // A scene of zeros, a thousand times as long as its address.
    Config small = config;
    small.max_body_bytes = 10'000;
    expect_problem(Service(small).client().Get(signed_target(config.url_key, std::string(100'000, ' '), soon)), 403, "bad-signature");
    expect_problem(Service().client().Get(target), 405, "method-not-allowed");
}

TEST(Access, TheCommandSignsWhatTheServiceTakes) {
    const TemporaryFolder folder;
    std::ofstream(folder.path("key")) << "0123456789abcdef0123456789abcdef\n";
    const Finished finished = run_program(PENUMBRA_FAKE_PROGRAM, {"sign-url", "-", "--url-key-file", folder.path("key"), "--expires", "60"}, kScene);
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
    Config config;
    config.url_key = "0123456789abcdef0123456789abcdef";
    const Service service(config);
    std::string target = target_of(finished.out);
    target.pop_back();
    EXPECT_EQ(service.client().Get(target)->status, 200);
    EXPECT_EQ(run_program(PENUMBRA_FAKE_PROGRAM, {"sign-url", "-"}, kScene).exit_code, 2);
    std::ofstream(folder.path("key")) << "short\n";
    EXPECT_EQ(run_program(PENUMBRA_FAKE_PROGRAM, {"sign-url", "-", "--url-key-file", folder.path("key")}, kScene).exit_code, 2);
}

TEST(Access, Base64UrlGoesThereAndBack) {
    std::string bytes;
    for (int i = 0; i < 300; ++i) {
        EXPECT_EQ(decode_base64url(encode_base64url(bytes)), bytes);
        EXPECT_EQ(encode_base64url(bytes).find_first_of("+/="), std::string::npos);
        bytes += char(i * 37);
    }
    for (const char* wrong : {"a", "a+bc", "ab==", "ab c", "\xff\xff"}) EXPECT_FALSE(decode_base64url(wrong)) << wrong;
}

// ---- what the service tells of itself

TEST(Documents, TheSchemaAndTheDescriptionAreTheOnesInDocs) {
    const Service service;
    const auto schema = service.client().Get("/v1/schema");
    EXPECT_EQ(schema->get_header_value("Content-Type"), "application/schema+json");
    EXPECT_EQ(schema->body, read_file(PENUMBRA_SOURCE_DIR "/docs/scene.schema.json"));
    const auto openapi = service.client().Get("/openapi.json");
    EXPECT_EQ(openapi->get_header_value("Content-Type"), "application/json");
    EXPECT_EQ(openapi->body, read_file(PENUMBRA_SOURCE_DIR "/docs/openapi.json"));
}

}  // namespace
}  // namespace penumbra::test
