// Instances to triangles, in world space or shared, with every defect that a vertex can have repaired and counted. What moves
// comes last, and motion_builder.* says how.
#include <algorithm>
#include <cmath>
#include <limits>

#include <unistd.h>

#include "engine/error.hpp"
#include "scenes/moment.hpp"
#include "scenes/motion_builder.hpp"
#include "scenes/normals.hpp"
#include "scenes/sharing.hpp"

namespace myriad::scenes {
namespace {

constexpr glm::vec3 up{0, 1, 0};

template <int n>
bool finite(const glm::vec<n, float>& v) {
    for (int i = 0; i < n; ++i)
        if (!std::isfinite(v[i])) return false;
    return true;
}

// Denormal coordinates become 0: devices may flush them, and host and device must see the same scene.
bool flush_denormals(glm::vec3& v) {
    bool any = false;
    for (int i = 0; i < 3; ++i)
        if (std::fpclassify(v[i]) == FP_SUBNORMAL) v[i] = 0, any = true;
    return any;
}

// Normals transform by the cofactor matrix: the inverse transpose times the determinant, so it needs no division and
// stays right for flattened (singular) instances; the sign of the determinant is put back by the caller.
glm::dmat3 cofactors(const glm::dmat3& m) {
    return {glm::cross(m[1], m[2]), glm::cross(m[2], m[0]), glm::cross(m[0], m[1])};
}

// Which of the attributes that a primitive may lack the scene has: those vectors are filled for every vertex.
struct Attributes {
    bool colors = false, texcoords1 = false, tangents = false;
};

struct Defects {
    size_t dropped = 0, denormal = 0, bad_normals = 0, bad_texcoords = 0, bad_colors = 0;
};

// Appends one primitive of one instance: where a transform places it, or where `posed` says that its vertices are.
class Flattener {
public:
    Flattener(Triangles& out, const Attributes& attributes, Defects& defects) : out_(out), attributes_(attributes), defects_(defects) {}

    void append(const Primitive& primitive, const glm::mat4& to_world) {
        posed_ = nullptr;
        linear_ = glm::dmat3(to_world);
        mirrored_ = glm::determinant(linear_) < 0;
        place(primitive, [&](size_t i) { return glm::vec3(to_world * glm::vec4(primitive.positions[i], 1)); });
        if (primitive.normals.empty()) flat(primitive);
        else smooth(primitive);
    }

    void append(const Primitive& primitive, PosedPrimitive& posed) {
        posed_ = &posed;
        place(primitive, [&](size_t i) { return posed.position(i); });
        if (primitive.normals.empty()) flat(primitive);
        else smooth(primitive);
    }

private:
    template <class Where>
    void place(const Primitive& primitive, Where where) {
        world_.resize(primitive.positions.size());
        usable_.resize(world_.size());
        for (size_t i = 0; i < world_.size(); ++i) {
            world_[i] = where(i);
            usable_[i] = std::abs(world_[i].x) <= farthest && std::abs(world_[i].y) <= farthest && std::abs(world_[i].z) <= farthest;
            defects_.denormal += flush_denormals(world_[i]);
        }
    }

    // The corners of triangle `t`, counter-clockwise as seen from its front in the world.
    glm::uvec3 corners(const Primitive& primitive, size_t t) const {
        const uint32_t* i = &primitive.indices[3 * t];
        const bool mirrored = posed_ ? posed_->mirrored(i[0]) : mirrored_;
        return mirrored ? glm::uvec3(i[0], i[2], i[1]) : glm::uvec3(i[0], i[1], i[2]);
    }

    bool keep(const glm::uvec3& c) {
        const bool ok = usable_[c.x] && usable_[c.y] && usable_[c.z];
        defects_.dropped += !ok;
        return ok;
    }

    glm::vec2 texcoord(const std::vector<glm::vec2>& set, uint32_t i) {
        if (set.empty()) return glm::vec2(0);
        if (finite(set[i])) return set[i];
        ++defects_.bad_texcoords;
        return glm::vec2(0);
    }

    glm::vec4 color(const Primitive& primitive, uint32_t i) {
        if (primitive.colors.empty()) return glm::vec4(1);
        if (finite(primitive.colors[i])) return glm::clamp(primitive.colors[i], 0.0f, 1.0f);
        ++defects_.bad_colors;
        return glm::vec4(1);
    }

