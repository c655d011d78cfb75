// Glowing particles (MegaViews 5.2): the atrium by night, and in it swarms of small lights that shine in all directions. One winds up over
// the fountain, two ribbons go around the court, and small swarms turn around columns, through the arches beside them.
//
// Each particle's way is a closed curve in closed form; the clip has its places and velocities at even times, and Hermite's cubics between
// them are within millimetres of the curve. All particles share one power, so that the picture is as bright with few as with many.
#include "scenes/builtin.hpp"
#include "scenes/builtin/atrium_parts.hpp"

#include <array>
#include <cmath>

namespace myriad::scenes {
namespace {

using glm::dvec3;
using glm::vec3;

constexpr double turn = 6.283185307179586;
constexpr double round = 16;                    // seconds
constexpr int keys = 32;                        // a round; the fastest turn in 8 of them
constexpr vec3 night{0.006f, 0.010f, 0.022f};   // radiance of the sky
constexpr double whole = 260;                   // W/sr, of all particles together
constexpr double ball = 1.8;                    // metres: all particles' discs together are as large as one of this radius, so that they are as bright whatever their number

// Where a particle is after a part t of a round.
struct Way {
    enum class Kind { funnel, ribbon, column } kind = Kind::funnel;
    dvec3 middle{0};
    double radius = 0, height = 0, turns = 1, phase = 0, lift = 0, lift_phase = 0, twist = 0;

    dvec3 at(double t) const {
        const double a = turn * (turns * t + phase), wave = std::sin(turn * (t + lift_phase));
        if (kind != Kind::ribbon) return middle + dvec3(radius * std::cos(a), height + lift * wave, radius * std::sin(a));
        // Along an ellipse that rises and falls; around it in a helix.
        const double b = turn * (twist * t + lift_phase);
        const dvec3 out(std::cos(a), 0, std::sin(a));
        return middle + dvec3((9.4 - lift) * out.x, height + lift * std::sin(2 * a), (2.9 - 0.3 * lift) * out.z) + radius * (std::cos(b) * out + dvec3(0, std::sin(b), 0));
    }
    dvec3 velocity(double t) const { return (at(t + 1e-4) - at(t - 1e-4)) / (2e-4 * round); }
};

// Columns whose arches on both sides are free of cloth, and that no shrub stands at (atrium.cpp, cloths(), furnish_court()): x, z, and which storey.
constexpr std::array<vec3, 10> columns = {{{9, 0, 4.5f}, {0, 0, 4.5f}, {-12, 0, -1.5f}, {-12, 0, 1.5f},
                                           {-3, 1, -4.5f}, {0, 1, -4.5f}, {9, 1, -4.5f}, {9, 1, 4.5f}, {6, 1, 4.5f}, {-3, 1, 4.5f}}};

struct Particle {
    Way way;
    vec3 color;
};

Particle particle(kit::Random& random) {
    const auto real = [&](double lo, double hi) { return double(random.real(float(lo), float(hi))); };
    const auto sign = [&] { return random.below(2) ? 1.0 : -1.0; };
    Particle p;
    Way& w = p.way;
    w.phase = real(0, 1), w.lift_phase = real(0, 1);
    const uint32_t kind = random.below(16);
    if (kind < 6) {
        // A funnel over the fountain: wide and slow above, narrow and fast below.
        const double up = std::sqrt(real(0, 1));
        w.middle = {1.5, 0, 0};
        w.radius = (0.25 + 3.0 * up * up) * (1 + real(-0.12, 0.12)), w.height = 2.75 + 5.6 * up, w.lift = 0.22;
        w.turns = 4 - std::round(3 * up);
        p.color = glm::mix(vec3(1.0f, 0.24f, 0.03f), vec3(1.0f, 0.58f, 0.14f), real(0, 1) * up);
    } else if (kind < 12) {
        const bool upper = kind >= 9;
        w.kind = Way::Kind::ribbon;
        w.radius = 0.5 * std::sqrt(real(0, 1)), w.height = upper ? 6.6 : 4.3, w.lift = upper ? 0.7 : 1.0, w.turns = upper ? -1 : 1, w.twist = 3;
        p.color = upper ? glm::mix(vec3(0.12f, 0.24f, 1.0f), vec3(0.58f, 0.14f, 1.0f), real(0, 1)) : glm::mix(vec3(0.03f, 0.52f, 0.80f), vec3(0.06f, 0.85f, 0.34f), real(0, 1));
    } else {
        const vec3& column = columns[random.below(uint32_t(columns.size()))];
        const bool upper = column.y > 0;
        w.kind = Way::Kind::column;
        w.middle = {column.x, upper ? 7.30 : 1.75, column.z};
        w.radius = real(0.62, 0.98), w.height = upper ? real(-0.15, 0.15) : real(-0.5, 0.5), w.lift = upper ? 0.2 : 0.5, w.turns = sign() * (2 + double(random.below(2)));
        p.color = upper ? vec3(1.0f, 0.14f, 0.30f) : vec3(1.0f, 0.62f, 0.12f);
    }
    return p;
}

Track track(const Way& way) {
    Track track{.interpolation = Track::Interpolation::cubic, .width = 3};
    for (int i = 0; i <= keys; ++i) {
        const double t = double(i % keys) / keys;  // the last is the first, to the bit
        const vec3 at(way.at(t)), velocity(way.velocity(t));
        track.times.push_back(float(round * i / keys));
        for (const vec3& v : {velocity, at, velocity}) track.values.insert(track.values.end(), {v.x, v.y, v.z});
    }
    return track;
}

}  // namespace

Scene make_particles(const BuiltinOptions& options, uint32_t seed) {
    Scene scene = atrium::without_sun(options.number("detail"), seed, night);
    const uint32_t count = uint32_t(options.number("count"));
    kit::Random random(uint64_t(seed) ^ 0x9a271c1e5ull);
    Clip swarm{.name = "swarm"};
    swarm.tracks.reserve(count), swarm.channels.reserve(count);
    scene.nodes.reserve(count), scene.lights.reserve(count);
    double sum = 0;
    for (uint32_t i = 0; i < count; ++i) {
        const Particle p = particle(random);
        const double share = 0.5 + double(random.real());
        sum += share * (double(p.color.x) + double(p.color.y) + double(p.color.z)) / 3;
        scene.nodes.push_back({.rest = {.translation = dvec3(vec3(p.way.at(0)))}});
        scene.lights.push_back({.position = vec3(p.way.at(0)), .intensity = float(share) * p.color, .node = i, .radius = float(std::min(0.08, ball / std::sqrt(double(count))))});
        swarm.channels.push_back({i, i, Path::translation});
        swarm.tracks.push_back(track(p.way));
    }
    for (Light& light : scene.lights) light.intensity *= float(whole / sum);
    if (count > 0) scene.clips.push_back(std::move(swarm));
    return scene;
}

}  // namespace myriad::scenes
