#include "scenes/scene.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/error.hpp"
#include "scenes/builtin.hpp"
#include "scenes/gltf.hpp"

namespace myriad::scenes {
namespace {

constexpr glm::vec3 up{0, 1, 0};

bool finite(const glm::vec3& v) { return std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z); }

// Denormal coordinates become 0: devices may flush them, and host and device must see the same scene.
bool flush_denormals(glm::vec3& v) {
    bool any = false;
    for (int i = 0; i < 3; ++i)
        if (std::fpclassify(v[i]) == FP_SUBNORMAL) v[i] = 0, any = true;
    return any;
}

// The unit vector of `v`, or `fallback` where there is none. In double: squares of float coordinates overflow at 1e19.
glm::vec3 unit_or(const glm::dvec3& v, const glm::vec3& fallback) {
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? glm::vec3(v / length) : fallback;
}

glm::dvec3 face_normal(const glm::vec3& a, const glm::vec3& b, const glm::vec3& c) {
    const glm::dvec3 o(a);
    return glm::cross(glm::dvec3(b) - o, glm::dvec3(c) - o);
}

// Normals transform by the cofactor matrix: the inverse transpose times the determinant, so it needs no division and
// stays right for flattened (singular) instances; the sign of the determinant is put back by the caller.
glm::dmat3 cofactors(const glm::dmat3& m) {
    return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

struct Defects {
    size_t dropped = 0, denormal = 0, bad_normals = 0;
};

// Appends one primitive of one instance.
class Flattener {
public:
    Flattener(Triangles& out, Defects& defects) : out_(out), defects_(defects) {}

    void append(const Primitive& primitive, const glm::mat4& to_world) {
        const size_t first = out_.positions.size(), split = primitive.normals.empty() ? primitive.indices.size() : 0;
        if (first + std::max(primitive.positions.size(), split) >= none || out_.triangles.size() >= none / 3)
            throw InputError("the scene has more than 2^32 vertices; give fewer instances or coarser meshes.");
        transform(primitive, to_world);
        if (primitive.normals.empty()) flat(primitive);
        else smooth(primitive, to_world);
    }

private:
    void transform(const Primitive& primitive, const glm::mat4& to_world) {
        mirrored_ = glm::determinant(glm::dmat3(to_world)) < 0;
        world_.resize(primitive.positions.size());
        usable_.resize(world_.size());
        for (size_t i = 0; i < world_.size(); ++i) {
            world_[i] = glm::vec3(to_world * glm::vec4(primitive.positions[i], 1));
            usable_[i] = finite(world_[i]);
            defects_.denormal += flush_denormals(world_[i]);
        }
    }

    // The corners of triangle `t`, counter-clockwise as seen from its front in the world.
    glm::uvec3 corners(const Primitive& primitive, size_t t) const {
        const uint32_t* i = &primitive.indices[3 * t];
        return mirrored_ ? glm::uvec3(i[0], i[2], i[1]) : glm::uvec3(i[0], i[1], i[2]);
    }

    bool keep(const glm::uvec3& c) {
        const bool ok = usable_[c.x] && usable_[c.y] && usable_[c.z];
        defects_.dropped += !ok;
        return ok;
    }

    glm::vec2 texcoord(const Primitive& primitive, uint32_t i) const {
        return primitive.texcoords.empty() ? glm::vec2(0) : primitive.texcoords[i];
    }

    void flat(const Primitive& primitive) {
        for (size_t t = 0; 3 * t < primitive.indices.size(); ++t) {
            const glm::uvec3 c = corners(primitive, t);
            if (!keep(c)) continue;
            const glm::vec3 n = unit_or(face_normal(world_[c.x], world_[c.y], world_[c.z]), up);
            const uint32_t first = uint32_t(out_.positions.size());
            for (int k = 0; k < 3; ++k) {
                out_.positions.push_back(world_[c[k]]);
                out_.normals.push_back(n);
                out_.texcoords.push_back(texcoord(primitive, c[k]));
            }
            out_.triangles.emplace_back(first, first + 1, first + 2, primitive.material);
        }
    }

    void smooth(const Primitive& primitive, const glm::mat4& to_world) {
        const uint32_t first = uint32_t(out_.positions.size());
        const glm::dmat3 to_normal = cofactors(glm::dmat3(to_world)) * (mirrored_ ? -1.0 : 1.0);
        for (size_t i = 0; i < world_.size(); ++i) {
            // An unusable vertex keeps its number, so that indices stay as they are; no triangle refers to it.
            out_.positions.push_back(usable_[i] ? world_[i] : glm::vec3(0));
            out_.normals.push_back(unit_or(to_normal * glm::dvec3(primitive.normals[i]), glm::vec3(0)));
            out_.texcoords.push_back(texcoord(primitive, uint32_t(i)));
        }
        const size_t first_triangle = out_.triangles.size();
        for (size_t t = 0; 3 * t < primitive.indices.size(); ++t)
            if (const glm::uvec3 c = corners(primitive, t); keep(c)) out_.triangles.emplace_back(c + first, primitive.material);
        repair_normals(first, first_triangle);
    }

    // A zero or non-finite normal is replaced by the area-weighted mean of the faces around the vertex.
    void repair_normals(uint32_t first, size_t first_triangle) {
        std::vector<glm::dvec3> sums;
        for (size_t i = first; i < out_.normals.size(); ++i)
            if (out_.normals[i] == glm::vec3(0)) sums.resize(out_.normals.size() - first);
        if (sums.empty()) return;
        for (size_t t = first_triangle; t < out_.triangles.size(); ++t) {
            const glm::uvec4 c = out_.triangles[t];
            const glm::dvec3 n = face_normal(out_.positions[c.x], out_.positions[c.y], out_.positions[c.z]);
            for (int k = 0; k < 3; ++k) sums[c[k] - first] += n;
        }
        for (size_t i = 0; i < sums.size(); ++i)
            if (auto& n = out_.normals[first + i]; n == glm::vec3(0)) n = unit_or(sums[i], up), ++defects_.bad_normals;
    }

    Triangles& out_;
    Defects& defects_;
    std::vector<glm::vec3> world_;
    std::vector<bool> usable_;
    bool mirrored_ = false;
};

}  // namespace

Triangles flatten(Scene& scene) {
    Triangles out;
    Defects defects;
    Flattener flattener(out, defects);
    for (const Instance& instance : scene.instances)
        for (const Primitive& primitive : scene.meshes[instance.mesh].primitives)
            flattener.append(primitive, instance.to_world);

    // Bounds over what the triangles use: an unusable vertex was parked at the origin.
    glm::vec3 lo(std::numeric_limits<float>::infinity()), hi(-lo);
    for (const auto& t : out.triangles)
        for (int k = 0; k < 3; ++k) lo = glm::min(lo, out.positions[t[k]]), hi = glm::max(hi, out.positions[t[k]]);
    if (!out.triangles.empty()) out.lo = lo, out.hi = hi;

    if (defects.dropped)
        scene.warnings.push_back(std::to_string(defects.dropped) + " triangles with a non-finite vertex were dropped.");
    if (defects.denormal)
        scene.warnings.push_back(std::to_string(defects.denormal) + " vertices with a denormal coordinate had it set to 0.");
    if (defects.bad_normals)
        scene.warnings.push_back(std::to_string(defects.bad_normals) + " zero or non-finite normals were computed anew.");
    return out;
}

Camera framing_camera(const Triangles& triangles) {
    Camera camera;
    camera.name = "framing";
    const glm::dvec3 centre = (glm::dvec3(triangles.lo) + glm::dvec3(triangles.hi)) * 0.5;
    const double radius = glm::length(glm::dvec3(triangles.hi) - glm::dvec3(triangles.lo)) * 0.5;
    // Far enough that the bounding sphere fits the vertical angle, a little to the side and above. A scene without
    // extent is seen from one metre.
    const double distance = radius > 0 ? 1.05 * radius / std::sin(camera.yfov * 0.5) : 1.0;
    const glm::dvec3 eye = centre + distance * glm::normalize(glm::dvec3(0.6, 0.45, 1.0));
    camera.to_world = glm::mat4(glm::inverse(glm::lookAt(eye, centre, glm::dvec3(up))));
    return camera;
}

Camera pick_camera(const Scene& scene, const Triangles& triangles, const std::string& name) {
    if (name.empty()) return scene.cameras.empty() ? framing_camera(triangles) : scene.cameras[0];
    for (const auto& camera : scene.cameras)
        if (camera.name == name) return camera;
    const bool digits = name.size() <= 9 && std::all_of(name.begin(), name.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (digits && std::stoul(name) < scene.cameras.size()) return scene.cameras[std::stoul(name)];
    if (scene.cameras.empty())
        throw InputError(scene.name + ": there is no camera \"" + name + "\", for the scene has none; leave the camera out.");
    std::string known;
    for (size_t i = 0; i < scene.cameras.size(); ++i)
        known += (i ? ", " : "") + std::to_string(i) + " \"" + scene.cameras[i].name + "\"";
    throw InputError(scene.name + ": there is no camera \"" + name + "\"; known: " + known + ".");
}

Scene load(const std::string& source, uint32_t seed) {
    constexpr std::string_view prefix = "builtin:";
    if (source.starts_with(prefix)) return load_builtin(source.substr(prefix.size()), seed);
    return load_gltf(source);
}

}  // namespace myriad::scenes
