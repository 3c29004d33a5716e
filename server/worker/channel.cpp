// SPDX-License-Identifier: MIT
#include "server/worker/channel.h"

#include <algorithm>
#include <cerrno>
#include <cstdint>
#include <cstring>

#include <poll.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <unistd.h>

#include "core/device_error.h"

namespace penumbra {
namespace {

struct Head {
    std::uint64_t size = 0;
    char kind = 0;
    char pad[7] = {};
};

// More is no message: a scene is bounded by the body's limit, its bitmaps by theirs.
constexpr std::uint64_t kMostBytes = std::uint64_t(4) << 30;

}  // namespace

Channel::~Channel() { ::close(socket_); }

bool Channel::send(Message::Kind kind, std::string_view bytes) {
    Head head;
    head.size = bytes.size();
    head.kind = char(kind);
    std::string_view parts[2] = {{reinterpret_cast<const char*>(&head), sizeof head}, bytes};
    for (std::string_view part : parts) {
        while (!part.empty()) {
            const ssize_t count = ::send(socket_, part.data(), part.size(), MSG_NOSIGNAL);
            if (count < 0 && errno == EINTR) continue;
            if (count <= 0) return false;
            part.remove_prefix(std::size_t(count));
        }
    }
    return true;
}

Channel::Result Channel::receive(Message& message, std::chrono::milliseconds patience) {
    using Clock = std::chrono::steady_clock;
    const Clock::time_point end = Clock::now() + patience;
    for (;;) {
        Head head;
        if (buffer_.size() >= sizeof head) {
            std::memcpy(&head, buffer_.data(), sizeof head);
            if (head.size > kMostBytes) return Result::closed;
            if (buffer_.size() >= sizeof head + head.size) {
                message.kind = Message::Kind(head.kind);
                message.bytes = buffer_.substr(sizeof head, head.size);
                buffer_.erase(0, sizeof head + head.size);
                return Result::message;
            }
        }
        const auto left = std::chrono::ceil<std::chrono::milliseconds>(end - Clock::now());
        pollfd entry{socket_, POLLIN, 0};
        const int ready = ::poll(&entry, 1, int(std::max<std::chrono::milliseconds::rep>(left.count(), 0)));
        if (ready < 0 && errno == EINTR) continue;
        if (ready <= 0) return Result::nothing;
        char bytes[65536];
        const ssize_t count = ::recv(socket_, bytes, sizeof bytes, MSG_DONTWAIT);
        if (count < 0 && (errno == EINTR || errno == EAGAIN)) continue;
        if (count <= 0) return Result::closed;
        buffer_.append(bytes, std::size_t(count));
    }
}

SharedMemory::SharedMemory() : fd_(::memfd_create("penumbra-pixels", MFD_CLOEXEC)) {
    if (fd_ < 0) throw DeviceError(std::string("There is no shared memory: ") + std::strerror(errno) + ".");
}

SharedMemory::~SharedMemory() { ::close(fd_); }

bool SharedMemory::write(const void* data, std::size_t size) const {
    const char* from = static_cast<const char*>(data);
    for (std::size_t at = 0; at < size;) {
        const ssize_t count = ::pwrite(fd_, from + at, size - at, off_t(at));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        at += std::size_t(count);
    }
    return true;
}

bool SharedMemory::read(void* data, std::size_t size) const {
    char* to = static_cast<char*>(data);
    for (std::size_t at = 0; at < size;) {
        const ssize_t count = ::pread(fd_, to + at, size - at, off_t(at));
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) return false;
        at += std::size_t(count);
    }
    return true;
}

void SharedMemory::clear() const {
    if (::ftruncate(fd_, 0) != 0) return;  // it is written over next time
}

}  // namespace penumbra
