// SPDX-License-Identifier: MIT
#include "server/worker/process_backend.h"

#include <cerrno>
#include <charconv>
#include <csignal>
#include <cstring>
#include <optional>

#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include "core/scene/normal_form.h"
#include "server/worker/channel.h"
#include "server/worker/wire.h"

namespace penumbra {
namespace {

using Clock = std::chrono::steady_clock;
using Kind = Message::Kind;
using std::chrono::milliseconds;

// How often it is asked whether the process lives and the render is still wanted.
constexpr milliseconds kLookUp{20};
// Pictures above this give their memory back after each.
constexpr std::size_t kKeptMemory = 16u << 20;
// What the child finds its two descriptors as.
constexpr int kChildSocket = 3, kChildMemory = 4;

// A child process. Killed at the end, if it has not ended by then.
class Child {
public:
    Child(const WorkerProcessOptions& options, int socket, int memory) {
        std::vector<std::string> words{options.program};
        words.insert(words.end(), options.arguments.begin(), options.arguments.end());
        words.insert(words.end(), {"--socket", std::to_string(kChildSocket), "--memory", std::to_string(kChildMemory)});
        std::vector<std::string> variables;
        for (char** entry = environ; *entry; ++entry) variables.emplace_back(*entry);
        for (const auto& [name, value] : options.environment) {
            std::erase_if(variables, [&](const std::string& old) { return old.starts_with(name + "="); });
            variables.push_back(name + "=" + value);
        }
        const auto pointers = [](std::vector<std::string>& list) {
            std::vector<char*> result;
            for (std::string& text : list) result.push_back(text.data());
            result.push_back(nullptr);
            return result;
        };
        posix_spawn_file_actions_t actions;
        ::posix_spawn_file_actions_init(&actions);
        ::posix_spawn_file_actions_adddup2(&actions, socket, kChildSocket);
        ::posix_spawn_file_actions_adddup2(&actions, memory, kChildMemory);
        // Clients' connections are none of its business: one that it held open would not end when the service ends it.
        ::posix_spawn_file_actions_addclosefrom_np(&actions, kChildMemory + 1);
        posix_spawnattr_t attributes;
        ::posix_spawnattr_init(&attributes);
        sigset_t none;
        ::sigemptyset(&none);
        ::posix_spawnattr_setsigmask(&attributes, &none);
        ::posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGMASK);
        const int error = ::posix_spawn(&pid_, options.program.c_str(), &actions, &attributes, pointers(words).data(),
                                        pointers(variables).data());
        ::posix_spawnattr_destroy(&attributes);
        ::posix_spawn_file_actions_destroy(&actions);
        if (error != 0) throw DeviceError("A worker process could not be started: " + std::string(std::strerror(error)) + ".");
    }
    ~Child() { kill(); }
    Child(const Child&) = delete;
    Child& operator=(const Child&) = delete;

    // Empty while it runs. One that somebody has stopped (SIGSTOP) is killed: nobody can say for how long it would be.
    std::string ended() {
        if (!end_.empty()) return end_;
        int status = 0;
        const pid_t result = ::waitpid(pid_, &status, WNOHANG | WUNTRACED);
        if (result == 0) return "";
        if (result == pid_ && WIFSTOPPED(status)) {
            kill();
            end_ = "was stopped by signal " + std::to_string(WSTOPSIG(status));
            return end_;
        }
        end_ = result != pid_           ? "is gone"
               : WIFSIGNALED(status)    ? "was ended by signal " + std::to_string(WTERMSIG(status))
                                        : "ended with exit code " + std::to_string(WEXITSTATUS(status));
        return end_;
    }

    // Lets it end by itself, once nobody talks to it.
    void wait(milliseconds patience) {
        const Clock::time_point end = Clock::now() + patience;
        while (ended().empty() && Clock::now() < end) ::usleep(2000);
        kill();
    }

    void kill() {
        if (!end_.empty()) return;
        ::kill(pid_, SIGKILL);
        while (::waitpid(pid_, nullptr, 0) < 0 && errno == EINTR) {
        }
        end_ = "was killed";
    }

    pid_t pid() const { return pid_; }

private:
    pid_t pid_ = -1;
    std::string end_;
};

// Both ends close at exec; the child has its own under other numbers.
std::pair<int, int> make_sockets() {
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends) != 0) {
        throw DeviceError(std::string("There is no socket for a worker process: ") + std::strerror(errno) + ".");
    }
    // dup2() onto the same number would leave it to close at exec.
    for (int& end : ends) {
        if (end > kChildMemory) continue;
        const int higher = ::fcntl(end, F_DUPFD_CLOEXEC, kChildMemory + 1);
        ::close(end);
        end = higher;
    }
    return {ends[0], ends[1]};
}

