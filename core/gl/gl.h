// SPDX-License-Identifier: MIT
// GL 4.3 core through glad. Included inside core/gl and core/passes only.
#pragma once

#include <glad/gl.h>
