// Tea time: a round table laid for tea in the corner of a room. The afternoon sun comes in through two arched windows on
// the left, across the table and the floor; the garden outside and what the sun strikes light the rest.
//
// All is built here from surfaces of revolution, swept sections and patches; ornaments are computed.
#include "scenes/builtin.hpp"
#include "scenes/builtin/teatime_parts.hpp"

#include <array>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace myriad::scenes {
namespace {

using namespace teatime;
using glm::mat4;
using glm::vec2;
using glm::vec3;
using kit::pi;
using kit::moved;
using kit::turned;

// The room: x from the window wall to the right, z from the picture wall towards the camera.
constexpr float left = -1.95f, right = 2.6f, back = -1.85f, front = 3.0f, ceiling = 2.75f, wall = 0.30f;
constexpr float table_height = 0.735f, table_radius = 0.62f, cloth_side = 1.90f;
constexpr float top = table_height + 0.006f;  // what stands on the cloth
constexpr kit::Opening window{{0.55f, 0.55f}, 0.80f, 1.75f};
constexpr std::array<float, 2> windows = {-0.55f, 1.45f};  // z of their axes

const vec3 sun_direction = glm::normalize(vec3(0.82f, -0.42f, 0.20f));
constexpr vec3 sun_irradiance{5.6f, 4.5f, 3.1f};
constexpr float garden_radiance = 2.0f;

class Teatime {
public:
    Teatime(float detail, uint32_t seed) : detail_(detail), seed_(seed), random_(seed) {}

    Scene make() {
        materials();
        room();
        window_wall();
        furniture();
        lay_table();
        scene_.lights.push_back({Light::Type::directional, "sun", {-10, 8, 0}, sun_direction, sun_irradiance});
        kit::add_camera(scene_, "table", {0.70f, 1.22f, 1.02f}, {-0.06f, 0.815f, -0.04f}, 40);
        kit::add_camera(scene_, "room", {2.2f, 1.55f, 2.55f}, {-0.45f, 0.82f, -0.35f}, 50);
        kit::add_camera(scene_, "teapot", {0.385f, 0.985f, 0.50f}, {-0.09f, 0.806f, 0.0f}, 40);
        return std::move(scene_);
    }

private:
    uint32_t plain(const char* name, vec3 albedo, float roughness = 0.6f, bool sheet = false) {
        const uint32_t material = kit::add_material(scene_, name, albedo, roughness);
        scene_.materials[material].double_sided = sheet;
        return material;
    }
    uint32_t textured(Texture texture, float roughness = 0.6f, bool sheet = false) {
        const std::string name = texture.name;
        scene_.textures.push_back(std::move(texture));
        const uint32_t material = kit::add_material(scene_, name, vec3(1), roughness, uint32_t(scene_.textures.size() - 1));
        scene_.materials[material].double_sided = sheet;
        return material;
    }

    void materials() {
        china_ = plain("china", {0.80f, 0.79f, 0.765f}, 0.15f);
        pot_ = textured(ornament("ornament of the pot", 5, {0.10f, 0.17f, 0.46f}, seed_ + 1), 0.15f);
        cup_ = textured(ornament("ornament of cups", 4, {0.10f, 0.17f, 0.46f}, seed_ + 2), 0.15f);
        rim_ = textured(ornament("ornament of plates", 12, {0.10f, 0.17f, 0.46f}, seed_ + 3), 0.15f);
        silver_ = plain("silver", {0.66f, 0.655f, 0.64f}, 0.2f);
        brass_ = plain("brass", {0.68f, 0.50f, 0.20f}, 0.3f);
        tea_ = plain("tea", {0.42f, 0.16f, 0.04f}, 0.1f);
        milk_ = plain("milk", {0.80f, 0.79f, 0.75f}, 0.2f);
        sugar_ = plain("sugar", {0.80f, 0.80f, 0.79f});
        linen_ = textured(tablecloth_linen(seed_ + 4), 0.9f, true);
        napkin_ = plain("blue napkin", {0.26f, 0.36f, 0.56f}, 0.9f, true);
        walnut_ = plain("walnut", {0.29f, 0.165f, 0.09f}, 0.5f);
        oak_ = plain("bent beech", {0.46f, 0.25f, 0.12f}, 0.5f);
        cane_ = plain("cane", {0.70f, 0.55f, 0.33f}, 0.8f);
        white_ = plain("white paint", {0.76f, 0.75f, 0.72f}, 0.6f);
        ceiling_ = plain("ceiling", {0.78f, 0.77f, 0.74f}, 0.9f);
        icing_ = plain("icing", {0.79f, 0.74f, 0.68f});
        cream_ = plain("cream", {0.80f, 0.78f, 0.72f});
        berry_ = plain("strawberries", {0.66f, 0.05f, 0.05f}, 0.3f);
        green_ = plain("leaves", {0.16f, 0.36f, 0.10f}, 0.6f, true);
        petals_ = plain("rose petals", {0.76f, 0.33f, 0.37f}, 0.7f, true);
        gold_ = plain("gilt frame", {0.70f, 0.52f, 0.22f}, 0.4f);
        paper_ = plain("paper", {0.76f, 0.72f, 0.62f}, 0.9f);
        glaze_ = plain("blue glaze", {0.14f, 0.28f, 0.46f}, 0.2f);
        sponge_ = textured(cut_cake(seed_ + 5), 0.9f);
        floor_ = textured(kit::planks("oak floor", 8, {0.56f, 0.36f, 0.20f}, {0.34f, 0.19f, 0.095f}, seed_ + 6), 0.5f);
        wallpaper_ = textured(wallpaper(seed_ + 7), 0.9f);
        carpet_ = textured(carpet(seed_ + 8), 0.9f);
    }

