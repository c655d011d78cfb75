// The atrium: a court of 24 m x 9 m under an open sky, two storeys of arcades around it, galleries behind them with
// coloured walls. A low, warm sun comes in over one corner and strikes the far part of the floor, one arcade wall and the
// end wall; everything else is lit by what these reflect and by a piece of bluish sky.
//
// Building: every wall and slab is a closed solid or backed by one, and runs into its neighbours, so no light leaks.
// Projections are measured from the line of the column axes, positive into the court.
#include "scenes/builtin.hpp"
#include "scenes/builtin/atrium_parts.hpp"

#include <array>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace myriad::scenes {
namespace {

using namespace atrium;
using glm::mat4;
using glm::vec2;
using glm::vec3;
using kit::Profile;
using kit::moved;
using kit::turned;

constexpr vec2 half{12, 4.5f};          // the rectangle of column axes
constexpr float depth = 3.2f;           // of the galleries, from the axes to the back wall
constexpr float outer = depth + 0.5f;   // outside of the back wall
constexpr float slab_low = 5.0f, ceiling = 10.05f, wall_top = 10.4f;
constexpr float lower_radius = 1.2f, upper_radius = 1.22f, vault_rise = 1.6f;
constexpr float below = -0.3f;          // foundations

// The sun's way, and the sky: see sky().
const vec3 sun_direction = glm::normalize(vec3(0.80f, -1.0f, -0.55f));
constexpr vec3 sun_irradiance{13.0f, 11.4f, 8.8f}, sky_radiance{0.75f, 1.10f, 1.60f};

// One side of the court: x runs along it, z into the court, the origin lies amid its column axes.
struct Side {
    mat4 frame;
    int bays;
    float bay_center(int i) const { return (float(i) + 0.5f - float(bays) / 2) * bay; }
    float axis(int i) const { return (float(i) - float(bays) / 2) * bay; }
};

const std::array<Side, 4> sides = {{
    {moved({0, 0, -half.y}), 8},               // sunlit
    {moved({0, 0, half.y}) * turned(180), 8},  // in the shade
    {moved({-half.x, 0, 0}) * turned(90), 3},
    {moved({half.x, 0, 0}) * turned(-90), 3},
}};

class Atrium {
public:
    Atrium(float detail, uint32_t seed, vec3 sun, vec3 sky) : detail_(detail), cell_(0.5f / detail), sun_(sun), sky_(sky), random_(seed) {}

    Scene make() {
        materials();
        floors();
        back_walls();
        slabs();
        piers();
        vaults();
        beams();
        arcades();
        furnish_walls();
        furnish_court();
        cloths();
        sky();
        for (auto& [material, primitive] : building_) {
            primitive.material = material;
            kit::add_instance(scene_, kit::add_mesh(scene_, scene_.materials[material].name, {std::move(primitive)}));
        }
        lights_and_cameras();
        return std::move(scene_);
    }

private:
    // What is built in place, a mesh for each material.
    Primitive& of(uint32_t material) { return building_[material]; }

