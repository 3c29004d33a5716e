// SPDX-License-Identifier: MIT
// Time, error and cost counters of renders: what `penumbra bench` writes.
#pragma once

#include <set>
#include <string>
#include <vector>

#include "server/bench/truth_cache.h"
#include "server/service/engine.h"

namespace penumbra {

struct BenchCase {
    std::string scene;     // file
    int size = 0;          // pixels along x; 0: the scene's own
    std::string method, quality, device;
};

struct BenchSettings {
    int repeats = 5;
    int warm_up = 1;
    // Never fewer than three repeats, but no more once this is spent on one case.
    double most_seconds = 20;
    int truth_pixels = 512;  // the exact solution is strided to about this many pixels a side
    bool errors = true;
};

// A measured case as one line of JSON (docs/benchmarks.md describes its members). Throws std::runtime_error with a
// sentence when the case cannot be run.
std::string run_case(const BenchCase& bench_case, const BenchSettings& settings, RenderBackend& backend,
                     const Engine& engine, const TruthCache& truths, const std::function<bool(double)>& progress);

// What tells a case from another in a file of results: scene's content, size, method, quality, device, build.
std::string case_key(const BenchCase& bench_case, const DeviceInfo& device);

// The keys of the results in a file; empty when there is none.
std::set<std::string> finished_cases(const std::string& path);

}  // namespace penumbra
