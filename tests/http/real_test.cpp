// SPDX-License-Identifier: MIT
// The real program with the real renderer, from end to end.
#include <gtest/gtest.h>
#include <signal.h>

#include <chrono>
#include <sstream>
#include <thread>

#include <httplib.h>
#include <nlohmann/json.hpp>

#include "core/image/codec.h"
#include "process.h"

namespace penumbra::test {
namespace {

const std::string kScene = R"({"version": 1, "canvas": {"width": 70, "height": 50}, "sky": {"radiance": 0.02},
  "shapes": [{"type": "circle", "center": [30, 25], "radius": 6, "emission": [4, 3, 2]},
             {"type": "rect", "center": [50, 25], "size": [4, 20], "albedo": 0.5}]})";

std::span<const std::uint8_t> bytes_of(const std::string& text) {
    return {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()};
}

// A cold compile of the shaders for each process is what a fresh machine does; here once is enough.
TEST(Real, CommandLineAndServiceGiveTheSameBytes) {
    const TemporaryFolder folder;
    Running program(PENUMBRA_PROGRAM, {"serve", "--port", "0", "--port-file", folder.path("port"), "--warm-up", "none"});
    const int port = wait_for_port(folder.path("port"));
    ASSERT_GT(port, 0) << program.err();
    httplib::Client client("127.0.0.1", port);
    client.set_read_timeout(60);

    for (const auto& [format, type] : {std::pair{"png", "image/png"}, std::pair{"pfm", "image/x-pfm"}, std::pair{"exr", "image/x-exr"},
                                       std::pair{"hdr", "image/vnd.radiance"}, std::pair{"npy", "application/x-npy"}}) {
        const auto served = client.Post("/v1/render", {{"Accept", type}}, kScene, "application/json");
        ASSERT_TRUE(served) << program.err();
        ASSERT_EQ(served->status, 200) << served->body;
        EXPECT_NE(served->get_header_value("Server-Timing").find("exact-points"), std::string::npos);
        const Finished rendered = run_program(PENUMBRA_PROGRAM, {"render", "-", "-o", "-", "--format", format}, kScene);
        ASSERT_EQ(rendered.exit_code, 0) << rendered.err;
        EXPECT_EQ(rendered.err, "");
        EXPECT_TRUE(rendered.out == served->body) << format;
        if (std::string(format) == "png") {
            const auto picture = decode_png(bytes_of(served->body));
            ASSERT_TRUE(std::holds_alternative<Texels>(picture));
            EXPECT_EQ(std::get<Texels>(picture).width, 70);
            EXPECT_EQ(std::get<Texels>(picture).height, 50);
        } else {
            const auto bytes = bytes_of(served->body);
            const auto picture = std::string(format) == "exr"   ? decode_exr(bytes)
                                 : std::string(format) == "hdr" ? decode_hdr(bytes)
                                 : std::string(format) == "npy" ? decode_npy(bytes)
                                                                : decode_pfm(bytes);
            ASSERT_TRUE(std::holds_alternative<ImageF>(picture)) << format;
            EXPECT_EQ(std::get<ImageF>(picture).width, 70) << format;
        }
    }
    const auto ready = client.Get("/readyz");
    ASSERT_TRUE(ready);
    EXPECT_EQ(ready->status, 200) << ready->body << program.err();
    const auto info = client.Get("/v1/info");
    ASSERT_TRUE(info);
    EXPECT_FALSE(nlohmann::json::parse(info->body)["device"]["renderer"].get<std::string>().empty());
    const auto lights = client.Post("/v1/render", R"({"version": 1, "canvas": {"width": 4, "height": 4},
      "render": {"bounces": 3}})", "application/json");
    ASSERT_TRUE(lights);
    EXPECT_TRUE(lights->status == 200 || lights->status == 422) << lights->body;

    program.signal(SIGTERM);
    EXPECT_EQ(program.wait(), 0) << program.err();
}

double timing_of(const httplib::Result& result, const std::string& name) {
    const std::string timing = result->get_header_value("Server-Timing");
    const std::size_t at = timing.find(name + ";dur=");
    return at == std::string::npos ? -1 : std::stod(timing.substr(at + name.size() + 5));
}

