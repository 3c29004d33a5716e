// SPDX-License-Identifier: MIT
#include "core/passes/frame_look.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <numbers>
#include <string>

#include <glm/common.hpp>
#include <glm/geometric.hpp>

#include "glsl/exact.h"

namespace penumbra {
namespace {

constexpr double kLegibleSpacing = 14;  // px

std::vector<glm::vec4> texels_of(const gl::Texture2D& texture) {
    std::vector<glm::vec4> texels(static_cast<std::size_t>(texture.size().x) * static_cast<std::size_t>(texture.size().y));
    texture.read(GL_RGBA, GL_FLOAT, texels.data());
    return texels;
}

}  // namespace

int shown_probes(const std::vector<CascadePlan>& cascades) {
    for (const CascadePlan& c : cascades)
        if (c.spacing >= kLegibleSpacing) return c.level;
    return cascades.back().level;
}

FrameLook::FrameLook(const Plan& plan) : canvas_(plan.canvas) {
    const LookAt at = plan.look.at;
    if (at == LookAt::steps || at == LookAt::skipped) values_.assign(index(0, canvas_.y), 0.0f);
    if (at == LookAt::cascade) light_ = ImageF(canvas_.x, canvas_.y, 3);
    if (at == LookAt::probes) probe_level_ = shown_probes(plan.cascades);
}

void FrameLook::see_cascade(const Plan& plan, std::size_t level, const gl::Texture2D& merged) {
    const CascadePlan& c = plan.cascades[level];
    const int groups = c.tiles.x * c.tiles.y;
    const bool is_shown = static_cast<int>(level) == (plan.look.at == LookAt::probes ? probe_level_ : plan.look.number);
    const LookAt at = plan.look.at;
    if (at != LookAt::steps && !(is_shown && (at == LookAt::cascade || at == LookAt::probes)) && !(level == 0 && at == LookAt::skipped)) return;
    const std::vector<glm::vec4> texels = texels_of(merged);
    const auto texel = [&](int group, glm::ivec2 probe) {
        const glm::ivec2 place = glm::ivec2(group % c.tiles.x, group / c.tiles.x) * c.probes + probe;
        return texels[static_cast<std::size_t>(place.y) * static_cast<std::size_t>(c.texture.x) + static_cast<std::size_t>(place.x)];
    };
    if (at == LookAt::probes) {
        probes_ = {plan.shown.size, c.probes, c.first_probe - glm::dvec2(plan.shown.first), c.spacing, groups, {}, {}};
        for (int g = 0; g < groups; ++g)
            for (int y = 0; y < c.probes.y; ++y)
                for (int x = 0; x < c.probes.x; ++x) {
                    const glm::vec4 light = texel(g, {x, y});
                    probes_.light.push_back(glm::vec3(light) * static_cast<float>(plan.radiance_scale));
                    if (g == 0) probes_.free.push_back(light.a > 0 ? 1 : 0);
                }
        seen_all_ = true;
        return;
    }
    // By probe, then by pixel: the nearest one's.
    std::vector<glm::vec4> sums;
    for (int y = 0; y < c.probes.y; ++y)
        for (int x = 0; x < c.probes.x; ++x) {
            glm::vec4 sum(0);
            for (int g = 0; g < groups; ++g) sum += texel(g, {x, y});
            sums.push_back(sum);
        }
    for (int y = 0; y < canvas_.y; ++y)
        for (int x = 0; x < canvas_.x; ++x) {
            const glm::dvec2 place = (glm::dvec2(x + 0.5, y + 0.5) - c.first_probe) / c.spacing;
            const glm::ivec2 probe = glm::clamp(glm::ivec2(glm::round(place)), glm::ivec2(0), c.probes - 1);
            const glm::vec4 sum = sums[static_cast<std::size_t>(probe.y) * static_cast<std::size_t>(c.probes.x) + static_cast<std::size_t>(probe.x)];
            if (at == LookAt::steps) values_[index(x, y)] += sum.r / static_cast<float>(c.spacing * c.spacing);
            if (at == LookAt::skipped) values_[index(x, y)] = sum.a > 0 ? 0.0f : 1.0f;
            if (at == LookAt::cascade)
                for (int k = 0; k < 3; ++k) light_.at(x, y)[k] = sum[k] / static_cast<float>(groups) * static_cast<float>(plan.radiance_scale);
        }
    seen_all_ = at == LookAt::cascade;
}

void FrameLook::see_level(const Plan& plan, const HrcQuadrant& q, int level, const gl::Texture2D& fluence) {
    if (plan.look.at != LookAt::cascade || plan.look.number != level) return;
    const HrcLevel& l = q.levels[static_cast<std::size_t>(level)];
    const std::vector<glm::vec4> texels = texels_of(fluence);
    const auto rows = static_cast<std::size_t>(q.rows);
    for (int y = 0; y < canvas_.y; ++y)
        for (int x = 0; x < canvas_.x; ++x) {
            const glm::dvec2 way = glm::dvec2(x + 0.5, y + 0.5) - q.first;
            const double column = glm::dot(way, q.along) / glm::dot(q.along, q.along), row = glm::dot(way, q.across) / glm::dot(q.across, q.across);
            const int plane = std::clamp(static_cast<int>(std::lround(column / std::ldexp(1.0, level))), 0, l.planes - 1);
            const auto at = static_cast<std::size_t>(std::clamp(static_cast<int>(std::lround(row)), 0, q.rows - 1));
            for (int cone = 0; cone < l.cones; ++cone) {
                const glm::vec4& light = texels[static_cast<std::size_t>(plane * l.cones + cone) * rows + at];
                for (int k = 0; k < 3; ++k) light_.at(x, y)[k] += light[k] * static_cast<float>(plan.radiance_scale / (2 * std::numbers::pi));
            }
        }
}

// As exact_fill.comp finds them.
void FrameLook::see_cells(const gl::Texture2D& cells, int first_row, int rows) {
    const glm::ivec2 size = cells.size();
    std::vector<std::uint32_t> leaf(static_cast<std::size_t>(size.x) * static_cast<std::size_t>(size.y));
    cells.read(GL_RED_INTEGER, GL_UNSIGNED_INT, leaf.data());
    for (int y = 0; y < rows; ++y)
        for (int x = 0; x < canvas_.x; ++x) {
            const auto smallest = [&](int side) {
                return static_cast<int>(leaf[static_cast<std::size_t>(y / side * side) * static_cast<std::size_t>(size.x) + static_cast<std::size_t>(x / side * side)]);
            };
            int side = glsl::kExactCell;
            while (side > 1 && smallest(side) < side) side /= 2;
            values_[index(x, y + first_row)] = static_cast<float>(1.0 - 1.0 / (side * side));
        }
}

HeatField FrameLook::shown(const Plan& plan) const {
    HeatField field{plan.shown.size, {}};
    for (int y = 0; y < field.size.y; ++y)
        for (int x = 0; x < field.size.x; ++x) field.values.push_back(values_[index(x + plan.shown.first.x, y + plan.shown.first.y)]);
    return field;
}

Image8 FrameLook::draw(const Plan& plan) const {
    switch (plan.look.at) {
        case LookAt::probes: return draw_probes(probes_, plan.method + " cascade " + std::to_string(probe_level_) + ": " + std::to_string(4 * probes_.groups) + " directions");
        case LookAt::steps: return draw_heat(shown(plan), plan.method + ": steps a pixel");
        case LookAt::skipped: return draw_heat(shown(plan), plan.method + ": share of pixels left out");
        default: {
            ImageF part(plan.shown.size.x, plan.shown.size.y, 3);
            for (int y = 0; y < part.height; ++y)
                std::copy_n(light_.at(plan.shown.first.x, plan.shown.first.y + y), 3 * static_cast<std::size_t>(part.width), part.at(0, y));
            return draw_light(part, plan.method + (plan.hrc.active() ? " level " : " cascade ") + std::to_string(plan.look.number));
        }
    }
}

}  // namespace penumbra
