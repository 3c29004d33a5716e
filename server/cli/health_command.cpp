// SPDX-License-Identifier: MIT
// penumbra health: asks a running service whether it is ready. For a container's HEALTHCHECK, so that the
// image needs no curl. Plain sockets: one request without a body is not worth a library.
#include <netdb.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <cstdio>
#include <memory>
#include <string>

#include <CLI/CLI.hpp>

#include "server/cli/checks.h"
#include "server/cli/commands.h"
#include "server/cli/files.h"

namespace penumbra {
namespace {

struct Address {
    std::string host, port = "80", path = "/readyz";
};

Address parse_url(const std::string& url) {
    constexpr std::string_view kScheme = "http://";
    if (!url.starts_with(kScheme)) throw InputError("--url takes http://HOST:PORT[/PATH], not " + url);
    std::string rest = url.substr(kScheme.size());
    Address address;
    if (const std::size_t slash = rest.find('/'); slash != std::string::npos) {
        if (slash + 1 < rest.size()) address.path = rest.substr(slash);
        rest.resize(slash);
    }
    const std::size_t colon = rest.rfind(':');
    const bool in_brackets = colon != std::string::npos && rest.find(']', colon) != std::string::npos;
    if (colon != std::string::npos && !in_brackets) {
        address.port = rest.substr(colon + 1);
        rest.resize(colon);
    }
    if (rest.starts_with('[') && rest.ends_with(']')) rest = rest.substr(1, rest.size() - 2);
    if (rest.empty() || address.port.empty()) throw InputError("--url takes http://HOST:PORT[/PATH], not " + url);
    address.host = rest;
    return address;
}

class Connection {
public:
    Connection(const Address& address, int timeout_s) {
        addrinfo hints{}, *list = nullptr;
        hints.ai_socktype = SOCK_STREAM;
        if (::getaddrinfo(address.host.c_str(), address.port.c_str(), &hints, &list) != 0) return;
        const timeval time{timeout_s, 0};
        for (const addrinfo* entry = list; entry && fd_ < 0; entry = entry->ai_next) {
            fd_ = ::socket(entry->ai_family, entry->ai_socktype | SOCK_CLOEXEC, entry->ai_protocol);
            if (fd_ < 0) continue;
            ::setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &time, sizeof time);
            ::setsockopt(fd_, SOL_SOCKET, SO_SNDTIMEO, &time, sizeof time);
            if (::connect(fd_, entry->ai_addr, entry->ai_addrlen) == 0) break;
            ::close(fd_);
            fd_ = -1;
        }
        ::freeaddrinfo(list);
    }
    ~Connection() {
        if (fd_ >= 0) ::close(fd_);
    }
    Connection(const Connection&) = delete;
    Connection& operator=(const Connection&) = delete;

    // The first line of the answer, "" when there is none.
    std::string ask(const std::string& request) const {
        std::string answer;
        if (fd_ < 0 || ::send(fd_, request.data(), request.size(), MSG_NOSIGNAL) != ssize_t(request.size())) {
            return answer;
        }
        char block[512];
        while (answer.find('\n') == std::string::npos && answer.size() < 4096) {
            const ssize_t count = ::recv(fd_, block, sizeof block, 0);
            if (count <= 0) break;
            answer.append(block, std::size_t(count));
        }
        return answer.substr(0, answer.find_first_of("\r\n"));
    }

private:
    int fd_ = -1;
};

int check_health(const std::string& url, int timeout_s) {
    const Address address = parse_url(url);
    const std::string line = Connection(address, timeout_s)
                                 .ask("GET " + address.path + " HTTP/1.1\r\nHost: " + address.host +
                                      "\r\nConnection: close\r\n\r\n");
    if (line.starts_with("HTTP/1.1 200")) return kSuccess;
    complain(url + (line.empty() ? " does not answer" : " is not ready: " + line));
    return kWorldFailed;
}

}  // namespace

void add_health_command(CLI::App& app, CommandContext& context) {
    CLI::App* command = app.add_subcommand("health", "Ask a running service whether it is ready");
    auto url = std::make_shared<std::string>();
    auto port = std::make_shared<int>(8080);
    auto timeout = std::make_shared<int>(5);
    command->add_option("--url", *url, "Service [http://127.0.0.1:PORT]; /readyz unless it has a path");
    command->add_option("--port", *port, "Port on this machine")
        ->envname("PENUMBRA_PORT")
        ->capture_default_str()
        ->check(whole_number(1, 65535));
    command->add_option("--timeout", *timeout, "Seconds to wait")->capture_default_str()->check(whole_number(1, 60));
    command->callback([&context, url, port, timeout] {
        context.run = [url, port, timeout]() -> int {
            try {
                return check_health(url->empty() ? "http://127.0.0.1:" + std::to_string(*port) : *url, *timeout);
            } catch (const InputError& error) {
                complain(error.what());
                return kBadInput;
            }
        };
    });
}

}  // namespace penumbra
