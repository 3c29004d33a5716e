// What a pixel holds (docs/methods/light-transport.md): floor times mean radiance where free, the topmost
// shape's emission where solid, with what it reflects for the eye.
#include "lib/scene.glsl"

layout(binding = kComposeRadianceUnit) uniform sampler2D radiance_texture;
layout(binding = kComposeLightsUnit) uniform sampler2D lights_texture;
layout(binding = kComposeDistanceUnit) uniform sampler2D distance_texture;
layout(binding = kComposeLitUnit) uniform sampler2D lit_texture;
layout(binding = kComposeMaterialUnit) uniform isampler2D material_texture;

float pixel_distance(ivec2 pixel) { return texelFetch(distance_texture, pixel + params.border, 0).r; }

vec3 floor_radiance(ivec2 pixel) {
    // A constant picture has a texture of one texel, and so have the lights of a scene without any.
    ivec2 at = pixel - params.first_lit;
    vec3 arriving = texelFetch(radiance_texture, min(at, textureSize(radiance_texture, 0) - 1), 0).rgb * params.radiance_scale;
    arriving += texelFetch(lights_texture, min(at, textureSize(lights_texture, 0) - 1), 0).rgb;
    return params.floor_albedo.rgb * arriving;
}

vec3 solid_radiance(ivec2 pixel) {
    int shape = texelFetch(material_texture, pixel + params.border, 0).r;
    vec3 lit = texelFetch(lit_texture, min(pixel, textureSize(lit_texture, 0) - 1), 0).rgb;
    return shape < 0 ? vec3(0.0) : shape_emission(shape, vec2(pixel) + 0.5) * params.radiance_scale + lit;
}
