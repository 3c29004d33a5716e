// SPDX-License-Identifier: MIT
// The boundary of the union of all shapes inside the domain: pieces that do not cross, each with
// free space on one side, solid on the other, and the material of the topmost shape there.
#pragma once

#include <cstdint>
#include <vector>

#include "core/reference/outlines.h"

namespace penumbra::reference {

class Boundary {
public:
    // `open_rings` cuts whole ellipses into arcs, which surfaces with elements need.
    Boundary(const Scene& scene, std::size_t max_pieces, bool open_rings);

    const Problems& problems() const { return problems_; }
    const std::vector<Piece>& pieces() const { return pieces_; }
    const Material& material_of(const Piece& piece) const {
        return materials_[std::size_t(piece.material)];
    }
    const std::vector<Material>& materials() const { return materials_; }
    // What the pieces' `body` counts.
    const std::vector<Body>& bodies() const { return bodies_; }
    const Box& domain() const { return domain_; }
    // Lengths below this are taken for rounding: points closer than this coincide.
    double tolerance() const { return tolerance_; }

    // Whether any shape covers the point, outlines included. Not clipped by the domain.
    bool is_solid(Point p) const { return topmost(p) >= 0; }
    // Index of the topmost body there, or -1.
    int topmost(Point p) const;

private:
    void index_bodies();
    void split_and_keep(const std::vector<Piece>& raw);
    void keep_if_visible(Piece part);

    bool open_rings_ = false;
    Box domain_;
    double tolerance_ = 0;
    std::vector<Body> bodies_;
    std::vector<Material> materials_;
    std::vector<Piece> pieces_;
    Problems problems_;
    int cells_x_ = 1, cells_y_ = 1;
    Box grid_;
    std::vector<std::vector<std::int32_t>> cells_;  // bodies by cell, topmost first
};

}  // namespace penumbra::reference
