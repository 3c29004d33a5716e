// Opens every header that GLSL and C++ share. GLSL knows these types; C++ borrows GLM's.
// Rules: float, int, uint, vec2, vec4 and integer forms only; no bool, no bare vec3; padding is a named
// field; a test compares the offsets that the driver reports with offsetof.
#ifndef PENUMBRA_GLSL_TYPES_H
#define PENUMBRA_GLSL_TYPES_H
#ifdef __cplusplus
#include <glm/vec2.hpp>
#include <glm/vec4.hpp>
#include <glm/ext/vector_int2.hpp>
#include <glm/ext/vector_int4.hpp>
namespace penumbra::glsl {
using glm::ivec2;
using glm::ivec4;
using glm::vec2;
using glm::vec4;
using uint = unsigned int;
}
#endif
#endif
