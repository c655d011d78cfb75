// The cathedral: a nave of six bays between aisles, closed by an apse of five sides, under ribbed vaults 18 m high. The
// late morning sun comes in through the windows of the south side and strikes piers, pews and the floor; everything else is
// lit by what these reflect, and by the glass of the other windows.
//
// Sunlight through coloured glass: there is no transmission in the scene model. So the sun is a spot light a window, thirty
// metres out in the sun's direction, of the colour of that window's glass and just as wide as the window; and the glass of
// these windows is made of louvres whose planes contain the spot's position. No ray of the spot ever meets one, but from
// the floor of the church they overlap and are seen, bright, as the glass. All other windows are sheets that emit light.
//
// Building: walls are closed solids that run into each other; vaults end within them; so no light leaks.
#include "scenes/builtin.hpp"
#include "scenes/builtin/cathedral_parts.hpp"

#include <array>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace myriad::scenes {
namespace {

using namespace cathedral;
using glm::mat4;
using glm::vec2;
using glm::vec3;
using kit::pi;
using kit::moved;
using kit::turned;

// The way the sun's light travels: from the south, a little from the east, well down.
const vec3 sun_direction = glm::normalize(vec3(-0.26f, -0.92f, -0.95f));
constexpr float sun_distance = 30, sun_irradiance = 6, sun_cone = 3.3f;  // metres, W/m^2, metres around the window's middle
constexpr float glass_radiance = 1.3f, sunny_glass_radiance = 1.7f;

float middle(int bay_number) { return (float(bay_number) + 0.5f) * bay; }

class Cathedral {
public:
    Cathedral(float detail, uint32_t seed) : detail_(0.9f * detail), seed_(seed), random_(seed) {}

    Scene make() {
        materials();
        floors();
        nave();
        aisles();
        apse();
        west_end();
        furnish();
        kit::add_camera(scene_, "nave", {1.6f, 2.1f, -0.9f}, {20, 6.0f, 0.4f}, 68);
        kit::add_camera(scene_, "rose", {26.5f, 2.2f, 1.6f}, {4, 7.4f, -0.6f}, 62);
        kit::add_camera(scene_, "aisle", {1.6f, 1.8f, 7.6f}, {16, 3.4f, 6.0f}, 66);
        kit::add_camera(scene_, "vault", {17.5f, 1.5f, 0.0f}, {20.6f, 16, 0.0f}, 74);
        return std::move(scene_);
    }

private:
    void materials() {
        const auto add = [&](const char* name, vec3 albedo, float roughness = 0.9f) { return kit::add_material(scene_, name, albedo, roughness); };
        const auto textured = [&](Texture texture, float roughness = 0.9f) {
            const std::string name = texture.name;
            scene_.textures.push_back(std::move(texture));
            return kit::add_material(scene_, name, vec3(1), roughness, uint32_t(scene_.textures.size() - 1));
        };
        wall_ = textured(kit::ashlar("hewn limestone", 10, 2.2f, {0.64f, 0.575f, 0.475f}, 0.20f, seed_));
        web_ = textured(kit::ashlar("vault web", 20, 2.0f, {0.68f, 0.63f, 0.545f}, 0.16f, seed_ + 1));
        plain_ = add("limestone", {0.66f, 0.60f, 0.50f});
        dark_ = add("dark marble", {0.28f, 0.255f, 0.24f}, 0.4f);
        gilt_ = add("gilding", {0.74f, 0.53f, 0.20f}, 0.4f);
        oak_ = add("oak", {0.33f, 0.20f, 0.115f}, 0.7f);
        cloth_ = add("altar cloth", {0.78f, 0.75f, 0.69f});
        scene_.materials[cloth_].double_sided = true;
        red_ = add("red cloth", {0.58f, 0.08f, 0.07f});
        flame_ = add("flames", vec3(0.2f));
        scene_.materials[flame_].emissive = {60, 36, 12};
        floor_ = textured(pavement(), 0.5f);
        for (int i = 0; i < 2; ++i) {
            north_aisle_[size_t(i)] = glass(window_glass(i ? "aisle glass II" : "aisle glass I", aisle_window, i ? Glass::warm : Glass::cool, seed_ + 20 + uint32_t(i)), vec3(glass_radiance));
            south_aisle_[size_t(i)] = glass(window_glass(i ? "sunny glass II" : "sunny glass I", aisle_window, i ? Glass::cool : Glass::warm, seed_ + 30 + uint32_t(i)), vec3(sunny_glass_radiance));
            apse_[size_t(i)] = glass(window_glass(i ? "apse glass II" : "apse glass I", apse_window, i ? Glass::warm : Glass::cool, seed_ + 40 + uint32_t(i)), vec3(1.4f * glass_radiance));
        }
        // The clerestory has pale glass, which lights the vaults without staining them; by daylight in the north, in sun in the south.
        Texture grisaille = window_glass("grisaille", clerestory_window, Glass::pale, seed_ + 10);
        north_ = glass(grisaille, 0.55f * glass_radiance * vec3(0.75f, 0.95f, 1.2f));
        south_ = glass(std::move(grisaille), 0.6f * glass_radiance * vec3(1.1f, 1.0f, 0.8f));
        rose_ = glass(rose_glass(seed_ + 60), vec3(1.4f * glass_radiance));
        for (uint32_t louvred : {south_, south_aisle_[0], south_aisle_[1]}) scene_.materials[louvred].double_sided = true;
        scene_.background = {0.55f, 0.75f, 1.05f};
    }

