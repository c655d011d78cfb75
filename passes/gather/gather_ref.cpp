#include "passes/gather/gather_ref.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace myriad::passes {

using glm::dvec2, glm::dvec3;

namespace {

// add(sum, p, i) for each light i of the set of pixel p; then what rounding may do to the sums.
template <class Add>
std::vector<GatherRef> sum_sets(const HostGBuffer& gbuffer, size_t lights, uint block, Add add) {
    std::vector<GatherRef> out(gbuffer.pixels());
    for (size_t p = 0; p < out.size(); ++p) {
        if (!gbuffer.hit(p)) continue;
        const size_t x = p % gbuffer.width, y = p / gbuffer.width;
        for (size_t i = x % block + y % block * block; i < lights; i += size_t(block) * block) add(out[p], p, i);
        out[p].slack += 1e-5 * out[p].irradiance;
        out[p].mirrored_slack += 1e-5 * out[p].mirrored;
    }
    return out;
}

// `light`: what 1 of the transfer is worth. `doubt`: the share by which lobes' arguments may be off.
void add_mirrored(GatherRef& sum, const dvec3& light, const dvec3& fresnel, double glossy, const Seen& s, double doubt) {
    sum.mirrored += light * fresnel * glossy * s.share;
    sum.mirrored_slack += light * fresnel * glossy * (s.slack + std::min(doubt, 1.0) * (s.share + s.slack));
}

dvec3 unit_light(const Vpl& light, uint block) { return dvec3(light.flux) / std::numbers::pi * double(block * block); }

}  // namespace

std::vector<GatherRef> gather_ref(const HostGBuffer& gbuffer, const std::vector<Vpl>& vpls, uint block, double bound, const SeenRef& seen) {
    return sum_sets(gbuffer, vpls.size(), block, [&](GatherRef& sum, size_t p, size_t i) {
        const dvec3 d = dvec3(vpls[i].position) - dvec3(gbuffer.position(p));
        const double distance = length(d);
        if (distance < 1e-19) return;  // its square is no float
        const double cos_receiver = dot(dvec3(gbuffer.shading(p)), d) / distance;
        const double cos_vpl = -dot(dvec3(unpack_direction(vpls[i].normal)), d) / distance;
        const dvec3 exitance = unit_light(vpls[i], block);
        const double geometry = std::max(cos_receiver, 0.0) * std::max(cos_vpl, 0.0) / (distance * distance), g = std::min(geometry, bound);
        const double rounding = std::min(4e-7 / (distance * distance), bound);
        if (std::min(cos_receiver, cos_vpl) < -1e-6) return;
        const Seen s = seen(p, i);
        const Lobe lobe = gbuffer.lobe(p);
        const double widening = 1 / (bound * distance * distance);
        const BrdfRef f = brdf_ref(gbuffer.gloss_ref(p), dvec3(gbuffer.shading(p)), dvec3(lobe.view), d / distance, widening);
        const double diffuse = std::numbers::pi * f.diffuse;
        sum.irradiance += exitance * (diffuse * g * s.share);
        sum.slack += exitance * (diffuse * ((s.share + s.slack) * rounding + s.slack * g));
        // A cosine that is off by 4e-7 is so by much of itself at grazing angles.
        // So is the half-way vector of opposite ways, in a lobe of this half-width.
        const double half_width = std::sqrt(lobe.alpha2 + widening);
        const double doubt = 4e-7 / std::min(cos_receiver, cos_vpl) + 2e-6 / (half_width * length(d / distance + dvec3(lobe.view))) + 1e-3;
        add_mirrored(sum, exitance, f.fresnel, std::min(f.glossy * geometry, bound / std::numbers::pi), s, doubt);
    });
}

