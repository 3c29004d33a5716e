// What a pixel holds (docs/methods/light-transport.md): floor times mean radiance where free, the topmost
// shape's emission where solid, with what it reflects for the eye.
#include "lib/scene.glsl"

layout(binding = kComposeRadianceUnit) uniform sampler2D radiance_texture;
layout(binding = kComposeLightsUnit) uniform sampler2D lights_texture;
layout(r32f, binding = kComposeDistanceImage) readonly uniform image2D distance_image;
layout(r32i, binding = kComposeMaterialImage) readonly uniform iimage2D material_image;
layout(binding = kComposeLitUnit) uniform sampler2D lit_texture;

// Which program this is: whether there are lights without a size, and whether solids reflect for the eye.
const int kComposeLights = 1;
const int kComposeLit = 1;

float pixel_distance(ivec2 pixel) { return imageLoad(distance_image, pixel + params.border).r; }

vec3 floor_radiance(ivec2 pixel) {
    // A constant picture has a texture of one texel, and so have the lights of a scene without any.
    ivec2 at = pixel - params.first_lit;
    vec3 arriving = texelFetch(radiance_texture, min(at, textureSize(radiance_texture, 0) - 1), 0).rgb * params.radiance_scale;
    if (kComposeLights != 0) arriving += texelFetch(lights_texture, min(at, textureSize(lights_texture, 0) - 1), 0).rgb;
    return params.floor_albedo.rgb * arriving;
}

// Black where it is not asked for: a gradient is not walked there.
vec3 solid_radiance(ivec2 pixel, bool asked) {
    int shape = asked ? imageLoad(material_image, pixel + params.border).r : -1;
    vec3 lit = vec3(0.0);
    if (kComposeLit != 0) lit = texelFetch(lit_texture, min(pixel, textureSize(lit_texture, 0) - 1), 0).rgb;
    return shape < 0 ? vec3(0.0) : shape_emission(shape, vec2(pixel) + 0.5) * params.radiance_scale + lit;
}