    // ---- what the clip "tea" moves, in a round of 8 s

    Clip& clip() {
        if (scene_.clips.empty()) scene_.clips.push_back({.name = "tea"});
        return scene_.clips[0];
    }
    void animate(uint32_t node, Path path, Track track) {
        clip().channels.push_back({node, uint32_t(clip().tracks.size()), path});
        clip().tracks.push_back(std::move(track));
    }
    // A node at `at`, from which the instance hangs as it stands.
    uint32_t hang(const char* name, const mat4& at, Instance& instance) {
        const uint32_t node = uint32_t(scene_.nodes.size());
        scene_.nodes.push_back({.name = name, .rest = {.translation = glm::dvec3(at[3]), .rotation = glm::quat_cast(glm::dmat3(at))}});
        scene_.nodes.push_back({.parent = node, .matrix = glm::inverse(scene_.nodes[node].rest.matrix()) * glm::dmat4(instance.to_world)});
        instance.node = node + 1;
        return node;
    }

    // About the vertical through `at`, once a round.
    void turn_around(const mat4& at, Instance& instance) {
        Track track{.interpolation = Track::Interpolation::linear, .width = 4};
        for (int quarter = 0; quarter <= 4; ++quarter) {
            const float half = float(quarter) * pi / 4;
            track.times.push_back(2 * float(quarter));
            track.values.insert(track.values.end(), {0, std::sin(half), 0, std::cos(half)});
        }
        animate(hang("turntable", at, instance), Path::rotation, std::move(track));
    }

    // In the cup at `cup`, four times a round: the bowl of the spoon goes in a circle, its handle leans over the rim. At rest it
    // lies on the saucer.
    void stir(const mat4& cup, Instance& spoon) {
        constexpr float radius = 0.009f, seconds = 2, lean = glm::radians(65.0f);
        const uint32_t seat = uint32_t(scene_.nodes.size());
        scene_.nodes.push_back({.name = "cup", .matrix = glm::dmat4(cup)});
        const glm::dmat4 lies = glm::inverse(glm::dmat4(cup)) * glm::dmat4(spoon.to_world);
        scene_.nodes.push_back({.name = "spoon", .parent = seat, .rest = {.translation = glm::dvec3(lies[3]), .rotation = glm::quat_cast(glm::dmat3(lies))}});
        spoon.node = seat + 1;
        // Cubic pieces with the circle's own tangents are a circle, to a fortieth of a percent.
        Track circle{.interpolation = Track::Interpolation::cubic, .width = 3}, leans;
        for (int i = 0; i <= 32; ++i) {
            const float angle = float(i) * pi / 4, speed = 2 * pi / seconds;
            const vec3 at(radius * std::cos(angle), 0.034f, radius * std::sin(angle)), tangent = speed * vec3(-at.z, 0, at.x);
            circle.times.push_back(float(i) * seconds / 8);
            for (const vec3& v : {tangent, at, tangent}) circle.values.insert(circle.values.end(), {v.x, v.y, v.z});
        }
        leans = {.interpolation = Track::Interpolation::step, .width = 4, .times = {0}};
        const glm::quat q = glm::angleAxis(-pi / 2, vec3(0, 1, 0)) * glm::angleAxis(lean, vec3(0, 0, 1));
        leans.values = {q.x, q.y, q.z, q.w};
        animate(spoon.node, Path::translation, std::move(circle));
        animate(spoon.node, Path::rotation, std::move(leans));
    }