    // A tangent lies in the surface and goes with it, unlike a normal. Where the instance mirrors, normal x tangent turns
    // around, and w undoes that.
    glm::vec4 tangent(const Primitive& primitive, uint32_t i) const {
        if (primitive.tangents.empty() || primitive.normals.empty()) return glm::vec4(0, 0, 0, 1);
        const glm::vec4& t = primitive.tangents[i];
        if (posed_) return posed_->tangent(i);
        return glm::vec4(unit_or(linear_ * glm::dvec3(t), glm::vec3(0)), (t.w < 0) != mirrored_ ? -1 : 1);
    }

    // Vertex `i` of `primitive`, with this normal. An unusable one keeps its number, so that indices stay as they are; no
    // triangle refers to it.
    void vertex(const Primitive& primitive, uint32_t i, const glm::vec3& normal) {
        out_.positions.push_back(usable_[i] ? world_[i] : glm::vec3(0));
        out_.normals.push_back(normal);
        out_.texcoords.push_back(texcoord(primitive.texcoords, i));
        if (attributes_.colors) out_.colors.push_back(color(primitive, i));
        if (attributes_.texcoords1)
            out_.texcoords1.push_back(primitive.texcoords1.empty() ? out_.texcoords.back() : texcoord(primitive.texcoords1, i));
        if (attributes_.tangents) out_.tangents.push_back(tangent(primitive, i));
        if (posed_) posed_->keep(i, usable_[i]);
    }

    void flat(const Primitive& primitive) {
        for (size_t t = 0; 3 * t < primitive.indices.size(); ++t) {
            const glm::uvec3 c = corners(primitive, t);
            if (!keep(c)) continue;
            const glm::vec3 n = unit_or(face_normal(world_[c.x], world_[c.y], world_[c.z]), up);
            const uint32_t first = uint32_t(out_.positions.size());
            if (posed_) posed_->keep_flat();
            for (int k = 0; k < 3; ++k) vertex(primitive, c[k], n);
            out_.triangles.emplace_back(first, first + 1, first + 2, primitive.material);
        }
    }

    void smooth(const Primitive& primitive) {
        const uint32_t first = uint32_t(out_.positions.size());
        const glm::dmat3 to_normal = cofactors(linear_) * (mirrored_ ? -1.0 : 1.0);
        for (uint32_t i = 0; i < world_.size(); ++i)
            vertex(primitive, i, posed_ ? posed_->normal(i) : unit_or(to_normal * glm::dvec3(primitive.normals[i]), glm::vec3(0)));
        const size_t first_triangle = out_.triangles.size();
        for (size_t t = 0; 3 * t < primitive.indices.size(); ++t)
            if (const glm::uvec3 c = corners(primitive, t); keep(c)) out_.triangles.emplace_back(c + first, primitive.material);
        repair_normals(first, first_triangle);
    }

    // A zero or non-finite normal is replaced by what its faces say.
    void repair_normals(uint32_t first, size_t first_triangle) {
        const std::span<glm::vec3> normals(out_.normals.data() + first, out_.normals.size() - first);
        defects_.bad_normals += scenes::repair_normals(normals, std::span(out_.positions).subspan(first), [&](auto face) {
            for (size_t t = first_triangle; t < out_.triangles.size(); ++t)
                face(out_.triangles[t].x - first, out_.triangles[t].y - first, out_.triangles[t].z - first);
        });
    }

