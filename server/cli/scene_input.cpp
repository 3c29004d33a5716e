// SPDX-License-Identifier: MIT
#include "server/cli/scene_input.h"

#include "server/cli/files.h"
#include "server/cli/scene_report.h"

namespace penumbra {

std::vector<Override> parse_sets(const std::vector<std::string>& sets) {
    std::vector<Override> overrides;
    for (const std::string& set : sets) {
        const std::size_t equals = set.find('=');
        if (equals == std::string::npos || set.empty() || set[0] != '/') {
            throw InputError("--set takes /json/pointer=value, not " + set);
        }
        overrides.push_back({set.substr(0, equals), set.substr(equals + 1)});
    }
    return overrides;
}

std::optional<Scene> read_scene(const std::string& path, const std::vector<Override>& overrides) {
    const SceneLimits limits = limits_of(Config{});
    const std::string text = read_text(path, limits.text.max_bytes);
    ParsedScene parsed = parse_scene(text, limits.scene, limits.text, overrides);
    if (!parsed.scene) complain_about_scene(path, parsed.problems, parsed.problems_left_out);
    return std::move(parsed.scene);
}

}  // namespace penumbra