    // A breath of air from the windows: two morph targets, a wave and its quarter, whose weights go around, so that it travels.
    void billow(Instance& curtains) {
        Primitive& cloth = scene_.meshes[curtains.mesh].primitives[0];
        cloth.targets.resize(2);
        for (int k = 0; k < 2; ++k) {
            // How far into the room, metres: nothing at the rod, most at the hem.
            const auto out = [&](double y, double z) {
                const double q = std::clamp((2.5 - y) / 2.5, 0.0, 1.0);
                return 0.075 * q * q * std::sin(2.4 * y + 1.7 * z + k * double(pi) / 2);
            };
            for (size_t i = 0; i < cloth.positions.size(); ++i) {
                const glm::dvec3 p(cloth.positions[i]);
                constexpr double h = 1e-4;
                const glm::dvec3 slope(0, (out(p.y + h, p.z) - out(p.y - h, p.z)) / (2 * h), (out(p.y, p.z + h) - out(p.y, p.z - h)) / (2 * h));
                cloth.targets[size_t(k)].positions.emplace_back(out(p.y, p.z), 0, 0);
                cloth.targets[size_t(k)].normals.push_back(glm::vec3(-slope * double(cloth.normals[i].x)));
            }
        }
        curtains.node = uint32_t(scene_.nodes.size());
        scene_.nodes.push_back({.name = "curtains", .weights = {0, 0}});
        Track track{.interpolation = Track::Interpolation::linear, .width = 2};
        for (int i = 0; i <= 64; ++i) {  // twice a round
            const float angle = float(i) * pi / 16;
            track.times.push_back(float(i) / 8);
            track.values.insert(track.values.end(), {std::cos(angle), std::sin(angle)});
        }
        animate(curtains.node, Path::weights, std::move(track));
    }

    uint32_t mesh(const char* name, std::vector<std::pair<uint32_t, Primitive>> parts) { return kit::add_mesh(scene_, name, std::move(parts)); }
    void place(uint32_t mesh, const mat4& at) { kit::add_instance(scene_, mesh, at); }
    uint32_t china(const char* name, China piece, uint32_t painted) { return mesh(name, {{painted, std::move(piece.painted)}, {china_, std::move(piece.plain)}}); }