    Triangles& out_;
    const Attributes attributes_;
    Defects& defects_;
    PosedPrimitive* posed_ = nullptr;
    glm::dmat3 linear_{1};
    std::vector<glm::vec3> world_;
    std::vector<bool> usable_;
    bool mirrored_ = false;
};

void reserve(Triangles& out, const Attributes& attributes, size_t vertices, size_t triangles) {
    out.positions.reserve(vertices);
    out.normals.reserve(vertices);
    out.texcoords.reserve(vertices);
    if (attributes.colors) out.colors.reserve(vertices);
    if (attributes.texcoords1) out.texcoords1.reserve(vertices);
    if (attributes.tangents) out.tangents.reserve(vertices);
    out.triangles.reserve(triangles);
}

// At most; morph targets often leave most vertices where they are.
uint64_t motion_bytes_a_vertex(const Primitive& p) {
    const size_t influences = p.joints[0].empty() ? 1 : p.joints[1].empty() ? 4 : 8;
    return sizeof(MovingVertex) + sizeof(glm::vec4) + influences * sizeof(Influence) + p.targets.size() * sizeof(MorphDelta);
}

// A file of a megabyte can place a mesh a hundred thousand times, and where instances cannot be shared each is written out. More
// than the machine has is refused before the system has to end the program for it.
void require_memory(const Attributes& attributes, size_t vertices, size_t triangles, uint64_t others) {
    const uint64_t vertex = 2 * sizeof(glm::vec3) + sizeof(glm::vec2) + (attributes.colors ? sizeof(glm::vec4) : 0) +
                            (attributes.texcoords1 ? sizeof(glm::vec2) : 0) + (attributes.tangents ? sizeof(glm::vec4) : 0);
    const uint64_t needed = vertex * vertices + sizeof(glm::uvec4) * triangles + others;
    const uint64_t machine = uint64_t(sysconf(_SC_PHYS_PAGES)) * uint64_t(sysconf(_SC_PAGESIZE));
    if (needed > machine)
        throw OutOfMemory("the scene's instances take " + std::to_string(needed >> 30) + " GiB written out, and the machine has " +
                          std::to_string(machine >> 30) + "; give fewer instances or coarser meshes.");
}

// Bounds over what the triangles use: an unusable vertex was parked at the origin.
void find_bounds(Triangles& out, const std::vector<Placement>& placements) {
    glm::vec3 lo(std::numeric_limits<float>::infinity()), hi(-lo);
    for (const Placement& placement : placements)
        for (uint32_t i = placement.first_triangle; i < placement.first_triangle + placement.count; ++i)
            for (int k = 0; k < 3; ++k) {
                const glm::vec3& p = out.positions[out.triangles[i][k]];
                const glm::vec3 world = placement.in_world ? p : glm::vec3(placement.to_world * glm::vec4(p, 1));
                lo = glm::min(lo, world), hi = glm::max(hi, world);
            }
    if (out.count() > 0) out.lo = lo, out.hi = hi;
}

// Adds where moving vertices get while the clips play, looked at at some moments. What a matrix moves stays in the box of it
// that the matrix moves, and a vertex between those of its matrices. Where clips loop the end is the next beginning: the last
// moment is the one just before it. Looping stays on, for clips that are shorter meet every part of the longest.
void widen_bounds(const Scene& scene, Triangles& out) {
    const Motion& motion = out.motion;
    const int moments = int(std::clamp<size_t>((4 << 20) / (scene.nodes.size() + motion.matrices.size() + 1), 8, 128));
    double duration = 0;
    for (const uint32_t clip : motion.playback.clips) duration = std::max(duration, scene.clips[clip].duration());
    const double last = motion.playback.loop ? std::nextafter(duration, 0.0) : duration;
    const auto each_moment = [&](auto action) {
        for (int i = 0; i < moments; ++i) action(moment_at(scene, motion, duration * i / moments));
        action(moment_at(scene, motion, last));
    };
    std::vector<float> least(motion.weights.size()), most(least);
    if (!least.empty())
        each_moment([&](const Moment& moment) {
            for (size_t i = 0; i < least.size(); ++i) least[i] = std::min(least[i], moment.weights[i]), most[i] = std::max(most[i], moment.weights[i]);
        });
    const glm::vec3 infinity(std::numeric_limits<float>::infinity());
    std::vector<glm::vec3> lo(motion.matrices.size(), infinity), hi(motion.matrices.size(), -infinity);
    for (uint32_t i = 0; i < motion.count(); ++i) {
        const MovingVertex &v = motion.vertices[i], &next = motion.vertices[i + 1];
        glm::vec3 low = v.position, high = v.position;
        for (uint32_t k = v.deltas; k < next.deltas; ++k) {
            const MorphDelta& d = motion.deltas[k];
            low += glm::min(d.position * least[d.weight], d.position * most[d.weight]);
            high += glm::max(d.position * least[d.weight], d.position * most[d.weight]);
        }
        for (uint32_t k = v.influences; k < next.influences; ++k) {
            const uint32_t m = motion.influences[k].matrix;
            lo[m] = glm::min(lo[m], low), hi[m] = glm::max(hi[m], high);
        }
    }
    each_moment([&](const Moment& moment) {
        for (size_t m = 0; m < lo.size(); ++m)
            for (int corner = 0; corner < 8 && lo[m].x <= hi[m].x; ++corner) {
                const glm::vec3 p(corner & 1 ? hi[m].x : lo[m].x, corner & 2 ? hi[m].y : lo[m].y, corner & 4 ? hi[m].z : lo[m].z);
                const glm::vec3 world = settled_point(affine_point(moment.matrices[m], p));
                out.lo = glm::min(out.lo, world), out.hi = glm::max(out.hi, world);
            }
    });
}

}  // namespace

Triangles flatten(Scene& scene, Sharing sharing, const Playback& playback) {
    Triangles out;
    Defects defects;
    Attributes attributes;
    const std::vector<Stance> stance = stances(scene, playback);
    const SharingPlan plan = plan_sharing(scene, sharing, stance);
    // What comes to be stored: each instance, but of shared meshes the first.
    std::vector<bool> stored(scene.meshes.size());
    size_t vertices = 0, triangles = 0;
    uint64_t in_the_world = 0, motion_bytes = 0;
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        const uint32_t mesh = scene.instances[i].mesh;
        const bool again = plan.shares[i] && stored[mesh], built = stance[i] != Stance::still;  // by a MotionBuilder
        if (plan.shares[i]) stored[mesh] = true;
        for (const Primitive& p : scene.meshes[mesh].primitives) {
            in_the_world += p.indices.size() / 3;
            if (again) continue;
            attributes.colors |= !p.colors.empty();
            attributes.texcoords1 |= !p.texcoords1.empty();
            attributes.tangents |= !p.tangents.empty() && !p.normals.empty();
            vertices += p.normals.empty() ? p.indices.size() : p.positions.size();
            triangles += p.indices.size() / 3;
            if (built) motion_bytes += (p.normals.empty() ? p.indices.size() : p.positions.size()) * motion_bytes_a_vertex(p);
        }
    }
    if (vertices >= none || in_the_world >= none / 3)
        throw InputError("the scene has more than 2^32 vertices; give fewer instances or coarser meshes.");
    require_memory(attributes, vertices, triangles, motion_bytes);
    reserve(out, attributes, vertices, triangles);

