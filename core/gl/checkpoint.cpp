// SPDX-License-Identifier: MIT
#include "core/gl/checkpoint.h"

#include <utility>

namespace penumbra::gl {
namespace {
thread_local const std::function<void()>* t_call = nullptr;
}

CheckpointScope::CheckpointScope(std::function<void()> call) : call_(std::move(call)), before_(t_call) { t_call = &call_; }
CheckpointScope::~CheckpointScope() { t_call = before_; }

void checkpoint() {
    if (t_call != nullptr && *t_call) (*t_call)();
}

}  // namespace penumbra::gl