std::vector<GatherRef> far_gather_ref(const HostGBuffer& gbuffer, const std::vector<Vpl>& lights, uint block, const SeenRef& seen) {
    return sum_sets(gbuffer, lights.size(), block, [&](GatherRef& sum, size_t p, size_t i) {
        const dvec3 to_light(far_direction(lights[i])), n(gbuffer.shading(p));
        const double cosine = dot(n, to_light), over = dot(dvec3(gbuffer.geometric(p)), to_light), solid_angle = far_solid_angle(lights[i]);
        if (std::min(cosine, over) < -1e-6) return;
        Seen s = seen(p, i);
        if (std::min(cosine, over) < 1e-6) s = {0.5 * s.share, s.slack + 0.5 * s.share};
        const dvec3 irradiance = unit_light(lights[i], block);
        const Lobe lobe = gbuffer.lobe(p);
        const double widening = solid_angle / std::numbers::pi;
        const BrdfRef f = brdf_ref(gbuffer.gloss_ref(p), n, dvec3(lobe.view), to_light, widening);
        const double diffuse = std::numbers::pi * f.diffuse * std::max(cosine, 0.0);
        sum.irradiance += irradiance * (diffuse * s.share);
        sum.slack += irradiance * (diffuse * s.slack + 4e-7 * (s.share + s.slack));
        const double half_width = std::sqrt(lobe.alpha2 + widening);
        const double doubt = 4e-7 / std::max(cosine, 1e-9) + 2e-6 / (half_width * length(to_light + dvec3(lobe.view))) + 1e-3;
        add_mirrored(sum, irradiance, f.fresnel, std::min(f.glossy * std::max(cosine, 0.0), 1 / solid_angle), s, doubt);
    });
}

std::vector<GatherRef> omni_gather_ref(const HostGBuffer& gbuffer, const std::vector<Vpl>& lights, uint block, const SeenRef& seen) {
    return sum_sets(gbuffer, lights.size(), block, [&](GatherRef& sum, size_t p, size_t i) {
        const dvec3 d = dvec3(lights[i].position) - dvec3(gbuffer.position(p)), n(gbuffer.shading(p));
        const double distance = length(d), radius = omni_radius(lights[i]);
        if (distance < 1e-12) return;
        const double cosine = dot(n, d) / distance, over = dot(dvec3(gbuffer.geometric(p)), d) / distance;
        // A place is as good as its floats, and a near light's direction with it.
        const double turn = 4e-7 + 2e-7 * length(dvec3(gbuffer.position(p))) / distance;
        if (std::min(cosine, over) < -turn) return;
        Seen s = seen(p, i);
        if (std::min(cosine, over) < turn) s = {0.5 * s.share, s.slack + 0.5 * s.share};
        const dvec3 intensity = unit_light(lights[i], block);
        const double spread = 1 / std::pow(std::max(distance, std::max(radius, 1e-12)), 2), g = spread * std::max(cosine, 0.0);
        const double rounding = spread * 3 * turn;
        const Lobe lobe = gbuffer.lobe(p);
        const double widening = std::min(std::pow(radius / distance, 2), 1.0);
        const BrdfRef f = brdf_ref(gbuffer.gloss_ref(p), n, dvec3(lobe.view), d / distance, widening);
        const double diffuse = std::numbers::pi * f.diffuse;
        sum.irradiance += intensity * (diffuse * g * s.share);
        sum.slack += intensity * (diffuse * (s.slack * g + rounding * (s.share + s.slack)));
        const double half_width = std::sqrt(lobe.alpha2 + widening);
        const double doubt = 2 * turn / std::max(cosine, 1e-9) + 5 * turn / (half_width * length(d / distance + dvec3(lobe.view))) + 1e-3;
        add_mirrored(sum, intensity, f.fresnel, std::min(f.glossy * g, 1 / (std::numbers::pi * radius * radius)), s, doubt);
    });
}

Seen parallel_seen_ref(const dvec3& x, const dvec3& n_g, const View& view, const uint* map, uint size, double bias) {
    const ParallelFrame frame = parallel_frame(view.direction);
    const dvec3 d = x - dvec3(view.position), n(view.direction), across(frame.across), down(frame.down);
    const double side = 2.0 * double(view.sin_phi) / size, depth = dot(d, n), slope = dot(n, n_g);
    const uint columns = parallel_columns(view), rows = parallel_rows(view, size);
    const dvec2 place(dot(d, across) / side - 0.5, dot(d, down) / side - 0.5);
    if (std::abs(slope) < 1e-5) return seen_unsure;
    Seen seen{0, 1e-6 * (columns + rows)};
    for (int i = 0; i < 4; ++i) {
        const dvec2 whole = floor(place) + dvec2(i % 2, i / 2), overlap = 1.0 - abs(place - whole);
        const double weight = overlap.x * overlap.y;
        const dvec2 texel = clamp(whole, dvec2(0), dvec2(columns - 1, rows - 1)), off = side * (texel - place);
        // Where the texel's line of sight meets the receiver's plane.
        const double on_plane = depth - dot(off.x * across + off.y * down, n_g) / slope;
        const double limit = (on_plane > 0 ? std::min(on_plane, depth) : depth) - bias * side * std::numbers::sqrt2 / 2;
        const double rounding = 2e-6 * (depth + side * (columns + rows)) / std::abs(slope);
        const double stored = uintBitsToFloat(map[uint(texel.y) * columns + uint(texel.x)]);
        if (std::abs(stored - limit) <= rounding) seen.share += 0.5 * weight, seen.slack += 0.5 * weight;
        else if (stored >= limit) seen.share += weight;
    }
    return seen;
}

