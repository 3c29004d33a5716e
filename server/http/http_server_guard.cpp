// SPDX-License-Identifier: MIT
#include "server/http/http_server_guard.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/select.h>
#include <sys/socket.h>

namespace penumbra {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

constexpr int kBacklog = 1024;

thread_local Exchange* t_exchange = nullptr;

milliseconds until(Clock::time_point deadline) {
    return std::chrono::ceil<milliseconds>(deadline - Clock::now());
}

bool wait_for(int socket, short events, milliseconds time) {
    pollfd entry{socket, events, 0};
    return ::poll(&entry, 1, int(std::clamp<milliseconds::rep>(time.count(), 0, 1 << 30))) > 0;
}

void address_of(int socket, bool peer, std::string& ip, int& port) {
    sockaddr_storage storage{};
    socklen_t length = sizeof storage;
    auto* address = reinterpret_cast<sockaddr*>(&storage);
    if ((peer ? ::getpeername(socket, address, &length) : ::getsockname(socket, address, &length)) != 0) {
        return;
    }
    char text[INET6_ADDRSTRLEN] = "";
    if (storage.ss_family == AF_INET) {
        const auto* v4 = reinterpret_cast<const sockaddr_in*>(&storage);
        ::inet_ntop(AF_INET, &v4->sin_addr, text, sizeof text);
        port = ntohs(v4->sin_port);
    } else if (storage.ss_family == AF_INET6) {
        const auto* v6 = reinterpret_cast<const sockaddr_in6*>(&storage);
        ::inet_ntop(AF_INET6, &v6->sin6_addr, text, sizeof text);
        port = ntohs(v6->sin6_port);
    }
    ip = text;
}

}  // namespace

std::string why_not_bound(const std::string& host, int error) {
    addrinfo* list = nullptr;
    if (const int unknown = ::getaddrinfo(host.c_str(), nullptr, nullptr, &list); unknown != 0) {
        return ::gai_strerror(unknown);
    }
    ::freeaddrinfo(list);
    return error != 0 ? std::strerror(error) : "the address is not of this machine, or the port is taken or not allowed";
}

// ---- GuardedStream

bool GuardedStream::client_gone() const {
    char byte = 0;
    const ssize_t count = ::recv(connection_.socket, &byte, 1, MSG_PEEK | MSG_DONTWAIT);
    return count == 0 || (count < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR);
}

// The library refuses numbers that select() cannot take, though nothing here is selected on.
socket_t GuardedStream::socket() const { return connection_.socket < FD_SETSIZE ? connection_.socket : 0; }

bool GuardedStream::is_writable() const {
    return !exchange_.streaming || wait_for(connection_.socket, POLLOUT, answered_ ? until(response_deadline_) : response_time_);
}

ssize_t GuardedStream::read(char* data, std::size_t size) {
    const std::size_t count = connection_.reader.head().copy(data, size, head_at_);
    head_at_ += count;
    return ssize_t(count);
}

ssize_t GuardedStream::write(const char* data, std::size_t size) {
    if (!answered_ || exchange_.streaming) response_deadline_ = Clock::now() + response_time_;
    answered_ = true;
    std::string_view rest(data, size);
    while (!rest.empty()) {
        const std::string_view unsent = connection_.left();  // comes first
        const std::string_view next = unsent.empty() ? rest : unsent;
        const ssize_t count = ::send(connection_.socket, next.data(), next.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        if (count >= 0) {
            unsent.empty() ? rest.remove_prefix(std::size_t(count)) : held_.has_sent(connection_, std::size_t(count));
            continue;
        }
        if (errno == EINTR) continue;
        if (errno != EAGAIN && errno != EWOULDBLOCK) return -1;
        // What a slow reader does not take yet waits without a thread; but not parts, nor what there is no room for.
        if (!exchange_.streaming && held_.send_later(connection_, rest)) break;
        if (!wait_for(connection_.socket, POLLOUT, until(response_deadline_))) return -1;
        if (until(response_deadline_).count() <= 0) return -1;
    }
    return ssize_t(size);
}

void GuardedStream::get_remote_ip_and_port(std::string& ip, int& port) const {
    address_of(connection_.socket, true, ip, port);
}
void GuardedStream::get_local_ip_and_port(std::string& ip, int& port) const {
    address_of(connection_.socket, false, ip, port);
}

// ---- GuardedServer

GuardedServer::GuardedServer(const EdgeLimits& limits, ReadHeaders read_headers, Refuse refuse, Judge judge)
    : limits_(limits),
      read_headers_(std::move(read_headers)),
      refuse_(std::move(refuse)),
      edge_(limits, {std::move(judge), [this](Connection& connection) { return answer(connection); }}) {
    set_keep_alive_timeout(std::chrono::duration_cast<std::chrono::seconds>(limits_.keep_alive).count());
    // The library's own default is SO_REUSEPORT, with which a second service on the same port starts
    // without a word and takes half of the requests.
    set_socket_options([](socket_t socket) {
        const int yes = 1;
        ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
}

Exchange& GuardedServer::exchange() { return *t_exchange; }

void GuardedServer::serve() {
    ::listen(svr_sock_, kBacklog);  // the library's own is 5
    // The library cuts answers in parts when it has no listening socket: it keeps the number, the edge the socket.
    edge_.start(svr_sock_);
}

void GuardedServer::drain() {
    draining_ = true;
    edge_.drain();
}

void GuardedServer::finish() {
    draining_ = true;
    edge_.stop();
    svr_sock_ = INVALID_SOCKET;
}

bool GuardedServer::answer(Connection& connection) {
    RequestReader& reader = connection.reader;
    Exchange exchange;
    exchange.start = connection.start;
    exchange.fault = connection.refusal != Fault::none ? connection.refusal : reader.fault();
    exchange.malformed = reader.framing_refusal();
    exchange.expects_body = reader.expects_body();
    exchange.body_read = reader.has_body();
    exchange.body = reader.take_body();
    GuardedStream stream(connection, edge_.held(), limits_.response_time, exchange);
    exchange.client_gone = [&stream] { return stream.client_gone(); };
    t_exchange = &exchange;
    const bool go_on = reader.has_head() && process(stream, exchange);
    if (!stream.answered() && exchange.fault != Fault::none) {
        const std::string text = refuse_(exchange);
        stream.write(text.data(), text.size());
    }
    t_exchange = nullptr;
    const bool unread = exchange.fault != Fault::none || (exchange.expects_body && !exchange.body_read);
    return go_on && !exchange.close && !unread && !draining_;
}

// Whether the connection may go on.
bool GuardedServer::process(GuardedStream& stream, Exchange& exchange) {
    bool closed = false;
    const bool last = draining_;
    const std::function<void(httplib::Request&)> setup = [&](httplib::Request& request) {
        read_headers_(request, exchange);
    };
    // Debian 13's version takes the addresses as well.
    const auto run = [&](auto& server) {
        if constexpr (requires { server.process_request(stream, last, closed, setup); }) {
            return server.process_request(stream, last, closed, setup);
        } else {
            std::string remote, local;
            int remote_port = 0, local_port = 0;
            stream.get_remote_ip_and_port(remote, remote_port);
            stream.get_local_ip_and_port(local, local_port);
            return server.process_request(stream, remote, remote_port, local, local_port, last, closed, setup);
        }
    };
    return run(*this) && !closed;
}

}  // namespace penumbra
