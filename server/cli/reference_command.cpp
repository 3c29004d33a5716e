// SPDX-License-Identifier: MIT
// penumbra reference: the exact solution of a scene, on the CPU, in double precision.
#include <csignal>
#include <cstdio>
#include <memory>

#include <CLI/CLI.hpp>

#include "core/image/codec.h"
#include "core/reference/solver.h"
#include "server/cli/checks.h"
#include "server/cli/commands.h"
#include "server/cli/files.h"
#include "server/cli/progress.h"
#include "server/cli/scene_input.h"
#include "server/service/formats.h"

namespace penumbra {
namespace {

struct ReferenceOptions {
    std::string scene, output;
    std::vector<std::string> sets;
    int stride = 1;
    int threads = 0;
    double element_length_px = 0.5;
    bool quiet = false;
};

volatile std::sig_atomic_t interrupted = 0;
void interrupt(int) { interrupted = 1; }

int solve_file(const ReferenceOptions& options) {
    const PictureFormat* format = find_format_of_file(options.output);
    // RGBE knows no NaN, which is what solid pixels hold.
    if (options.output != "-" && (format == nullptr || format->name == "png" || format->name == "hdr"))
        throw InputError("--output takes a name that ends in .pfm, .exr or .npy, or -, not " + options.output);
    if (options.output == "-" && stdout_is_terminal())
        throw InputError("a picture does not go to a terminal; use -o FILE or a pipe");
    const std::optional<Scene> scene = read_scene(options.scene, parse_sets(options.sets));
    if (!scene) return kBadInput;
    Progress progress("solving " + options.scene, options.quiet);
    reference::SolveOptions solve_options;
    solve_options.stride = options.stride;
    solve_options.threads = options.threads;
    solve_options.element_length_px = options.element_length_px;
    solve_options.progress = [&](double fraction) {
        progress.update(fraction);
        return interrupted == 0;
    };
    std::signal(SIGINT, interrupt);
    std::signal(SIGTERM, interrupt);
    const reference::Solution solution = reference::solve(*scene, solve_options);
    for (const Problem& problem : solution.problems)
        complain(options.scene + ": " + problem.pointer + ": " + problem.message);
    if (!solution.problems.empty()) return kBadInput;
    if (solution.cancelled) {
        complain("interrupted; nothing was written");
        return kWorldFailed;
    }
    write_file(options.output, encode_linear(solution.image, format == nullptr ? "pfm" : format->name));
    if (!options.quiet)
        std::fprintf(stderr, "%s: solved in %.2f s, %llu intervals\n", options.scene.c_str(), solution.seconds,
                     static_cast<unsigned long long>(solution.intervals));
    return kSuccess;
}

}  // namespace

void add_reference_command(CLI::App& app, CommandContext& context) {
    CLI::App* command = app.add_subcommand("reference", "Solve a scene exactly (slow, on the CPU): the truth");
    auto options = std::make_shared<ReferenceOptions>();
    command->add_option("scene", options->scene, "Scene file, - for the standard input")->required();
    command->add_option("-o,--output", options->output, "Picture file (.pfm, .exr, .npy), - for the standard output; NaN where solid")->required();
    command->add_option("--stride", options->stride, "Solve every N-th pixel in both axes; the others are NaN")
        ->check(whole_number(1, 4096));
    command->add_option("--threads", options->threads, "Threads, 0 for one each processor")->check(whole_number(0, 1024));
    command->add_option("--element-length", options->element_length_px,
                        "Longest boundary element in pixels, where light bounces")
        ->check(number_between(0.01, 1000));
    command->add_option("--set", options->sets, "Replace a value of the scene: /json/pointer=value")->expected(1)->take_all();
    command->add_flag("-q,--quiet", options->quiet, "No progress on the standard error");
    command->callback([&context, options] {
        context.run = [options]() -> int {
            try {
                return solve_file(*options);
            } catch (const InputError& error) {
                complain(error.what());
                return kBadInput;
            }
        };
    });
}

}  // namespace penumbra
