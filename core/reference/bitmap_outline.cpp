// SPDX-License-Identifier: MIT
// The outline of a picture's solid texels: straight pieces between a solid texel and one that is
// not. What lies inside the solid part is never seen, so a photograph costs only its border.
#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <string>

#include "core/reference/outlines.h"

namespace penumbra::reference {

double srgb_to_linear(double encoded) {
    return encoded <= 0.04045 ? encoded / 12.92 : std::pow((encoded + 0.055) / 1.055, 2.4);
}

namespace {

// One of the two families of grid lines: walks every line, joining edges that look alike.
struct LineWalk {
    const Body& body;
    Outlines& out;
    int body_index;
    bool upright;  // lines of constant x

    int texel(int along, int across) const {
        const int x = upright ? across : along;
        const int y = upright ? along : across;
        if (x < 0 || y < 0 || x >= body.texels_x || y >= body.texels_y) return -1;
        return body.texel_material[std::size_t(y) * std::size_t(body.texels_x) + std::size_t(x)];
    }
    Point corner(int along, int across) const {
        const Point index = upright ? Point(across, along) : Point(along, across);
        return body.center + index * body.half_size;
    }
    void walk() const {
        const int lines = upright ? body.texels_x : body.texels_y;
        const int steps = upright ? body.texels_y : body.texels_x;
        for (int line = 0; line <= lines; ++line) {
            int start = 0, before = -1, after = -1;
            for (int step = 0; step <= steps; ++step) {
                const bool end = step == steps;
                int b = end ? -1 : texel(step, line - 1);
                int a = end ? -1 : texel(step, line);
                if (a >= 0 && b >= 0) a = b = -1;  // inside: no edge
                if (step > 0 && b == before && a == after) continue;
                if (before >= 0 || after >= 0) emit(line, start, step, before, after);
                start = step;
                before = b;
                after = a;
            }
        }
    }
    void emit(int line, int start, int end, int before, int after) const {
        Point from = corner(start, line);
        Point to = corner(end, line);
        // Solid on the left of the direction of travel: see Piece.
        if ((after >= 0) == upright) std::swap(from, to);
        Piece piece = straight_piece(from, to);
        piece.body = body_index;
        piece.material = std::max(before, after);
        out.pieces.push_back(piece);
    }
};

}  // namespace

void add_bitmap(const Bitmap& bitmap, int shape, std::size_t max_pieces, Outlines& out) {
    const std::string pointer = "/shapes/" + std::to_string(shape);
    if (!bitmap.image || bitmap.image->width <= 0 || bitmap.image->height <= 0) {
        out.problems.push_back({pointer + "/image", "no_picture", "The bitmap has no picture."});
        return;
    }
    const Texels& image = *bitmap.image;
    Body body;
    body.kind = Body::Kind::bitmap;
    body.shape = shape;
    body.center = bitmap.position;
    body.texels_x = image.width;
    body.texels_y = image.height;
    body.half_size = bitmap.size / Point(image.width, image.height);
    body.box.add(bitmap.position);
    body.box.add(bitmap.position + bitmap.size);

    double linear[256];
    for (int i = 0; i < 256; ++i) linear[i] = srgb_to_linear(i / 255.0);
    std::map<std::array<std::uint8_t, 3>, int> known;
    const std::size_t count = std::size_t(image.width) * std::size_t(image.height);
    body.texel_material.assign(count, -1);
    for (std::size_t i = 0; i < count; ++i) {
        const std::uint8_t* texel = image.rgba.data() + 4 * i;
        if (texel[3] / 255.0 < bitmap.solid_above) continue;
        const std::array<std::uint8_t, 3> key{texel[0], texel[1], texel[2]};
        const auto [place, is_new] = known.try_emplace(key, int(out.materials.size()));
        if (is_new) {
            const Colour colour{linear[texel[0]], linear[texel[1]], linear[texel[2]]};
            Material material;
            if (bitmap.as_albedo)
                material.albedo = colour;
            else
                material.emission = colour * bitmap.emission_scale;
            out.materials.push_back(material);
        }
        body.texel_material[i] = place->second;
    }
    const int index = int(out.bodies.size());
    out.bodies.push_back(std::move(body));
    for (const bool upright : {false, true}) {
        LineWalk{out.bodies[std::size_t(index)], out, index, upright}.walk();
        if (out.pieces.size() > max_pieces) return;  // reported by outlines_of
    }
}

}  // namespace penumbra::reference