    // Walls are slabs whose ends run into each other; the wallpapered ones have their paper as a face before them.
    void room() {
        Primitive boards, slabs, ceiling_slab, paper, trim;
        kit::quad(boards, {left - 0.05f, 0, back - 0.05f}, {0, 0, front - back + 0.1f}, {right - left + 0.1f, 0, 0}, 12, 12);
        for (size_t i = 0; i < boards.positions.size(); ++i) boards.texcoords[i] = vec2(boards.positions[i].x, boards.positions[i].z) * vec2(0.45f, 0.8f);
        kit::box(slabs, {left - wall, -0.3f, back - wall}, {right + wall, -0.05f, front + wall}, 1);
        kit::box(slabs, {left - wall + 0.01f, -0.29f, back - wall + 0.02f}, {right + wall - 0.01f, ceiling + 0.2f, back - 0.01f}, 1);
        kit::box(slabs, {right, -0.28f, back - wall + 0.03f}, {right + wall - 0.03f, ceiling + 0.19f, front + wall - 0.03f}, 1);
        kit::box(slabs, {left - wall + 0.04f, -0.27f, front}, {right + wall - 0.05f, ceiling + 0.18f, front + wall - 0.05f}, 1);
        kit::box(ceiling_slab, {left - wall + 0.02f, ceiling, back - wall + 0.04f}, {right + wall - 0.02f, ceiling + 0.17f, front + wall - 0.02f}, 1);
        const auto papered = [&](vec3 corner, vec3 along) {
            const uint32_t first = uint32_t(paper.positions.size());
            kit::quad(paper, corner, along, {0, ceiling - 0.9f, 0}, 8, 4);
            for (uint32_t i = first; i < paper.positions.size(); ++i) {
                const float at = glm::dot(paper.positions[i] - corner, glm::normalize(along));
                paper.texcoords[i] = vec2(at, paper.positions[i].y) * 1.35f;
            }
        };
        papered({left, 0.9f, back + 0.004f}, {right - left, 0, 0});
        papered({right - 0.004f, 0.9f, back}, {0, 0, front - back});

        // Skirting, panelling to the height of the rail, and a cornice, around the room.
        const mat4 centre = moved({(left + right) / 2, 0, (back + front) / 2});
        const vec2 half{(right - left) / 2, (front - back) / 2};
        Primitive around;
        kit::ring(around, {{-0.05f, -0.01f}, {0.022f, -0.01f}, {0.022f, 0.11f}, {0.014f, 0.13f}, {0.010f, 0.15f}, {-0.05f, 0.15f}}, half, 0.5f);
        kit::ring(around, {{-0.05f, 0.865f}, {0.012f, 0.865f}, {0.030f, 0.885f}, {0.036f, 0.90f}, {0.030f, 0.915f}, {0.010f, 0.925f}, {-0.05f, 0.925f}}, half, 0.5f);
        kit::ring(around, {{-0.05f, ceiling - 0.13f}, {0.012f, ceiling - 0.13f}, {0.018f, ceiling - 0.10f}, {0.05f, ceiling - 0.075f}, {0.085f, ceiling - 0.03f}, {0.10f, ceiling - 0.025f}, {0.10f, ceiling + 0.01f}}, half, 0.5f);
        kit::append(trim, around, centre);
        // The panelling of a wall `width` wide, facing +z, its left end at the origin.
        const auto panelling = [&](float width, int count, const mat4& at) {
            Primitive wall_panels;
            kit::box(wall_panels, {-0.02f, 0, -0.03f}, {width + 0.02f, 0.88f, 0.006f}, 0.6f, kit::front);
            for (int i = 0; i < count; ++i) {
                const float x0 = width * float(i) / float(count) + 0.05f, x1 = width * float(i + 1) / float(count) - 0.05f;
                const vec2 lo(x0, 0.22f), hi(x1, 0.79f);
                Primitive bead;
                kit::ring(bead, {{-0.026f, 0.003f}, {0, 0.003f}, {0, 0.008f}, {-0.008f, 0.016f}, {-0.018f, 0.014f}, {-0.026f, 0.008f}, {-0.026f, 0.003f}}, (hi - lo) / 2.0f, 0.3f);
                kit::append(wall_panels, bead, moved(vec3((lo + hi) / 2.0f, 0)) * glm::rotate(mat4(1), pi / 2, vec3(1, 0, 0)));
            }
            kit::append(trim, wall_panels, at);
        };
        panelling(right - left, 7, moved({left, 0, back}));
        panelling(front - back, 7, moved({right, 0, back}) * turned(-90));
        panelling(front - back, 7, moved({left, 0, front}) * turned(90));
        place(mesh("room", {{floor_, std::move(boards)}, {white_, std::move(slabs)}, {ceiling_, std::move(ceiling_slab)}, {wallpaper_, std::move(paper)}, {white_, std::move(trim)}}), mat4(1));
    }

