// A small mesh-building kit. Everything appends to a Primitive, front faces counter-clockwise, unit normals outward,
// so that a scene is a list of such calls. Solids may run into each other: walls bury their ends in other walls, and no
// two faces lie in the same plane.
#pragma once

#include <array>
#include <functional>
#include <vector>

#include "scenes/scene.hpp"

namespace myriad::scenes::kit {

inline constexpr float pi = 3.14159265358979f;

// How many steps something has that has n of them at detail 1.
inline int steps(float n, float detail) { return n * detail < 3 ? 3 : int(n * detail + 0.5f); }

// PCG32: small, and the same everywhere, which the distributions of <random> are not.
class Random {
public:
    explicit Random(uint64_t seed);
    uint32_t bits();
    float real() { return float(bits() >> 8) * 0x1p-24f; }               // [0, 1)
    float real(float lo, float hi) { return lo + (hi - lo) * real(); }
    uint32_t below(uint32_t n) { return uint32_t((uint64_t(bits()) * n) >> 32); }

private:
    uint64_t state_;
};

// What all of this is made of. join_grid() joins (nu + 1) x (nv + 1) vertices that start at `first`, u running fastest, into
// triangles facing du x dv; triangles of (nearly) no area, as at poles, are left out.
void vertex(Primitive& out, glm::vec3 position, glm::vec3 normal, glm::vec2 texcoord);
void triangle(Primitive& out, uint32_t a, uint32_t b, uint32_t c);
void join_grid(Primitive& out, uint32_t first, int nu, int nv);

// The surface point(u, v) over the unit square in nu x nv cells; the front is where d/du x d/dv points. Normals by
// central differences; texture coordinates are (u, v) * uv_scale. Triangles that collapse are left out.
using Patch = std::function<glm::vec3(float u, float v)>;
void patch(Primitive& out, int nu, int nv, const Patch& point, glm::vec2 uv_scale = {1, 1});

// The parallelogram origin, origin + u, origin + v; texture coordinates in metres times `uv_per_metre`.
void quad(Primitive& out, glm::vec3 origin, glm::vec3 u, glm::vec3 v, int nu, int nv, float uv_per_metre = 1);

// A closed box in cells of about `cell` metres.
enum Face : unsigned { left = 1, right = 2, bottom = 4, top = 8, back = 16, front = 32, all_faces = 63 };
void box(Primitive& out, glm::vec3 lo, glm::vec3 hi, float cell, unsigned faces = all_faces);

// A profile is a polyline in the plane of a sweep, with the solid on the left of its direction of travel: bottom to top
// where the solid is a wall seen from outside, counter-clockwise where it is closed (last point equal to first). Where it
// turns by more than 0.6 radians the edge is hard, elsewhere the surface is smooth.
using Profile = std::vector<glm::vec2>;

// The unit tangents at both ends of the profile's segment `segment`, shared with its neighbours where the edge is smooth.
std::array<glm::vec2, 2> profile_tangents(const Profile& profile, size_t segment);

// Moves the profile through space: `place(p, t)` for t in [0, 1] in nt steps, hand chosen so that the front is
// d/dprofile x d/dt. lathe(), ring() and arch_moulding() are this with their own place().
using Placement = std::function<glm::vec3(glm::vec2 p, float t)>;
void sweep(Primitive& out, const Profile& profile, int nt, const Placement& place);

// Profile (radius, height) turned about +Y. `radius_factor`, if given, varies the radius with angle and height: flutes.
using RadiusFactor = std::function<float(float angle, float height)>;
void lathe(Primitive& out, const Profile& profile, int sides, const RadiusFactor& radius_factor = {});
// A part of that, between two angles, about the vertical through `axis` (x, z): for what is half buried in something else.
void lathe(Primitive& out, const Profile& profile, int sides, glm::vec2 axis, float from, float to, const RadiusFactor& radius_factor = {});

// Appends an arc around `centre` from angle `from` to `to`, in n segments, to a profile: rounds, hollows and bulges.
void arc(Profile& profile, glm::vec2 centre, float radius, float from, float to, int n);

// Profile (projection towards the centre, height) around the rectangle |x| = half.x, |z| = half.y, mitred at its
// corners: mouldings, slabs and walls around a court.
void ring(Primitive& out, const Profile& profile, glm::vec2 half, float cell);

// Profile (radial offset, z) along the semi-ellipse x = a cos, y = b sin, y >= 0: archivolts on a wall, ribs of a vault.
void arch_moulding(Primitive& out, const Profile& profile, float a, float b, int segments);

// A wall panel between z = -thickness/2 and thickness/2, |x| <= width/2, from the springing line y = 0 up to `height`,
// with a semicircular opening of `radius` that stands on the springing line. The ends and the top stay open: they are
// buried in the neighbouring panel and in the slab above.
void arch_panel(Primitive& out, float width, float height, float radius, float thickness, int segments);

// A groin vault over |x| <= half.x, |z| <= half.y, springing at y = 0 and rising to `rise`, seen from below.
void groin_vault(Primitive& out, glm::vec2 half, float rise, int cells);

// A drape that hangs from (0, 0, 0) downwards, `width` wide at the top towards +x, gathered to `tied` of its width at
// 60 % of its height (1: hangs straight). Folds run vertically.
struct Drape {
    float width, height, tied, folds;
};
void drape(Primitive& cloth, const Drape& shape, Random& random, float detail);

void append(Primitive& out, const Primitive& in, const glm::mat4& transform);

// Transforms: a translation; a rotation about an axis.
glm::mat4 moved(glm::vec3 by);
glm::mat4 turned(float degrees, glm::vec3 axis = {0, 1, 0});

// Puts a scene together.
uint32_t add_material(Scene& scene, const std::string& name, glm::vec3 albedo, float roughness = 0.9f, uint32_t texture = none);
uint32_t add_mesh(Scene& scene, const std::string& name, std::vector<Primitive> primitives);
// Of parts by material; empty ones are left out.
uint32_t add_mesh(Scene& scene, const std::string& name, std::vector<std::pair<uint32_t, Primitive>> parts);
void add_instance(Scene& scene, uint32_t mesh, const glm::mat4& to_world = glm::mat4(1));
void add_camera(Scene& scene, const std::string& name, glm::vec3 eye, glm::vec3 target, float yfov_degrees);

// Linear radiance to an sRGB byte, for procedural textures.
uint8_t srgb8(float linear);

}  // namespace myriad::scenes::kit
