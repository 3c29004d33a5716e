// SPDX-License-Identifier: MIT
#pragma once

namespace penumbra {

// The limits on what arrives over a connection.
enum class Fault { none, malformed, headers_too_large, body_too_large, timeout, too_many_connections, stopping };

}  // namespace penumbra
