// SPDX-License-Identifier: MIT
#include "server/http/http_server_guard.h"

#include <algorithm>
#include <cerrno>
#include <cstring>

#include <arpa/inet.h>
#include <netdb.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace penumbra {
namespace {

using Clock = std::chrono::steady_clock;
using std::chrono::milliseconds;

// How often a waiting thread looks up: bounds how late it notices a stop.
constexpr milliseconds kLookUp{100};
// A fresh connection may be this silent while others wait for a thread; an old one not at all.
constexpr milliseconds kPatienceWhenBusy{1000};
// A client that is refused in the middle of its body reads the answer only when it stops sending.
constexpr milliseconds kLingerTime{2000};
// One that was too slow gets little more of a thread's time.
constexpr milliseconds kLingerTimeOfSlow{200};
constexpr std::size_t kBufferBytes = 16u << 10;

thread_local Exchange* t_exchange = nullptr;
thread_local bool t_refusing = false;

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

bool GuardedStream::wait_for_request(const std::function<bool(milliseconds)>& give_up) {
    const Clock::time_point start = Clock::now();
    while (buffer_at_ == buffer_.size()) {
        if (wait_for(socket_, POLLIN, kLookUp)) return true;  // or the end, which read() will tell
        const auto idle = std::chrono::duration_cast<milliseconds>(Clock::now() - start);
        if (idle >= limits_.keep_alive || give_up(idle)) return false;
    }
    return true;
}

void GuardedStream::begin(Exchange& exchange) {
    exchange_ = &exchange;
    request_deadline_ = Clock::now() + limits_.request_time;
    answered_ = false;
    in_header_ = true;
    header_bytes_ = header_lines_ = body_bytes_ = 0;
    line_end_ = 0;
    grammar_ = {};
}

bool GuardedStream::client_gone() const {
    char byte = 0;
    const ssize_t count = ::recv(socket_, &byte, 1, MSG_PEEK | MSG_DONTWAIT);
    return count == 0 || (count < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR);
}

void GuardedStream::linger() {
    ::shutdown(socket_, SHUT_WR);
    const bool slow = exchange_->fault == Fault::timeout;
    const Clock::time_point deadline = Clock::now() + (slow ? kLingerTimeOfSlow : kLingerTime);
    std::vector<char> waste(kBufferBytes);
    while (until(deadline).count() > 0 && wait_for(socket_, POLLIN, until(deadline))) {
        if (::recv(socket_, waste.data(), waste.size(), 0) <= 0) return;
    }
}

bool GuardedStream::is_readable() const {
    return buffer_at_ < buffer_.size() || wait_for(socket_, POLLIN, milliseconds(0));
}

bool GuardedStream::is_writable() const {
    return wait_for(socket_, POLLOUT, answered_ ? until(response_deadline_) : limits_.response_time);
}

bool GuardedStream::fill(Clock::time_point deadline) {
    while (true) {
        if (until(deadline).count() <= 0 || !wait_for(socket_, POLLIN, until(deadline))) {
            if (until(deadline).count() > 0 && errno == EINTR) continue;
            exchange_->fault = Fault::timeout;
            return false;
        }
        buffer_.resize(kBufferBytes);
        buffer_at_ = 0;
        const ssize_t count = ::recv(socket_, buffer_.data(), buffer_.size(), MSG_DONTWAIT);
        buffer_.resize(count > 0 ? std::size_t(count) : 0);
        if (count > 0) return true;
        if (count == 0 || (errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR)) return false;
    }
}

// Counts one byte of the header section and finds its end.
Fault GuardedStream::count_header(char c) {
    if (++header_bytes_ > limits_.header_bytes) return Fault::headers_too_large;
    // One line too many is known by its first byte: the library's own count (0.18) would come at its end.
    if (line_end_ == 2 && c != '\r' && header_lines_ > limits_.header_lines) return Fault::headers_too_large;
    if (c == '\n' && ++header_lines_ > limits_.header_lines + 2) return Fault::headers_too_large;  // request line, blank line
    if (!grammar_.take(c)) return Fault::malformed;
    line_end_ = c == "\r\n\r\n"[line_end_] ? line_end_ + 1 : (c == '\r' ? 1 : 0);
    if (line_end_ == 4) in_header_ = false;
    return Fault::none;
}

ssize_t GuardedStream::read(char* data, std::size_t size) {
    if (exchange_->fault != Fault::none) return -1;
    if (size == 0) return 0;
    if (buffer_at_ == buffer_.size() && !fill(request_deadline_)) {
        return exchange_->fault == Fault::none ? 0 : -1;
    }
    std::size_t count = std::min(size, buffer_.size() - buffer_at_);
    if (in_header_) {
        std::size_t seen = 0;
        while (seen < count && in_header_) {
            exchange_->fault = count_header(buffer_[buffer_at_ + seen]);
            if (exchange_->fault != Fault::none) return -1;
            ++seen;
        }
        count = seen;
    } else {
        body_bytes_ += count;
        if (body_bytes_ > limits_.body_bytes) {
            exchange_->fault = Fault::body_too_large;
            return -1;
        }
        for (std::size_t i = count - std::min<std::size_t>(count, 4); i < count; ++i) {
            exchange_->body_end = exchange_->body_end << 8 | static_cast<unsigned char>(buffer_[buffer_at_ + i]);
        }
    }
    std::memcpy(data, buffer_.data() + buffer_at_, count);
    buffer_at_ += count;
    return ssize_t(count);
}

ssize_t GuardedStream::write(const char* data, std::size_t size) {
    if (!answered_ || exchange_->streaming) response_deadline_ = Clock::now() + limits_.response_time;
    answered_ = true;
    std::size_t sent = 0;
    while (sent < size) {
        const ssize_t count = ::send(socket_, data + sent, size - sent, MSG_NOSIGNAL | MSG_DONTWAIT);
        if (count >= 0) {
            sent += std::size_t(count);
            continue;
        }
        if (errno == EINTR) continue;
        if (errno != EAGAIN && errno != EWOULDBLOCK) return -1;
        if (!wait_for(socket_, POLLOUT, until(response_deadline_))) return -1;
        if (until(response_deadline_).count() <= 0) return -1;
    }
    return ssize_t(size);
}

void GuardedStream::get_remote_ip_and_port(std::string& ip, int& port) const {
    address_of(socket_, true, ip, port);
}
void GuardedStream::get_local_ip_and_port(std::string& ip, int& port) const {
    address_of(socket_, false, ip, port);
}

// ---- ConnectionQueue

bool ConnectionQueue::refusing() { return t_refusing; }

ConnectionQueue::Enqueued ConnectionQueue::enqueue(std::function<void()> connection) {
    bool full = false;
    {
        const std::lock_guard lock(mutex_);
        full = connections_.size() >= limits_.waiting_connections;
        if (!full) {
            connections_.push_back(std::move(connection));
            waiting_ = connections_.size();
            if (connections_.size() > idle_ && threads_.size() < limits_.threads) {
                threads_.emplace_back([this] { work(); });
            }
        }
    }
    if (full) {
        t_refusing = true;
        connection();
        t_refusing = false;
    } else {
        changed_.notify_one();
    }
    return static_cast<Enqueued>(true);
}

void ConnectionQueue::shutdown() {
    {
        const std::lock_guard lock(mutex_);
        stopping_ = true;
    }
    changed_.notify_all();
    for (std::thread& thread : threads_) thread.join();
}

void ConnectionQueue::work() {
    std::unique_lock lock(mutex_);
    while (true) {
        ++idle_;
        changed_.wait(lock, [&] { return stopping_ || !connections_.empty(); });
        --idle_;
        if (connections_.empty()) return;
        const std::function<void()> connection = std::move(connections_.front());
        connections_.pop_front();
        waiting_ = connections_.size();
        lock.unlock();
        connection();
        lock.lock();
    }
}

// ---- GuardedServer

GuardedServer::GuardedServer(const GuardLimits& limits, ReadHeaders read_headers, Refuse refuse)
    : limits_(limits), read_headers_(std::move(read_headers)), refuse_(std::move(refuse)) {
    new_task_queue = [this] { return new ConnectionQueue(limits_, waiting_); };
    set_tcp_nodelay(true);
    set_keep_alive_timeout(std::chrono::duration_cast<std::chrono::seconds>(limits_.keep_alive).count());
    // The library's own default is SO_REUSEPORT, with which a second service on the same port starts
    // without a word and takes half of the requests.
    set_socket_options([](socket_t socket) {
        const int yes = 1;
        ::setsockopt(socket, SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    });
}

Exchange& GuardedServer::exchange() { return *t_exchange; }

bool GuardedServer::has_backlog() const { return wait_for(svr_sock_, POLLIN, milliseconds(0)); }

void GuardedServer::widen_backlog() { ::listen(svr_sock_, 1024); }

bool GuardedServer::process_and_close_socket(socket_t socket) {
    {
        GuardedStream stream(socket, limits_);
        if (ConnectionQueue::refusing()) {
            // On the accepting thread: say it without waiting for anything.
            Exchange exchange;
            exchange.fault = Fault::too_many_connections;
            const std::string answer = refuse_(exchange);
            ::send(socket, answer.data(), answer.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        } else {
            serve_connection(stream);
        }
    }
    ::shutdown(socket, SHUT_RDWR);
    ::close(socket);
    return true;
}

void GuardedServer::serve_connection(GuardedStream& stream) {
    bool fresh = true;
    const auto give_up = [&](milliseconds idle) {
        if (draining_) return true;
        return waiting_ > 0 && (!fresh || idle > kPatienceWhenBusy);
    };
    while (stream.wait_for_request(give_up)) {
        fresh = false;
        Exchange exchange;
        exchange.client_gone = [&stream] { return stream.client_gone(); };
        t_exchange = &exchange;
        stream.begin(exchange);
        // A client that asks without a pause would keep its thread for ever, and those that wait for one out.
        exchange.close = waiting_ > 0;
        const bool go_on = serve_request(stream, exchange, draining_);
        t_exchange = nullptr;
        if (!go_on) return;
    }
}

bool GuardedServer::serve_request(GuardedStream& stream, Exchange& exchange, bool last) {
    bool closed = false;
    const std::function<void(httplib::Request&)> setup = [&](httplib::Request& request) {
        read_headers_(request, exchange);
    };
    // Debian 13's version takes the addresses as well.
    const auto process = [&](auto& server) {
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
    const bool ok = process(*this);
    if (!stream.answered() && exchange.fault != Fault::none) {
        const std::string answer = refuse_(exchange);
        stream.write(answer.data(), answer.size());
    }
    const bool unread = exchange.fault != Fault::none || (exchange.expects_body && !exchange.body_read);
    if (unread && stream.answered()) stream.linger();
    return ok && !closed && !exchange.close && !unread;
}

}  // namespace penumbra
