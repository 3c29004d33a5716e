// SPDX-License-Identifier: MIT
#include "core/reference/radiosity.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace penumbra::reference {

namespace {

constexpr double kPi = std::numbers::pi;

// Elements at a piece's ends start at this share of the full length and grow by this factor: a
// geometric mesh resolves the bend of radiance in a corner (Babuska's h-version grading).
constexpr double kEndShare = 1.0 / 64;
constexpr double kShortEndShare = 1.0 / 8;  // on pieces shorter than eight elements
constexpr double kGrowth = 1.5;
// Shadow edges of delta lights are pinned down to this share of an element.
constexpr double kEdgeShare = 1.0 / 4096;
// Curved elements turn by at most this much, so that a chord stands for them.
constexpr double kLargestTurn = 2 * kPi / 64;
constexpr int kFewestElements = 4;

double arc_length(const Piece& piece, double t0, double t1) {
    if (!piece.is_arc) return std::sqrt(length_squared(piece.b - piece.a)) * (t1 - t0);
    // Gauss-Legendre, five points: ample for less than a third of a turn.
    constexpr double kNode[3] = {0, 0.5384693101056831, 0.9061798459386640};
    constexpr double kWeight[3] = {0.5688888888888889, 0.4786286704993665, 0.2369268850561891};
    const double middle = 0.5 * (t0 + t1), half = 0.5 * (t1 - t0);
    double sum = 0;
    for (int i = 0; i < 3; ++i) {
        for (const double sign : {-1.0, 1.0}) {
            const double speed =
                std::sqrt(length_squared(piece.tangent(middle + sign * half * kNode[i])));
            sum += (i == 0 ? 0.5 : 1.0) * kWeight[i] * speed;
        }
    }
    return sum * half;
}

Point unit(Point d) { return d / std::sqrt(length_squared(d)); }

// The angle from `from` to `to`, for the many thin elements of a picture without a call of atan2:
// its series' first term left out is below 1e-17 of it.
double angle_between(Point from, Point to) {
    const double ratio = cross(from, to) / dot(from, to);
    if (!(ratio >= 0 && ratio < 0.02) || dot(from, to) <= 0) {
        return std::max(std::atan2(cross(from, to), dot(from, to)), 0.0);
    }
    const double square = ratio * ratio;
    return ratio * (1 - square * (1.0 / 3 - square * (1.0 / 5 - square * (1.0 / 7 - square / 9))));
}

double minmod(double a, double b) {
    if (a * b <= 0) return 0;
    return std::abs(a) < std::abs(b) ? a : b;
}

// Slope from the differences to either side: the centred one, held to twice the smaller (MC
// limiter, van Leer 1977), so that smooth courses keep second order.
double limited(double before, double after, double weight_before, double weight_after) {
    const double centred = weight_before * before + weight_after * after;
    return minmod(centred, 2 * minmod(before, after));
}

// Mean place, uniform in angle, of the points from `from` to `to` (relative to the observer),
// measured along `tangent` from the element's middle.
double mean_offset(Point from, Point to, Point middle, Point tangent) {
    const Point chord = to - from;
    const double size = std::sqrt(length_squared(chord));
    const double near = length_squared(from);
    if (size * size < 4e-4 * near) return dot(0.5 * (from + to) - middle, tangent);
    const double angle = std::atan2(std::abs(cross(from, to)), dot(from, to));
    if (angle < 1e-9) return dot(0.5 * (from + to) - middle, tangent);
    // At height h above the chord's line, places are h tan(phi); tan integrates to -ln cos.
    const Point along = chord / size;
    const double height = std::abs(cross(from, along));
    const double mean = 0.5 * height * std::log(length_squared(to) / near) / angle;
    const double share = std::clamp(mean - dot(from, along), 0.0, size);
    return dot(from + along * share - middle, tangent);
}

}  // namespace

Elements::Elements(const Boundary& boundary, const DeltaLights& lights, double length)
    : boundary_(boundary) {
    Sweep sweep(boundary);
    first_.push_back(0);
    for (std::size_t i = 0; i < boundary.pieces().size(); ++i) {
        const Piece& piece = boundary.pieces()[i];
        const bool reflects = boundary.material_of(piece).albedo != Colour(0);
        append(std::int32_t(i), reflects ? first_knots(std::int32_t(i), lights, length, sweep)
                                         : std::vector<double>{piece.t0});
    }
}