// With an empty shader cache, other methods in between: a driver that compiles again takes a quarter of a second and more.
TEST(Real, AfterTheWarmUpNothingIsCompiledForCommonScenes) {
    const TemporaryFolder folder;
    Running program(PENUMBRA_PROGRAM, {"serve", "--port", "0", "--port-file", folder.path("port")},
                    {{"MESA_SHADER_CACHE_DIR", folder.path("shaders")}});
    const int port = wait_for_port(folder.path("port"));
    ASSERT_GT(port, 0) << program.err();
    httplib::Client client("127.0.0.1", port);
    client.set_read_timeout(60);
    for (int i = 0; i < 6000 && client.Get("/readyz")->status != 200; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(20));
    const auto post = [&](int width, int height, const std::string& shapes, const std::string& rest = "") {
        return client.Post("/v1/render", {{"Cache-Control", "no-cache"}},
                           R"({"version": 1, "canvas": {"width": )" + std::to_string(width) + R"(, "height": )" +
                               std::to_string(height) + R"(}, "shapes": [)" + shapes + "]" + rest + "}",
                           "application/json");
    };
    const std::string disc = R"({"type": "circle", "center": [30, 25], "radius": 6, "emission": 1})";
    const std::string wall = R"({"type": "rect", "center": [50, 25], "size": [4, 20], "rotation": 3})";
    const std::string arcs = disc + R"(, {"type": "circle", "center": [38, 25], "radius": 7, "emission": 1})";
    const std::string sky = R"(, "sky": {"radiance": 0.2})";
    for (const auto& [width, height] : {std::pair{256, 128}, {200, 150}}) {
        for (const auto& [shapes, rest] : {std::pair{disc, std::string()}, {disc + ", " + wall, sky}, {arcs, std::string()}, {arcs, sky}}) {
            ASSERT_EQ(post(width, height, disc, R"(, "render": {"method": "hrc"})")->status, 200) << program.err();
            const auto first = post(width, height, shapes, rest), second = post(width, height, shapes, rest);
            ASSERT_TRUE(first && second);
            ASSERT_EQ(first->status, 200) << first->body;
            for (const char* pass : {"exact-lists", "exact-points-8", "exact-points-1", "compose"}) {
                EXPECT_GE(timing_of(first, pass), 0) << pass;
                EXPECT_LT(timing_of(first, pass), timing_of(second, pass) + 150)
                    << pass << " of " << width << " x " << height << shapes << rest;
            }
        }
    }
}

TEST(Real, EveryNameInServerTimingIsDescribed) {
    const std::string api = read_file(PENUMBRA_SOURCE_DIR "/docs/api.md");
    const TemporaryFolder folder;
    Running program(PENUMBRA_PROGRAM, {"serve", "--port", "0", "--port-file", folder.path("port"), "--warm-up", "none"});
    const int port = wait_for_port(folder.path("port"));
    ASSERT_GT(port, 0) << program.err();
    httplib::Client client("127.0.0.1", port);
    client.set_read_timeout(60);
    for (const char* render : {R"({"quality": "draft"})", R"({"skip": "none"})", R"({"method": "rc"})",
                               R"({"method": "hrc"})", R"({"method": "reference"})"}) {
        std::string scene = kScene;
        scene.insert(scene.rfind('}'), std::string(", \"render\": ") + render);
        const auto served = client.Post("/v1/render", scene, "application/json");
        ASSERT_TRUE(served) << program.err();
        ASSERT_EQ(served->status, 200) << served->body;
        std::istringstream timing(served->get_header_value("Server-Timing"));
        for (std::string entry; std::getline(timing >> std::ws, entry, ',');) {
            std::string name = entry.substr(0, entry.find(';'));
            if (name.starts_with("cascade-")) name = "cascade-0";
            if (name.starts_with("exact-points-")) name = "exact-points-8";
            // `hrc-left-merge` is written `hrc-left-` and `-merge`.
            const std::size_t step = name.rfind('-');
            const bool quadrant = name.starts_with("hrc-") && step > 4;
            const bool described = api.find('`' + name + '`') != std::string::npos ||
                                   (quadrant && api.find('`' + name.substr(0, step + 1)) != std::string::npos &&
                                    (api.find('`' + name.substr(step) + '`') != std::string::npos || name.ends_with("-trace")));
            EXPECT_TRUE(described) << name;
        }
    }
}

TEST(Real, InfoAndStatsAreJson) {
    const Finished info = run_program(PENUMBRA_PROGRAM, {"info", "--json"});
    ASSERT_EQ(info.exit_code, 0) << info.err;
    EXPECT_GE(nlohmann::json::parse(info.out)["devices"].size(), 1u);
    const TemporaryFolder folder;
    const Finished render = run_program(
        PENUMBRA_PROGRAM, {"render", "-", "-o", folder.path("out.png"), "--stats", "-", "--device", "cpu"}, kScene);
    ASSERT_EQ(render.exit_code, 0) << render.err;
    EXPECT_GE(nlohmann::json::parse(render.out)["passes"].size(), 3u);
}

}  // namespace
}  // namespace penumbra::test