    // The wall with the windows, the light from outside, and curtains.
    void window_wall() {
        Primitive shell, bars, curtains, rods, outside;
        const float thick = wall;
        // Panels from window to window; turned so that +z of the panel is +x of the room.
        const mat4 at_wall = moved({left - thick / 2, 0, 0}) * turned(90);
        const std::array<float, 3> ends = {front + 0.1f, (windows[0] + windows[1]) / 2, back - 0.1f};
        for (size_t i = 0; i < windows.size(); ++i) {
            const float w = windows[windows.size() - 1 - i];
            // The panel is symmetric about its window; what is left to the next panel is a box.
            const float reach = std::min(ends[i] - w, w - ends[i + 1]);
            Primitive panel;
            kit::opening_panel(panel, 2 * reach, ceiling + 0.1f, window, thick, steps(28, detail_));
            kit::append(shell, panel, at_wall * moved({-w, 0, 0}));
            for (auto [from, to] : {std::pair(ends[i], w + reach), std::pair(w - reach, ends[i + 1])})
                if (from - to > 0.01f) kit::box(shell, {left - thick, 0, to}, {left, ceiling + 0.1f, from}, 0.5f, kit::left | kit::right);

            // Frame and glazing bars.
            Primitive one;
            const kit::Profile section = kit::ellipse(0.035f, 0.045f, steps(10, detail_)), thin = {{0.014f, 0}, {0.006f, 0.016f}, {-0.006f, 0.016f}, {-0.014f, 0}, {-0.006f, -0.016f}, {0.006f, -0.016f}, {0.014f, 0}};
            Primitive frame;
            kit::arch_moulding(frame, section, window.arch, window.spring - window.sill, steps(28, detail_));
            kit::append(one, frame, moved({0, window.spring, 0}));
            const auto bar = [&](vec2 a, vec2 b) {
                const vec2 across = glm::normalize(vec2(a.y - b.y, b.x - a.x));
                kit::sweep(one, thin, 1, [&](vec2 p, float t) { return vec3(a + (b - a) * t + across * p.x, p.y); });
            };
            const float a = window.arch.half;
            kit::box(one, {-0.025f, window.sill, -0.03f}, {0.025f, window.spring, 0.03f}, 1, kit::left | kit::right | kit::front | kit::back);
            for (float x : {-0.5f * a, 0.5f * a}) bar({x, window.sill}, {x, window.spring});
            for (int k = 1; k < 3; ++k) bar({a, window.sill + (window.spring - window.sill) * float(k) / 3}, {-a, window.sill + (window.spring - window.sill) * float(k) / 3});
            kit::box(one, {-a, window.spring - 0.025f, -0.035f}, {a, window.spring + 0.025f, 0.035f}, 1);
            for (float angle : {0.25f * pi, 0.5f * pi, 0.75f * pi}) bar(vec2(0.18f * std::cos(angle), window.spring + 0.18f * std::sin(angle)), vec2(a * std::cos(angle), window.spring + a * std::sin(angle)));
            kit::arc_moulding(one, thin, {0, window.spring}, 0.18f, pi, 0, steps(16, detail_));
            kit::box(one, {-a - 0.08f, window.sill - 0.035f, -0.1f}, {a + 0.08f, window.sill + 0.008f, thick / 2 + 0.07f}, 0.3f);  // the sill
            kit::append(bars, one, at_wall * moved({-w, 0, 0}));

            // Curtains to both sides, tied back, from a rod above.
            const float height = 2.50f;
            for (float s : {-1.0f, 1.0f}) {
                Primitive cloth;
                kit::drape(cloth, {0.46f, height - 0.02f, 0.42f, 5}, random_, detail_);
                kit::append(curtains, cloth, moved({left + 0.13f, height, w + s * 0.82f}) * turned(s > 0 ? 90 : -90));
            }
            kit::tube(rods, {{left + 0.13f, height + 0.012f, w - 0.95f}, {left + 0.13f, height + 0.012f, w + 0.95f}}, {0.014f, 0.014f}, steps(14, detail_));
        }
        // The garden: a picture beyond the windows, as high as the sunbeams leave it. Above it the sky is louvres along the sun's
        // way, which no beam meets and which overlap for who looks up less steeply than the sun comes down.
        const float far = left - 2.4f, high = window.sill - (left - far) * sun_direction.y / sun_direction.x, pitch = 0.12f, depth = 0.55f, z0 = back - 3.5f, z1 = front + 3.5f;
        kit::quad(outside, {far, -0.6f, z1}, {0, 0, z0 - z1}, {0, high + 0.6f, 0}, 16, 8);
        const vec3 slat = glm::normalize(vec3(sun_direction.x, sun_direction.y, 0)) * depth;
        for (float y = high - 0.6f; y < high + 2.8f; y += pitch) kit::quad(outside, vec3(far, y, z1) - slat * 0.5f, {0, 0, z0 - z1}, -slat, 16, 1);
        for (size_t i = 0; i < outside.positions.size(); ++i) outside.texcoords[i] = {(outside.positions[i].z - z0) / 5.5f, std::min((outside.positions[i].y + 0.6f) / (high + 1.2f), 0.99f)};
        const uint32_t material = kit::add_material(scene_, "garden", vec3(0.2f), 1);
        scene_.textures.push_back(garden(seed_ + 9));
        scene_.textures.back().wrap_v = Texture::Wrap::clamp;
        scene_.materials[material].emissive = vec3(garden_radiance);
        scene_.materials[material].emissive_texture = {uint32_t(scene_.textures.size() - 1)};
        scene_.background = garden_radiance * vec3(0.62f, 0.76f, 0.96f);
        // Light from the rest of the house: a door with a drawn curtain, behind the cameras.
        Primitive curtained;
        kit::quad(curtained, {1.7f, 0.16f, front - 0.03f}, {-2.4f, 0, 0}, {0, 2.1f, 0}, 6, 6);
        const uint32_t sheer = kit::add_material(scene_, "sheer curtain", vec3(0.7f), 1);
        scene_.materials[sheer].emissive = {2.6f, 2.4f, 2.05f};
        place(mesh("door", {{sheer, std::move(curtained)}}), mat4(1));
        const uint32_t chintz = plain("curtains", {0.74f, 0.66f, 0.50f}, 0.9f, true);
        place(mesh("window wall", {{white_, std::move(shell)}, {white_, std::move(bars)}, {brass_, std::move(rods)}}), mat4(1));
        place(mesh("curtains", {{chintz, std::move(curtains)}}), mat4(1));
        billow(scene_.instances.back());
        place(mesh("garden", {{material, std::move(outside)}}), mat4(1));
    }