std::vector<double> Elements::first_knots(std::int32_t index, const DeltaLights& lights,
                                          double length, Sweep& sweep) const {
    const Piece& piece = boundary_.pieces()[std::size_t(index)];
    const double whole = arc_length(piece, piece.t0, piece.t1);
    const double turns = piece.is_arc ? (piece.t1 - piece.t0) / kLargestTurn : 0.0;
    const double full =
        std::min({length, whole / kFewestElements, turns > 0 ? whole / turns : length});
    // Half the piece from its end, growing; mirrored for the other half.
    std::vector<double> half;
    double place = 0, step = full * (whole < 8 * length ? kShortEndShare : kEndShare);
    while (place < 0.5 * whole) {
        half.push_back(place);
        place += std::min(step, full);
        step *= kGrowth;
    }
    const double stretch = 0.5 / place;  // so that a knot falls on the middle
    const auto parameter = [&](double share) { return piece.t0 + (piece.t1 - piece.t0) * share; };
    std::vector<double> knots;
    for (const double at : half) knots.push_back(parameter(at * stretch));
    knots.push_back(parameter(0.5));
    for (std::size_t i = half.size(); i-- > 0;)
        knots.push_back(i == 0 ? piece.t1 : parameter(1 - half[i] * stretch));
    if (lights.empty()) return knots;

    const auto lit_set = [&](double t) {
        const Point p = piece.at(t);
        const Point normal = unit(turned(piece.tangent(t)));
        return lights.lit_set(p, normal, sweep.look(p, normal, 4 * boundary_.tolerance(), true));
    };
    const double least = kEdgeShare * length / whole * (piece.t1 - piece.t0);
    std::vector<double> refined;
    const std::function<void(double, double, std::uint64_t, std::uint64_t)> refine =
        [&](double low, double high, std::uint64_t at_low, std::uint64_t at_high) {
            if (at_low == at_high || high - low <= least) {
                refined.push_back(low);
                return;
            }
            const double middle = 0.5 * (low + high);
            const std::uint64_t at_middle = lit_set(middle);
            refine(low, middle, at_low, at_middle);
            refine(middle, high, at_middle, at_high);
        };
    // The ends themselves touch other pieces: ask a little inside.
    const double inset = 1e-3 * (knots[1] - knots[0]);
    std::vector<std::uint64_t> sets;
    for (const double t : knots)
        sets.push_back(lit_set(std::clamp(t, piece.t0 + inset, piece.t1 - inset)));
    for (std::size_t i = 0; i + 1 < knots.size(); ++i)
        refine(knots[i], knots[i + 1], sets[i], sets[i + 1]);
    refined.push_back(knots.back());
    return refined;
}

void Elements::append(std::int32_t index, const std::vector<double>& knots) {
    const Piece& piece = boundary_.pieces()[std::size_t(index)];
    double run = 0;
    for (std::size_t i = 0; i + 1 < knots.size(); ++i) {
        const double middle = 0.5 * (knots[i] + knots[i + 1]);
        Element element;
        element.middle = piece.at(middle);
        element.tangent = unit(piece.tangent(middle));
        element.normal = turned(element.tangent);
        element.piece = index;
        element.size = arc_length(piece, knots[i], knots[i + 1]);
        element.place = run + 0.5 * element.size;
        element.radiance = element.mean = boundary_.material_of(piece).emission_at(element.middle);
        elements_.push_back(element);
        run += element.size;
    }
    for (const double t : knots) {
        knots_.push_back(t);
        knot_points_.push_back(piece.at(t));
    }
    first_.push_back(std::int32_t(elements_.size()));
}

