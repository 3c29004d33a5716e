// SPDX-License-Identifier: MIT
// Renderers in processes of their own, and what happens to these.
#include <gmock/gmock.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <future>
#include <thread>

#include "core/scene/normal_form.h"
#include "process.h"
#include "server/worker/channel.h"
#include "server/worker/process_backend.h"
#include "server/worker/wire.h"
#include "server_fixture.h"

namespace penumbra::test {
namespace {

using std::chrono::milliseconds;
using testing::HasSubstr;
using Clock = std::chrono::steady_clock;

WorkerProcessOptions options(const Environment& environment = {}) {
    WorkerProcessOptions made;
    made.program = PENUMBRA_FAKE_PROGRAM;
    made.arguments = {"worker-process"};
    made.environment = environment;
    made.silence = milliseconds(30'000);
    made.stop_time = milliseconds(20'000);
    return made;
}

Scene scene_of(double red, const std::string& format = "png") {
    Scene scene;
    scene.canvas.width = 40;
    scene.canvas.height = 30;
    scene.sky.radiance = Colour(red, 0, 0);
    scene.output.format = format;
    return scene;
}

std::string json_of(double red, int width = 40) {
    return R"({"version": 1, "canvas": {"width": )" + std::to_string(width) + R"(, "height": 30}, "sky": {"radiance": [)" +
           std::to_string(red) + ", 0, 0]}}";
}

template <class Work>
std::string lost_by(const Work& work) {
    try {
        work();
    } catch (const BackendLost& error) {
        return error.what();
    } catch (const std::exception& error) {
        return std::string("not lost: ") + error.what();
    }
    return "nothing thrown";
}

template <class Condition>
bool within(milliseconds time, const Condition& condition) {
    const Clock::time_point end = Clock::now() + time;
    while (!condition()) {
        if (Clock::now() > end) return false;
        std::this_thread::sleep_for(milliseconds(10));
    }
    return true;
}

// Bounds are for a machine that others use as well; docs/reliability.md has what was measured.

// ---- one process

TEST(WorkerProcess, RendersWhatTheRendererRenders) {
    const Engine engine = fake_engine(std::make_shared<FakeControl>());
    const auto here = engine.make_backend({});
    const auto there = make_process_backend(options());
    EXPECT_EQ(there->device().renderer, here->device().renderer);
    EXPECT_EQ(there->device().max_texture_side, here->device().max_texture_side);
    EXPECT_EQ(there->self_test(), "");
    for (const char* format : {"png", "pfm"}) {
        for (const double red : {0.0, 0.5}) {
            const RenderResult a = here->render(scene_of(red, format), {}), b = there->render(scene_of(red, format), {});
            ASSERT_EQ(a.picture.index(), b.picture.index());
            std::visit([&](const auto& picture) {
                using Picture = std::decay_t<decltype(picture)>;
                EXPECT_TRUE(picture.data == std::get<Picture>(b.picture).data);
                EXPECT_EQ(std::get<Picture>(b.picture).width, 40);
            }, a.picture);
            ASSERT_EQ(b.stats.passes.size(), 2u);
            EXPECT_EQ(b.stats.passes[1].name, "cascade 0");
            EXPECT_EQ(b.stats.passes[1].rays, 64u);
            EXPECT_EQ(b.stats.skipped[0].why, "the scene asks for none");
            EXPECT_EQ(b.stats.total_ms, 2);
        }
    }
    EXPECT_EQ(there->worn_out(), "");
}

TEST(WorkerProcess, AnExceptionCostsNothing) {
    const auto backend = make_process_backend(options());
    for (int i = 0; i < 3; ++i) {
        try {
            backend->render(scene_of(13), {});
            ADD_FAILURE();
        } catch (const BackendLost& error) {
            ADD_FAILURE() << error.what();
        } catch (const DeviceError& error) {
            EXPECT_EQ(std::string(error.what()), kThrownSecret);
        }
        EXPECT_NO_THROW(backend->render(scene_of(0), {}));
    }
}

TEST(WorkerProcess, ItsEndIsNoticedAtOnceAndNamed) {
    for (const int signal : {SIGKILL, SIGSEGV, SIGSTOP}) {
        // The address sanitizer would take the signal for itself.
        const auto backend = make_process_backend(options({{"ASAN_OPTIONS", "handle_segv=0"}}));
        const std::vector<pid_t> children = children_of(::getpid());
        ASSERT_EQ(children.size(), 1u);
        auto killer = std::async(std::launch::async, [&] {
            std::this_thread::sleep_for(milliseconds(200));
            ::kill(children[0], signal);
            return Clock::now();
        });
        const std::string why = lost_by([&] { backend->render(scene_of(3100), {}); });
        EXPECT_LT(Clock::now() - killer.get(), milliseconds(8000)) << signal << ", of a render of 30 s";
        EXPECT_THAT(why, HasSubstr("signal " + std::to_string(signal)));
        EXPECT_TRUE(within(milliseconds(8000), [] { return children_of(::getpid()).empty(); }));
        EXPECT_NE(backend->worn_out(), "");
        EXPECT_THAT(lost_by([&] { backend->render(scene_of(0), {}); }), HasSubstr("signal"));
    }
}

TEST(WorkerProcess, ItsEndWhileIdleIsTold) {
    const auto backend = make_process_backend(options());
    ::kill(children_of(::getpid()).at(0), SIGKILL);
    EXPECT_TRUE(within(milliseconds(15'000), [&] { return backend->worn_out().find("signal 9") != std::string::npos; }));
}

TEST(WorkerProcess, OneThatHangsIsKilled) {
    WorkerProcessOptions impatient = options();
    impatient.silence = milliseconds(400);
    const auto backend = make_process_backend(impatient);
    const Clock::time_point start = Clock::now();
    EXPECT_THAT(lost_by([&] { backend->render(scene_of(15), {}); }), HasSubstr("did not say a word"));
    EXPECT_LT(Clock::now() - start, milliseconds(9000));
    EXPECT_TRUE(children_of(::getpid()).empty());
}

TEST(WorkerProcess, ALongRenderIsNoHang) {
    WorkerProcessOptions impatient = options();
    impatient.silence = milliseconds(3000);
    EXPECT_NO_THROW(make_process_backend(impatient)->render(scene_of(100 + 450), {})) << "it has a pulse";
}

TEST(WorkerProcess, StopsWhenItIsTold) {
    auto backend = make_process_backend(options());
    const std::vector<pid_t> before = children_of(::getpid());
    for (int i = 0; i < 3; ++i) {
        const Clock::time_point start = Clock::now();
        EXPECT_THROW(backend->render(scene_of(3100), [&] { return Clock::now() - start > milliseconds(50); }), RenderStopped);
        EXPECT_LT(Clock::now() - start, milliseconds(15'000)) << "of a render of 30 s";
        EXPECT_NO_THROW(backend->render(scene_of(0), {}));
    }
    EXPECT_EQ(children_of(::getpid()), before) << "the same process goes on";
    // One that hears nothing is killed.
    WorkerProcessOptions impatient = options();
    impatient.stop_time = milliseconds(300);
    backend = make_process_backend(impatient);
    const Clock::time_point start = Clock::now();
    EXPECT_THROW(backend->render(scene_of(15), [] { return true; }), RenderStopped);
    EXPECT_LT(Clock::now() - start, milliseconds(9000));
    EXPECT_NE(backend->worn_out(), "");
}

TEST(WorkerProcess, WearsOutByRendersAndByMemory) {
    WorkerProcessOptions bounded = options();
    bounded.most_renders = 2;
    auto backend = make_process_backend(bounded);
    backend->render(scene_of(0), {});
    EXPECT_EQ(backend->worn_out(), "");
    backend->render(scene_of(0), {});
    EXPECT_THAT(backend->worn_out(), HasSubstr("has rendered 2 times"));
    bounded = options();
    bounded.most_memory_bytes = 1 << 20;  // less than any process has
    backend = make_process_backend(bounded);
    EXPECT_EQ(backend->worn_out(), "");
    backend->render(scene_of(0), {});
    EXPECT_THAT(backend->worn_out(), HasSubstr("MiB"));
}

TEST(WorkerProcess, OneThatCannotStartSaysWhy) {
    const auto why = [](const WorkerProcessOptions& with) {
        try {
            make_process_backend(with);
        } catch (const DeviceError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    EXPECT_EQ(why(options({{"FAKE_START_ERROR", "There is no device."}})), "There is no device.");
    WorkerProcessOptions other = options();
    other.program = "/no/such/program";
    EXPECT_THAT(why(other), HasSubstr("No such file"));
    other.program = "/bin/true";
    EXPECT_THAT(why(other), HasSubstr("exit code 0"));
    EXPECT_TRUE(within(milliseconds(8000), [] { return children_of(::getpid()).empty(); }));
}

// ---- what goes over the wire

TEST(Wire, AHeadThatLiesIsRefused) {
    RenderResult result;
    result.picture = Image8(5, 4, 3);
    const PictureHead head = head_of(result);
    EXPECT_TRUE(make_result(head));
    for (const auto& lie : std::vector<std::function<void(PictureHead&)>>{
             [](PictureHead& h) { h.kind = 99; }, [](PictureHead& h) { h.width = 0; }, [](PictureHead& h) { h.height = -1; },
             [](PictureHead& h) { h.channels = 5; }, [](PictureHead& h) { ++h.bytes; }, [](PictureHead& h) { h.kind = 1; },
             [](PictureHead& h) { h.width = 1 << 30; }}) {
        PictureHead wrong = head;
        lie(wrong);
        EXPECT_FALSE(make_result(wrong));
    }
}

TEST(Wire, CutAndDamagedBytesAreNoValue) {
    RenderReport report;
    report.stats.device = "x";
    report.stats.passes.push_back({"distance", 1, 2, 3, 4, 5, 6, 7, 8});
    const std::string bytes = to_bytes(report);
    ASSERT_TRUE(report_of(bytes));
    EXPECT_EQ(report_of(bytes)->stats.passes[0].cpu_ms, 8);
    for (std::size_t size = 0; size < bytes.size(); ++size) EXPECT_FALSE(report_of(std::string_view(bytes).substr(0, size)));
    EXPECT_FALSE(report_of(bytes + "x"));
    const std::string scene = normal_form(scene_of(1));
    for (std::size_t at = 0; at < scene.size(); ++at) {
        std::string damaged = scene;
        damaged[at] = char(damaged[at] ^ 0x55);
        read_normal_form(damaged);  // whatever comes out: no crash, no endless work
        EXPECT_FALSE(read_normal_form(std::string_view(scene).substr(0, at)));
    }
}

// ---- the service with such workers

struct Served {
    explicit Served(std::vector<std::string> more, const Environment& environment = {})
        : program(PENUMBRA_FAKE_PROGRAM, full(std::move(more)), environment), port(wait_for_port(folder.path("port"))) {
        EXPECT_TRUE(within(milliseconds(30'000), [&] { return ready()["status"] == "ready"; })) << program.err();
    }
    std::vector<std::string> full(std::vector<std::string> more) const {
        std::vector<std::string> all{"serve", "--port", "0", "--port-file", folder.path("port"), "--warm-up", "none"};
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    httplib::Client client() const {
        httplib::Client made("127.0.0.1", port);
        made.set_read_timeout(20);
        return made;
    }
    nlohmann::json ready() const {
        const auto result = client().Get("/readyz");
        return result ? nlohmann::json::parse(result->body, nullptr, false) : nlohmann::json();
    }
    httplib::Result post(const std::string& scene) const { return client().Post("/v1/render", scene, kJson); }

    TemporaryFolder folder;
    Running program;
    int port;
};

TEST(Workers, AreAsManyAsWasSaidAndEndWithTheService) {
    Served served({"--workers", "3"});
    EXPECT_EQ(children_of(served.program.pid()).size(), 3u);
    EXPECT_EQ(served.ready()["workers"], 3);
    EXPECT_EQ(served.post(json_of(0))->status, 200);
    const std::vector<pid_t> workers = children_of(served.program.pid());
    served.program.signal(SIGTERM);
    EXPECT_EQ(served.program.wait(), 0);
    for (const pid_t worker : workers) EXPECT_EQ(::kill(worker, 0), -1) << "it is gone";
}

TEST(Workers, EndWhenTheServiceIsKilled) {
    Served served({"--workers", "2"});
    const std::vector<pid_t> workers = children_of(served.program.pid());
    ASSERT_EQ(workers.size(), 2u);
    served.program.signal(SIGKILL);
    served.program.wait();
    EXPECT_TRUE(within(milliseconds(15'000), [&] {
        return std::all_of(workers.begin(), workers.end(), [](pid_t worker) {
            const std::string stat = read_file("/proc/" + std::to_string(worker) + "/stat");
            return stat.empty() || stat.find(") Z") != std::string::npos;
        });
    }));
}

// Clients ask without a pause while workers are ended in every way, in the middle of their renders.
TEST(Workers, WhenOneIsEndedNobodyNoticesAndAnotherOneComes) {
    Served served({"--workers", "2", "--queue", "64", "--cache-bytes", "0"});
    std::atomic<bool> ending{false};
    std::atomic<int> answers{0}, wrong{0};
    std::vector<std::thread> clients;
    for (int i = 0; i < 4; ++i) {
        clients.emplace_back([&, i] {
            for (int n = 0; !ending; ++n) {
                const auto result = served.post(json_of(103, 40 + 1000 * i + n));  // 30 ms
                ++answers;
                wrong += !result || result->status != 200;
            }
        });
    }
    int ended = 0;
    for (const int signal : {SIGKILL, SIGSEGV, SIGSTOP, SIGKILL}) {
        std::this_thread::sleep_for(milliseconds(300));
        const std::vector<pid_t> workers = children_of(served.program.pid());
        ASSERT_EQ(workers.size(), 2u);
        const pid_t victim = workers[std::size_t(ended) % 2];
        ::kill(victim, signal);
        ++ended;
        EXPECT_TRUE(within(milliseconds(15'000), [&] {
            const auto state = served.ready();
            return state["ready_workers"] == 2 && state["lost"].get<int>() + state["replaced"].get<int>() >= ended &&
                   std::count(workers.begin(), workers.end(), victim) == 1 &&
                   read_file("/proc/" + std::to_string(victim) + "/stat").empty();
        })) << "signal " << signal << " " << served.ready().dump() << served.program.err();
    }
    ending = true;
    for (std::thread& client : clients) client.join();
    EXPECT_EQ(wrong, 0) << "of " << answers;
    EXPECT_GT(answers, 4);
    EXPECT_THAT(served.program.err(), HasSubstr("was stopped by signal 19"));
}

TEST(Workers, ASceneThatEndsTwoIsRefusedFromThenOn) {
    Served served({"--workers", "2"});
    expect_problem(served.post(json_of(14)), 422, "scene-refused");
    EXPECT_TRUE(within(milliseconds(15'000), [&] { return served.ready()["ready_workers"] == 2; }));
    EXPECT_EQ(served.ready()["lost"], 2);
    for (const char* again : {R"({"version": 1, "canvas": {"width": 40, "height": 30}, "sky": {"radiance": [14, 0, 0]}})",
                              R"({"sky": {"radiance": [1.4e1, 0, 0]}, "canvas": {"height": 30, "width": 40}, "version": 1})"}) {
        expect_problem(served.post(again), 422, "scene-refused");
    }
    EXPECT_EQ(served.ready()["lost"], 2) << "it is not tried again";
    EXPECT_EQ(served.post(json_of(0))->status, 200);
    EXPECT_EQ(served.post(json_of(13))->status, 500) << "an exception is no crash";
    EXPECT_EQ(served.post(json_of(13))->status, 500);
}

TEST(Workers, OneThatHangsIsReplaced) {
    Served served({"--workers", "1", "--worker-silence", "1"});
    auto hanging = std::async(std::launch::async, [&] { return served.post(json_of(15)); });
    std::this_thread::sleep_for(milliseconds(200));
    const auto other = served.post(json_of(0));
    EXPECT_EQ(other->status, 200);
    expect_problem(hanging.get(), 422, "scene-refused");
}

TEST(Workers, WearOutWithoutAnybodyNoticing) {
    Served served({"--workers", "1", "--worker-renders", "5", "--cache-bytes", "0"});
    const std::vector<pid_t> first = children_of(served.program.pid());
    for (int n = 0; n < 23; ++n) EXPECT_EQ(served.post(json_of(0, 40 + n))->status, 200) << n;
    EXPECT_NE(children_of(served.program.pid()), first);
    EXPECT_EQ(served.ready()["lost"], 0);
    EXPECT_GE(served.ready()["replaced"], 4);
}

TEST(Workers, ADeadlineEndsARenderAndKeepsTheWorker) {
    Served served({"--workers", "1"});
    const std::vector<pid_t> before = children_of(served.program.pid());
    const auto result = served.client().Post("/v1/render", {{"Prefer", "wait=0.2"}}, json_of(3100), kJson);
    expect_problem(result, 504, "deadline-exceeded");
    EXPECT_EQ(served.post(json_of(0))->status, 200);
    EXPECT_EQ(children_of(served.program.pid()), before);
}

TEST(Workers, AtTheEndTheRestIsEndedInTime) {
    Served served({"--workers", "1", "--shutdown-timeout", "1"});
    auto answer = std::async(std::launch::async, [&] { return served.post(json_of(3100)); });
    std::this_thread::sleep_for(milliseconds(200));
    const Clock::time_point start = Clock::now();
    served.program.signal(SIGTERM);
    expect_problem(answer.get(), 503, "not-ready");
    EXPECT_EQ(served.program.wait(), 0);
    EXPECT_LT(Clock::now() - start, milliseconds(20'000)) << "of a render of 30 s";
}

TEST(Workers, WithoutADeviceTheServiceEndsWith1) {
    const TemporaryFolder folder;
    const Finished finished = run_program(PENUMBRA_FAKE_PROGRAM, {"serve", "--port", "0", "--workers", "2"}, "",
                                          {{"FAKE_START_ERROR", "There is no device."}});
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_THAT(finished.err, HasSubstr("penumbra: There is no device."));
}

}  // namespace
}  // namespace penumbra::test
