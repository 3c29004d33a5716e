// SPDX-License-Identifier: MIT
#pragma once

#include "server/service/engine.h"

namespace penumbra {

Engine real_engine();

}  // namespace penumbra