    uint32_t glass(Texture texture, vec3 radiance) {
        const uint32_t material = kit::add_material(scene_, texture.name, vec3(0.2f), 0.2f);
        scene_.materials[material].emissive = radiance;
        scene_.materials[material].emissive_texture = {uint32_t(scene_.textures.size())};
        scene_.textures.push_back(std::move(texture));
        return material;
    }

    // Slabs of two stones in a checker of lozenges, worn and uneven in tint: 4 x 4 of them.
    Texture pavement() {
        return kit::picture("pavement", 512, 512, [&](vec2 uv) {
            const vec2 p = uv * 4.0f, in = glm::fract(p);
            const int i = int(p.x), j = int(p.y);
            const uint32_t own = uint32_t(i * 4 + j) + 100 * seed_;
            const float lozenge = std::abs(in.x - 0.5f) + std::abs(in.y - 0.5f), edge = std::abs(lozenge - 0.36f);
            const bool inner = lozenge < 0.36f;
            const vec3 stone = inner ? vec3(0.25f, 0.235f, 0.22f) : (i + j) % 2 ? vec3(0.57f, 0.50f, 0.40f) : vec3(0.50f, 0.455f, 0.38f);
            const float joint = glm::smoothstep(0.004f, 0.016f, std::min({edge, in.x, 1 - in.x, in.y, 1 - in.y}));
            return stone * (0.92f + 0.16f * kit::unit(own, inner) + 0.07f * kit::fractal_noise(uv * 16.0f, 16, seed_, 3)) * (0.7f + 0.3f * joint);
        });
    }

    // Adds what is not empty of a piece as a mesh, one primitive a material; `textured` takes the walls of it.
    uint32_t mesh(const char* name, Stone piece, uint32_t walls) {
        for (vec2& uv : piece.wall.texcoords) uv *= 0.25f;  // the textures are four metres wide
        return mesh(name, {{walls, std::move(piece.wall)}, {plain_, std::move(piece.plain)}, {dark_, std::move(piece.dark)}, {gilt_, std::move(piece.gilt)}});
    }
    uint32_t mesh(const char* name, std::vector<std::pair<uint32_t, Primitive>> parts) { return kit::add_mesh(scene_, name, std::move(parts)); }
    void place(uint32_t mesh, const mat4& at) { kit::add_instance(scene_, mesh, at); }

