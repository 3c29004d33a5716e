// SPDX-License-Identifier: MIT
#include "server/cli/scene_report.h"

#include <cstdio>

namespace penumbra {

void complain_about_scene(const std::string& path, const std::vector<LocatedProblem>& problems,
                          std::size_t left_out) {
    const std::string name = path == "-" ? "<stdin>" : path;
    for (const LocatedProblem& problem : problems) {
        std::fprintf(stderr, "%s: %s\n", name.c_str(), to_string(problem).c_str());
    }
    if (left_out > 0) std::fprintf(stderr, "%s: and %zu more problems\n", name.c_str(), left_out);
}

}  // namespace penumbra
