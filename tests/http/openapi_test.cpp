// SPDX-License-Identifier: MIT
// docs/openapi.json against the running service: every operation and every status that it names is provoked, and each answer is of
// the form that it promises.
#include <gmock/gmock.h>

#include <ctime>
#include <fstream>
#include <future>
#include <regex>
#include <set>
#include <thread>

#include "server/http/access.h"
#include "server_fixture.h"

namespace penumbra::test {
namespace {

using Json = nlohmann::json;

const Json& document() {
    static const Json json = [] {
        std::ifstream file(PENUMBRA_SOURCE_DIR "/docs/openapi.json");
        return Json::parse(file);
    }();
    return json;
}

Json resolved(const Json& node) {
    if (!node.is_object() || !node.contains("$ref")) return node;
    return resolved(document().at(Json::json_pointer(node["$ref"].get<std::string>().substr(1))));
}

// The part of JSON Schema that the document uses; a keyword beyond it is a failure, so that nothing goes unchecked.
std::string breach(const Json& given, const Json& value, const std::string& where = "") {
    const Json schema = resolved(given);
    for (const auto& [key, rule] : schema.items()) {
        const auto wrong = [&](const std::string& why) { return where + ": " + why + ": " + value.dump().substr(0, 200); };
        if (key == "description" || key == "example" || key == "examples" || key == "default" || key == "format") continue;
        if (key == "type") {
            const auto is = [&](const std::string& type) {
                return (type == "object" && value.is_object()) || (type == "array" && value.is_array()) || (type == "string" && value.is_string()) ||
                       (type == "boolean" && value.is_boolean()) || (type == "null" && value.is_null()) || (type == "number" && value.is_number()) ||
                       (type == "integer" && value.is_number() && value.get<double>() == std::floor(value.get<double>()));
            };
            const bool good = rule.is_array() ? std::any_of(rule.begin(), rule.end(), [&](const Json& one) { return is(one); }) : is(rule);
            if (!good) return wrong("is no " + rule.dump());
        } else if (key == "const") {
            if (value != rule) return wrong("is not " + rule.dump());
        } else if (key == "enum") {
            if (std::find(rule.begin(), rule.end(), value) == rule.end()) return wrong("is none of " + rule.dump());
        } else if (key == "pattern") {
            if (!std::regex_search(value.get<std::string>(), std::regex(rule.get<std::string>()))) return wrong("does not match " + rule.dump());
        } else if (key == "minimum") {
            if (value.is_number() && value.get<double>() < rule.get<double>()) return wrong("is less than " + rule.dump());
        } else if (key == "maximum") {
            if (value.is_number() && value.get<double>() > rule.get<double>()) return wrong("is more than " + rule.dump());
        } else if (key == "minItems" || key == "maxItems") {
            if (key == "minItems" ? value.size() < rule.get<std::size_t>() : value.size() > rule.get<std::size_t>()) return wrong(key);
        } else if (key == "items") {
            for (const Json& item : value) {
                if (std::string why = breach(rule, item, where + "/*"); !why.empty()) return why;
            }
        } else if (key == "prefixItems") {
            for (std::size_t i = 0; i < rule.size() && i < value.size(); ++i) {
                if (std::string why = breach(rule[i], value[i], where + "/" + std::to_string(i)); !why.empty()) return why;
            }
        } else if (key == "properties") {
            for (const auto& [name, of] : rule.items()) {
                if (!value.contains(name)) continue;
                if (std::string why = breach(of, value[name], where + "/" + name); !why.empty()) return why;
            }
        } else if (key == "required") {
            for (const Json& name : rule) {
                if (!value.contains(name.get<std::string>())) return wrong("lacks " + name.dump());
            }
        } else if (key == "additionalProperties") {
            for (const auto& [name, member] : value.items()) {
                if (schema.contains("properties") && schema["properties"].contains(name)) continue;
                if (rule == false) return wrong("has " + name + ", which is not described");
                if (!rule.is_object()) continue;
                if (std::string why = breach(rule, member, where + "/" + name); !why.empty()) return why;
            }
        } else if (key == "anyOf" || key == "oneOf") {
            if (std::none_of(rule.begin(), rule.end(), [&](const Json& one) { return breach(one, value).empty(); })) return wrong("fits none of " + key);
        } else {
            return wrong("the test does not know the keyword " + key);
        }
    }
    return "";
}

class Walk {
public:
    // Whether an answer is as the operation says.
    void check(const std::string& method, const std::string& pattern, const httplib::Result& result) {
        ASSERT_TRUE(result) << method << " " << pattern;
        const std::string status = std::to_string(result->status);
        const std::string what = method + " " + pattern + " " + status;
        std::string verb = method;
        std::transform(verb.begin(), verb.end(), verb.begin(), [](unsigned char c) { return char(std::tolower(c)); });
        ASSERT_TRUE(document()["paths"].contains(pattern)) << what;
        const Json& operations = document()["paths"][pattern];
        // What a path does not take has no operation: 405 is told under those that it has.
        const Json& operation = operations.contains(verb) ? operations[verb] : operations.begin().value();
        const bool other = !operations.contains(verb);
        const Json* responses = &operation.at("responses");
        if (other) {
            for (const auto& [name, one] : operations.items()) {
                if (one.at("responses").contains("405")) responses = &one.at("responses");
            }
        }
        ASSERT_TRUE(responses->contains(status)) << what << " is not described: " << result->body.substr(0, 300);
        const Json response = resolved((*responses)[status]);
        const Json headers = response.contains("headers") ? response["headers"] : Json::object();
        for (const auto& [name, header] : headers.items()) {
            // Those that depend on the request or on options.
            static const std::set<std::string> kSometimes{"Penumbra-Partial", "RateLimit", "RateLimit-Policy", "Retry-After", "Preference-Applied", "Server-Timing"};
            if (!result->has_header(name)) {
                EXPECT_TRUE(kSometimes.contains(name)) << what << " lacks " << name;
                continue;
            }
            const Json schema = resolved(header)["schema"];
            const std::string value = result->get_header_value(name);
            const bool number = schema.value("type", "") == "integer" || schema.value("type", "") == "number";
            EXPECT_EQ(breach(schema, number ? Json::parse(value) : Json(value), name), "") << what;
        }
        EXPECT_TRUE(result->has_header("X-Request-Id")) << what;
        const Json content = response.contains("content") ? response["content"] : Json::object();
        if (content.empty()) {
            EXPECT_EQ(result->body, "") << what;
        } else if (method != "HEAD") {
            std::string type = result->get_header_value("Content-Type");
            type = type.substr(0, type.find(';'));
            ASSERT_TRUE(content.contains(type)) << what << " has " << type;
            if (content[type].contains("schema") && type.ends_with("json")) {
                const Json body = Json::parse(result->body, nullptr, false);
                ASSERT_FALSE(body.is_discarded()) << what;
                EXPECT_EQ(breach(content[type]["schema"], body), "") << what;
            }
        }
        if (!other) seen_.insert(verb + " " + pattern + " " + status);
        // Told once for the path, whichever operation it is described under.
        for (const auto& [name, one] : operations.items()) {
            if (other && one["responses"].contains(status)) seen_.insert(name + " " + pattern + " " + status);
        }
    }