    void floors() {
        Primitive floor, steps_;
        const float x0 = -0.4f, x1 = nave_end + 5.4f, z = outer;
        kit::quad(floor, {x0, 0, -z}, {0, 0, 2 * z}, {x1 - x0, 0, 0}, 20, 36, 0.25f);
        kit::box(steps_, {x0, -0.6f, -z - 0.3f}, {x1, -0.1f, z + 0.3f}, 2);  // what it lies on
        // Three steps up to the sanctuary, across the nave.
        for (int i = 0; i < 3; ++i) {
            const float from = nave_end - 3.2f + 0.42f * float(i), y = 0.14f * float(i + 1);
            kit::box(steps_, {from, -0.05f, -4.2f + 0.01f * float(i)}, {nave_end + 4.6f - 0.01f * float(i), y, 4.2f - 0.01f * float(i)}, 1.2f, kit::left | kit::top);
        }
        place(mesh("floor", {{floor_, std::move(floor)}, {plain_, std::move(steps_)}}), mat4(1));
    }

    // A window of one kind on one side: tracery, and the glass a little further out.
    static constexpr float bars_z = -0.08f, glass_z = -0.12f;
    void window(uint32_t tracery_mesh, uint32_t glass_mesh, const mat4& at) {
        place(tracery_mesh, at * moved({0, 0, bars_z}));
        place(glass_mesh, at * moved({0, 0, glass_z}));
    }

    // The spot that is the sun for one window, in the window's frame, and its light.
    void sun(const Opening& o, const mat4& at, vec3 color) {
        const vec3 target = vec3(at * glm::vec4(0, 0.5f * (o.sill + o.spring + o.arch.rise), 0, 1));
        const float cone = std::atan(sun_cone / sun_distance);
        scene_.lights.push_back({Light::Type::spot, "sun", target - sun_direction * sun_distance, sun_direction, color * (sun_irradiance * sun_distance * sun_distance),
                                 0.8f * cone, cone});
    }
    // Where it is, seen from the glass of any window of that kind: louvres are the same in all.
    static vec3 sun_in_frame(const Opening& o) {
        const vec3 up = -sun_direction * sun_distance;
        return {-up.x, 0.5f * (o.sill + o.spring + o.arch.rise) + up.y, -up.z - glass_z};
    }

    void nave() {
        Stone bay_stone, pier_stone, vault, rib;
        Primitive tracery_bars;
        nave_bay(bay_stone, detail_);
        pier(pier_stone, detail_);
        nave_vault(vault, detail_);
        transverse_rib(rib.plain, detail_);
        tracery(tracery_bars, clerestory_window, detail_);
        const uint32_t bay_mesh = mesh("nave bay", std::move(bay_stone), wall_), pier_mesh = mesh("pier", std::move(pier_stone), wall_);
        const uint32_t vault_mesh = mesh("nave vault", std::move(vault), web_), rib_mesh = mesh("transverse rib", std::move(rib), wall_);
        const uint32_t bars = mesh("clerestory tracery", {{plain_, std::move(tracery_bars)}});
        Primitive sheet, slats;
        pane(sheet, clerestory_window, detail_);
        const uint32_t north = mesh("north window", {{north_, std::move(sheet)}});
        louvres(slats, clerestory_window, sun_in_frame(clerestory_window), detail_);
        const uint32_t south = mesh("south window", {{south_, std::move(slats)}});

        for (int i = 0; i < bays; ++i) {
            const mat4 north_at = moved({middle(i), 0, -wall}), south_at = moved({middle(i), 0, wall}) * turned(180);
            for (const mat4& at : {north_at, south_at}) place(bay_mesh, at);
            place(vault_mesh, moved({middle(i), vault_spring, 0}));
            window(bars, north, north_at);
            window(bars, south, south_at);
            sun(clerestory_window, south_at, vec3(1.0f, 0.90f, 0.72f));
        }
        for (int i = 0; i <= bays; ++i) {
            const float x = bay * float(i);
            for (float side : {0.0f, 180.0f}) place(pier_mesh, moved({x, 0, side == 0 ? -wall : wall}) * turned(side));
            place(rib_mesh, moved({x, vault_spring, 0}) * turned(90));
        }
    }

