// Tone curves and the sRGB curve. Input and output are linear; every curve maps 0 to 0 or nearly so.

#include "lib/pick.glsl"

vec3 tonemap_reinhard(vec3 c) { return c / (1.0 + c); }

// Reinhard et al., "Photographic Tone Reproduction for Digital Images", 2002, equation 4, per channel.
vec3 tonemap_reinhard_extended(vec3 c, float white) { return c * (1.0 + c / (white * white)) / (1.0 + c); }

// Stephen Hill's fit of the ACES reference and output transforms (BakingLab), without its exposure factor.
vec3 tonemap_aces(vec3 c) {
    const mat3 into = mat3(0.59719, 0.07600, 0.02840, 0.35458, 0.90834, 0.13383, 0.04823, 0.01566, 0.83777);
    const mat3 back = mat3(1.60475, -0.10208, -0.00327, -0.53108, 1.10813, -0.07276, -0.07367, -0.00605, 1.07602);
    // Beyond this the curve is flat to the last bit of a half, and its squares would overflow.
    vec3 v = min(into * c, vec3(1e6));
    v = (v * (v + 0.0245786) - 0.000090537) / (v * (0.983729 * v + 0.4329510) + 0.238081);
    return back * v;
}

// Krzysztof Narkowicz, "ACES Filmic Tone Mapping Curve", 2016.
vec3 tonemap_aces_narkowicz(vec3 c) {
    c = min(c, vec3(1e6));
    return c * (2.51 * c + 0.03) / (c * (2.43 * c + 0.59) + 0.14);
}

// ASC CDL; luma is taken before the power, as in Wrensch's and Filament's.
vec3 graded(vec3 v, vec3 slope, float power, float saturation) {
    v = max(v * slope, vec3(0.0));
    float luma = dot(v, vec3(0.2126, 0.7152, 0.0722));
    v = pow(v, vec3(power));
    return luma + saturation * (v - luma);
}

// AgX (Sobotka's inset and range), with Wrensch's contrast polynomial of 6th order and outset.
vec3 tonemap_agx(vec3 c) {
    const mat3 inset = mat3(0.842479062253094, 0.0423282422610123, 0.0423756549057051,
                            0.0784335999999992, 0.878468636469772, 0.0784336,
                            0.0792237451477643, 0.0791661274605434, 0.879142973793104);
    const mat3 outset = mat3(1.19687900512017, -0.0528968517574562, -0.0529716355144438,
                             -0.0980208811401368, 1.15190312990417, -0.0980434501171241,
                             -0.0990297440797205, -0.0989611768448433, 1.15107367264116);
    vec3 v = inset * c;
    v = clamp((log2(max(v, vec3(1e-10))) + 12.47393) / 16.5, 0.0, 1.0);
    vec3 v2 = v * v;
    vec3 v4 = v2 * v2;
    v = 15.5 * v4 * v2 - 40.14 * v4 * v + 31.96 * v4 - 6.868 * v2 * v + 0.4298 * v2 + 0.1191 * v - 0.00232;
    if (kComposeLook == kLookGolden) v = graded(v, vec3(1.0, 0.9, 0.5), 0.8, 1.3);
    if (kComposeLook == kLookPunchy) v = graded(v, vec3(1.0), 1.35, 1.4);
    return pow(max(outset * v, vec3(0.0)), vec3(2.2));
}

// Khronos PBR Neutral, the current specification (compression mixes towards the new peak).
vec3 tonemap_pbr_neutral(vec3 c) {
    float x = min(c.r, min(c.g, c.b));
    float offset = x <= 0.08 ? x - x * x / 0.16 : 0.04;
    c -= offset;
    float peak = max(c.r, max(c.g, c.b));
    if (peak <= 0.76) return c;
    float compressed = 1.0 - 0.24 * 0.24 / (peak + 1.0 - 1.52);
    float g = 1.0 / (0.15 * (peak - compressed) + 1.0);
    return c * (compressed / peak) * g + compressed * (1.0 - g);
}

layout(binding = kComposeLutUnit) uniform sampler2D tone_lut;

// A table over x/(x+1): 0 is the middle of the first texel and 1 that of the last. Texels are read whole and mixed here, since a
// device's filter knows 256 steps between them.
vec3 tonemap_lut(vec3 c) {
    int size = textureSize(tone_lut, 0).x;
    vec3 at = c / (1.0 + c) * float(size - 1);
    ivec3 low = min(ivec3(at), ivec3(size - 2));
    vec3 f = at - vec3(low);
    vec3 layers[2];
    for (int z = 0; z < 2; ++z) {
        ivec2 texel = ivec2(low.x, (low.z + z) * size + low.y);
        vec3 near = mix(texelFetch(tone_lut, texel, 0).rgb, texelFetch(tone_lut, texel + ivec2(1, 0), 0).rgb, f.x);
        vec3 far = mix(texelFetch(tone_lut, texel + ivec2(0, 1), 0).rgb, texelFetch(tone_lut, texel + ivec2(1, 1), 0).rgb, f.x);
        layers[z] = mix(near, far, f.y);
    }
    return mix(layers[0], layers[1], f.z);
}

vec3 tonemap(vec3 c, float white) {
    if (kComposeTonemap == kTonemapReinhard) return tonemap_reinhard(c);
    if (kComposeTonemap == kTonemapReinhardExtended) return tonemap_reinhard_extended(c, white);
    if (kComposeTonemap == kTonemapAces) return tonemap_aces(c);
    if (kComposeTonemap == kTonemapAcesNarkowicz) return tonemap_aces_narkowicz(c);
    if (kComposeTonemap == kTonemapAgx) return tonemap_agx(c);
    if (kComposeTonemap == kTonemapPbrNeutral) return tonemap_pbr_neutral(c);
    if (kComposeTonemap == kTonemapTony) return tonemap_lut(c);
    return c;
}

// IEC 61966-2-1.
vec3 srgb_encode(vec3 c) {
    return pick(1.055 * pow(max(c, vec3(1e-10)), vec3(1.0 / 2.4)) - 0.055, 12.92 * c, lessThanEqual(c, vec3(0.0031308)));
}
