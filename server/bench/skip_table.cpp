// SPDX-License-Identifier: MIT
#include "server/bench/skip_table.h"

#include <cstdio>
#include <filesystem>
#include <stdexcept>

#include "core/plan/saving.h"
#include "server/bench/measure.h"
#include "server/cli/files.h"

namespace penumbra {
namespace {

// One of a pair, over all turns.
struct Side {
    Scene scene;
    std::vector<double> cpu_ms;
    RenderStats stats;

    void render(RenderBackend& backend, bool counts) {
        const double start = process_cpu_ms();
        RenderResult result = backend.render(scene, {});
        if (counts) cpu_ms.push_back(process_cpu_ms() - start);
        stats = std::move(result.stats);
    }
};

struct Pair {
    Side with, without;  // what is left out
    double ratio = 0;
};

// In turns, so that what else the machine does falls on both. The first turn warms up.
Pair measure(const Scene& lean, const Scene& full, const SkipTableSettings& settings, RenderBackend& backend) {
    Pair pair{{lean, {}, {}}, {full, {}, {}}};
    double spent = 0;
    std::vector<double> ratios;
    for (int turn = -1; turn < settings.repeats && (turn < 3 || spent < 1e3 * settings.most_seconds); ++turn) {
        const bool lean_first = turn % 2 == 0;
        (lean_first ? pair.with : pair.without).render(backend, turn >= 0);
        (lean_first ? pair.without : pair.with).render(backend, turn >= 0);
        if (turn < 0) continue;
        spent += pair.with.cpu_ms.back() + pair.without.cpu_ms.back();
        ratios.push_back(pair.without.cpu_ms.back() / std::max(pair.with.cpu_ms.back(), 1e-3));
    }
    pair.ratio = median(ratios);
    return pair;
}

std::string short_number(double value) {
    char text[32];
    if (value >= 1e6)
        std::snprintf(text, sizeof text, "%.2f M", 1e-6 * value);
    else
        std::snprintf(text, sizeof text, "%.0f", value);
    return text;
}

std::string row_text(const std::string& scene, const std::string& method, const std::string& what, const Pair& pair) {
    const Work lean = work_of(pair.with.stats);
    const Work full = work_of(pair.without.stats);
    const double with = median(pair.with.cpu_ms), without = median(pair.without.cpu_ms);
    char times[96];
    std::snprintf(times, sizeof times, "%.*f | %.*f | %.*f", with < 20 ? 2 : 0, with, without < 20 ? 2 : 0, without, pair.ratio < 20 ? 2 : 0, pair.ratio);
    const auto both = [](std::uint64_t a, std::uint64_t b) { return short_number(double(a)) + " / " + short_number(double(b)); };
    return "| " + scene + " | " + method + " | " + what + " | " + times + " | " + both(lean.invocations, full.invocations) + " | " +
           (full.points + lean.points > 0 ? both(lean.points, full.points) : both(lean.rays, full.rays)) + " | " +
           both(lean.dispatches, full.dispatches) + " |\n";
}

// By their words: the numbers in `saved` change from run to run only with the work.
bool same_skips(const RenderStats& a, const RenderStats& b) {
    if (a.skipped.size() != b.skipped.size()) return false;
    for (std::size_t i = 0; i < a.skipped.size(); ++i)
        if (a.skipped[i].what != b.skipped[i].what || a.skipped[i].saved != b.skipped[i].saved) return false;
    return true;
}

}  // namespace

std::string skip_table_head() {
    return "| scene | method | left out | with, CPU-ms | without, CPU-ms | ratio | invocations with / without | points or rays | dispatches |\n"
           "| --- | --- | --- | --- | --- | --- | --- | --- | --- |\n";
}

std::string skip_rows(const std::string& path, const std::string& method, const std::string& quality,
                      const SkipTableSettings& settings, RenderBackend& backend, const Engine& engine) {
    const Scene lean = bench_scene(path, read_text(path, std::size_t(64) << 20),
                                   {{"/render/method", method}, {"/render/quality", quality}, {"/render/skip", "all"}});
    for (const Problem& problem : engine.unsupported_with({})(lean)) throw std::runtime_error(problem.pointer + ": " + problem.message);
    const std::string name = std::filesystem::path(path).stem().string();
    Scene full = lean;
    full.render.skip = Skip::none;
    const Pair all = measure(lean, full, settings, backend);
    std::string rows = row_text(name, method, "**all of it**", all);
    for (const SavingName& one : kSavings) {
        Scene kept = lean;
        kept.render.keep = static_cast<std::uint32_t>(one.saving);
        const RenderStats stats = backend.render(kept, {}).stats;
        if (same_skips(stats, all.with.stats) && work_of(stats) == work_of(all.with.stats)) continue;  // this scene has none of it
        rows += row_text(name, method, std::string(one.name), measure(lean, kept, settings, backend));
    }
    return rows;
}

}  // namespace penumbra