    void materials() {
        const auto add = [&](const char* name, vec3 albedo, float roughness = 0.9f) { return kit::add_material(scene_, name, albedo, roughness); };
        stone_ = add("limestone", {0.70f, 0.63f, 0.52f});
        base_ = add("grey stone", {0.50f, 0.47f, 0.42f});
        marble_ = add("marble", {0.78f, 0.75f, 0.70f}, 0.5f);
        plaster_ = add("white plaster", {0.79f, 0.76f, 0.70f});
        wood_ = add("oak", {0.36f, 0.22f, 0.12f}, 0.7f);
        iron_ = add("iron", {0.22f, 0.21f, 0.20f}, 0.5f);
        clay_ = add("clay", {0.62f, 0.31f, 0.19f});
        earth_ = add("earth", {0.22f, 0.16f, 0.11f});
        leaf_ = add("leaf", {0.17f, 0.36f, 0.10f}, 0.7f);
        water_ = add("water", {0.16f, 0.33f, 0.34f}, 0.2f);
        glaze_ = add("blue glaze", {0.16f, 0.28f, 0.55f}, 0.4f);
        scene_.materials[leaf_].double_sided = true;
        lower_walls_ = {add("terracotta plaster", {0.68f, 0.30f, 0.18f}), add("ochre plaster", {0.76f, 0.53f, 0.20f}),
                        add("rose plaster", {0.70f, 0.40f, 0.36f}), add("teal plaster", {0.20f, 0.48f, 0.46f})};
        upper_walls_ = {add("sage plaster", {0.45f, 0.55f, 0.34f}), add("blue plaster", {0.26f, 0.42f, 0.62f}),
                        add("cream plaster", {0.78f, 0.70f, 0.52f}), add("ochre plaster above", {0.76f, 0.53f, 0.20f})};
        cloths_ = {add("red cloth", {0.66f, 0.09f, 0.07f}), add("green cloth", {0.10f, 0.42f, 0.15f}), add("blue cloth", {0.09f, 0.20f, 0.60f})};
        for (uint32_t cloth : cloths_) scene_.materials[cloth].double_sided = true;

        const auto textured = [&](const char* name, int tiles, bool checker, vec3 light, vec3 dark) {
            scene_.textures.push_back(paving(name, tiles, checker, light, dark, random_));
            return kit::add_material(scene_, name, vec3(1), 0.8f, uint32_t(scene_.textures.size() - 1));
        };
        paving_ = textured("court paving", 8, false, {0.60f, 0.53f, 0.43f}, {});
        lower_tiles_ = textured("lower gallery tiles", 8, true, {0.70f, 0.62f, 0.50f}, {0.50f, 0.22f, 0.14f});
        upper_tiles_ = textured("upper gallery tiles", 8, true, {0.72f, 0.68f, 0.60f}, {0.30f, 0.36f, 0.36f});
    }

    // The floor of a gallery at height y: four rectangles around the court, from the axes to inside the back wall.
    void gallery_floor_at(uint32_t material, float y, float per_metre) {
        const float in = -0.45f, out = depth + 0.05f;
        const vec2 a = half - in, b = half + out;
        const auto rectangle = [&](vec2 lo, vec2 hi) {
            const vec2 size = hi - lo;
            kit::quad(of(material), {lo.x, y, lo.y}, {0, 0, size.y}, {size.x, 0, 0}, int(size.y / cell_) + 1, int(size.x / cell_) + 1, per_metre);
        };
        rectangle({-b.x, -b.y}, {b.x, -a.y});
        rectangle({-b.x, a.y}, {b.x, b.y});
        rectangle({-b.x, -a.y}, {-a.x, a.y});
        rectangle({a.x, -a.y}, {b.x, a.y});
    }

    void floors() {
        // A slab under everything; the court's paving lies on it, down to below the step around it.
        kit::box(of(base_), {-half.x - outer + 0.1f, below - 0.3f, -half.y - outer + 0.1f}, {half.x + outer - 0.1f, -0.05f, half.y + outer - 0.1f}, 2 * cell_);
        const vec2 court = half - 0.5f;
        kit::quad(of(paving_), {-court.x, 0, -court.y}, {0, 0, 2 * court.y}, {2 * court.x, 0, 0}, int(2 * court.y / cell_), int(2 * court.x / cell_), 0.25f);
        kit::ring(of(base_), {{0.60f, -0.1f}, {0.60f, gallery_floor - 0.02f}, {0.58f, gallery_floor}, {-0.45f, gallery_floor}}, half, cell_);
        gallery_floor_at(lower_tiles_, gallery_floor, 0.4f);
        gallery_floor_at(upper_tiles_, upper_floor, 0.4f);
    }

    void back_walls() {
        // The shell, open towards the galleries, where the coloured faces close it.
        kit::ring(of(plaster_), {{-depth, wall_top}, {-outer, wall_top}, {-outer, below}, {-depth, below}}, half, 2 * cell_);
        constexpr float change = 5.2f;  // inside the slab
        for (size_t s = 0; s < sides.size(); ++s) {
            const float w = (sides[s].bays * bay) / 2 + depth;
            for (auto [material, y0, y1] : {std::tuple(lower_walls_[s], below, change), std::tuple(upper_walls_[s], change, wall_top)}) {
                Primitive wall;
                kit::quad(wall, {-w, y0, -depth}, {2 * w, 0, 0}, {0, y1 - y0, 0}, int(2 * w / cell_), int((y1 - y0) / cell_));
                kit::append(of(material), wall, sides[s].frame);
            }
        }
        // Plinths, and the impost that the vaults spring from.
        const auto band = [&](uint32_t material, float y0, float y1, float out) {
            const float d = -depth + out;
            kit::ring(of(material), {{-depth - 0.05f, y0}, {d - 0.02f, y0}, {d, y0 + 0.03f}, {d, y1 - 0.05f}, {d - 0.02f, y1}, {-depth - 0.05f, y1}}, half, cell_);
        };
        band(base_, gallery_floor - 0.05f, 0.55f, 0.05f);
        band(stone_, lower_spring - 0.16f, lower_spring - 0.02f, 0.08f);
        band(stone_, upper_floor - 0.05f, upper_floor + 0.35f, 0.04f);
        band(stone_, 9.45f, 9.62f, 0.07f);
    }