bool Elements::refine(double share, double least_size) {
    double reflected = 0, length = 0;
    for (const Element& e : elements_) {
        const Colour own =
            e.radiance - boundary_.material_of(boundary_.pieces()[std::size_t(e.piece)]).emission_at(e.middle);
        reflected += e.size * std::max({own.r, own.g, own.b});
        length += e.size;
    }
    if (reflected == 0) return false;
    const double allowed = share * reflected / length;
    std::vector<bool> bends(elements_.size(), false);
    bool any = false;
    for (std::size_t i = 1; i + 1 < elements_.size(); ++i) {
        const Element& e = elements_[i];
        const Element& before = elements_[i - 1];
        const Element& after = elements_[i + 1];
        if (before.piece != e.piece || after.piece != e.piece) continue;
        const Colour back = (e.radiance - before.radiance) / (e.place - before.place);
        const Colour on = (after.radiance - e.radiance) / (after.place - e.place);
        for (int c = 0; c < 3; ++c) {
            if (std::abs(on[c] - back[c]) * e.size / 8 <= allowed) continue;
            // A kink may lie in a neighbour: its bend shows here too.
            for (std::size_t k = i - 1; k <= i + 1; ++k) {
                if (elements_[k].size < 2 * least_size) continue;
                bends[k] = any = true;
            }
        }
    }
    if (!any) return false;
    const std::vector<std::int32_t> first = std::move(first_);
    const std::vector<double> knots = std::move(knots_);
    elements_.clear();
    knots_.clear();
    knot_points_.clear();
    first_ = {0};
    for (std::size_t i = 0; i + 1 < first.size(); ++i) {
        std::vector<double> own;
        for (auto e = std::size_t(first[i]); e < std::size_t(first[i + 1]); ++e) {
            const double low = knots[e + i], high = knots[e + i + 1];
            own.push_back(low);
            if (bends[e]) own.push_back(0.5 * (low + high));
        }
        own.push_back(knots[std::size_t(first[i + 1]) + i]);
        append(std::int32_t(i), own);
    }
    return true;
}

void Elements::restart() {
    for (Element& e : elements_) {
        const Material& material = boundary_.material_of(boundary_.pieces()[std::size_t(e.piece)]);
        e.radiance = e.mean = material.emission_at(e.middle);
        e.slope = material.slope * dot(material.axis, e.tangent);
    }
}

void Elements::reconstruct() {
    for (std::size_t i = 0; i < elements_.size(); ++i) {
        Element& e = elements_[i];
        const Element* before =
            i > 0 && elements_[i - 1].piece == e.piece ? &elements_[i - 1] : nullptr;
        const Element* after = i + 1 < elements_.size() && elements_[i + 1].piece == e.piece
                                   ? &elements_[i + 1]
                                   : nullptr;
        e.mean = e.radiance;
        if (!before && !after) continue;
        const double back = before ? e.place - before->place : 0;
        const double on = after ? after->place - e.place : 0;
        for (int c = 0; c < 3; ++c) {
            const double rise_back = before ? (e.radiance[c] - before->radiance[c]) / back : 0;
            const double rise_on = after ? (after->radiance[c] - e.radiance[c]) / on : 0;
            if (!before)
                e.slope[c] = rise_on;
            else if (!after)
                e.slope[c] = rise_back;
            else {
                e.slope[c] = limited(rise_back, rise_on, on / (back + on), back / (back + on));
                // A parabola's mean is its middle plus a 24th of its bend: fourth order seen from
                // afar. Next to a jump one of the two differences is small, and so is the
                // correction.
                const double bend = 2 * (rise_on - rise_back) / (back + on);
                const double most =
                    0.5 * std::min(std::abs(rise_back) * back, std::abs(rise_on) * on);
                const double more = std::clamp(bend * e.size * e.size / 24, -most, most);
                e.mean[c] = std::max(e.radiance[c] + more, 0.0);
            }
        }
    }
}

template <class Visit>
void Elements::walk(const Interval& interval, Point p, const Visit& visit) const {
    const auto index = std::size_t(interval.piece);
    const Piece& piece = boundary_.pieces()[index];
    const std::size_t base = std::size_t(first_[index]) + index;
    const std::size_t count = std::size_t(first_[index + 1] - first_[index]);
    const double* knots = knots_.data() + base;
    const auto hit = [&](Point d) {
        const double distance = distance_to(piece, p, d);
        return d * (std::isfinite(distance) ? std::max(distance, 0.0) : 0.0);
    };
    // An observer who turns towards growing angles goes down in parameter.
    Point from = hit(interval.from);
    const Point to = hit(interval.to);
    const double high = std::clamp(piece.parameter_of(p + from), piece.t0, piece.t1);
    const double low = std::clamp(piece.parameter_of(p + to), piece.t0, high);
    auto k = std::size_t(std::lower_bound(knots + 1, knots + count, high) - knots) - 1;
    while (true) {
        const bool is_last = k == 0 || knots[k] <= low;
        const Point end = is_last ? to : knot_points_[base + k] - p;
        visit(elements_[std::size_t(first_[index]) + k], from, end);
        if (is_last) return;
        from = end;
        --k;
    }
}

