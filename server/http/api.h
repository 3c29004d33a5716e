// SPDX-License-Identifier: MIT
// Private to the HTTP front: which path is answered by what. docs/api.md says what each answers.
#pragma once

#include <atomic>
#include <chrono>
#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "server/http/access.h"
#include "server/http/responder.h"
#include "server/service/jobs.h"
#include "server/service/log.h"
#include "server/service/render_service.h"

namespace penumbra {

// What lies on which of the two ports: clients' and operators'.
enum class Door { clients, operators };

class Api {
public:
    Api(RenderService& service, Jobs* jobs, const Config& config, const Log& log, const GuardedServer& server, Door door);
    Api(const Api&) = delete;
    Api& operator=(const Api&) = delete;

    // What decides about a request before it is routed.
    void read_headers(httplib::Request& request, Exchange& exchange) const;
    // Answers; false: it has a body that is to be read first, by with_body().
    bool route(const httplib::Request& request, httplib::Response& response);
    void with_body(const httplib::Request& request, httplib::Response& response);
    // What becomes of a request, as far as its head alone says.
    Edge::Judgement judge(const RequestHead& head, const std::string& malformed) const;
    // Whether the declared length of a body alone says that it will be refused.
    bool declared_too_large(const httplib::Request& request) const;
    HttpProblem too_large() const;
    const Responder& respond() const { return respond_; }

    // Whatever happens inside ends as an answer without internals.
    template <class Work>
    void guarded(const httplib::Request& request, httplib::Response& response, const Work& work) {
        std::string what;
        try {
            work();
            return;
        } catch (const std::exception& error) {
            what = error.what();
        } catch (...) {
            what = "unknown exception";
        }
        log_.error("Unexpected exception", {{"path", request.path}, {"error", what}, {"id", Responder::request_id()}});
        respond_.problem(response, make_problem(ProblemKind::internal, ""));
    }

private:
    using Request = httplib::Request;
    using Response = httplib::Response;
    using Handler = void (Api::*)(const Request&, Response&);
    using BodyHandler = void (Api::*)(const Request&, Response&, std::string&& body);
    struct Endpoint {
        const char* pattern;    // "/v1/render"; "/problems/*" matches one name
        Handler get = nullptr;  // HEAD as well
        BodyHandler post = nullptr;
        Handler remove = nullptr;  // DELETE
        bool guarded = false;      // needs a token, where there are any
        bool clients = true, operators = false;
        bool probe = false;  // waits for nobody
    };
    static const std::vector<Endpoint>& endpoints();
    const Endpoint* find(const std::string& path) const;
    static std::string allow_of(const Endpoint& endpoint);
    bool try_route(const Request& request, Response& response);
    // Why it is refused, as its head alone says; nothing of its answer is made yet.
    std::optional<HttpProblem> refusal(const Endpoint* endpoint, const Request& request, Exchange& exchange) const;
    std::optional<HttpProblem> refuse_client(const Endpoint& endpoint, const Request& request, Exchange& exchange) const;
    std::optional<HttpProblem> refuse_body(const Endpoint& endpoint, const Request& request) const;
    void preflight(const Endpoint* endpoint, const Request& request, Response& response);

    void hint(const Request& request, Response& response);
    void alive(const Request& request, Response& response);
    void ready(const Request& request, Response& response);
    void started(const Request& request, Response& response);
    void info(const Request& request, Response& response);
    void schema(const Request& request, Response& response);
    void openapi(const Request& request, Response& response);
    void problem_page(const Request& request, Response& response);
    void metrics(const Request& request, Response& response);

    // ---- renders (api_render.cpp)
    std::optional<RenderRequest> wanted(const Request& request, Response& response, std::string_view body);
    void render(const Request& request, Response& response, std::string&& body);
    void render_signed(const Request& request, Response& response);
    void estimate(const Request& request, Response& response, std::string&& body);
    void animate(const Request& request, Response& response, std::string&& body);  // api_animate.cpp
    // ---- jobs (api_jobs.cpp)
    void begin_job(const Request& request, Response& response, std::string&& body);
    void tell_job(const Request& request, Response& response);
    void stream_job(const Request& request, Response& response);
    void give_job(const Request& request, Response& response);
    void end_job(const Request& request, Response& response);
    std::shared_ptr<Job> find_job(const Request& request, Response& response);

    // A place among the answers that come in parts; the service does not end before it is given back. Null: there is none, as has
    // been answered.
    using StreamPlace = std::shared_ptr<void>;
    StreamPlace place_for_stream(Response& response);
    // Parts, as long as `next` says that there are more.
    void stream(Response& response, StreamPlace place, const std::string& media_type, std::function<bool(std::string& part)> next);

    void send_picture(Response& response, const RenderRequest& request, const RenderResponse& rendered);
    void send_failure(Response& response, const RenderResponse& rendered);
    void tell_budget(Response& response, const RenderResponse& rendered) const;

    RenderService& service_;
    const Config& config_;
    const Log& log_;
    const GuardedServer& server_;
    const Door door_;
    const Responder respond_;
    Jobs* const jobs_;
    std::atomic<std::size_t> streams_{0};
    const std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

std::vector<std::string> header_values(const httplib::Request& request, const char* name);
std::string joined(const std::vector<std::string>& values);

}  // namespace penumbra