    void slabs() {
        kit::ring(of(stone_), {{-depth - 0.2f, slab_low}, {0.27f, slab_low}, {0.27f, 5.06f}, {0.31f, 5.09f}, {0.31f, 5.20f}, {0.36f, 5.22f}, {0.42f, 5.25f},
                               {0.47f, 5.30f}, {0.50f, 5.32f}, {0.50f, upper_floor - 0.01f}, {0.49f, upper_floor}, {-0.45f, upper_floor}}, half, cell_);
        // The roof's underside is the ceiling of the upper gallery.
        kit::ring(of(wood_), {{-depth - 0.2f, ceiling}, {0.1f, ceiling}}, half, cell_);
        kit::ring(of(stone_), {{0.1f, ceiling}, {0.27f, ceiling}, {0.27f, 10.10f}, {0.32f, 10.14f}, {0.32f, 10.26f}, {0.42f, 10.28f}, {0.54f, 10.34f},
                               {0.62f, 10.42f}, {0.66f, 10.44f}, {0.66f, 10.54f}}, half, cell_);
        kit::ring(of(clay_), {{0.66f, 10.54f}, {0.70f, 10.54f}, {0.70f, 10.60f}, {-outer - 0.3f, 11.1f}, {-outer - 0.3f, 10.2f}, {-outer + 0.1f, 10.2f}}, half, cell_);
        // Dentils under both cornices.
        for (const Side& side : sides)
            for (auto [y, pitch] : {std::pair(5.12f, 0.20f), std::pair(10.17f, 0.30f)}) {
                const float reach = float(side.bays) * bay / 2 - 0.3f;
                const int count = int(2 * reach / pitch);
                Primitive row;
                for (int i = 0; i < count; ++i) {
                    const float x = -reach + 2 * reach * (float(i) + 0.5f) / float(count), w = 0.27f * pitch;
                    const float z = y < 8 ? 0.31f : 0.32f, out = y < 8 ? 0.05f : 0.09f;
                    kit::box(row, {x - w, y, z - 0.02f}, {x + w, y + 0.11f, z + out}, 1, kit::all_faces & ~(kit::back | kit::top));
                }
                kit::append(of(stone_), row, side.frame);
            }
    }

    // Square piers at the four corners, through both storeys.
    void piers() {
        const float w = 0.34f;
        for (float sx : {-1.0f, 1.0f})
            for (float sz : {-1.0f, 1.0f}) {
                Primitive pier;
                for (auto [y0, y1] : {std::pair(0.05f, 5.05f), std::pair(5.35f, 10.1f)})
                    kit::box(pier, {-w, y0, -w}, {w, y1, w}, cell_, kit::all_faces & ~(kit::bottom | kit::top));
                // Bases and imposts; the outside of these rings faces away from their centre, so they run downwards.
                const auto band = [&](float y0, float y1, float out) {
                    kit::ring(pier, {{0.02f, y1}, {-out + 0.02f, y1}, {-out, y1 - 0.03f}, {-out, y0 + 0.03f}, {-out + 0.02f, y0}, {0.02f, y0}}, vec2(w), cell_);
                };
                band(0.05f, 0.55f, 0.06f);
                band(lower_spring - 0.14f, lower_spring, 0.07f);
                band(upper_floor - 0.05f, upper_floor + 0.35f, 0.06f);
                band(upper_spring - 0.14f, upper_spring, 0.07f);
                kit::append(of(stone_), pier, moved({sx * half.x, 0, sz * half.y}));
            }
    }

