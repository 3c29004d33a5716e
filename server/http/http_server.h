// SPDX-License-Identifier: MIT
// The service over HTTP. docs/api.md says what it answers; docs/operations.md how it is run.
#pragma once

#include <memory>
#include <string>

#include "server/service/config.h"
#include "server/service/log.h"
#include "server/service/render_service.h"

namespace penumbra {

class HttpServer {
public:
    // All three outlive the server.
    HttpServer(RenderService& service, const Config& config, const Log& log);
    ~HttpServer();  // stops
    HttpServer(const HttpServer&) = delete;
    HttpServer& operator=(const HttpServer&) = delete;

    // Binds and listens. Empty when it does, else a sentence saying why not.
    std::string start();

    int port() const;         // the real one, also when the configured one is 0
    int admin_port() const;   // the same; 0 without one
    std::string url() const;  // "http://127.0.0.1:8080"
    bool listening() const;   // false before start(), after stop(), and when listening failed

    // Serves a connection that someone else accepted (tests/fuzz), on this thread until it ends; closes it.
    void serve_connection(int socket);

    // Takes no more connections, answers what was asked, and returns when all is said.
    void stop();

private:
    struct Impl;
    std::unique_ptr<Impl> impl_;
};

}  // namespace penumbra
