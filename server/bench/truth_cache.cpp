// SPDX-License-Identifier: MIT
#include "server/bench/truth_cache.h"

#include <cstdio>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "core/image/codec.h"
#include "core/reference/solver.h"
#include "server/cli/files.h"

namespace penumbra {
namespace {

// Raise when the solver's answers change: old files are then not found.
constexpr const char* kSolverRevision = "exact-1";

}  // namespace

std::uint64_t hash_text(std::string_view text, std::uint64_t seed) {
    for (const char c : text) seed = (seed ^ static_cast<unsigned char>(c)) * 1099511628211ull;
    return seed;
}

std::string hex(std::uint64_t value) {
    char text[17];
    std::snprintf(text, sizeof text, "%016llx", static_cast<unsigned long long>(value));
    return text;
}

TruthCache::TruthCache(std::string folder) : folder_(std::move(folder)) {}

Truth TruthCache::get(const Scene& scene, const std::string& identity, int stride,
                      const std::function<bool(double)>& progress) const {
    Truth truth;
    truth.hash = hex(hash_text(std::string(kSolverRevision) + "\n" + std::to_string(stride) + "\n" + identity));
    const std::string path = folder_ + "/" + truth.hash + ".pfm";
    const std::string note = folder_ + "/" + truth.hash + ".seconds";
    if (std::filesystem::exists(path) && std::filesystem::exists(note)) {
        const std::string text = read_text(path, std::size_t(4) << 30);
        auto decoded = decode_pfm({reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
        if (auto* image = std::get_if<ImageF>(&decoded);
            image != nullptr && image->width == scene.canvas.region_or_all().w && image->height == scene.canvas.region_or_all().h) {
            truth.image = std::move(*image);
            truth.seconds = std::strtod(read_text(note, 64).c_str(), nullptr);
            return truth;
        }
    }
    reference::SolveOptions options;
    options.stride = stride;
    options.progress = progress;
    reference::Solution solution = reference::solve(scene, options);
    if (!solution.problems.empty())
        throw std::runtime_error("the exact solver refuses it: " + solution.problems.front().message);
    if (solution.cancelled) throw std::runtime_error("interrupted");
    std::filesystem::create_directories(folder_);
    write_file(path, encode_pfm(solution.image));
    write_text(note, std::to_string(solution.seconds));
    truth.image = std::move(solution.image);
    truth.seconds = solution.seconds;
    return truth;
}

}  // namespace penumbra