    // Groin vaults over the lower gallery, with ribs between them that stand on pilasters.
    void vaults() {
        const int n = steps(12, detail_);
        const float r = depth / 2;
        Primitive vault, corner, rib, pilaster;
        kit::groin_vault(vault, {bay / 2, r}, vault_rise, n);
        kit::groin_vault(corner, {r, r}, vault_rise, n);
        const float e = 0.18f;
        kit::arch_moulding(rib, {{0.04f, e}, {-0.10f, e}, {-0.14f, e - 0.04f}, {-0.14f, 0.04f - e}, {-0.10f, -e}, {0.04f, -e}}, r, vault_rise, 2 * n);
        const unsigned wall_side = kit::back;
        kit::box(pilaster, {-0.20f, 0.05f, -0.1f}, {0.20f, lower_spring - 0.1f, 0.14f}, cell_, kit::all_faces & ~(wall_side | kit::bottom | kit::top));
        kit::box(pilaster, {-0.24f, 0.05f, -0.1f}, {0.24f, 0.60f, 0.18f}, cell_, kit::all_faces & ~(wall_side | kit::bottom));
        kit::box(pilaster, {-0.25f, lower_spring - 0.18f, -0.1f}, {0.25f, lower_spring, 0.19f}, cell_, kit::all_faces & ~wall_side);
        for (const Side& side : sides) {
            for (int i = 0; i < side.bays; ++i)
                kit::append(of(plaster_), vault, side.frame * moved({side.bay_center(i), lower_spring, -r}));
            for (int i = 0; i <= side.bays; ++i) {
                kit::append(of(stone_), rib, side.frame * moved({side.axis(i), lower_spring, -r}) * turned(90));
                kit::append(of(stone_), pilaster, side.frame * moved({side.axis(i), 0, -depth}));
            }
        }
        for (float sx : {-1.0f, 1.0f})
            for (float sz : {-1.0f, 1.0f})
                kit::append(of(plaster_), corner, moved({sx * (half.x + r), lower_spring, sz * (half.y + r)}));
    }

    // Oak beams under the ceiling of the upper gallery.
    void beams() {
        for (size_t s = 0; s < sides.size(); ++s) {
            const float reach = float(sides[s].bays) * bay / 2 + (s < 2 ? depth : -0.3f);  // the long sides take the corners
            const int count = int(2 * reach / 0.75f);
            Primitive row;
            for (int i = 0; i < count; ++i) {
                const float x = -reach + 2 * reach * (float(i) + 0.5f) / float(count);
                kit::box(row, {x - 0.09f, 9.80f, -depth - 0.05f}, {x + 0.09f, ceiling + 0.02f, 0.0f}, cell_, kit::all_faces & ~(kit::top | kit::back | kit::front));
            }
            kit::append(of(wood_), row, sides[s].frame);
        }
    }

    // Makes a mesh of parts, one primitive a material, to be placed many times.
    uint32_t mesh(const char* name, std::vector<std::pair<uint32_t, Primitive>> parts) {
        std::vector<Primitive> primitives;
        for (auto& [material, primitive] : parts) {
            primitive.material = material;
            primitives.push_back(std::move(primitive));
        }
        return kit::add_mesh(scene_, name, std::move(primitives));
    }

    void arcades() {
        Primitive lower, upper, stand, rails, wall0, trim0, wall1, trim1, frame, boss;
        lower_column(lower, lower_spring - gallery_floor, detail_);
        upper_column(upper, upper_spring - upper_floor - 1.0f, detail_);
        pedestal(stand, 1.0f, detail_);
        balustrade(rails, bay - 0.44f, detail_);
        arcade_bay(wall0, trim0, lower_radius, slab_low + 0.05f - lower_spring, detail_);
        arcade_bay(wall1, trim1, upper_radius, ceiling + 0.05f - upper_spring, detail_);
        medallion(frame, boss, detail_);
        const uint32_t column0 = mesh("lower column", {{marble_, std::move(lower)}});
        const uint32_t column1 = mesh("upper column", {{marble_, std::move(upper)}, {stone_, std::move(stand)}});
        const uint32_t bay0 = mesh("lower bay", {{stone_, std::move(wall0)}, {marble_, std::move(trim0)}});
        const uint32_t bay1 = mesh("upper bay", {{plaster_, std::move(wall1)}, {marble_, std::move(trim1)}});
        const uint32_t railing = mesh("balustrade", {{marble_, std::move(rails)}});
        const uint32_t relief = mesh("medallion", {{marble_, std::move(frame)}, {glaze_, std::move(boss)}});
        scene_.meshes[column1].primitives[0] = raised(scene_.meshes[column1].primitives[0], 1.0f);
        const auto place = [&](uint32_t mesh, const Side& side, vec3 at) { kit::add_instance(scene_, mesh, side.frame * moved(at)); };
        for (const Side& side : sides) {
            for (int i = 0; i < side.bays; ++i) {
                const float x = side.bay_center(i);
                place(bay0, side, {x, lower_spring, 0});
                place(bay1, side, {x, upper_spring, 0});
                place(railing, side, {x, upper_floor, 0});
            }
            for (int i = 1; i < side.bays; ++i) {
                const float x = side.axis(i);
                place(column0, side, {x, gallery_floor, 0});
                place(column1, side, {x, upper_floor, 0});
                place(relief, side, {x, lower_spring + 1.25f, wall_thickness / 2});
                place(relief, side, {x, upper_spring + 1.27f, wall_thickness / 2});
            }
        }
    }