    void furniture() {
        Primitive wood, cane, chair_wood, rug, gold, canvas, board_wood, brass, clock_wood, dial, hands;
        table(wood, table_radius, table_height, detail_);
        place(mesh("table", {{walnut_, std::move(wood)}}), mat4(1));
        kit::lathe(rug, {{1.40f, 0.001f}, {1.39f, 0.010f}, {0.7f, 0.010f}, {0, 0.010f}}, steps(96, detail_));
        for (size_t i = 0; i < rug.positions.size(); ++i) rug.texcoords[i] = 0.5f + vec2(rug.positions[i].x, rug.positions[i].z) / 2.8f;
        place(mesh("carpet", {{carpet_, std::move(rug)}}), mat4(1));
        chair(chair_wood, cane, detail_);
        const uint32_t chair_mesh = mesh("chair", {{oak_, std::move(chair_wood)}, {cane_, std::move(cane)}});
        for (auto [angle, distance, twist] : {std::tuple(-158.0f, 0.92f, 8.0f), {112.0f, 1.02f, -12.0f}, {-52.0f, 0.98f, 6.0f}, {28.0f, 1.30f, 25.0f}})
            place(chair_mesh, turned(angle) * moved({0, 0.011f, distance}) * turned(180 + twist));

        picture_frame(gold, canvas, 0.80f, 0.58f, detail_);
        place(mesh("picture", {{gold_, std::move(gold)}, {textured(landscape(seed_ + 10), 0.8f), std::move(canvas)}}), moved({-0.55f, 1.72f, back + 0.015f}));
        const float board = 0.92f, board_x = 0.80f;
        sideboard(board_wood, brass, 1.5f, board, 0.42f, detail_);
        place(mesh("sideboard", {{walnut_, std::move(board_wood)}, {brass_, std::move(brass)}}), moved({board_x, 0, back + 0.04f}));
        clock(clock_wood, dial, hands, detail_);
        place(mesh("clock", {{walnut_, std::move(clock_wood)}, {textured(clock_face()), std::move(dial)}, {brass_, std::move(hands)}}), moved({board_x - 0.1f, board + 0.001f, back + 0.15f}) * turned(6));
        std::vector<uint32_t> covers;
        for (auto [name, color] : {std::pair("red leather", vec3(0.46f, 0.09f, 0.07f)), {"green leather", vec3(0.10f, 0.26f, 0.16f)}, {"blue cloth", vec3(0.13f, 0.22f, 0.42f)}, {"ochre cloth", vec3(0.62f, 0.42f, 0.16f)}, {"brown leather", vec3(0.34f, 0.18f, 0.10f)}})
            covers.push_back(plain(name, color));
        books(scene_, covers, paper_, moved({board_x + 0.18f, board, back + 0.10f}), 0.42f, random_);

        Primitive cloth;
        tablecloth(cloth, table_radius, cloth_side, seed_ + 11, detail_);
        place(mesh("tablecloth", {{linen_, std::move(cloth)}}), moved({0, table_height, 0}) * turned(12));
    }

