// SPDX-License-Identifier: MIT
// Workers and a real Redis: what is done, taken over, given up; with workers killed, stopped and told to end.
#include <gmock/gmock.h>
#include <signal.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <thread>

#include <httplib.h>

#include "../http/process.h"
#include "server/redis/job_stream.h"

namespace penumbra::test {
namespace {

using std::chrono::milliseconds;
using std::chrono::seconds;
using Clock = std::chrono::steady_clock;
using testing::HasSubstr;

std::string scene_of(int number, double red = 0.5) {
    return R"({"version": 1, "canvas": {"width": 40, "height": 30, "margin": )" + std::to_string(number) + R"(}, "sky": {"radiance": [)" +
           std::to_string(red) + ", 0, 0]}}";
}

// The sky's red that makes the fake renderer take so long.
double takes(int ms) { return 100 + ms / 10.0; }
constexpr double kKillsItsProcess = 14;

bool is_whole_png(const std::string& bytes) {
    return bytes.starts_with("\x89PNG\r\n\x1a\n") && bytes.ends_with(std::string("IEND\xae\x42\x60\x82"));
}

class Batch : public testing::Test {
protected:
    void SetUp() override {
        if (std::string(REDIS_SERVER).empty()) GTEST_SKIP() << "there is no redis-server (Debian: redis-server; scripts/setup installs it)";
        std::filesystem::create_directories(folder.path("data"));
        start_redis();
    }

    void start_redis() {
        server = std::make_unique<Running>(REDIS_SERVER, std::vector<std::string>{"--port", "0", "--unixsocket", socket(), "--dir", folder.path("data"), "--save", "",
                                                                                  "--appendonly", "yes", "--appendfsync", "always"});
        for (const auto end = Clock::now() + seconds(30);; std::this_thread::sleep_for(milliseconds(20))) {
            try {
                redis = std::make_unique<Redis>(std::get<RedisAddress>(parse_redis_url(url())));
                redis->command({"PING"});
                return;
            } catch (const std::exception& error) {
                ASSERT_LT(Clock::now(), end) << error.what() << read_file(folder.path("data/log"));
            }
        }
    }

    std::string socket() const { return folder.path("redis.sock"); }
    std::string url() const { return "redis+unix://" + socket(); }
    std::string out(const std::string& name = "") const { return folder.path("out") + (name.empty() ? "" : "/" + name); }

    // A worker that comes back to what was abandoned after 0.4 s.
    std::unique_ptr<Running> worker(const std::vector<std::string>& more = {}, const std::string& program = PENUMBRA_FAKE_PROGRAM) {
        std::vector<std::string> arguments = {"worker", "--redis", url(), "--workers", "1", "--abandoned-after", "0.4"};
        if (std::find(more.begin(), more.end(), "--put") == more.end()) arguments.insert(arguments.end(), {"-o", out()});
        arguments.insert(arguments.end(), more.begin(), more.end());
        return std::make_unique<Running>(program, arguments);
    }

    std::string submit(const std::string& name, const std::string& scene, StreamFields more = {}) {
        StreamFields fields = {{"scene", scene}, {"name", name}};
        fields.insert(fields.end(), more.begin(), more.end());
        return submit_job(*redis, {}, fields);
    }

    std::size_t left() { return std::size_t(redis->command({"XLEN", "penumbra"}).number); }
    std::size_t in_hand() { return std::size_t(redis->command({"XPENDING", "penumbra", "penumbra"}).at(0).number); }

    template <class Condition>
    bool wait_until(const Condition& condition, seconds patience = seconds(60)) {
        for (const auto end = Clock::now() + patience; Clock::now() < end; std::this_thread::sleep_for(milliseconds(10))) {
            if (condition()) return true;
        }
        return false;
    }

    // Notes of the streams of the done and the dead.
    std::vector<std::map<std::string, std::string>> notes(const std::string& stream) {
        std::vector<std::map<std::string, std::string>> found;
        const RedisReply range = redis->command({"XRANGE", stream, "-", "+"});
        for (const RedisReply& entry : range.list) {
            std::map<std::string, std::string> fields;
            const auto& list = entry.at(1).list;
            for (std::size_t i = 0; i + 1 < list.size(); i += 2) fields[list[i].text] = list[i + 1].text;
            found.push_back(fields);
        }
        return found;
    }

