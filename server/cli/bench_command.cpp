// SPDX-License-Identifier: MIT
// penumbra bench: time against error for scenes, methods, qualities, sizes and devices, as JSON lines.
#include <cstdio>
#include <fstream>
#include <iostream>
#include <memory>

#include <CLI/CLI.hpp>
#include <nlohmann/json.hpp>

#include "server/bench/bench.h"
#include "server/bench/scaling.h"
#include "server/bench/skip_table.h"
#include "server/cli/checks.h"
#include "server/cli/commands.h"
#include "server/cli/files.h"
#include "server/cli/progress.h"
#include "server/json/scene_json.h"

namespace penumbra {
namespace {

struct BenchOptions {
    std::vector<std::string> scenes;
    std::vector<std::string> methods = {"rc"};
    std::vector<std::string> qualities = {"draft", "standard", "high"};
    std::vector<int> sizes = {256, 512, 1024};
    std::vector<std::string> devices = {"auto"};
    std::string output = "-";
    std::string truths = "out/truth";
    bool fresh = false;
    bool skip_table = false;
    bool scaling = false;
    std::vector<std::string> curves = scaling_curves();
    BenchSettings settings;
};

void tell(const std::string& row_text) {
    const auto row = nlohmann::json::parse(row_text);
    std::string error = "-";
    if (row.contains("errors") && !row["errors"]["rel"].is_null()) {
        char text[64];
        std::snprintf(text, sizeof text, "nrmse %.4f rel %.4f", row["errors"]["nrmse"].get<double>(),
                      row["errors"]["rel"].get<double>());
        error = text;
    }
    std::fprintf(stderr, "%-14s %5dx%-5d %-10s %-9s %-4s gpu %9.2f ms  cpu %9.2f ms  %s\n",
                 row["scene"].get<std::string>().c_str(), row["width"].get<int>(), row["height"].get<int>(),
                 row["method"].get<std::string>().c_str(), row["quality"].get<std::string>().c_str(),
                 row["device"].get<std::string>().c_str(), row["gpu_ms"]["median"].get<double>(),
                 row["cpu_ms"]["median"].get<double>(), error.c_str());
}

// Every word that no scene could be rendered with, judged on a small one.
void check_words(const std::string& option, const std::string& pointer, const std::vector<std::string>& words, const Engine& engine) {
    for (const std::string& word : words) {
        const ParsedScene parsed =
            parse_scene(R"({"version": 1, "canvas": {"width": 16, "height": 16}})", {}, {}, {{pointer, word}});
        if (!parsed.scene) throw InputError(option + ": " + parsed.problems.front().problem.message);
        for (const Problem& problem : engine.unsupported_with({})(*parsed.scene)) throw InputError(option + ": " + problem.message);
    }
}

// A line of results, to the file or to the standard output.
void put(const BenchOptions& options, const std::string& text) {
    if (options.output == "-")
        std::cout << text << std::flush;
    else
        std::ofstream(options.output, std::ios::app) << text;
}

int run_skip_table(const BenchOptions& options, const Engine& engine) {
    if (options.output != "-") std::ofstream(options.output, std::ios::trunc);
    const auto backend = engine.make_backend({.device = options.devices.front(), .shader_dir = {}, .tone_lut = {}});
    put(options, skip_table_head());
    std::size_t failed = 0;
    for (const std::string& scene : options.scenes)
        for (const std::string& method : options.methods)
            try {
                put(options, skip_rows(scene, method, "standard", {options.settings.repeats, options.settings.most_seconds}, *backend, engine));
            } catch (const std::runtime_error& error) {
                complain(scene + " (" + method + "): " + error.what());
                ++failed;
            }
    return failed == 0 ? kSuccess : kWorldFailed;
}

int run_scaling(const BenchOptions& options, const Engine& engine) {
    if (options.output != "-") std::ofstream(options.output, std::ios::trunc);
    const auto backend = engine.make_backend({.device = options.devices.front(), .shader_dir = {}, .tone_lut = {}});
    measure_scaling({options.methods, options.curves, "standard", options.settings.repeats, options.settings.most_seconds}, *backend, engine,
                    [&](const std::string& row) {
                        put(options, row + "\n");
                        if (options.output != "-") std::fprintf(stderr, "%s\n", row.c_str());
                    });
    return kSuccess;
}

int run_bench(const BenchOptions& options, const Engine& engine) {
    if (options.scenes.empty() && !options.scaling) throw InputError("scenes: name at least one scene file");
    check_words("--methods", "/render/method", options.methods, engine);
    if (options.skip_table) return run_skip_table(options, engine);
    if (options.scaling) return run_scaling(options, engine);
    check_words("--qualities", "/render/quality", options.qualities, engine);
    const bool to_file = options.output != "-";
    if (options.fresh && to_file) std::ofstream(options.output, std::ios::trunc);
    const std::set<std::string> done = to_file ? finished_cases(options.output) : std::set<std::string>();
    const TruthCache truths(options.truths);
    std::size_t failed = 0;
    std::size_t kept = 0;
    for (const std::string& device : options.devices) {
        const auto backend = engine.make_backend({.device = device, .shader_dir = {}, .tone_lut = {}});
        for (const std::string& scene : options.scenes)
            for (const int size : options.sizes)
                for (const std::string& method : options.methods)
                    for (const std::string& quality : options.qualities) {
                        const BenchCase bench_case{scene, size, method, quality, device};
                        if (done.count(case_key(bench_case, backend->device())) > 0) {
                            ++kept;
                            continue;
                        }
                        try {
                            Progress progress("solving " + scene);
                            const std::string row = run_case(bench_case, options.settings, *backend, engine, truths,
                                                             [&](double f) { progress.update(f); return true; });
                            if (to_file) {
                                std::ofstream(options.output, std::ios::app) << row << "\n";
                            } else {
                                std::cout << row << "\n" << std::flush;
                            }
                            tell(row);
                        } catch (const std::runtime_error& error) {
                            complain(scene + " (" + method + ", " + quality + ", " + std::to_string(size) + "): " + error.what());
                            ++failed;
                        }
                    }
    }
    if (kept > 0) std::fprintf(stderr, "%zu cases were in %s already (--fresh starts over)\n", kept, options.output.c_str());
    if (failed > 0) std::fprintf(stderr, "%zu cases could not be measured\n", failed);
    return failed == 0 ? kSuccess : kWorldFailed;
}

}  // namespace

void add_bench_command(CLI::App& app, CommandContext& context) {
    CLI::App* command = app.add_subcommand("bench", "Measure time against error (see docs/benchmarks.md)");
    auto options = std::make_shared<BenchOptions>();
    command->add_option("scenes", options->scenes, "Scene files")->check(readable_file());
    command->add_option("--methods", options->methods, "Methods")->delimiter(',')->capture_default_str();
    command->add_option("--qualities", options->qualities, "Qualities")->delimiter(',')->capture_default_str();
    command->add_option("--sizes", options->sizes, "Pixels along x, 0 for the scene's own size")
        ->check(whole_number(0, 8192))->delimiter(',')->capture_default_str();
    command->add_option("--devices", options->devices, "Devices: auto, cpu, gpu or an index")
        ->check(device_name())->delimiter(',')->capture_default_str();
    command->add_option("-o,--output", options->output,
                        "Results, a line of JSON a case; what the file holds already is not measured again");
    auto* skip_table = command->add_flag("--skip-table", options->skip_table,
                      "Measure what each kind of work that a scene does not need costs, as a Markdown table (standard quality)");
    command->add_flag("--scaling", options->scaling,
                      "Measure how cost grows with shapes, canvas and emitters (scenes of its own, standard quality)")->excludes(skip_table);
    command->add_option("--curves", options->curves, "What grows, with --scaling")
        ->check(CLI::IsMember(scaling_curves()))->delimiter(',')->capture_default_str();
    command->add_flag("--fresh", options->fresh, "Measure all cases anew");
    command->add_option("--truths,--truth-dir", options->truths,
                        "Folder of exact solutions, kept by the scene's hash; made when the first one is solved")->capture_default_str();
    command->add_flag("!--no-errors", options->settings.errors, "Measure time only; nothing is solved");
    command->add_option("--repeats", options->settings.repeats, "Measured renders a case")->check(whole_number(1, 1000))->capture_default_str();
    command->add_option("--warm-up", options->settings.warm_up, "Renders before them")->check(whole_number(0, 100))->capture_default_str();
    command->add_option("--most-seconds", options->settings.most_seconds, "Of one case; three renders are always made")
        ->check(number_of_at_least(0))->capture_default_str();
    command->add_option("--truth-pixels", options->settings.truth_pixels,
                        "Larger pictures are compared at every N-th pixel, about this many a side")
        ->check(whole_number(1, 8192))->capture_default_str();
    command->callback([&context, options] {
        context.run = [&context, options]() -> int {
            try {
                return run_bench(*options, context.engine);
            } catch (const InputError& error) {
                complain(error.what());
                return kBadInput;
            }
        };
    });
}

}  // namespace penumbra
