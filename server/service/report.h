// SPDX-License-Identifier: MIT
// What the program tells about itself and its renders as JSON: the same text for /v1/info,
// `penumbra info --json`, `--stats` and `validate --json`.
#pragma once

#include <string>

#include "server/service/render_service.h"

namespace penumbra {

// {"name", "version", "device", "limits", "formats", "methods", "tonemaps"}. What is listed as possible
// is asked of unsupported(), so that the list is never older than the renderer.
std::string info_json(const DeviceInfo* device, const std::vector<DeviceListing>* listing,
                      const SceneLimits& limits, const UnsupportedFeatures& unsupported);

// Precondition: no failure.
std::string stats_json(const RenderResponse& response);

// {"valid": ..., "problems": [...], "problems_left_out": n}
std::string validation_json(const CheckedScene& checked);

// The members of one problem: {"pointer", "line", "column", "code", "message", "suggestion"}.
std::string problem_json(const LocatedProblem& problem);

}  // namespace penumbra
