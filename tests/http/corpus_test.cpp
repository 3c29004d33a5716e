// SPDX-License-Identifier: MIT
// tests/corpus over HTTP: every bad scene and every malformed request is the client's fault, named as such, and soon.
#include <gmock/gmock.h>

#include <algorithm>
#include <chrono>
#include <cstdio>
#include <filesystem>
#include <map>

#include "process.h"
#include "server/http/header_grammar.h"
#include "server_fixture.h"

namespace penumbra::test {
namespace {

using Clock = std::chrono::steady_clock;
const std::filesystem::path kCorpus = std::filesystem::path(PENUMBRA_SOURCE_DIR) / "tests/corpus";

// Told, not judged: a machine may be busy. docs/reliability.md has the figures of an idle one.
class Times {
public:
    ~Times() {
        std::printf("%zu answers, the slowest %s: %.1f ms\n", count_, slowest_.c_str(), slowest_ms_);
        testing::Test::RecordProperty("slowest_ms", int(slowest_ms_ + 0.5));
    }
    void add(const std::string& name, Clock::time_point start) {
        const double ms = std::chrono::duration<double, std::milli>(Clock::now() - start).count();
        ++count_;
        if (ms <= slowest_ms_) return;
        slowest_ms_ = ms;
        slowest_ = name;
    }

private:
    std::size_t count_ = 0;
    double slowest_ms_ = 0;
    std::string slowest_;
};

TEST(CorpusOverHttp, EveryBadSceneIsRefusedWithItsPlace) {
    const Service service;
    auto client = service.client();
    const auto expected = nlohmann::json::parse(read_file(kCorpus / "bad/expected.json"));
    EXPECT_GE(expected.size(), 200u);
    Times times;
    for (const auto& [name, problem] : expected.items()) {
        const std::string text = read_file(kCorpus / "bad" / name);
        const Clock::time_point start = Clock::now();
        const auto result = client.Post("/v1/render", text, kJson);
        times.add(name, start);
        ASSERT_TRUE(result) << name;
        const bool json = problem["code"] != "syntax" && problem["code"] != "too_deep";
        const auto told = expect_problem(result->body, json ? 422 : 400, json ? "invalid-scene" : "not-json");
        EXPECT_EQ(result->status, json ? 422 : 400) << name;
        ASSERT_FALSE(told.value("errors", nlohmann::json::array()).empty()) << name << result->body;
        bool found = false;
        for (const auto& error : told["errors"]) {
            found = found || (error["pointer"] == problem["pointer"] && error["code"] == problem["code"]);
            EXPECT_GE(error.value("line", 0), 1) << name << error;
            EXPECT_GE(error.value("column", 0), 1) << name << error;
        }
        EXPECT_TRUE(found) << name << told;
    }
    EXPECT_EQ(service.control->begun(), 0);
    expect_alive(service);
}

TEST(CorpusOverHttp, EveryMalformedRequestIsRefused) {
    const Service service;
    const auto expected = nlohmann::json::parse(read_file(kCorpus / "requests/expected.json"));
    std::size_t files = 0;
    for (const auto& entry : std::filesystem::directory_iterator(kCorpus / "requests")) files += entry.path().extension() == ".http";
    EXPECT_EQ(files, expected.size()) << "expected.json and the files must agree";
    Times times;
    for (const auto& [name, answer] : expected.items()) {
        const Clock::time_point start = Clock::now();
        RawClient client(service.port());
        client.send(read_file(kCorpus / "requests" / name));
        client.end();
        const std::string response = client.receive();
        times.add(name, start);
        EXPECT_EQ(status_of(response), answer["status"].get<int>()) << name << "\n" << response;
        expect_problem(body_of(response), answer["status"], answer["type"]);
    }
    EXPECT_EQ(service.control->begun(), 0);  // nothing was taken for a scene
    expect_alive(service);
}

// What the library would pass over in silence, another program may read otherwise.
TEST(HeaderGrammar, TakesWhatIsWellFormedAlone) {
    const auto takes = [](std::string_view head) {
        HeaderGrammar grammar;
        return std::all_of(head.begin(), head.end(), [&](char c) { return grammar.take(c); });
    };
    for (const std::string head :
         {"GET / HTTP/1.1\r\n\r\n", "GET / HTTP/1.1\r\nHost: x\r\nA:\r\nB:  c d\t\r\n\r\n", "\r\n\r\nGET / HTTP/1.1\r\n\r\n",
          "GET /\xc3\xa4 HTTP/1.1\r\nA: \xc3\xa4\r\n\r\n", "M-SEARCH * HTTP/1.1\r\n!#$%&'*+-.^_`|~9: x\r\n\r\nGET / HTTP/1.1\r\nA: b\r\n\r\n"}) {
        EXPECT_TRUE(takes(head)) << head;
    }
    for (const std::string line : {"A : b", " A: b", "\tA: b", "A", ": b", "A\nB: c", "A: b\nB: c", "A: b\rB: c", "A: b\x01", "A\x7f: b", "A(b): c", "A: \x7f"}) {
        EXPECT_FALSE(takes("GET / HTTP/1.1\r\n" + line + "\r\n\r\n")) << line;
    }
    EXPECT_FALSE(takes(std::string_view("GET / HTTP/1.1\r\nA: \0\r\n\r\n", 23)));
    for (const std::string line : {"GET /", "GET  / HTTP/1.1", "GET / HTTP/1.1 ", " GET / HTTP/1.1", "GET / a HTTP/1.1", "GET\t/\tHTTP/1.1", "GET / HTTP/1.1\n", "GET /\x01 HTTP/1.1"}) {
        EXPECT_FALSE(takes(line + "\r\n\r\n")) << line;
    }
}

}  // namespace
}  // namespace penumbra::test