    // Nothing but these pictures, all of them whole.
    void expect_pictures(const std::set<std::string>& names) {
        std::set<std::string> found;
        for (const auto& entry : std::filesystem::recursive_directory_iterator(out())) {
            if (!entry.is_regular_file()) continue;
            const std::string name = std::filesystem::relative(entry.path(), out());
            found.insert(name);
            EXPECT_TRUE(is_whole_png(read_file(entry.path()))) << name;
        }
        EXPECT_EQ(found, names);
    }

    TemporaryFolder folder;
    std::unique_ptr<Running> server;
    std::unique_ptr<Redis> redis;
};

TEST_F(Batch, JobsBecomeFilesAndNotes) {
    std::set<std::string> names;
    for (int i = 0; i < 10; ++i) {
        names.insert("shot/" + std::to_string(i) + ".png");
        submit("shot/" + std::to_string(i) + ".png", scene_of(i), {{"customer", "x"}});
    }
    const auto one = worker(), two = worker({"--workers", "2"});
    ASSERT_TRUE(wait_until([&] { return left() == 0; })) << one->err();
    expect_pictures(names);
    const auto done = notes("penumbra:done");
    ASSERT_EQ(done.size(), 10u);
    for (auto note : done) {
        EXPECT_TRUE(names.contains(note["name"]));
        EXPECT_EQ(note["bytes"], std::to_string(std::filesystem::file_size(out(note["name"]))));
        EXPECT_EQ(note["customer"], "x");  // handed on
        EXPECT_EQ(note["deliveries"], "1");
        EXPECT_EQ(note["format"], "png");
        EXPECT_FALSE(note.contains("scene"));
    }
    EXPECT_EQ(in_hand(), 0u);
    EXPECT_TRUE(notes("penumbra:dead").empty());
}

TEST_F(Batch, AJobWithoutANameIsCalledByItsNumberAndFormat) {
    const std::string id = submit_job(*redis, {}, {{"scene", scene_of(1)}, {"format", "pfm"}, {"set", "/canvas/width=8"}, {"set", "/canvas/height=2"}});
    const auto one = worker();
    ASSERT_TRUE(wait_until([&] { return left() == 0; })) << one->err();
    EXPECT_THAT(read_file(out(id + ".pfm")), testing::StartsWith("PF\n8 2\n"));
}

TEST_F(Batch, WhatCanNeverGoWellIsDeadAtOnce) {
    submit("bad.png", R"({"version": 1, "canvas": {"width": 0, "height": 3}})");
    submit("text.png", "{");
    submit("../escape.png", scene_of(1));
    submit_job(*redis, {}, {{"name", "empty.png"}});
    submit("format.png", scene_of(1), {{"format", "gif"}});
    submit("put.png", scene_of(1), {{"put", "http://169.254.169.254/"}});
    submit("set.png", scene_of(1), {{"set", "width=3"}});
    submit("good.png", scene_of(2));
    const auto one = worker();
    ASSERT_TRUE(wait_until([&] { return left() == 0; })) << one->err();
    expect_pictures({"good.png"});
    const auto dead = notes("penumbra:dead");
    ASSERT_EQ(dead.size(), 7u);
    std::map<std::string, std::map<std::string, std::string>> by_name;
    for (auto note : dead) {
        EXPECT_EQ(note["deliveries"], "1") << note["reason"];
        by_name[note["name"]] = note;
    }
    EXPECT_THAT(by_name["bad.png"]["reason"], HasSubstr("/canvas/width"));
    EXPECT_THAT(by_name["bad.png"]["problems"], HasSubstr("out_of_range"));
    EXPECT_THAT(by_name["bad.png"]["scene"], HasSubstr("\"width\": 0"));  // to be mended and sent again
    EXPECT_THAT(by_name["../escape.png"]["reason"], HasSubstr("no name of a result"));
    EXPECT_THAT(by_name["put.png"]["reason"], HasSubstr("does not put"));
    EXPECT_THAT(by_name["set.png"]["reason"], HasSubstr("set takes"));
}

TEST_F(Batch, WorkersKilledWhileTheyRenderLoseNothing) {
    constexpr int kJobs = 60;
    std::set<std::string> names;
    for (int i = 0; i < kJobs; ++i) {
        names.insert(std::to_string(i) + ".png");
        submit(std::to_string(i) + ".png", scene_of(i, takes(60)));
    }
    std::vector<std::unique_ptr<Running>> workers;
    for (int i = 0; i < 3; ++i) workers.push_back(worker({"--tries", "100"}));
    int killed = 0;
    const auto end = Clock::now() + seconds(120);
    while (left() > 0 && Clock::now() < end) {
        std::this_thread::sleep_for(milliseconds(150));
        auto& victim = workers[std::size_t(killed++) % workers.size()];
        victim->signal(SIGKILL);
        victim->wait();
        victim = worker({"--tries", "100"});
    }
    EXPECT_EQ(left(), 0u) << workers[0]->err();
    EXPECT_GE(killed, 3);
    expect_pictures(names);
    std::multiset<std::string> done;
    for (auto note : notes("penumbra:done")) done.insert(note["name"]);
    EXPECT_EQ(done.size(), std::size_t(kJobs));  // each once
    EXPECT_EQ(std::set<std::string>(done.begin(), done.end()), names);
    EXPECT_TRUE(notes("penumbra:dead").empty());
    std::printf("%d jobs, %d workers killed\n", kJobs, killed);
}

TEST_F(Batch, ALongRenderIsNotTakenAway) {
    submit("long.png", scene_of(1, takes(2500)));
    const auto one = worker(), two = worker();  // six times as long as an abandoned job is waited for
    ASSERT_TRUE(wait_until([&] { return left() == 0; })) << one->err();
    const auto done = notes("penumbra:done");
    ASSERT_EQ(done.size(), 1u);
    EXPECT_EQ(done[0].at("deliveries"), "1");
}

TEST_F(Batch, AStoppedWorkerIsTakenOverAndDoesNoHarmWhenItGoesOn) {
    submit("a.png", scene_of(1, takes(1000)));
    const auto stopped = worker();
    ASSERT_TRUE(wait_until([&] { return in_hand() == 1; })) << stopped->err();
    stopped->signal(SIGSTOP);
    const auto other = worker();
    ASSERT_TRUE(wait_until([&] { return left() == 0; })) << other->err();
    stopped->signal(SIGCONT);
    ASSERT_TRUE(wait_until([&] { return stopped->err().find("done by another") != std::string::npos; })) << stopped->err();
    expect_pictures({"a.png"});
    EXPECT_EQ(notes("penumbra:done").size(), 1u);
    EXPECT_EQ(notes("penumbra:done")[0].at("deliveries"), "2");
}

TEST_F(Batch, AJobThatKillsItsRendererIsDeadAfterSoManyTries) {
    submit("poison.png", scene_of(1, kKillsItsProcess));
    submit("good.png", scene_of(2));
    const auto one = worker({"--tries", "2"});
    ASSERT_TRUE(wait_until([&] { return left() == 0; })) << one->err();
    expect_pictures({"good.png"});
    const auto dead = notes("penumbra:dead");
    ASSERT_EQ(dead.size(), 1u);
    EXPECT_EQ(dead[0].at("deliveries"), "2");
    EXPECT_THAT(dead[0].at("reason"), HasSubstr("signal"));
}

TEST_F(Batch, AJobThatEndsWholeWorkersIsDeadAsWell) {
    submit("a.png", scene_of(1, takes(60'000)));
    for (int i = 0; i < 2; ++i) {
        const auto victim = worker({"--tries", "2"});
        ASSERT_TRUE(wait_until([&] {
            const RedisReply pending = redis->command({"XPENDING", "penumbra", "penumbra", "-", "+", "1"});
            return pending.at(0).at(3).number == i + 1;
        })) << victim->err();
        victim->signal(SIGKILL);
    }
    const auto last = worker({"--tries", "2"});
    ASSERT_TRUE(wait_until([&] { return left() == 0; })) << last->err();
    ASSERT_EQ(notes("penumbra:dead").size(), 1u);
    EXPECT_THAT(notes("penumbra:dead")[0].at("reason"), HasSubstr("no worker came back"));
}

TEST_F(Batch, SigtermFinishesWhatIsUnderWayAndTakesNoMore) {
    for (int i = 0; i < 3; ++i) submit(std::to_string(i) + ".png", scene_of(i, takes(700)));
    const auto one = worker();
    ASSERT_TRUE(wait_until([&] { return in_hand() == 1; })) << one->err();
    one->signal(SIGTERM);
    EXPECT_EQ(one->wait(), 0);
    expect_pictures({"0.png"});
    EXPECT_EQ(left(), 2u);
    EXPECT_EQ(in_hand(), 0u);
    EXPECT_TRUE(redis->command({"XINFO", "CONSUMERS", "penumbra", "penumbra"}).list.empty());  // its name is given back
}

TEST_F(Batch, ASecondSigtermLeavesTheJobToOthers) {
    submit("a.png", scene_of(1, takes(8000)));
    const auto one = worker();
    ASSERT_TRUE(wait_until([&] { return in_hand() == 1; })) << one->err();
    one->signal(SIGTERM);
    std::this_thread::sleep_for(milliseconds(300));
    one->signal(SIGTERM);
    EXPECT_EQ(one->wait(), 1);
    const auto two = worker();
    ASSERT_TRUE(wait_until([&] { return left() == 0; })) << two->err();
    expect_pictures({"a.png"});
}

TEST_F(Batch, ARenderThatOutlastsTheShutdownIsLeftToOthers) {
    submit("a.png", scene_of(1, takes(4000)));
    const auto one = worker({"--shutdown-timeout", "1"});
    ASSERT_TRUE(wait_until([&] { return in_hand() == 1; })) << one->err();
    one->signal(SIGTERM);
    EXPECT_EQ(one->wait(), 0);
    EXPECT_EQ(left(), 1u);
    const auto two = worker();
    ASSERT_TRUE(wait_until([&] { return left() == 0; })) << two->err();
}

TEST_F(Batch, ARedisThatGoesAndComesIsWaitedFor) {
    const auto one = worker();
    submit("a.png", scene_of(1));
    ASSERT_TRUE(wait_until([&] { return left() == 0; })) << one->err();
    redis.reset();
    server->signal(SIGKILL);
    server->wait();
    std::this_thread::sleep_for(milliseconds(800));
    start_redis();
    submit("b.png", scene_of(2));
    ASSERT_TRUE(wait_until([&] { return left() == 0; })) << one->err();
    expect_pictures({"a.png", "b.png"});
    EXPECT_THAT(one->err(), HasSubstr("no Redis"));
}

TEST_F(Batch, AStreamThatWasDeletedIsMadeAnew) {
    const auto one = worker();
    submit("a.png", scene_of(1));
    ASSERT_TRUE(wait_until([&] { return left() == 0; })) << one->err();
    redis->command({"DEL", "penumbra"});
    submit("b.png", scene_of(2));
    ASSERT_TRUE(wait_until([&] { return std::filesystem::exists(out("b.png")); })) << one->err();
}

// A store that takes PUT.
class Store {
public:
    Store() {
        server_.Put(".*", [this](const httplib::Request& request, httplib::Response& response) {
            const std::lock_guard lock(mutex_);
            response.status = answers_.empty() ? 200 : answers_.front();
            if (!answers_.empty()) answers_.erase(answers_.begin());
            targets_.push_back(request.target);
            types_.push_back(request.get_header_value("Content-Type"));
            if (response.status == 200) bodies_[request.path] = request.body;
        });
        port_ = server_.bind_to_any_port("127.0.0.1");
        thread_ = std::thread([this] { server_.listen_after_bind(); });
    }
    ~Store() {
        server_.stop();
        thread_.join();
    }
    std::string url(const std::string& rest) const { return "http://127.0.0.1:" + std::to_string(port_) + rest; }
    void answer(std::vector<int> statuses) {
        const std::lock_guard lock(mutex_);
        answers_ = std::move(statuses);
    }
    std::string body(const std::string& path) {
        const std::lock_guard lock(mutex_);
        return bodies_[path];
    }
    std::vector<std::string> targets() {
        const std::lock_guard lock(mutex_);
        return targets_;
    }
    std::vector<std::string> types() {
        const std::lock_guard lock(mutex_);
        return types_;
    }

private:
    httplib::Server server_;
    std::mutex mutex_;
    std::vector<int> answers_;
    std::vector<std::string> targets_, types_;
    std::map<std::string, std::string> bodies_;
    int port_ = 0;
    std::thread thread_;
};

TEST_F(Batch, ResultsArePutAndTriedAgain) {
    Store store;
    store.answer({503, 500});
    submit("shots/a.png", scene_of(1));
    const std::string signed_url = store.url("/bucket/b.png?X-Amz-Signature=ab%2Fc%3D&X-Amz-Date=20221122T0000Z");
    const auto one = worker({"--put", store.url("/bucket/")});
    ASSERT_TRUE(wait_until([&] { return left() == 0; })) << one->err();
    EXPECT_TRUE(is_whole_png(store.body("/bucket/shots/a.png")));
    EXPECT_EQ(store.targets().size(), 3u);
    EXPECT_EQ(store.types()[0], "image/png");
    submit("b", scene_of(2), {{"put", signed_url}});
    ASSERT_TRUE(wait_until([&] { return left() == 0; })) << one->err();
    EXPECT_TRUE(is_whole_png(store.body("/bucket/b.png")));
    EXPECT_EQ(store.targets().back(), signed_url.substr(signed_url.find("/bucket")));  // as it was signed
    EXPECT_EQ(one->err().find("Signature"), std::string::npos);
    // What the store refuses is dead at once; where it may not put, it does not.
    store.answer({403});
    submit("c.png", scene_of(3));
    submit("d.png", scene_of(4), {{"put", store.url("/other/d.png")}});
    ASSERT_TRUE(wait_until([&] { return left() == 0; })) << one->err();
    const auto dead = notes("penumbra:dead");
    ASSERT_EQ(dead.size(), 2u);
    EXPECT_THAT(dead[0].at("reason"), HasSubstr("answered 403"));
    EXPECT_THAT(dead[1].at("reason"), HasSubstr("does not put"));
}

TEST_F(Batch, SubmitChecksNamesAndWaits) {
    const std::string good = folder.write("one.json", scene_of(1)), bad = folder.write("bad.json", R"({"version": 2})");
    const auto submit_files = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(), {"submit", "--redis", url()});
        return run_program(PENUMBRA_FAKE_PROGRAM, arguments);
    };
    const Finished refused = submit_files({good, bad});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_THAT(refused.err, HasSubstr("bad.json"));
    EXPECT_EQ(left(), 0u);  // all or none
    EXPECT_EQ(submit_files({good, "--name", "../x.png"}).exit_code, 2);
    EXPECT_EQ(submit_files({good, "--format", "gif"}).exit_code, 2);
    const auto one = worker();
    const Finished waited = submit_files({good, "--folder", "batch", "--set", "/canvas/width=12", "--wait"});
    EXPECT_EQ(waited.exit_code, 0) << waited.err;
    EXPECT_THAT(waited.out, HasSubstr("one.json done batch/one.png"));
    expect_pictures({"batch/one.png"});
    EXPECT_EQ(read_file(out("batch/one.png")).substr(16, 4), std::string("\0\0\0\x0c", 4));
    // The sky (13, 0, 0) makes each render fail.
    const std::string failing = folder.write("failing.json", scene_of(1, 13));
    const Finished dead = submit_files({failing, "--wait"});
    EXPECT_EQ(dead.exit_code, 1);
    EXPECT_THAT(dead.err, HasSubstr("failing.json"));
}

TEST_F(Batch, TheCommandLineIsChecked) {
    const auto run = [&](const std::vector<std::string>& arguments) { return run_program(PENUMBRA_FAKE_PROGRAM, arguments); };
    EXPECT_EQ(run({"worker", "-o", out()}).exit_code, 2);
    EXPECT_EQ(run({"worker", "--redis", url()}).exit_code, 2);
    EXPECT_EQ(run({"worker", "--redis", url(), "-o", out(), "--put", "http://h/"}).exit_code, 2);
    EXPECT_EQ(run({"worker", "--redis", "http://h", "-o", out()}).exit_code, 2);
    EXPECT_EQ(run({"worker", "--redis", url(), "--put", "s3://bucket/"}).exit_code, 2);
    redis->command({"SET", "text", "x"});
    const Finished wrong = run({"worker", "--redis", url(), "--stream", "text", "-o", out()});
    EXPECT_EQ(wrong.exit_code, 1);
    EXPECT_THAT(wrong.err, HasSubstr("Redis refuses"));
}

#ifdef PENUMBRA_PROGRAM
// The real renderer.
TEST_F(Batch, RealPictures) {
    if (!std::filesystem::exists(PENUMBRA_PROGRAM)) GTEST_SKIP() << "the program is not built";
    const std::string scene = R"({"version": 1, "canvas": {"width": 64, "height": 64}, "shapes": [
        {"type": "circle", "center": [20, 32], "radius": 6, "emission": 2}, {"type": "rect", "center": [44, 32], "size": [6, 30]}]})";
    submit("real.png", scene);
    const auto one = worker({"--device", "cpu"}, PENUMBRA_PROGRAM);
    ASSERT_TRUE(wait_until([&] { return left() == 0; }, seconds(120))) << one->err();
    const TemporaryFolder other;
    const Finished rendered = run_program(PENUMBRA_PROGRAM, {"render", "-", "-o", other.path("real.png"), "--device", "cpu"}, scene);
    ASSERT_EQ(rendered.exit_code, 0) << rendered.err;
    EXPECT_EQ(read_file(out("real.png")), read_file(other.path("real.png")));  // the same bytes
}
#endif

}  // namespace
}  // namespace penumbra::test