    void aisles() {
        Stone bay_stone, respond_stone, vault;
        Primitive tracery_bars, slats, ends;
        aisle_bay(bay_stone, detail_);
        respond(respond_stone, detail_);
        aisle_vault(vault, detail_);
        tracery(tracery_bars, aisle_window, detail_);
        const uint32_t bay_mesh = mesh("aisle bay", std::move(bay_stone), wall_), respond_mesh = mesh("respond", std::move(respond_stone), wall_);
        const uint32_t vault_mesh = mesh("aisle vault", std::move(vault), web_), bars = mesh("aisle tracery", {{plain_, std::move(tracery_bars)}});
        louvres(slats, aisle_window, sun_in_frame(aisle_window), detail_);
        std::array<uint32_t, 2> north, south;
        for (size_t i : {0u, 1u}) {
            Primitive sheet;
            pane(sheet, aisle_window, detail_);
            north[i] = mesh("north aisle window", {{north_aisle_[i], std::move(sheet)}});
            south[i] = mesh("south aisle window", {{south_aisle_[i], slats}});
        }
        constexpr std::array<vec3, 6> colors = {vec3(1.0f, 0.20f, 0.02f), vec3(0.03f, 0.09f, 1.0f), vec3(1.0f, 0.03f, 0.02f), vec3(0.95f, 0.45f, 0.05f), vec3(0.20f, 0.04f, 0.90f), vec3(1.0f, 0.12f, 0.02f)};
        const float middle_z = (wall + wall_thick / 2 + outer - outer_thick / 2) / 2;
        for (int i = 0; i < bays; ++i) {
            const mat4 north_at = moved({middle(i), 0, -outer}), south_at = moved({middle(i), 0, outer}) * turned(180);
            for (const mat4& at : {north_at, south_at}) place(bay_mesh, at);
            for (float s : {-1.0f, 1.0f}) place(vault_mesh, moved({middle(i), pier_spring, s * middle_z}));
            window(bars, north[size_t(i % 2)], north_at);
            window(bars, south[size_t(i % 2)], south_at);
            sun(aisle_window, south_at, colors[size_t(i)] * 0.5f);
        }
        for (int i = 0; i <= bays; ++i)
            for (float side : {0.0f, 180.0f}) place(respond_mesh, moved({bay * float(i), 0, (side == 0 ? -1 : 1) * (outer - outer_thick / 2)}) * turned(side));
        // The east ends of the aisles.
        for (float s : {-1.0f, 1.0f}) {
            const float z0 = s < 0 ? -outer - 0.35f : wall + 0.1f, z1 = s < 0 ? -wall - 0.1f : outer + 0.35f;
            kit::box(ends, {nave_end - 0.1f, -0.3f, z0}, {nave_end + 0.8f, 9.05f, z1}, 1);
            Primitive wall_face;
            std::swap(wall_face, ends);
            for (size_t k = 0; k < wall_face.positions.size(); ++k) wall_face.texcoords[k] = vec2(wall_face.positions[k].z, wall_face.positions[k].y) * 0.25f;
            place(mesh("aisle end", {{wall_, std::move(wall_face)}}), mat4(1));
        }
    }

