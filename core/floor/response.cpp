// SPDX-License-Identifier: MIT
#include "core/floor/response.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <glm/geometric.hpp>

namespace penumbra {
namespace {

constexpr double kPi = std::numbers::pi;

// Azimuths and elevations, or places on the facets' distribution, that integrals take.
constexpr int kAround = 32;
constexpr int kUp = 24;

double squared(double x) { return x * x; }
double fifth(double x) { return squared(squared(x)) * x; }

void add(ResponseTerms& to, const ResponseTerms& more, double weight) {
    to.diffuse += weight * more.diffuse;
    to.facets += weight * more.facets;
    to.rim += weight * more.rim;
}

ResponseTerms mixed(const ResponseTerms& a, const ResponseTerms& b, double t) {
    return {std::lerp(a.diffuse, b.diffuse, t), std::lerp(a.facets, b.facets, t), std::lerp(a.rim, b.rim, t)};
}

}  // namespace

double facet_distribution(double cosine, double alpha) {
    const double a = cosine * alpha;
    const double k = alpha / (1 - squared(cosine) + squared(a));
    return k * k / kPi;
}

double facet_visibility(double nl, double nv, double alpha) {
    const double a = squared(alpha);
    const double l = nv * std::sqrt(squared(nl) * (1 - a) + a);
    const double v = nl * std::sqrt(squared(nv) * (1 - a) + a);
    return 0.5 / (l + v);
}

double burley_diffuse(double nl, double nv, double lh, double alpha) {
    const double f90 = 0.5 + 2 * alpha * squared(lh);
    return (1 + (f90 - 1) * fifth(1 - nl)) * (1 + (f90 - 1) * fifth(1 - nv)) / kPi;
}

FloorResponse::FloorResponse(const std::optional<Gloss>& gloss) : gloss_(gloss) {
    if (gloss_) alpha_ = squared(std::max(gloss_->roughness, kLeastRoughness));
    for (int i = 0; i < kTilts; ++i) {
        const double z = i + 1 == kTilts ? 0 : std::cos(i * kPi / 2 / (kTilts - 1));
        rows_.push_back({integrated(z), gloss_ ? mirrored(z) : 1.0});
    }
}

ResponseTerms FloorResponse::of_beam(const glm::dvec3& normal, const glm::dvec3& to_light) const {
    ResponseTerms terms;
    const double nl = glm::dot(normal, to_light);
    if (!(nl > 0)) return terms;
    if (!gloss_) {
        terms.diffuse = nl / kPi;
        return terms;
    }
    // The eye is straight above; a normal never turns away from it (errata E-26).
    const double nv = std::abs(normal.z) + 1e-5;
    const glm::dvec3 half = to_light + glm::dvec3(0, 0, 1);
    const double size = glm::length(half);
    const double nh = std::min(glm::dot(normal, half) / size, 1.0), lh = glm::dot(to_light, half) / size;
    const double rim = fifth(1 - lh);
    const double facets = facet_distribution(nh, alpha_) * facet_visibility(nl, nv, alpha_) * nl;
    // What is mirrored is not scattered as well: errata E-28.
    terms.diffuse = burley_diffuse(nl, std::min(nv, 1.0), lh, alpha_) * nl * (1 - rim);
    terms.facets = facets * (1 - rim);
    terms.rim = facets * rim;
    return terms;
}

ResponseColours FloorResponse::colours(const Colour& albedo, double normal_z) const {
    if (!gloss_) return {albedo, Colour(0), Colour(0)};
    // Errata E-24: of the base colour itself, not of what metal leaves of it.
    const Colour f0 = Colour(0.16 * squared(gloss_->reflectance) * (1 - gloss_->metallic)) + gloss_->metallic * albedo;
    // Light that facets throw on each other: Filament's compensation, errata E-28.
    const Colour more = 1.0 + f0 * (1 / at(normal_z).mirrored - 1);
    // The base colour counts for the diffuse part alone: errata E-25.
    return {(1 - gloss_->metallic) * albedo * (1.0 - f0), f0 * more, more};
}

FloorResponse::OfField FloorResponse::integrated(double normal_z) const {
    const double z = std::clamp(normal_z, 0.0, 1.0);
    const double lean = std::sqrt(std::max(1 - squared(z), 0.0));
    const glm::dvec3 normal(lean, 0, z);
    OfField sum;
    // Light from the azimuth w has the radiance of w at every elevation e: the integral of response times cos(e) over both.
    const auto take = [&](double cosine, const ResponseTerms& terms, double weight) {
        add(sum.mean, terms, weight);
        add(sum.lean, terms, 2 * weight * cosine);
    };
    for (int i = 0; i < kAround; ++i) {
        const double azimuth = (i + 0.5) * kPi / kAround;  // the other half is its mirror image
        const double cosine = std::cos(azimuth);
        const double share = 2 * kPi / kAround;
        if (!gloss_) {
            // Over the elevations at which the floor faces the light, in closed form.
            const double a = lean * cosine;
            const double from = a < 0 ? std::atan2(-a, z) : 0.0;
            const double up = a * (kPi / 4 - from / 2 - std::sin(2 * from) / 4) + z / 2 * squared(std::cos(from));
            take(cosine, {up / kPi, 0, 0}, share);
            continue;
        }
        for (int k = 0; k < 2 * kUp; ++k) {
            const double s = (k + 0.5) / (2 * kUp);  // sine of the elevation
            const double c = std::sqrt(1 - s * s);
            ResponseTerms terms = of_beam(normal, {c * cosine, c * std::sin(azimuth), s});
            terms.facets = terms.rim = 0;
            take(cosine, terms, share / (2 * kUp));
        }
    }
    if (!gloss_) return sum;
    // Facets: by their own distribution, of which each place below stands for as much.
    const glm::dvec3 across(z, 0, -lean), side(0, 1, 0);
    for (int i = 0; i < kAround; ++i) {
        const double azimuth = (i + 0.5) * kPi / kAround;
        for (int k = 0; k < kUp; ++k) {
            const double u = (k + 0.5) / kUp;
            const double nh = std::sqrt((1 - u) / (1 + (squared(alpha_) - 1) * u));
            const double sine = std::sqrt(std::max(1 - nh * nh, 0.0));
            const glm::dvec3 half = normal * nh + (across * std::cos(azimuth) + side * std::sin(azimuth)) * sine;
            const glm::dvec3 light = half * (2 * half.z) - glm::dvec3(0, 0, 1);
            const double nl = glm::dot(normal, light);
            if (light.z <= 0 || nl <= 0 || half.z <= 0) continue;
            const double nv = z + 1e-5;
            // Directions of light per direction of facets: 4 v.h; facets per place: D n.h.
            const double facets = facet_visibility(nl, nv, alpha_) * nl * 4 * half.z / nh / (kAround * kUp);
            const double rim = fifth(1 - half.z);
            const double level = std::hypot(light.x, light.y);
            take(level > 0 ? light.x / level : 0.0, {0, facets * (1 - rim), facets * rim}, 1);
        }
    }
    return sum;
}

double FloorResponse::mirrored(double cosine) const {
    const double nv = std::clamp(cosine, 0.0, 1.0) + 1e-5;
    const glm::dvec3 eye(std::sqrt(std::max(1 - squared(std::min(nv, 1.0)), 0.0)), 0, std::min(nv, 1.0));
    double sum = 0;
    for (int i = 0; i < kAround; ++i) {
        const double azimuth = (i + 0.5) * kPi / kAround;
        for (int k = 0; k < kUp; ++k) {
            const double u = (k + 0.5) / kUp;
            const double nh = std::sqrt((1 - u) / (1 + (squared(alpha_) - 1) * u));
            const double sine = std::sqrt(std::max(1 - nh * nh, 0.0));
            const glm::dvec3 half(sine * std::cos(azimuth), sine * std::sin(azimuth), nh);
            const double vh = glm::dot(eye, half);
            const double nl = 2 * vh * half.z - eye.z;
            if (vh > 0 && nl > 0) sum += facet_visibility(nl, nv, alpha_) * nl * 4 * vh / nh / (kAround * kUp);
        }
    }
    return std::clamp(sum, 1e-3, 1.0);
}

FloorResponse::Row FloorResponse::at(double normal_z) const {
    const double place = std::acos(std::clamp(normal_z, 0.0, 1.0)) / (kPi / 2) * (kTilts - 1);
    const auto i = std::min(std::size_t(place), std::size_t(kTilts - 2));
    const double t = place - double(i);
    const Row &a = rows_[i], &b = rows_[i + 1];
    return {{mixed(a.field.mean, b.field.mean, t), mixed(a.field.lean, b.field.lean, t)}, std::lerp(a.mirrored, b.mirrored, t)};
}

FloorResponse::OfField FloorResponse::of_field(double normal_z) const { return at(normal_z).field; }

std::vector<glm::vec4> FloorResponse::table() const {
    std::vector<glm::vec4> texels;
    for (const Row& row : rows_) {
        const OfField& f = row.field;
        texels.push_back(glm::vec4(f.mean.diffuse, f.lean.diffuse, f.mean.facets, f.lean.facets));
        texels.push_back(glm::vec4(f.mean.rim, f.lean.rim, row.mirrored, 0));
    }
    return texels;
}

}  // namespace penumbra
