// SPDX-License-Identifier: MIT
#include "server/worker/worker_process.h"

#include <chrono>
#include <csignal>
#include <fstream>

#include <sys/prctl.h>
#include <unistd.h>

#include "core/scene/normal_form.h"
#include "server/worker/channel.h"
#include "server/worker/wire.h"

namespace penumbra {
namespace {

using Clock = std::chrono::steady_clock;
using Kind = Message::Kind;

// Often enough for the service to know within a second that it works, seldom enough to cost nothing.
constexpr std::chrono::milliseconds kPulse{200}, kListen{5};
constexpr std::chrono::hours kForever{24 * 365};

std::uint64_t resident_bytes() {
    std::ifstream file("/proc/self/statm");
    std::uint64_t all = 0, resident = 0;
    file >> all >> resident;
    return resident * std::uint64_t(::sysconf(_SC_PAGESIZE));
}

// Says that it is alive, and hears whether it shall stop.
class Listener {
public:
    explicit Listener(Channel& channel) : channel_(channel) {}

    bool operator()() {
        ++slices_;
        const Clock::time_point now = Clock::now();
        if (now - spoken_ >= kPulse) {
            channel_.send(Kind::pulse, std::to_string(slices_));
            spoken_ = now;
        }
        if (now - heard_ >= kListen) {
            heard_ = now;
            Message message;
            const Channel::Result result = channel_.receive(message, std::chrono::milliseconds(0));
            stop_ = stop_ || result == Channel::Result::closed || (result == Channel::Result::message && message.kind == Kind::stop);
        }
        return stop_;
    }

private:
    Channel& channel_;
    Clock::time_point spoken_ = Clock::now(), heard_ = spoken_;
    bool stop_ = false;
    std::uint64_t slices_ = 0;
};

void render(RenderBackend& backend, const std::string& bytes, Channel& channel, const SharedMemory& memory) {
    const std::optional<Scene> scene = read_normal_form(bytes);
    if (!scene) {
        channel.send(Kind::failed, "The scene did not arrive as it was sent.");
        return;
    }
    RenderResult result;
    try {
        Listener listener(channel);
        result = backend.render(*scene, [&] { return listener(); });
    } catch (const RenderStopped&) {
        channel.send(Kind::stopped);
        return;
    }
    RenderReport report;
    report.picture = head_of(result);
    if (!memory.write(pixels_of(result), report.picture.bytes)) {
        channel.send(Kind::failed, "There is no room for the picture in shared memory.");
        return;
    }
    report.stats = std::move(result.stats);
    report.memory_bytes = resident_bytes();
    channel.send(Kind::picture, to_bytes(report));
}

}  // namespace

int run_worker_process(const Engine& engine, const RendererOptions& options, int socket, int memory_fd) {
    // The service decides when it ends: signals from a terminal go to both. And without the service it has no reason to be.
    std::signal(SIGINT, SIG_IGN);
    std::signal(SIGTERM, SIG_IGN);
    ::prctl(PR_SET_PDEATHSIG, SIGKILL);
    ::prctl(PR_SET_NAME, "penumbra-worker");
    // Writing a core of 100 MB takes seconds in which the service would wait for one that is dead.
    ::prctl(PR_SET_DUMPABLE, 0);
    Channel channel(socket);
    const SharedMemory memory(memory_fd);
    std::unique_ptr<RenderBackend> backend;
    try {
        backend = engine.make_backend(options);
    } catch (const std::exception& error) {
        channel.send(Kind::broken, error.what());
        return 1;
    }
    channel.send(Kind::device, to_bytes(backend->device()));
    for (;;) {
        Message message;
        const Channel::Result result = channel.receive(message, kForever);
        if (result == Channel::Result::closed) return 0;
        if (result == Channel::Result::nothing) continue;
        try {
            if (message.kind == Kind::render) render(*backend, message.bytes, channel, memory);
            if (message.kind == Kind::test) channel.send(Kind::tested, backend->self_test());
            // A stop that comes after the end of its render means nothing.
        } catch (const std::exception& error) {
            channel.send(message.kind == Kind::test ? Kind::tested : Kind::failed, error.what());
        } catch (...) {
            channel.send(Kind::failed, "unknown exception");
        }
    }
}

}  // namespace penumbra
