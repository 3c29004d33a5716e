// SPDX-License-Identifier: MIT
// A place between two dispatches where a frame may be told to stop. What is called here may throw: everything that a frame makes
// is a value that goes with it.
#pragma once

#include <functional>

namespace penumbra::gl {

// While it lives, checkpoint() on this thread calls `call`.
class CheckpointScope {
public:
    explicit CheckpointScope(std::function<void()> call);
    ~CheckpointScope();
    CheckpointScope(const CheckpointScope&) = delete;
    CheckpointScope& operator=(const CheckpointScope&) = delete;

private:
    std::function<void()> call_;
    const std::function<void()>* before_;
};

void checkpoint();

}  // namespace penumbra::gl