    Flattener flattener(out, attributes, defects);
    std::vector<Placement> placements, first_of(scene.meshes.size());
    const auto place = [&](Placement placement) {
        if (placement.count == 0) return;
        if (!placements.empty()) {
            Placement& last = placements.back();
            placement.first_id = last.first_id + last.count;
            if (last.in_world && placement.in_world && last.first_triangle + last.count == placement.first_triangle)
                return void(last.count += placement.count);
        }
        placements.push_back(placement);
    };
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        if (stance[i] != Stance::still) continue;
        const Instance& instance = scene.instances[i];
        Placement& first = first_of[instance.mesh];  // of a shared mesh: where its triangles are, once they are
        Placement placement{.to_world = plan.shares[i] ? instance.to_world : glm::mat4(1), .in_world = !plan.shares[i],
                            .first_triangle = uint32_t(out.triangles.size())};
        if (plan.shares[i] && !first.in_world) {
            placement.first_triangle = first.first_triangle, placement.count = first.count;
        } else {
            for (const Primitive& primitive : scene.meshes[instance.mesh].primitives)
                flattener.append(primitive, plan.shares[i] ? glm::mat4(1) : instance.to_world);
            placement.count = uint32_t(out.triangles.size()) - placement.first_triangle;
            if (plan.shares[i]) first = placement;
        }
        place(placement);
    }
    // What is posed once, then what moves: at the end, so that all before it never changes.
    for (const Stance which : {Stance::posed, Stance::moving}) {
        if (std::ranges::find(stance, which) == stance.end()) continue;
        MotionBuilder builder(scene, stance, which, playback);
        builder.with_tangents = attributes.tangents;
        builder.motion.first_vertex = uint32_t(out.positions.size());
        builder.motion.first_triangle = uint32_t(out.triangles.size());
        for (size_t i = 0; i < scene.instances.size(); ++i) {
            if (stance[i] != which) continue;
            for (const Primitive& primitive : scene.meshes[scene.instances[i].mesh].primitives) {
                PosedPrimitive posed(builder, uint32_t(i), primitive);
                defects.bad_normals += posed.bad_normals();
                flattener.append(primitive, posed);
            }
        }
        place({.first_triangle = builder.motion.first_triangle, .count = uint32_t(out.triangles.size()) - builder.motion.first_triangle});
        if (which == Stance::posed) continue;
        builder.finish();
        out.motion = std::move(builder.motion);
        deform(out, builder.moment);
    }
    out.motion.playback = playback;
    if (std::any_of(placements.begin(), placements.end(), [](const Placement& p) { return !p.in_world; })) out.placements = placements;
    find_bounds(out, placements);
    if (out.motion.count() > 0) widen_bounds(scene, out);

    warn(scene, defects.dropped, "triangles with a vertex that is not finite or beyond 1e9 m were dropped");
    warn(scene, defects.denormal, "vertices with a denormal coordinate had it set to 0");
    warn(scene, defects.bad_normals, "zero or non-finite normals were computed anew");
    warn(scene, defects.bad_texcoords, "non-finite texture coordinates were set to 0");
    warn(scene, defects.bad_colors, "non-finite vertex colours were set to white");
    return out;
}

}  // namespace myriad::scenes