    void lay_table() {
        // Before everything else, where each thing stands: (x, z), turned by degrees.
        const auto on = [](float x, float z, float degrees = 0, float y = 0) { return moved({x, top + y, z}) * turned(degrees); };
        China pot, one_cup, jug, bowl, saucer, small_plate, stand, tiers;
        teapot(pot, detail_), cup(one_cup, detail_), creamer(jug, detail_), sugar_bowl(bowl, detail_);
        plate(saucer, 0.072f, detail_), plate(small_plate, 0.095f, detail_), cake_stand(stand, 0.155f, 0.105f, detail_);
        Primitive silver, knife, handle, tea, milk, rod;
        spoon(silver, detail_), cake_knife(knife, handle, detail_);
        liquid(tea, tea_radius, tea_height, detail_), liquid(milk, 0.0335f, 0.074f, detail_);
        const std::vector<Stand> plates = {{0.125f, 0.012f}, {0.095f, 0.135f}};
        tiered_stand(tiers, rod, plates, detail_);

        place(china("teapot", std::move(pot), pot_), on(-0.135f, 0.165f, -28));
        place(china("creamer", std::move(jug), cup_), on(0.065f, 0.235f, 160));
        place(mesh("milk", {{milk_, std::move(milk)}}), on(0.065f, 0.235f));
        place(china("sugar bowl", std::move(bowl), cup_), on(0.175f, 0.175f, 35));
        place(china("cake stand", std::move(stand), rim_), on(0.10f, -0.13f, 15));
        turn_around(moved({0.10f, 0, -0.13f}), scene_.instances.back());
        const mat4 tier_at = on(-0.30f, -0.135f, 0);
        place(mesh("tiered stand", {{rim_, std::move(tiers.painted)}, {china_, std::move(tiers.plain)}, {silver_, std::move(rod)}}), tier_at);

        // A cup on its saucer with a spoon, and a plate with a napkin, for each of four.
        const uint32_t cup_mesh = mesh("cup", {{cup_, std::move(one_cup.painted)}, {china_, std::move(one_cup.plain)}, {tea_, std::move(tea)}});
        const uint32_t saucer_mesh = china("saucer", std::move(saucer), rim_), plate_mesh = china("plate", std::move(small_plate), rim_);
        const uint32_t spoon_mesh = mesh("spoon", {{silver_, std::move(silver)}});
        Primitive folded;
        napkin(folded, 0.19f, detail_);
        const uint32_t napkin_mesh = mesh("napkin", {{napkin_, std::move(folded)}});
        for (auto [angle, shift] : {std::pair(28.0f, 0.0f), {112.0f, 0.01f}, {-158.0f, 0.0f}, {-52.0f, -0.01f}}) {
            // In the frame of the seat: z towards the guest.
            const mat4 seat = turned(angle) * moved({0, top, 0});
            place(plate_mesh, seat * moved({-0.07f + shift, 0, 0.49f}));
            place(saucer_mesh, seat * moved({0.115f + shift, 0, 0.43f}));
            place(cup_mesh, seat * moved({0.115f + shift, 0.0038f, 0.43f}) * turned(random_.real(-60, 60)));
            place(spoon_mesh, seat * moved({0.163f + shift, 0.0068f, 0.432f}) * turned(78 + random_.real(-8, 8)) * glm::rotate(mat4(1), 0.03f, vec3(0, 0, 1)));
            if (angle == 28.0f) stir(seat * moved({0.115f + shift, 0.0038f, 0.43f}), scene_.instances.back());
            place(napkin_mesh, seat * moved({-0.215f + shift, 0.001f, 0.46f}) * turned(90 + random_.real(-10, 10)));
        }
        place(mesh("cake knife", {{silver_, std::move(knife)}, {oak_, std::move(handle)}}), on(0.245f, -0.02f, 205));
        sweets(plates, tier_at);
        sugar();

        Bouquet flowers;
        bouquet(flowers, 11, random_, detail_);
        place(mesh("flowers", {{glaze_, std::move(flowers.vase)}, {green_, std::move(flowers.stems)}, {petals_, std::move(flowers.petals)}, {green_, std::move(flowers.hearts)}}), on(-0.09f, -0.33f, 40));
    }

