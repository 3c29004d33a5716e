// SPDX-License-Identifier: MIT
// What the service and a worker process say to each other: messages of a kind and some bytes over a socket, pixels through memory
// that both have open.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>

namespace penumbra {

struct Message {
    enum class Kind : char {
        // to the worker
        render = 'r',  // a scene's normal form
        test = 't',    // the self test
        stop = 's',    // end the render: it may have ended already
        // from the worker
        device = 'd',   // it has one: DeviceInfo
        broken = 'b',   // it has none: a sentence
        pulse = 'p',    // it is at work; how many dispatches there were
        picture = 'P',  // RenderStats, size and kind of the pixels, its memory in use
        failed = 'f',   // a sentence
        stopped = 'S',
        tested = 'T',   // a sentence; empty: it was right
    };
    Kind kind = Kind::pulse;
    std::string bytes;
};

// One end of a socket pair. Owned, closed at the end.
class Channel {
public:
    explicit Channel(int socket) : socket_(socket) {}
    ~Channel();
    Channel(const Channel&) = delete;
    Channel& operator=(const Channel&) = delete;

    // False when nobody reads any more.
    bool send(Message::Kind kind, std::string_view bytes = {});

    enum class Result { message, nothing, closed };
    // Waits for a whole message at most so long.
    Result receive(Message& message, std::chrono::milliseconds patience);

private:
    int socket_;
    std::string buffer_;
};

// Anonymous memory with a file descriptor that a child process inherits.
class SharedMemory {
public:
    SharedMemory();                                // throws DeviceError
    explicit SharedMemory(int fd) : fd_(fd) {}     // takes it over
    ~SharedMemory();
    SharedMemory(const SharedMemory&) = delete;
    SharedMemory& operator=(const SharedMemory&) = delete;

    int fd() const { return fd_; }
    bool write(const void* data, std::size_t size) const;
    bool read(void* data, std::size_t size) const;  // false when there is less
    void clear() const;                             // gives the memory back

private:
    int fd_;
};

}  // namespace penumbra
