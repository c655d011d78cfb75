// A ball of hair, after the well-known test scene (Laine and Karras 2010): strands start on a core and swirl outwards, each
// a tube of its own. There is no level of detail to find by luck: everything is thinner than a pixel of a small view, all
// of it shadows the rest, and bounds of its parts overlap without end.
//
// It lies in a photographer's booth: a grey paper sweep between a red and a blue flat, a soft box above and one hard lamp.
#include "scenes/builtin.hpp"
#include "scenes/builtin/curves.hpp"
#include "scenes/builtin/textures.hpp"

#include <algorithm>
#include <array>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace myriad::scenes {
namespace {

using glm::vec2;
using glm::vec3;
using kit::pi;

constexpr float ball = 1.0f, core = 0.30f;     // radii, in metres
constexpr vec3 ball_centre{0, 0.95f, 0};
constexpr int rings = 23, sides = 4;           // of a strand: 2 points, 21 rings of vertices, 168 triangles

// A divergence-free field, the curl of a sum of plane waves: it bends neighbouring strands alike, into locks, and thins
// them nowhere.
class Swirl {
public:
    explicit Swirl(kit::Random& random) {
        for (size_t i = 0; i < waves_.size(); ++i) {
            const vec3 way = sphere(random), across = glm::normalize(glm::cross(way, sphere(random)));
            const float frequency = 2.2f * std::pow(1.28f, float(i));
            waves_[i] = {way * frequency, across, random.real(0, 2 * pi)};
        }
    }
    vec3 at(vec3 p) const {
        vec3 sum(0);
        for (const Wave& w : waves_) sum += w.across * std::cos(glm::dot(w.way, p) + w.phase);
        return sum * std::sqrt(2 / float(waves_.size()));
    }
    static vec3 sphere(kit::Random& random) {
        const float z = random.real(-1, 1), angle = random.real(0, 2 * pi), r = std::sqrt(1 - z * z);
        return {r * std::cos(angle), r * std::sin(angle), z};
    }

private:
    struct Wave {
        vec3 way, across;
        float phase;
    };
    std::array<Wave, 8> waves_;
};

// Strands start evenly over the core, by a golden spiral, so that every count covers it alike.
vec3 start(uint32_t i, uint32_t count) {
    const float y = 1 - (2 * float(i) + 1) / float(count), r = std::sqrt(1 - y * y);
    const float turn = float(i * 0.6180339887498949 - std::floor(i * 0.6180339887498949));
    return {r * std::cos(2 * pi * turn), y, r * std::sin(2 * pi * turn)};
}

void strand(Primitive& hair, uint32_t i, uint32_t count, float thickness, const Swirl& swirl, kit::Random& random) {
    const vec3 root = start(i, count), own = Swirl::sphere(random);
    const float length = random.real(1.3f, 2.3f), step = length / float(rings - 1);
    // Locks have a colour, with some variation among their strands.
    const float tone = std::clamp(0.5f + 0.4f * swirl.at(1.5f * root).x + random.real(-0.3f, 0.3f), 0.02f, 0.98f);
    const float shell = ball * random.real(0.86f, 1.0f);  // where this strand turns along the surface
    std::vector<vec3> points(rings);
    std::vector<float> radii(rings);
    vec3 p = root * (core - 0.02f), ahead = root;
    for (int k = 0; k < rings; ++k) {
        const float t = float(k) / float(rings - 1), r = glm::length(p);
        points[size_t(k)] = ball_centre + p;
        radii[size_t(k)] = k == 0 || k == rings - 1 ? 0 : 0.5f * thickness * (1 - 0.7f * t * t);
        // Outwards while inside, along the ball near its surface, back where it was left; bent with its neighbours.
        const vec3 out = p / r;
        const float pull = std::clamp((shell - r) / (0.3f * ball), -1.5f, 1.0f);
        vec3 bend = swirl.at(p + 0.06f * own) + own * 0.22f;
        bend -= out * glm::dot(bend, out) * glm::smoothstep(0.5f * ball, 0.9f * ball, r);
        ahead = glm::normalize(ahead * 1.2f + out * (0.5f * pull) + bend * (0.25f + 0.45f * t));
        p += ahead * step;
        // The paper is in the way of the lowest strands: they lie on it.
        p.y = std::max(p.y, thickness - ball_centre.y + 0.06f * (1 - t) * (1 - t) * tone);
    }
    const size_t first = hair.texcoords.size();
    kit::tube(hair, points, radii, sides);
    for (size_t v = first; v < hair.texcoords.size(); ++v) hair.texcoords[v].x = tone;
}

// u: from the darkest to the lightest strand, v: from root to tip.
Texture tones() {
    constexpr std::array<vec3, 4> strands = {vec3(0.36f, 0.15f, 0.07f), vec3(0.62f, 0.32f, 0.14f), vec3(0.76f, 0.53f, 0.28f), vec3(0.84f, 0.71f, 0.48f)};
    Texture texture = kit::picture("hair tones", 32, 32, [&](vec2 uv) {
        const float u = 3 * uv.x;
        return glm::mix(strands[size_t(u)], strands[size_t(u) + 1], u - std::floor(u)) * (0.62f + 0.38f * std::min(1.0f, 1.4f * uv.y));
    });
    texture.wrap_u = texture.wrap_v = Texture::Wrap::clamp;
    return texture;
}

// Floor and back wall are one sheet, which curves up; the flats, the ceiling and the wall behind the camera are slabs.
void booth(Scene& scene) {
    const uint32_t paper = kit::add_material(scene, "grey paper", vec3(0.62f, 0.62f, 0.63f), 1);
    const uint32_t red = kit::add_material(scene, "red flat", {0.66f, 0.13f, 0.08f}, 1);
    const uint32_t blue = kit::add_material(scene, "blue flat", {0.10f, 0.25f, 0.58f}, 1);
    const uint32_t white = kit::add_material(scene, "white wall", vec3(0.74f), 1);
    const uint32_t black = kit::add_material(scene, "black cloth", vec3(0.2f), 1);
    constexpr float half = 2.3f, high = 3.4f, front = 4.2f, back = -2.1f, bend = 1.1f, wall = 0.12f;

    Primitive sweep;
    sweep.material = paper;
    kit::Profile section = {{front + 0.05f, 0}, {back + bend, 0}};  // (z, y) from the front to the top of the back
    for (int i = 1; i <= 24; ++i) {
        const float angle = pi / 2 * float(i) / 24;
        section.push_back({back + bend - bend * std::sin(angle), bend - bend * std::cos(angle)});
    }
    section.push_back({back, high + 0.05f});
    section.insert(section.end(), {{back - wall, high + 0.05f}, {back - wall, -wall}, {front + 0.05f, -wall}, section.front()});
    kit::sweep(sweep, section, 12, [&](vec2 p, float t) { return vec3((1 - 2 * t) * (half + 0.05f), p.y, p.x); });
    kit::add_instance(scene, kit::add_mesh(scene, "sweep", {std::move(sweep)}));

    const auto slab = [&](const char* name, uint32_t material, vec3 lo, vec3 hi) {
        Primitive p;
        p.material = material;
        kit::box(p, lo, hi, 0.5f);
        kit::add_instance(scene, kit::add_mesh(scene, name, {std::move(p)}));
    };
    slab("red flat", red, {-half - wall, -wall - 0.02f, back - 0.1f}, {-half, high + 0.06f, front + 0.1f});
    slab("blue flat", blue, {half, -wall - 0.02f, back - 0.1f}, {half + wall, high + 0.06f, front + 0.1f});
    slab("ceiling", white, {-half - 0.06f, high, back - 0.06f}, {half + 0.06f, high + wall, front + 0.04f});
    slab("curtain", black, {-half - 0.06f, -wall - 0.01f, front}, {half + 0.06f, high + 0.07f, front + wall});

    // The soft box hangs from the ceiling by nothing, a shallow tray with a lit underside.
    const uint32_t lamp = kit::add_material(scene, "soft box", vec3(0.75f), 1);
    scene.materials[lamp].emissive = {19, 18, 16.5f};
    const glm::mat4 place = glm::translate(glm::mat4(1), vec3(-0.7f, 3.05f, -0.1f)) * glm::rotate(glm::mat4(1), glm::radians(-14.0f), vec3(0, 0, 1));
    Primitive tray, panel;
    tray.material = black, panel.material = lamp;
    kit::box(tray, {-0.9f, 0, -0.65f}, {0.9f, 0.08f, 0.65f}, 0.3f);
    kit::quad(panel, {-0.86f, -0.006f, -0.61f}, {1.72f, 0, 0}, {0, 0, 1.22f}, 6, 4);  // faces down
    kit::add_instance(scene, kit::add_mesh(scene, "soft box", {std::move(tray), std::move(panel)}), place);
}

}  // namespace

