// SPDX-License-Identifier: MIT
#include "raw_client.h"

#include <arpa/inet.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <sys/time.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdlib>

namespace penumbra::test {

RawClient::RawClient(int port) {
    fd_ = ::socket(AF_INET, SOCK_STREAM, 0);
    const timeval time{20, 0};
    ::setsockopt(fd_, SOL_SOCKET, SO_RCVTIMEO, &time, sizeof time);
    ::setsockopt(fd_, SOL_SOCKET, SO_SNDTIMEO, &time, sizeof time);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(static_cast<std::uint16_t>(port));
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    if (::connect(fd_, reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0) std::abort();
}

void RawClient::end() { ::shutdown(fd_, SHUT_WR); }

RawClient::~RawClient() { ::close(fd_); }

bool RawClient::send(std::string_view bytes) {
    while (!bytes.empty()) {
        const ssize_t count = ::send(fd_, bytes.data(), bytes.size(), MSG_NOSIGNAL);
        if (count <= 0) return false;
        bytes.remove_prefix(std::size_t(count));
    }
    return true;
}

std::string RawClient::receive() {
    std::size_t wanted = 0;
    char block[65536];
    while (wanted == 0 || rest_.size() < wanted) {
        if (const std::size_t end = rest_.find("\r\n\r\n"); wanted == 0 && end != std::string::npos) {
            const std::size_t length = rest_.find("Content-Length: ");
            wanted = end + 4 + (length < end ? std::size_t(std::atoll(rest_.c_str() + length + 16)) : 0);
            continue;
        }
        const ssize_t count = ::recv(fd_, block, sizeof block, 0);
        if (count <= 0) return "";
        rest_.append(block, std::size_t(count));
    }
    const std::string response = rest_.substr(0, wanted);
    rest_.erase(0, wanted);
    return response;
}

bool RawClient::closed_by_server() {
    char block[65536];
    while (true) {
        const ssize_t count = ::recv(fd_, block, sizeof block, 0);
        if (count == 0) return true;
        if (count < 0) return errno == ECONNRESET;
    }
}

int status_of(const std::string& response) {
    return response.starts_with("HTTP/1.1 ") ? std::atoi(response.c_str() + 9) : 0;
}

std::string body_of(const std::string& response) {
    const std::size_t end = response.find("\r\n\r\n");
    return end == std::string::npos ? "" : response.substr(end + 4);
}

}  // namespace penumbra::test