    static Primitive raised(const Primitive& in, float by) {
        Primitive out;
        kit::append(out, in, moved({0, by, 0}));
        out.material = in.material;
        return out;
    }

    void furnish_walls() {
        Primitive door_frame, door_wood, window_frame, window_wood;
        door(door_frame, door_wood, detail_);
        window(window_frame, window_wood, detail_);
        const uint32_t doors = mesh("door", {{stone_, std::move(door_frame)}, {wood_, std::move(door_wood)}});
        const uint32_t windows = mesh("window", {{marble_, std::move(window_frame)}, {leaf_wood(), std::move(window_wood)}});
        for (const Side& side : sides)
            for (int i = 0; i < side.bays; ++i) {
                const vec3 at(side.bay_center(i), 0, -depth);
                if (i % 2 == 1) kit::add_instance(scene_, doors, side.frame * moved(at + vec3(0, gallery_floor, 0)));
                kit::add_instance(scene_, windows, side.frame * moved(at + vec3(0, upper_floor + 1.1f, 0)));
            }
    }

    uint32_t leaf_wood() { return kit::add_material(scene_, "green shutters", {0.16f, 0.32f, 0.24f}, 0.7f); }

    void furnish_court() {
        Primitive bowl, pool, clay, earth;
        fountain(bowl, pool, detail_);
        const uint32_t well = mesh("fountain", {{marble_, std::move(bowl)}, {water_, std::move(pool)}});
        kit::add_instance(scene_, well, moved({1.5f, 0, 0}));
        pot(clay, earth, detail_);
        const uint32_t planter = mesh("pot", {{clay_, std::move(clay)}, {earth_, std::move(earth)}});
        for (float x : {-9.0f, -3.0f, 6.0f, 10.6f})
            for (float z : {-3.35f, 3.35f}) {
                Primitive leaves;
                shrub(leaves, random_, detail_);
                const mat4 at = moved({x, 0, z}) * turned(random_.real(0, 360)) * glm::scale(mat4(1), vec3(random_.real(0.95f, 1.15f)));
                kit::add_instance(scene_, planter, at);
                kit::add_instance(scene_, mesh("shrub", {{leaf_, std::move(leaves)}}), at);
            }
    }

    // A pair of drapes in an arch, from a rod at the springing line.
    void curtain(const Side& side, int i, size_t color, float rod_height, float fall, float tied) {
        const float clear = bay - 0.62f, x = side.bay_center(i), z = -0.02f;
        Primitive iron, left, right;
        rod(iron, bay - 0.3f, detail_);
        kit::append(of(iron_), iron, side.frame * moved({x, rod_height, z}));
        const kit::Drape shape{clear / 2 + 0.04f, fall, tied, 6};
        kit::drape(left, shape, random_, detail_);
        kit::drape(right, shape, random_, detail_);
        kit::append(of(cloths_[color]), left, side.frame * moved({x - clear / 2, rod_height, z}));
        // The right one is the mirror image: a half turn, for cloth has no front.
        kit::append(of(cloths_[color]), right, side.frame * moved({x + clear / 2, rod_height, z}) * turned(180));
    }

