// SPDX-License-Identifier: MIT
#include "server/service/version.h"

namespace penumbra {

std::string version() { return PENUMBRA_VERSION; }

}  // namespace penumbra