    void sweets(const std::vector<Stand>& plates, const mat4& tier_at) {
        const float cut = glm::radians(40.0f);
        const mat4 on_stand = moved({0.10f, top + 0.1052f, -0.13f}) * turned(88);
        const auto cake_mesh = [&](const char* name, Cake& c) {
            return mesh(name, {{icing_, std::move(c.icing)}, {sponge_, std::move(c.inside)}, {cream_, std::move(c.cream)}, {berry_, std::move(c.berries)}, {green_, std::move(c.leaves)}});
        };
        Cake whole, piece;
        cake(whole, cut, detail_);
        place(cake_mesh("cake", whole), on_stand);
        turn_around(moved({0.10f, 0, -0.13f}), scene_.instances.back());
        slice(piece, cut, detail_);
        // The slice is on the nearest guest's plate.
        place(cake_mesh("slice", piece), turned(28) * moved({-0.125f, top + 0.0054f, 0.49f}) * turned(20));

        Primitive paper, icing, cherry, shells, filling, dough;
        cupcake(paper, icing, cherry, detail_);
        const std::array<std::pair<const char*, vec3>, 3> icings = {std::pair("pink icing", vec3(0.76f, 0.44f, 0.48f)), {"lemon icing", vec3(0.79f, 0.70f, 0.36f)}, {"mint icing", vec3(0.48f, 0.70f, 0.56f)}};
        const uint32_t wrapper = plain("paper cases", {0.72f, 0.60f, 0.44f}, 0.9f);
        std::vector<uint32_t> cupcakes;
        for (const auto& [name, color] : icings) cupcakes.push_back(mesh("cupcake", {{wrapper, paper}, {plain(name, color), icing}, {berry_, cherry}}));
        for (int i = 0; i < 7; ++i) {
            const float angle = 2 * pi * float(i) / 7 + 0.3f;
            place(cupcakes[size_t(i) % 3], tier_at * moved({0.079f * std::cos(angle), plates[0].height + 0.010f, 0.079f * std::sin(angle)}) * turned(random_.real(0, 360)));
        }
        macaron(shells, filling, detail_);
        std::vector<uint32_t> macarons;
        for (auto [name, color] : {std::pair("raspberry", vec3(0.70f, 0.24f, 0.34f)), {"pistachio", vec3(0.52f, 0.62f, 0.28f)}, {"lavender", vec3(0.52f, 0.40f, 0.64f)}, {"vanilla", vec3(0.78f, 0.66f, 0.42f)}})
            macarons.push_back(mesh("macaron", {{plain(name, color), shells}, {cream_, filling}}));
        for (int i = 0; i < 8; ++i) {  // a ring of them standing on edge, leaning on the rod
            const float angle = 2 * pi * float(i) / 8;
            place(macarons[size_t(i) % 4], tier_at * moved({0, plates[1].height + 0.0052f, 0}) * glm::rotate(mat4(1), -angle, vec3(0, 1, 0)) * moved({0.050f, 0.0f, 0}) * turned(random_.real(-9, 9)));
        }
        for (int i = 0; i < 4; ++i) {
            const float angle = 2 * pi * (float(i) + 0.5f) / 4;
            place(macarons[size_t(i + 1) % 4], tier_at * moved({0.034f * std::cos(angle), plates[1].height + 0.0345f, 0.034f * std::sin(angle)}) * turned(random_.real(0, 360)));
        }
        biscuit(dough, detail_);
        const uint32_t biscuit_mesh = mesh("biscuit", {{plain("shortbread", {0.72f, 0.50f, 0.26f}, 0.9f), std::move(dough)}});
        // A few on the other guests' plates, leaning on each other.
        for (float angle : {112.0f, -158.0f, -52.0f})
            for (int i = 0; i < 3; ++i)
                place(biscuit_mesh, turned(angle) * moved({-0.09f + 0.026f * float(i), top + 0.0055f + 0.0065f * float(i % 2) + (i == 2 ? 0.003f : 0), 0.485f + 0.014f * float(i % 2)}) * turned(random_.real(0, 360)) *
                                        glm::rotate(mat4(1), i == 1 ? 0.22f : 0.0f, vec3(0, 0, 1)));
    }

    void sugar() {
        Primitive cube;
        kit::box(cube, vec3(-0.0075f, 0, -0.0075f), vec3(0.0075f, 0.0135f, 0.0075f), 0.005f);
        const uint32_t lump = mesh("sugar", {{sugar_, std::move(cube)}});
        for (int i = 0; i < 22; ++i) {  // heaped in the bowl
            const float r = 0.031f * std::sqrt((float(i % 11) + 0.5f) / 11), angle = 2.399963f * float(i);
            place(lump, moved({0.175f + r * std::cos(angle), top + (i < 11 ? 0.042f : 0.054f) + 0.010f * (1 - r / 0.031f), 0.175f + r * std::sin(angle)}) * turned(random_.real(0, 90)) *
                            glm::rotate(mat4(1), random_.real(-0.6f, 0.6f), vec3(1, 0, 0)));
        }
        for (vec2 at : {vec2(0.245f, 0.19f), vec2(0.262f, 0.205f)}) place(lump, moved({at.x, top + 0.0005f, at.y}) * turned(random_.real(0, 90)));
    }

    const float detail_;
    const uint32_t seed_;
    kit::Random random_;
    Scene scene_;
    uint32_t china_, pot_, cup_, rim_, silver_, brass_, tea_, milk_, sugar_, linen_, napkin_, walnut_, oak_, cane_, white_, ceiling_, icing_, cream_, berry_, green_, petals_, gold_, paper_, glaze_, sponge_, floor_,
        wallpaper_, carpet_;
};

}  // namespace

Scene make_teatime(const BuiltinOptions& options, uint32_t seed) { return Teatime(options.number("detail"), seed).make(); }

}  // namespace myriad::scenes
