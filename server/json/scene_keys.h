// SPDX-License-Identifier: MIT
// Every key of the scene format, object by object, and the words that the parser tells apart itself
// (core/scene/words.h has the others). A test compares them with docs/scene.schema.json.
#pragma once

#include <string_view>

namespace penumbra {

inline constexpr std::string_view kSceneKeys[] = {"version", "canvas", "sky",   "shapes",
                                                  "lights",  "render", "output"};
inline constexpr std::string_view kCanvasKeys[] = {"width", "height", "view",
                                                   "region", "margin", "floor"};
inline constexpr std::string_view kFloorKeys[] = {"albedo",    "image",    "normal_map", "tile",
                                                 "roughness", "metallic", "reflectance"};
inline constexpr std::string_view kSkyKeys[] = {"radiance", "gradient", "image", "row", "scale"};
inline constexpr std::string_view kStopKeys[] = {"angle", "radiance"};
inline constexpr std::string_view kRenderKeys[] = {"method", "quality", "bounces", "tolerance", "skip", "view"};
inline constexpr std::string_view kOutputKeys[] = {"format", "bit_depth", "antialias",
                                                   "solids", "exposure",  "tonemap",
                                                   "look",   "white",     "dither"};
// An exposure that is an object: a camera's, or the automatic one's.
inline constexpr std::string_view kCameraKeys[] = {"aperture", "shutter", "iso", "compensation"};
inline constexpr std::string_view kAutoExposureKeys[] = {"key"};
// Emission along a stroke.
inline constexpr std::string_view kGradientKeys[] = {"gradient"};
inline constexpr std::string_view kEmissionStopKeys[] = {"at", "emission"};
inline constexpr std::string_view kColourKeys[] = {"color", "intensity"};

inline constexpr std::string_view kShapeTypes[] = {"circle",   "ellipse", "rect",  "line",
                                                   "polyline", "polygon", "bitmap", "path", "text"};
inline constexpr std::string_view kCircleKeys[] = {"type", "emission", "albedo", "medium", "center",
                                                   "radius"};
inline constexpr std::string_view kEllipseKeys[] = {"type",   "emission", "albedo", "medium",
                                                    "center", "radii",    "rotation"};
inline constexpr std::string_view kRectKeys[] = {"type", "emission", "albedo", "medium",       "center",
                                                 "size", "rotation", "corner_radius"};
inline constexpr std::string_view kLineKeys[] = {"type", "emission", "albedo", "medium",
                                                 "from", "to",       "width"};
inline constexpr std::string_view kPolylineKeys[] = {"type",   "emission", "albedo", "medium",
                                                     "points", "width",    "closed"};
inline constexpr std::string_view kPolygonKeys[] = {"type", "emission", "albedo", "medium", "points"};
inline constexpr std::string_view kBitmapKeys[] = {
    "type", "image", "position", "size", "emission_scale", "solid_above", "as"};

inline constexpr std::string_view kPathKeys[] = {"type", "emission", "albedo", "medium", "d", "fill_rule", "position", "scale"};
inline constexpr std::string_view kTextKeys[] = {"type", "emission", "albedo", "medium", "text", "position", "size", "anchor"};

inline constexpr std::string_view kMediumKeys[] = {"extinction", "emission", "transmission", "depth"};

inline constexpr std::string_view kLightTypes[] = {"point", "spot", "directional"};
inline constexpr std::string_view kPointLightKeys[] = {"type",    "position", "intensity", "radius",
                                                       "candela", "lumens",   "height"};
inline constexpr std::string_view kSpotKeys[] = {"type",        "position",    "direction",
                                                 "inner_angle", "outer_angle", "intensity",
                                                 "candela",     "lumens",      "height",
                                                 "tilt"};
inline constexpr std::string_view kDirectionalKeys[] = {"type", "direction", "irradiance", "lux",
                                                        "elevation"};

inline constexpr std::string_view kQualities[] = {"draft", "standard", "high"};
inline constexpr std::string_view kSkips[] = {"all", "none"};
inline constexpr std::string_view kSolids[] = {"emission", "lit"};
inline constexpr std::string_view kDithers[] = {"none", "triangular"};
inline constexpr std::string_view kFillRules[] = {"nonzero", "evenodd"};
inline constexpr std::string_view kAnchors[] = {"start", "middle", "end"};
inline constexpr std::string_view kUses[] = {"emission", "albedo"};

}  // namespace penumbra