Colour Gather::fluence(Point p, const std::vector<Interval>& seen) const {
    Colour sum(0);
    for (const Interval& interval : seen) {
        if (interval.piece < 0) {
            if (!sky.is_black())
                sum +=
                    sky.integral(std::atan2(interval.from.y, interval.from.x), angle_of(interval));
        } else if (elements && elements->has(interval.piece)) {
            elements->walk(interval, p, [&](const Elements::Element& e, Point from, Point to) {
                const double angle = angle_between(from, to);
                sum += angle * (e.mean + e.slope * mean_offset(from, to, e.middle - p, e.tangent));
            });
        } else {
            const Material& material =
                boundary.material_of(boundary.pieces()[std::size_t(interval.piece)]);
            if (material.slope != Colour(0))
                sum += gradient_light(material, p, interval.piece, interval.from, interval.to).mean;
            else if (material.emission != Colour(0))
                sum += angle_of(interval) * material.emission;
        }
    }
    return sum;
}

// Of a straight piece whose radiance is linear along it. At the height h above its line, and the angle t from the perpendicular
// `ahead`, a ray meets it at h tan t along `along`: the integrals of (c + s h tan t) times 1, cos t and sin t, in closed form.
Gather::Moments Gather::gradient_light(const Material& material, Point p, std::int32_t index, Point from, Point to) const {
    const Piece& piece = boundary.pieces()[std::size_t(index)];
    const Point along = unit(piece.b - piece.a);
    Point ahead = turned(along);
    double height = dot(piece.a - p, ahead);
    if (height < 0) {
        ahead = -ahead;
        height = -height;
    }
    const Colour c = material.emission_at(p + ahead * height);
    const Colour s = material.slope * (dot(material.axis, along) * height);
    const double cos0 = dot(from, ahead), sin0 = dot(from, along), cos1 = dot(to, ahead), sin1 = dot(to, along);
    // Towards growing angles `along` may come before or after.
    const double sense = cross(ahead, along);
    const double turn = std::max(std::atan2(cross(from, to), dot(from, to)), 0.0);
    Moments m;
    m.mean = c * turn + s * (sense * std::log(cos0 / cos1));
    const Colour cosine = sense * (c * (sin1 - sin0) + s * (cos0 - cos1));
    const Colour sine = sense * (c * (cos0 - cos1) + s * (std::log((1 + sin1) * cos0 / ((1 + sin0) * cos1)) - (sin1 - sin0)));
    m.x = cosine * ahead.x + sine * along.x;
    m.y = cosine * ahead.y + sine * along.y;
    return m;
}

Gather::Moments Gather::moments(Point p, const std::vector<Interval>& seen) const {
    Moments sum;
    const auto add = [&](const Colour& radiance, Point from, Point to, double angle) {
        sum.mean += radiance * angle;
        sum.x += radiance * (to.y - from.y);
        sum.y += radiance * (from.x - to.x);
    };
    for (const Interval& interval : seen) {
        if (interval.piece < 0) {
            if (sky.is_black()) continue;
            const double from = std::atan2(interval.from.y, interval.from.x), extent = angle_of(interval);
            sum.mean += sky.integral(from, extent);
            sum.x += sky.cosine_integral(from, extent, 0);
            sum.y += sky.cosine_integral(from, extent, 0.5 * kPi);
        } else if (elements && elements->has(interval.piece)) {
            elements->walk(interval, p, [&](const Elements::Element& e, Point from, Point to) {
                const Colour radiance = e.mean + e.slope * mean_offset(from, to, e.middle - p, e.tangent);
                const double far0 = std::sqrt(length_squared(from)), far1 = std::sqrt(length_squared(to));
                if (far0 > 0 && far1 > 0) add(radiance, from / far0, to / far1, angle_between(from, to));
            });
        } else {
            const Material& material =
                boundary.material_of(boundary.pieces()[std::size_t(interval.piece)]);
            if (material.slope != Colour(0)) {
                const Moments part = gradient_light(material, p, interval.piece, interval.from, interval.to);
                sum.mean += part.mean;
                sum.x += part.x;
                sum.y += part.y;
            } else if (material.emission != Colour(0)) {
                add(material.emission, interval.from, interval.to, angle_of(interval));
            }
        }
    }
    return sum;
}