Scene make_hairball(const BuiltinOptions& options, uint32_t seed) {
    Scene scene;
    kit::Random random(seed);
    const auto count = uint32_t(options.number("strands"));
    scene.textures.push_back(tones());
    const uint32_t hair_material = kit::add_material(scene, "hair", vec3(1), 0.6f, 0);
    const uint32_t skin = kit::add_material(scene, "core", {0.30f, 0.20f, 0.13f}, 1);

    // Fewer strands are thicker, so that the ball stays about as dense to look at.
    const float thickness = std::clamp(0.013f * std::sqrt(5000 / float(count)), 0.001f, 0.03f) * options.number("thickness");
    const Swirl swirl(random);
    Primitive hair, inside;
    hair.material = hair_material, inside.material = skin;
    constexpr size_t vertices = size_t(rings - 2) * sides + 2, triangles = size_t(rings - 2) * sides * 2;
    hair.positions.reserve(count * vertices), hair.normals.reserve(count * vertices), hair.texcoords.reserve(count * vertices);
    hair.indices.reserve(count * triangles * 3);
    for (uint32_t i = 0; i < count; ++i) strand(hair, i, count, thickness, swirl, random);
    kit::Profile meridian;
    for (int i = 0; i <= 24; ++i) meridian.push_back({i % 24 ? core * std::sin(pi * float(i) / 24) : 0, -core * std::cos(pi * float(i) / 24)});
    kit::lathe(inside, meridian, 48);
    kit::add_instance(scene, kit::add_mesh(scene, "hair", {std::move(hair)}));
    kit::add_instance(scene, kit::add_mesh(scene, "core", {std::move(inside)}), glm::translate(glm::mat4(1), ball_centre));

    booth(scene);
    const vec3 lamp(2.0f, 2.65f, 2.7f);
    scene.lights.push_back({Light::Type::spot, "key", lamp, glm::normalize(ball_centre - lamp), vec3(62, 55, 44), 0.25f, 0.85f});
    kit::add_camera(scene, "front", {0.25f, 1.25f, 4.0f}, {0, 0.98f, 0}, 40);
    kit::add_camera(scene, "close", {-0.9f, 1.35f, 1.95f}, {-0.28f, 1.12f, 0}, 40);
    return scene;
}

}  // namespace myriad::scenes
