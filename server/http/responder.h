// SPDX-License-Identifier: MIT
// Writing answers: what every one of them has in common.
#pragma once

#include <string>
#include <string_view>

#include "server/http/http_server_guard.h"
#include "server/http/problem.h"
#include "server/service/config.h"

namespace penumbra {

class Responder {
public:
    Responder(const Config& config, const GuardedServer& server) : config_(config), server_(server) {}

    static const std::string& request_id() { return GuardedServer::exchange().request_id; }

    // What each answer needs; the others below call it.
    void finish(httplib::Response& response) const;
    void problem(httplib::Response& response, const HttpProblem& problem) const;
    // 200, never kept. Compressed when the client takes that and it is worth it.
    void text(httplib::Response& response, std::string body, const char* media_type) const;
    void json(httplib::Response& response, std::string body) const { text(response, std::move(body), "application/json"); }
    void nothing(httplib::Response& response) const;  // 204

    // The library's own headers are not true here: it offers ranges, counts requests that nobody counts, and says how long a
    // connection is kept that is closed. Called when it has set them.
    void mend_headers(httplib::Response& response) const;

    // Whether browsers' scripts from there may read the answers.
    bool allows_origin(std::string_view origin) const;

private:
    void compress(httplib::Response& response, std::string& body) const;

    const Config& config_;
    const GuardedServer& server_;
};

}  // namespace penumbra