Seen map_seen_ref(const dvec3& x, const dvec3& n_g, const dvec3& vpl, const uint* map, uint size, double bias) {
    const dvec3 d = x - vpl;
    const double distance = length(d), facing = dot(d, n_g) / distance;
    const dvec2 uv = dvec2(d.y, d.z) / (distance + std::abs(d.x)), point = 0.5 * double(size) * (uv + 1.0) - 0.5;
    const uint half = d.x < 0 ? half_back : half_front;
    // Where the halves meet, floats may choose the other one; seen head-on, a plane has no depth to speak of.
    if (std::abs(d.x) < 1e-6 * distance || std::abs(facing) < 1e-6) return seen_unsure;
    Seen seen{0, 4e-7 * size};  // weights are as good as (u, v)
    for (int i = 0; i < 4; ++i) {
        // Each of the four texels nearest weighs what a square of a texel's size around the point has in common with it.
        const dvec2 whole = floor(point) + dvec2(i % 2, i / 2), overlap = 1.0 - abs(point - whole);
        const double weight = overlap.x * overlap.y;
        const dvec2 texel = clamp(whole, dvec2(0), dvec2(size - 1));
        const dvec2 middle = (2.0 * texel + 1.0) / double(size) - 1.0;
        const double q = dot(middle, middle);
        const dvec3 w = dvec3(d.x < 0 ? q - 1 : 1 - q, 2 * middle.x, 2 * middle.y) / (1 + q);
        const double slope = dot(w, n_g), on_plane = distance * facing / slope;
        const double depth = on_plane > 0 ? std::min(on_plane, distance) : distance;
        const double limit = depth - bias * distance * 2 * std::numbers::sqrt2 / (size * (1 + dot(uv, uv)));
        const double rounding = 1e-6 * (distance + depth * (1 / std::abs(facing) + 1 / std::abs(slope)));
        const double stored = uintBitsToFloat(map[texel_index(half, uint(texel.x), uint(texel.y), size)]);
        if (std::abs(stored - limit) <= rounding) seen.share += 0.5 * weight, seen.slack += 0.5 * weight;
        else if (stored >= limit) seen.share += weight;
    }
    return seen;
}

std::vector<uint> exact_map(const vec3& from, const scenes::Triangles& triangles, uint size) {
    std::vector<uint> map;
    for (uint half_index : {half_front, half_back})
        for (uint y = 0; y < size; ++y)
            for (uint x = 0; x < size; ++x) {
                const dvec3 w(unproject(half_index, texel_middle(x, y, size)));
                map.push_back(floatBitsToUint(float(closest_ref(triangles, dvec3(from), w, 1e-5, HitRef{}.t).t)));
            }
    return map;
}

Seen ray_seen_ref(const dvec3& from, const dvec3& to, const scenes::Triangles& triangles, const ThereRef& there) {
    Seen seen = seen_whole;
    for (uint32_t i = 0; i < triangles.triangles.size(); ++i) {
        const uvec4& t = triangles.triangles[i];
        const dvec3 a = dvec3(triangles.positions[t.x]) - from, b = dvec3(triangles.positions[t.y]) - from, c = dvec3(triangles.positions[t.z]) - from;
        const dvec3 d = to - from, n = cross(b - a, c - a);
        // Weights from the volumes that the ray spans with the edges, and t from the triangle's plane.
        const double wa = dot(d, cross(b, c)), wb = dot(d, cross(c, a)), wc = dot(d, cross(a, b)), sum = wa + wb + wc;
        const double inside = std::min({wa / sum, wb / sum, wc / sum}), at = dot(a, n) / dot(d, n);
        // A ray leaves its own triangle from some 1e-6 of its length away (ray_origin), which is no doubt.
        const double margin = std::min(inside / 1e-4, std::min(at, 1 - at) / 5e-7);
        if (margin > -1 && there && !there(i, std::max(wb / sum, 0.0), std::max(wc / sum, 0.0))) continue;
        if (margin > 1) return seen_not;
        if (margin > -1) seen = seen_unsure;
    }
    return seen;
}

}  // namespace myriad::passes