class ProcessBackend final : public RenderBackend {
public:
    explicit ProcessBackend(const WorkerProcessOptions& options) : options_(options) {
        const auto [ours, theirs] = make_sockets();
        channel_.emplace(ours);
        const int memory = ::fcntl(memory_.fd(), F_DUPFD_CLOEXEC, kChildMemory + 1);
        try {
            child_.emplace(options, theirs, memory);
        } catch (...) {
            ::close(theirs);
            ::close(memory);
            throw;
        }
        ::close(theirs);
        ::close(memory);
        const Message message = wait_for(options.start_time, "did not start in time");
        if (message.kind == Kind::broken) throw DeviceError(message.bytes);
        const auto device = message.kind == Kind::device ? device_of(message.bytes) : std::nullopt;
        if (!device) throw lost("said something else than what device it has");
        device_ = *device;
    }

    ~ProcessBackend() override {
        channel_.reset();
        child_->wait(options_.stop_time);
    }

    RenderResult render(const Scene& scene, const StopCheck& stop) override {
        if (!channel_->send(Kind::render, normal_form(scene))) throw lost("could not be told what to render");
        const Message message = wait_for(options_.silence, "did not say a word for too long", stop);
        ++renders_;
        if (message.kind == Kind::stopped) throw RenderStopped();
        if (message.kind == Kind::failed) throw DeviceError(message.bytes);
        auto report = message.kind == Kind::picture ? report_of(message.bytes) : std::nullopt;
        auto result = report ? make_result(report->picture) : std::nullopt;
        if (!result || !memory_.read(pixels_of(*result), report->picture.bytes)) throw lost("gave something else than a picture");
        result->stats = std::move(report->stats);
        if (report->picture.bytes > kKeptMemory) memory_.clear();
        memory_bytes_ = report->memory_bytes;
        return std::move(*result);
    }

    std::string self_test() override {
        if (!channel_->send(Kind::test)) throw lost("could not be told to test itself");
        const Message message = wait_for(options_.start_time, "did not end its self test in time");
        if (message.kind != Kind::tested) throw lost("gave something else than the result of its test");
        return message.bytes;
    }

    std::uint64_t slices() const override { return slices_; }
    const DeviceInfo& device() const override { return device_; }

    std::string worn_out() override {
        if (const std::string end = child_->ended(); !end.empty()) return name() + " " + end + ".";
        if (options_.most_memory_bytes > 0 && memory_bytes_ > options_.most_memory_bytes) {
            return name() + " uses " + std::to_string(memory_bytes_ >> 20) + " MiB.";
        }
        if (options_.most_renders > 0 && renders_ >= options_.most_renders) {
            return name() + " has rendered " + std::to_string(renders_) + " times.";
        }
        return "";
    }

private:
    std::string name() const { return "The worker process " + std::to_string(child_->pid()); }

    // Whatever it does now, nobody waits for it.
    BackendLost lost(const std::string& why) {
        const std::string end = child_->ended();
        child_->kill();
        return BackendLost(name() + " " + (end.empty() ? why : end) + ".");
    }

    // The next message that is no pulse. Each pulse begins the silence anew.
    Message wait_for(milliseconds silence, const char* why_lost, const StopCheck& stop = {}) {
        Clock::time_point heard = Clock::now();
        std::optional<Clock::time_point> told;
        for (;;) {
            Message message;
            const Channel::Result result = channel_->receive(message, kLookUp);
            if (result == Channel::Result::message && message.kind != Kind::pulse) return message;
            const Clock::time_point now = Clock::now();
            if (result == Channel::Result::message) {
                heard = now;
                // What is believed of it: a number, or none.
                const char* end = message.bytes.data() + message.bytes.size();
                std::uint64_t slices = 0;
                if (std::from_chars(message.bytes.data(), end, slices).ptr == end) slices_ = slices;
            }
            if (result == Channel::Result::closed) {
                child_->wait(milliseconds(200));  // so that it can be said how it ended
                throw lost("closed its connection");
            }
            if (!child_->ended().empty()) throw lost("");
            if (now - heard > silence) throw lost(why_lost);
            if (!told && stop && stop()) {
                channel_->send(Kind::stop);
                told = now;
            }
            if (told && now - *told > options_.stop_time) {
                // That it does not listen is no fault of a render that nobody wants.
                child_->kill();
                throw RenderStopped();
            }
        }
    }

    const WorkerProcessOptions options_;
    SharedMemory memory_;
    std::optional<Channel> channel_;
    std::optional<Child> child_;
    DeviceInfo device_;
    std::size_t memory_bytes_ = 0;
    std::uint64_t renders_ = 0;
    std::uint64_t slices_ = 0;
};

}  // namespace

std::unique_ptr<RenderBackend> make_process_backend(const WorkerProcessOptions& options) {
    return std::make_unique<ProcessBackend>(options);
}

}  // namespace penumbra
