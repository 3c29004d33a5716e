// SPDX-License-Identifier: MIT
// Ending a render before its end.
#pragma once

#include <functional>
#include <stdexcept>

namespace penumbra {

// Asked between the dispatches of a render, on its thread, some hundred times a second; true ends it. Empty: never.
using StopCheck = std::function<bool()>;

// What a render that was ended throws. Its renderer can go on with the next one.
class RenderStopped : public std::runtime_error {
public:
    RenderStopped() : std::runtime_error("The render was stopped.") {}
};

}  // namespace penumbra