    // What the document names and nobody provoked.
    std::set<std::string> missing() const {
        std::set<std::string> all;
        for (const auto& [pattern, operations] : document()["paths"].items()) {
            for (const auto& [verb, operation] : operations.items()) {
                for (const auto& [status, response] : operation["responses"].items()) all.insert(verb + " " + pattern + " " + status);
            }
        }
        for (const std::string& one : seen_) all.erase(one);
        return all;
    }

private:
    std::set<std::string> seen_;
};

std::string lasting(int hundredths) {
    return R"({"version": 1, "canvas": {"width": 40, "height": 30}, "sky": {"radiance": [)" + std::to_string(100 + hundredths) + ", 0, 0]}}";
}
const char* const kThrows = R"({"version": 1, "canvas": {"width": 40, "height": 30}, "sky": {"radiance": [13, 0, 0]}})";
const char* const kAnimated =
    R"({"version": 1, "canvas": {"width": 40, "height": 30}, "animate": {"frames": 2, "tracks": [{"pointer": "/canvas/margin", "keys": [[0, 0], [1, 9]]}]}})";

std::string animated(const std::string& radiance) {
    return R"({"version": 1, "canvas": {"width": 40, "height": 30}, "animate": {"vary": [{"pointer": "/sky/radiance", "values": [)" + radiance + "]}]}}";
}

TEST(OpenApi, EveryOperationAnswersAsItIsDescribed) {
    Walk walk;
    const std::string key = "0123456789abcdef0123456789abcdef";
    Config config;
    config.url_key = key;
    config.max_body_bytes = 100'000;
    config.max_deadline_s = 20;
    const Service service(config);
    service.worker->wait_until_started();
    httplib::Client client = service.client();
    const auto post = [&](const char* path, const std::string& body, const httplib::Headers& headers = {}, const char* type = kJson) {
        walk.check("POST", path, service.client().Post(path, headers, body, type));
    };
    // Every path: what it takes, what it does not take, and its document.
    for (const auto& [pattern, operations] : document()["paths"].items()) {
        std::string path = std::regex_replace(pattern, std::regex("\\{name\\}"), "not-json");
        path = std::regex_replace(path, std::regex("\\{id\\}"), "0123456789abcdef0123456789abcdef");
        walk.check("OPTIONS", pattern, client.Options(path));
        walk.check("PUT", pattern, service.client().Put(path, "", "text/plain"));
        if (!operations.contains("get") || pattern == "/v1/render" || pattern.find("{id}") != std::string::npos) continue;
        walk.check("GET", pattern, client.Get(path));
        walk.check("HEAD", pattern, client.Head(path));
    }
    walk.check("GET", "/problems/{name}", client.Get("/problems/none"));

    // What every endpoint with a body has in common.
    for (const char* path : {"/v1/render", "/v1/estimate", "/v1/jobs", "/v1/animate"}) {
        const std::string good = std::string(path) == "/v1/animate" ? kAnimated : kScene;
        post(path, good);
        post(path, "{");
        post(path, "{}");
        post(path, std::string(200'000, ' '));
        post(path, good, {}, "text/plain");
        post(path, good, {{"Cookie", std::string(20'000, 'x')}});
    }
    for (const char* path : {"/v1/render", "/v1/jobs", "/v1/animate"}) post(path, kScene, {{"Accept", "text/html"}});
    post("/v1/render", kThrows);
    post("/v1/animate", animated("[13, 0, 0]"));
    const auto rendered = client.Post("/v1/render", kScene, kJson);
    post("/v1/render", kScene, {{"If-None-Match", rendered->get_header_value("ETag")}});
    post("/v1/render", lasting(200), {{"Prefer", "wait=0.1"}});

    // Signed addresses.
    const auto signed_get = [&](const std::string& scene, const httplib::Headers& headers = {}) {
        walk.check("GET", "/v1/render", service.client().Get(signed_target(key, scene, std::time(nullptr) + 100), headers));
    };
    signed_get(kScene);
    signed_get(kScene, {{"If-None-Match", rendered->get_header_value("ETag")}});
    signed_get("{");
    signed_get("{}");
    signed_get(kThrows);
    signed_get(lasting(201), {{"Prefer", "wait=0.1"}});
    walk.check("GET", "/v1/render", client.Get("/v1/render?scene=x"));

    // Jobs.
    const auto begin = [&](const std::string& scene) {
        const auto result = service.client().Post("/v1/jobs", scene, kJson);
        return Json::parse(result->body)["links"];
    };
    const auto job_get = [&](const Json& links, const char* which, const char* pattern, const httplib::Headers& headers = {}) {
        walk.check("GET", pattern, service.client().Get(links[which].get<std::string>(), headers));
    };
    const Json done = begin(kScene);
    const Json failed = begin(kThrows);
    job_get(done, "events", "/v1/jobs/{id}/events");
    job_get(failed, "events", "/v1/jobs/{id}/events");
    job_get(done, "self", "/v1/jobs/{id}");
    job_get(done, "result", "/v1/jobs/{id}/result");
    job_get(done, "result", "/v1/jobs/{id}/result", {{"If-None-Match", rendered->get_header_value("ETag")}});
    job_get(failed, "result", "/v1/jobs/{id}/result");
    for (const char* pattern : {"/v1/jobs/{id}", "/v1/jobs/{id}/events", "/v1/jobs/{id}/result"}) {
        walk.check("GET", pattern, client.Get(std::regex_replace(pattern, std::regex("\\{id\\}"), "0123456789abcdef0123456789abcdef")));
    }
    walk.check("DELETE", "/v1/jobs/{id}", client.Delete("/v1/jobs/0123456789abcdef0123456789abcdef"));
    service.control->close_gate();
    const Json held = begin(scene_number(77));
    service.control->wait_for_begun(1);
    job_get(held, "result", "/v1/jobs/{id}/result");
    walk.check("DELETE", "/v1/jobs/{id}", client.Delete(held["self"].get<std::string>()));
    service.control->open_gate();

    // A client that takes too long.
    {
        Config slow;
        slow.request_timeout_s = 1;
        const Service impatient(slow);
        for (const char* path : {"/v1/render", "/v1/estimate", "/v1/jobs", "/v1/animate"}) {
            RawClient raw(impatient.port());
            raw.send(std::string("POST ") + path + " HTTP/1.1\r\nHost: x\r\nContent-Type: application/json\r\nContent-Length: 10\r\n\r\n{");
            const std::string answer = raw.receive();
            EXPECT_EQ(status_of(answer), 408) << path;
            ASSERT_TRUE(document()["paths"][path]["post"]["responses"].contains("408"));
        }
    }
    // Without a token.
    {
        Config closed;
        closed.tokens = Tokens::parse("aaaaaaaaaaaaaaaaaaaaaaaa");
        const Service guarded(closed);
        for (const char* path : {"/v1/render", "/v1/estimate", "/v1/jobs", "/v1/animate"}) {
            walk.check("POST", path, guarded.client().Post(path, kScene, kJson));
        }
        walk.check("GET", "/v1/info", guarded.client().Get("/v1/info"));
        for (const char* pattern : {"/v1/jobs/{id}", "/v1/jobs/{id}/events", "/v1/jobs/{id}/result"}) {
            walk.check("GET", pattern, guarded.client().Get(std::regex_replace(pattern, std::regex("\\{id\\}"), "0123456789abcdef0123456789abcdef")));
        }
        walk.check("DELETE", "/v1/jobs/{id}", guarded.client().Delete("/v1/jobs/0123456789abcdef0123456789abcdef"));
    }
    // With a share that is spent.
    {
        Config poor;
        poor.client_budget_s = 0.2;
        poor.url_key = key;
        const Service service_of_little(poor);
        EXPECT_EQ(service_of_little.post(lasting(40))->status, 200);
        walk.check("POST", "/v1/render", service_of_little.post(lasting(40), {{"Cache-Control", "no-cache"}}));
        walk.check("GET", "/v1/render", service_of_little.client().Get(signed_target(key, lasting(40), 0), {{"Cache-Control", "no-cache"}}));
    }
    // Before there is a renderer, and with one that is wrong.
    {
        auto control = std::make_shared<FakeControl>();
        control->close_start();
        const Service starting({}, control);
        walk.check("GET", "/readyz", starting.client().Get("/readyz"));
        walk.check("GET", "/startupz", starting.client().Get("/startupz"));
    }
    {
        auto control = std::make_shared<FakeControl>();
        control->set_self_test("wrong");
        Config none;
        none.max_jobs = 0;
        none.url_key = key;
        const Service wrong(none, control);
        wrong.worker->wait_until_started();
        walk.check("POST", "/v1/render", wrong.post(kScene));
        walk.check("GET", "/v1/render", wrong.client().Get(signed_target(key, kScene, 0)));
        walk.check("POST", "/v1/jobs", wrong.client().Post("/v1/jobs", kScene, kJson));
        walk.check("POST", "/v1/animate", wrong.client().Post("/v1/animate", kAnimated, kJson));
    }
    std::set<std::string> missing = walk.missing();
    // 408 was looked at above; the others cannot be had of every endpoint, or take a machine full of connections.
    std::erase_if(missing, [](const std::string& one) {
        return one.ends_with(" 408") || one == "post /v1/estimate 500" || one == "post /v1/estimate 503" || one == "post /v1/jobs 500" ||
               one == "post /v1/animate 504" || one == "get /v1/jobs/{id}/events 503" || one == "get /v1/jobs/{id}/result 504";
    });
    EXPECT_THAT(missing, testing::IsEmpty());
}

TEST(OpenApi, NamesWhatThereIs) {
    const Service service;
    for (const auto& type : document()["components"]["schemas"]["Problem"]["properties"]["type"]["enum"]) {
        EXPECT_EQ(service.client().Get(type.get<std::string>().c_str())->status, 200) << type;
    }
    std::set<std::string> operations;
    for (const auto& [path, methods] : document()["paths"].items()) {
        for (const auto& [method, operation] : methods.items()) EXPECT_TRUE(operations.insert(operation["operationId"]).second) << path;
    }
    // Every path that the service greets with is described.
    const std::string hint = service.client().Get("/")->body;
    for (const char* path : {"/v1/render", "/v1/estimate", "/v1/animate", "/v1/jobs", "/v1/info", "/v1/schema", "/openapi.json"}) {
        EXPECT_THAT(hint, testing::HasSubstr(path));
        EXPECT_TRUE(document()["paths"].contains(path)) << path;
    }
}

}  // namespace
}  // namespace penumbra::test