    void cloths() {
        const float low = lower_spring - 0.04f, high = upper_spring - 0.04f, low_fall = low - gallery_floor - 0.08f, high_fall = high - upper_floor - 1.0f;
        for (auto [side, i, color, tied] : {std::tuple(0, 2, 0, 0.35f), {0, 4, 1, 0.45f}, {0, 6, 2, 0.35f}, {1, 2, 2, 0.4f}, {1, 5, 0, 0.35f}, {3, 1, 0, 0.35f}})
            curtain(sides[size_t(side)], i, size_t(color), low, low_fall, tied);
        for (auto [side, i, color, tied] : {std::tuple(0, 1, 1, 0.5f), {0, 5, 0, 0.9f}, {1, 3, 1, 0.4f}, {1, 6, 2, 0.9f}, {3, 0, 2, 0.5f}, {3, 2, 2, 0.5f}})
            curtain(sides[size_t(side)], i, size_t(color), high, high_fall, tied);
        for (auto [side, i, color] : {std::tuple(0, 3, 2), {0, 7, 0}, {1, 1, 0}, {1, 4, 1}, {3, 1, 1}}) {
            Primitive cloth;
            runner(cloth, 1.3f, 1.5f, random_, detail_);
            const Side& s = sides[size_t(side)];
            kit::append(of(cloths_[size_t(color)]), cloth, s.frame * moved({s.bay_center(i), upper_floor + 0.97f, 0}));
        }
    }

    // The sky: two emissive planes, like half of a tent, over the half of the hemisphere that the sun does not come from.
    // Its ridge just clears the sunbeam to the highest lit edges, so that no sun is lost; its eaves lie below every line of
    // sight out of the court, so that the cameras see no void. Being near, it wastes little of its light outside.
    void sky() {
        const uint32_t material = kit::add_material(scene_, "sky", vec3(0.2f));
        scene_.materials[material].emissive = sky_;
        Primitive& out = of(material);
        constexpr float ridge = 17, eaves = 10.9f;
        const float rise = (ridge - 10.6f) / -sun_direction.y;
        const float x0 = half.x - 0.9f - rise * sun_direction.x, z0 = -half.y + 0.9f - rise * sun_direction.z;  // where the ridges run
        const float x1 = half.x + 10, z1 = -half.y - 11, west = -half.x - 10, south = half.y + 10;
        const vec3 hip(x0, ridge, z0), hip_low(x1, eaves, z1);
        kit::patch(out, 16, 4, [&](float u, float v) {
            const vec3 a = vec3(west, ridge, z0) + (hip - vec3(west, ridge, z0)) * u, b = vec3(west, eaves, z1) + (hip_low - vec3(west, eaves, z1)) * u;
            return a + (b - a) * (1 - v);
        });
        kit::patch(out, 16, 4, [&](float u, float v) {
            const vec3 a = hip + (vec3(x0, ridge, south) - hip) * u, b = hip_low + (vec3(x1, eaves, south) - hip_low) * u;
            return a + (b - a) * (1 - v);
        });
    }

    void lights_and_cameras() {
        if (sun_ != vec3(0)) scene_.lights.push_back({Light::Type::directional, "sun", {0, 30, 0}, sun_direction, sun_});
        kit::add_camera(scene_, "court", {-11.0f, 1.75f, 1.3f}, {2.0f, 3.55f, -0.9f}, 62);
        kit::add_camera(scene_, "gallery", {-3.2f, 7.05f, 7.2f}, {1.6f, 6.35f, -4.5f}, 62);
        kit::add_camera(scene_, "corner", {-11.0f, 2.0f, 2.5f}, {2.0f, 4.5f, -4.2f}, 66);
    }

    const float detail_, cell_;
    const vec3 sun_, sky_;  // irradiance, radiance
    kit::Random random_;
    Scene scene_;
    std::map<uint32_t, Primitive> building_;
    uint32_t stone_, base_, marble_, plaster_, wood_, iron_, clay_, earth_, leaf_, water_, glaze_, paving_, lower_tiles_, upper_tiles_;
    std::array<uint32_t, 4> lower_walls_, upper_walls_;
    std::array<uint32_t, 3> cloths_;
};

}  // namespace

Scene make_atrium(const BuiltinOptions& options, uint32_t seed) { return Atrium(options.number("detail"), seed, sun_irradiance, sky_radiance).make(); }

Scene atrium::without_sun(float detail, uint32_t seed, vec3 sky_radiance) { return Atrium(detail, seed, vec3(0), sky_radiance).make(); }

}  // namespace myriad::scenes