Colour Gather::irradiance(Point p, Point normal, const std::vector<Interval>& seen) const {
    // The cosine integrates to the sine of the angle from the normal; behind, it stays at +-1.
    const auto sine = [&](Point d, double size) {
        const double s = cross(normal, d);
        if (dot(normal, d) <= 0) return s < 0 ? -1.0 : 1.0;
        return std::clamp(s / size, -1.0, 1.0);
    };
    const double normal_angle = std::atan2(normal.y, normal.x);
    Colour sum(0);
    for (const Interval& interval : seen) {
        // The sweep starts behind the normal, where both ends have the cut's direction.
        const double start = interval.key_from <= -1  ? -1.0
                             : interval.key_from >= 1 ? 1.0
                                                      : sine(interval.from, 1);
        const double end = interval.key_to <= -1  ? -1.0
                           : interval.key_to >= 1 ? 1.0
                                                  : sine(interval.to, 1);
        if (end <= start) continue;
        if (interval.piece < 0) {
            if (sky.is_black()) continue;
            const auto turn = [&](Point d) { return std::atan2(cross(normal, d), dot(normal, d)); };
            const double low = interval.key_from <= -1 ? -0.5 * kPi : turn(interval.from);
            const double high = interval.key_to >= 1 ? 0.5 * kPi : turn(interval.to);
            if (!(low < high)) continue;
            sum += sky.cosine_integral(normal_angle + low, high - low, normal_angle);
        } else if (elements && elements->has(interval.piece)) {
            double before = start;
            elements->walk(interval, p, [&](const Elements::Element& e, Point from, Point to) {
                const double after =
                    std::clamp(sine(to, std::sqrt(length_squared(to))), before, end);
                const double weight = after - before;
                before = after;
                if (weight <= 0) return;
                sum += weight * (e.mean + e.slope * mean_offset(from, to, e.middle - p, e.tangent));
            });
        } else {
            const Material& material = boundary.material_of(boundary.pieces()[std::size_t(interval.piece)]);
            if (material.slope == Colour(0)) {
                sum += (end - start) * material.emission;
                continue;
            }
            // What lies before the surface: its edges are where the sine is 1.
            const Point from = dot(interval.from, normal) > 0 ? interval.from : turned(normal);
            const Point to = dot(interval.to, normal) > 0 ? interval.to : -turned(normal);
            const Moments light = gradient_light(material, p, interval.piece, from, to);
            sum += light.x * normal.x + light.y * normal.y;
        }
    }
    return sum;
}

bool reflect(Elements& elements, const Boundary& boundary, const SkyIntegral& sky,
             const DeltaLights& lights, int bounces, double converged, const Refinement& refinement,
             const Parallel& parallel) {
    const Gather gather{boundary, sky, &elements};
    std::vector<Colour> next, from_lights;
    double brightest = 0, change = 0;
    const auto round = [&](bool is_first) {
        next.resize(elements.count());
        from_lights.resize(elements.count(), Colour(0));
        const bool done = parallel(elements.count(), [&](std::size_t i, Sweep& sweep) {
            const Elements::Element& e = elements.all()[i];
            const auto& seen = sweep.look(e.middle, e.normal, 4 * boundary.tolerance(), true);
            if (is_first) from_lights[i] = lights.irradiance(e.middle, e.normal, seen);
            const Material& material =
                boundary.material_of(boundary.pieces()[std::size_t(e.piece)]);
            const Colour arriving = gather.irradiance(e.middle, e.normal, seen) + from_lights[i];
            next[i] = material.emission_at(e.middle) + 0.5 * material.albedo * arriving;
        });
        if (!done) return false;
        brightest = change = 0;
        for (std::size_t i = 0; i < next.size(); ++i) {
            for (int c = 0; c < 3; ++c) {
                brightest = std::max(brightest, next[i][c]);
                change = std::max(change, std::abs(next[i][c] - elements.all()[i].radiance[c]));
            }
            elements.all()[i].radiance = next[i];
        }
        elements.reconstruct();
        return true;
    };
    // The first bounce has the sharpest edges: it shows where elements must be short.
    for (int i = 0; i < refinement.rounds; ++i) {
        if (!round(true)) return false;
        if (!elements.refine(refinement.share, refinement.least_size)) break;
    }
    elements.restart();
    for (int bounce = 0; bounce < bounces; ++bounce) {
        if (!round(bounce == 0)) return false;
        if (change <= converged * brightest) break;
    }
    return true;
}

}  // namespace penumbra::reference
