// SPDX-License-Identifier: MIT
// Any bytes as what a client sends on one connection, through the guard, the library and our routing: answered as HTTP, never
// with a failure of our own, and the connection ends.
#include <sys/socket.h>
#include <unistd.h>

#include <array>
#include <string>
#include <thread>

#include "../http/server_fixture.h"
#include "check.h"

using penumbra::fuzz::check;

namespace {

struct Front {
    penumbra::test::Service* service = nullptr;

    Front() {
        penumbra::Config config;
        config.max_pixels = 64 * 64;  // a picture costs little beside its request
        config.cache_bytes = 1u << 20;
        config.request_timeout_s = 5;
        config.keep_alive_s = 1;
        // The log takes the stream that it finds: a line for each of a million requests is of no use.
        FILE* const real = stderr;
        stderr = std::fopen("/dev/null", "w");
        service = new penumbra::test::Service(config);  // lives as long as the process
        stderr = real;
        service->worker->wait_until_started();
    }
};

void send_all(int socket, const std::uint8_t* data, std::size_t size) {
    for (std::size_t sent = 0; sent < size;) {
        const ssize_t count = ::send(socket, data + sent, size - sent, MSG_NOSIGNAL);
        if (count <= 0) break;  // the server has closed: it is done with us
        sent += std::size_t(count);
    }
    ::shutdown(socket, SHUT_WR);
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
    static const Front kFront;
    int ends[2];
    check(::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) == 0, "there are sockets");
    std::thread server([&] { kFront.service->server->serve_connection(ends[1]); });
    // Reads beside writing, or both sides could wait for each other.
    std::thread client([&] { send_all(ends[0], data, size); });
    std::string answer;
    std::array<char, 4096> block;
    for (ssize_t count; (count = ::recv(ends[0], block.data(), block.size(), 0)) > 0;) answer.append(block.data(), std::size_t(count));
    client.join();
    server.join();
    ::close(ends[0]);
    check(answer.empty() || answer.starts_with("HTTP/1.1 "), "an answer is HTTP");
    check(answer.find("\"type\": \"/problems/internal\"") == std::string::npos, "no request makes the service fail");
    // As a header: a problem may quote the word out of the request.
    check(answer.find("\r\nEXCEPTION_WHAT:") == std::string::npos, "no exception's text goes out");
    return 0;
}