    void apse() {
        constexpr float thick = 0.7f;
        const float apothem = nave_arch.half * std::cos(pi / 10) - 0.1f + thick / 2, width = 2 * (apothem + thick / 2) * std::tan(pi / 10);
        Stone side, vault;
        Primitive bars;
        apse_bay(side, width, thick, detail_);
        apse_vault(vault, detail_);
        tracery(bars, apse_window, detail_);
        const uint32_t side_mesh = mesh("apse side", std::move(side), wall_), bars_mesh = mesh("apse tracery", {{plain_, std::move(bars)}});
        place(mesh("apse vault", std::move(vault), web_), moved({nave_end, vault_spring, 0}));
        std::array<uint32_t, 2> panes;
        for (size_t i : {0u, 1u}) {
            Primitive sheet;
            pane(sheet, apse_window, detail_);
            panes[i] = mesh("apse window", {{apse_[i], std::move(sheet)}});
        }
        for (int k = 0; k < 5; ++k) {
            const float degrees = 36 * (float(k) + 0.5f) - 90;
            const mat4 at = moved({nave_end, 0, 0}) * turned(-degrees - 90) * moved({0, 0, -apothem});
            place(side_mesh, at);
            window(bars_mesh, panes[size_t(k % 2)], at);
        }
    }

    void west_end() {
        Stone wall_stone;
        Primitive bars, sheet, doors;
        west_wall(wall_stone, outer + 0.38f, detail_);
        rose_tracery(bars, detail_);
        rose_pane(sheet, detail_);
        for (float s : {-1.0f, 1.0f}) {
            kit::box(doors, {s < 0 ? -1.7f : 0.012f, -0.05f, -0.25f}, {s < 0 ? -0.012f : 1.7f, 5.6f, -0.12f}, 1);
            for (float y : {0.5f, 1.6f, 2.7f}) kit::box(doors, {s < 0 ? -1.45f : 0.12f, y, -0.14f}, {s < 0 ? -0.12f : 1.45f, y + 0.85f, -0.07f}, 1);
        }
        const mat4 at = moved({-wall_thick / 2 + 0.1f, 0, 0}) * turned(90);
        place(mesh("west wall", std::move(wall_stone), wall_), at);
        place(mesh("doors", {{oak_, std::move(doors)}}), at);
        window(mesh("rose tracery", {{plain_, std::move(bars)}}), mesh("rose window", {{rose_, std::move(sheet)}}), at * moved({0, rose_height, 0}));
    }

    void furnish() {
        Primitive wood;
        pew(wood, 2.55f, detail_);
        const uint32_t pew_mesh = mesh("pew", {{oak_, std::move(wood)}});
        for (int i = 0; i < 15; ++i)
            for (float s : {-1.0f, 1.0f}) {
                const float x = 6.4f + 1.02f * float(i) + random_.real(-0.02f, 0.02f);
                place(pew_mesh, moved({x, 0, s * 2.35f}) * turned(random_.real(-0.4f, 0.4f)));
            }
        Primitive stone, cloth, gold, flames, carpet;
        altar(stone, cloth, gold, flames, detail_);
        place(mesh("altar", {{plain_, std::move(stone)}, {cloth_, std::move(cloth)}, {gilt_, std::move(gold)}, {flame_, std::move(flames)}}), moved({nave_end + 1.6f, 0.42f, 0}));
        // A red runner between the pews, up to the steps.
        kit::quad(carpet, {0.6f, 0.012f, -0.7f}, {0, 0, 1.4f}, {nave_end - 3.9f, 0, 0}, 2, 40);
        for (float s : {-1.0f, 1.0f}) kit::quad(carpet, {s > 0 ? 0.6f : nave_end - 3.3f, 0, s * 0.7f}, {s * (nave_end - 3.9f), 0, 0}, {0, 0.012f, 0}, 20, 1);
        place(mesh("carpet", {{red_, std::move(carpet)}}), mat4(1));
    }

    const float detail_;
    const uint32_t seed_;
    kit::Random random_;
    Scene scene_;
    uint32_t wall_, web_, plain_, dark_, gilt_, oak_, cloth_, red_, flame_, floor_, north_, south_, rose_;
    std::array<uint32_t, 2> north_aisle_, south_aisle_, apse_;
};

}  // namespace

Scene make_cathedral(const BuiltinOptions& options, uint32_t seed) { return Cathedral(options.number("detail"), seed).make(); }

}  // namespace myriad::scenes
