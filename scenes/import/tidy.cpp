#include "scenes/import/tidy.hpp"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstring>
#include <numeric>
#include <unordered_map>

#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "scenes/attributes.hpp"
#include "scenes/normals.hpp"

namespace myriad::scenes {
namespace {

template <class Vector>
bool finite(const Vector& v) {
    const auto* values = glm::value_ptr(v);
    return std::all_of(values, values + sizeof v / sizeof *values, [](auto x) { return std::isfinite(x); });
}

// The unit vector of `v`, or 0 where there is none. In double: squares of float coordinates overflow at 1e19.
glm::dvec3 unit(const glm::dvec3& v) {
    const double length = glm::length(v);
    return length > 0 && std::isfinite(length) ? v / length : glm::dvec3(0);
}

// Copies vertex i of `in` to the end of `out`, with all it has.
void append_vertex(Primitive& out, const Primitive& in, uint32_t i) {
    each_attribute(out, in, [i](auto& to, const auto& from) {
        if (!from.empty()) to.push_back(from[i]);
    });
}

// What was found and repaired, over the whole scene.
struct Defects {
    size_t unusable = 0, flat = 0, normals = 0, tangents = 0, texcoords = 0, colors = 0, instances = 0;

    void report(Scene& scene) const {
        warn(scene, unusable, "triangles with a corner that is not finite were left out");
        warn(scene, flat, "triangles without area were left out");
        warn(scene, normals, "zero or non-finite normals were computed anew");
        warn(scene, tangents, "primitives with useless tangents lost them");
        warn(scene, texcoords, "texture coordinates that were not finite were set to 0");
        warn(scene, colors, "vertex colours that were not finite were set to white");
        warn(scene, instances, "instances whose transform is not finite or not affine were left out");
    }
};

void drop_triangles(Primitive& p, Defects& defects) {
    size_t kept = 0;
    for (size_t t = 0; t + 2 < p.indices.size(); t += 3) {
        const uint32_t* i = &p.indices[t];
        assert(i[0] < p.positions.size() && i[1] < p.positions.size() && i[2] < p.positions.size());
        const glm::vec3 &a = p.positions[i[0]], &b = p.positions[i[1]], &c = p.positions[i[2]];
        if (!finite(a) || !finite(b) || !finite(c)) ++defects.unusable;
        else if (p.targets.empty() && face_normal(a, b, c) == glm::dvec3(0)) ++defects.flat;  // a morph target may open it
        else std::copy_n(i, 3, &p.indices[kept]), kept += 3;
    }
    p.indices.resize(kept);
}

void compact(Primitive& p) {
    std::vector<uint32_t> number(p.positions.size(), none);
    for (uint32_t i : p.indices) number[i] = 0;
    if (std::ranges::find(number, none) == number.end()) return;
    Primitive out;
    for (uint32_t i = 0; i < number.size(); ++i)
        if (number[i] == 0) number[i] = uint32_t(out.positions.size()), append_vertex(out, p, i);
    for (uint32_t& i : p.indices) i = number[i];
    out.indices = std::move(p.indices);
    out.material = p.material;
    p = std::move(out);
}

// A normal that is none is replaced by the area-weighted mean of the faces around the vertex.
void repair_normals(Primitive& p, Defects& defects) {
    std::vector<uint32_t> bad;
    for (uint32_t i = 0; i < p.normals.size(); ++i) {
        const glm::dvec3 n = finite(p.normals[i]) ? unit(p.normals[i]) : glm::dvec3(0);
        if (n == glm::dvec3(0)) bad.push_back(i);
        else if (std::abs(glm::dot(p.normals[i], p.normals[i]) - 1) > 1e-5f) p.normals[i] = glm::vec3(n);
    }
    if (bad.empty()) return;
    defects.normals += bad.size();
    std::vector<glm::dvec3> sums(p.positions.size());
    for (size_t t = 0; t < p.indices.size(); t += 3) {
        const uint32_t* i = &p.indices[t];
        const glm::dvec3 n = face_normal(p.positions[i[0]], p.positions[i[1]], p.positions[i[2]]);
        for (int k = 0; k < 3; ++k) sums[i[k]] += n;
    }
    for (uint32_t i : bad) {
        const glm::dvec3 n = unit(sums[i]);
        p.normals[i] = n == glm::dvec3(0) ? glm::vec3(0, 1, 0) : glm::vec3(n);
    }
}

void repair_rest(Primitive& p, Defects& defects) {
    bool useless = false;
    for (glm::vec4& t : p.tangents) {
        const glm::dvec3 u = finite(t) ? unit(glm::dvec3(t)) : glm::dvec3(0);
        useless |= u == glm::dvec3(0);
        t = glm::vec4(glm::vec3(u), t.w < 0 ? -1 : 1);
    }
    if (useless) p.tangents.clear(), ++defects.tangents;
    for (auto* set : {&p.texcoords, &p.texcoords1})
        for (glm::vec2& uv : *set)
            if (!finite(uv)) uv = glm::vec2(0), ++defects.texcoords;
    for (glm::vec4& color : p.colors) {
        if (!finite(color)) color = glm::vec4(1), ++defects.colors;
        color = glm::clamp(color, 0.0f, 1.0f);
    }
}

// Numbers for what is used, in order; none for the rest. Erases the rest from `list`.
template <class T>
std::vector<uint32_t> keep_used(std::vector<T>& list, const std::vector<bool>& used) {
    std::vector<uint32_t> number(list.size(), none);
    uint32_t kept = 0;
    for (size_t i = 0; i < list.size(); ++i) {
        if (!used[i]) continue;
        number[i] = kept;
        if (kept != i) list[kept] = std::move(list[i]);
        ++kept;
    }
    list.resize(kept);
    return number;
}

void drop_unused(Scene& scene) {
    std::vector<bool> used(scene.meshes.size());
    for (const Instance& instance : scene.instances) used[instance.mesh] = true;
    for (size_t m = 0; m < used.size(); ++m) {
        std::erase_if(scene.meshes[m].primitives, [](const Primitive& p) { return p.indices.empty(); });
        if (scene.meshes[m].primitives.empty()) used[m] = false;
    }
    const auto meshes = keep_used(scene.meshes, used);
    std::erase_if(scene.instances, [&](const Instance& instance) { return meshes[instance.mesh] == none; });
    for (Instance& instance : scene.instances) instance.mesh = meshes[instance.mesh];

    used.assign(scene.materials.size(), false);
    for (const Mesh& mesh : scene.meshes)
        for (const Primitive& p : mesh.primitives) used[p.material] = true;
    const auto materials = keep_used(scene.materials, used);
    for (Mesh& mesh : scene.meshes)
        for (Primitive& p : mesh.primitives) p.material = materials[p.material];
    if (scene.materials.empty()) scene.materials.push_back({.name = "default"});

    used.assign(scene.textures.size(), false);
    const auto each_use = [&](auto action) {
        for (Material& m : scene.materials)
            for (TextureUse* use : {&m.base_color_texture, &m.metallic_roughness_texture, &m.emissive_texture, &m.normal_texture})
                if (use->texture != none) action(*use);
    };
    each_use([&](TextureUse& use) { used[use.texture] = true; });
    const auto textures = keep_used(scene.textures, used);
    each_use([&](TextureUse& use) { use.texture = textures[use.texture]; });
}

}  // namespace

glm::dmat4 upright(Axis up) {
    // Column by column: where the file's x, y and z go. Without sines, which would leave 1e-17 where there is 0.
    if (up == Axis::x) return {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1};
    if (up == Axis::z) return {1, 0, 0, 0, 0, 0, -1, 0, 0, 1, 0, 0, 0, 0, 0, 1};
    return glm::dmat4(1);
}

void add_root(Scene& scene, const glm::dmat4& matrix) {
    if (scene.nodes.empty()) return;
    const auto shift = [](uint32_t& node) {
        if (node != none) ++node;
    };
    for (Node& node : scene.nodes) node.parent = node.parent == none ? 0 : node.parent + 1;
    scene.nodes.insert(scene.nodes.begin(), {.matrix = matrix});
    for (Instance& instance : scene.instances) shift(instance.node);
    for (Camera& camera : scene.cameras) shift(camera.node);
    for (Light& light : scene.lights) shift(light.node);
    for (Skin& skin : scene.skins)
        for (uint32_t& joint : skin.joints) ++joint;
    for (Clip& clip : scene.clips)
        for (Channel& channel : clip.channels) ++channel.node;
}

void transform(Scene& scene, const glm::dmat4& rotation, double scale) {
    const glm::dmat4 m = glm::scale(glm::dmat4(1), glm::dvec3(scale)) * rotation;
    if (m == glm::dmat4(1)) return;
    add_root(scene, m);
    for (Instance& instance : scene.instances) instance.to_world = glm::mat4(m * glm::dmat4(instance.to_world));
    for (Camera& camera : scene.cameras) {
        camera.to_world = glm::mat4(rotation * glm::dmat4(camera.to_world));
        camera.to_world[3] = glm::vec4(glm::vec3(camera.to_world[3]) * float(scale), 1);
    }
    for (Light& light : scene.lights) {
        light.position = glm::vec3(m * glm::dvec4(light.position, 1));
        light.direction = glm::vec3(rotation * glm::dvec4(light.direction, 0));
    }
}

void weld(Primitive& p) {
    // Of each vertex, all floats that it has, and a hash of them.
    const auto each_float = [&](uint32_t i, auto action) {
        const auto all = [&](const auto& list) {
            if (list.empty()) return;
            for (int c = 0; c < list[i].length(); ++c) action(std::bit_cast<uint32_t>(float(list[i][c])));
        };
        each_attribute(p, all);
    };
    const auto hash = [&](uint32_t i) {
        uint64_t h = 0;
        each_float(i, [&](uint32_t bits) { h = (std::rotl(h, 25) ^ bits) * 0x9E3779B97F4A7C15u; });
        return h ^ h >> 32;
    };
    const auto same = [&](uint32_t i, uint32_t j) {
        bool same = true;
        each_attribute(p, [&](const auto& list) { same = same && (list.empty() || std::memcmp(&list[i], &list[j], sizeof list[0]) == 0); });
        return same;
    };
    // Open addressing, at most half full.
    std::vector<uint32_t> table(std::bit_ceil(2 * p.positions.size() + 1), none), number(p.positions.size(), none);
    Primitive out;
    for (uint32_t& index : p.indices) {
        if (number[index] == none) {
            size_t at = hash(index) & (table.size() - 1);
            while (table[at] != none && !same(table[at], index)) at = (at + 1) & (table.size() - 1);
            if (table[at] == none) {
                table[at] = index;
                number[index] = uint32_t(out.positions.size());
                append_vertex(out, p, index);
            }
            number[index] = number[table[at]];
        }
        index = number[index];
    }
    out.indices = std::move(p.indices);
    out.material = p.material;
    p = std::move(out);
}

void smooth_normals(Primitive& p, float crease) {
    const size_t corners = p.indices.size();
    // Vertices at one place, whatever else distinguishes them, are one point.
    std::vector<uint32_t> order(p.positions.size()), point(p.positions.size());
    std::iota(order.begin(), order.end(), 0u);
    const auto before = [&](uint32_t a, uint32_t b) {
        const glm::vec3 &u = p.positions[a], &v = p.positions[b];
        return u.x != v.x ? u.x < v.x : u.y != v.y ? u.y < v.y : u.z < v.z;
    };
    std::ranges::sort(order, before);
    for (size_t i = 0; i < order.size(); ++i)
        point[order[i]] = i && p.positions[order[i - 1]] == p.positions[order[i]] ? point[order[i - 1]] : order[i];

    std::vector<glm::dvec3> faces(corners / 3);
    for (size_t t = 0; t < faces.size(); ++t)
        faces[t] = unit(face_normal(p.positions[p.indices[3 * t]], p.positions[p.indices[3 * t + 1]], p.positions[p.indices[3 * t + 2]]));

    // Corners that share a normal form a set: those at both ends of each smooth edge are put together.
    std::vector<uint32_t> set(corners);
    std::iota(set.begin(), set.end(), 0u);
    const auto root = [&](uint32_t c) {
        while (set[c] != c) c = set[c] = set[set[c]];
        return c;
    };
    const auto unite = [&](uint32_t a, uint32_t b) {
        a = root(a), b = root(b);
        set[std::max(a, b)] = std::min(a, b);
    };
    struct Edge {
        uint64_t ends;    // its two points, the lesser first
        uint32_t corner;  // where it begins in its triangle
    };
    const auto next = [](uint32_t corner) { return corner % 3 == 2 ? corner - 2 : corner + 1; };
    const auto point_of = [&](uint32_t corner) { return point[p.indices[corner]]; };
    std::vector<Edge> edges(corners);
    for (uint32_t c = 0; c < corners; ++c) {
        const uint32_t a = point_of(c), b = point_of(next(c));
        edges[c] = {uint64_t(std::min(a, b)) << 32 | std::max(a, b), c};
    }
    std::ranges::sort(edges, [](const Edge& a, const Edge& b) { return a.ends != b.ends ? a.ends < b.ends : a.corner < b.corner; });
    const double least = std::cos(glm::radians(double(crease)));
    for (size_t i = 1; i < edges.size(); ++i) {
        if (edges[i].ends != edges[i - 1].ends) continue;
        const uint32_t a = edges[i - 1].corner, b = edges[i].corner;
        if (glm::dot(faces[a / 3], faces[b / 3]) < least) continue;
        const bool opposite = point_of(a) != point_of(b);  // the usual: neighbours run along their edge in opposite ways
        unite(a, opposite ? next(b) : b);
        unite(next(a), opposite ? b : next(b));
    }

    std::vector<glm::dvec3> sums(corners);  // one a set, at its root; faces count by their angle there
    for (uint32_t c = 0; c < corners; ++c) {
        const glm::dvec3 here(p.positions[p.indices[c]]);
        const glm::dvec3 u = unit(glm::dvec3(p.positions[p.indices[next(c)]]) - here);
        const glm::dvec3 v = unit(glm::dvec3(p.positions[p.indices[next(next(c))]]) - here);
        sums[root(c)] += faces[c / 3] * std::acos(std::clamp(glm::dot(u, v), -1.0, 1.0));
    }
    Primitive out;
    out.material = p.material;
    std::unordered_map<uint64_t, uint32_t> made;  // vertex and set to new vertex
    for (uint32_t c = 0; c < corners; ++c) {
        const uint32_t r = root(c);
        const auto [at, fresh] = made.try_emplace(uint64_t(p.indices[c]) << 32 | r, uint32_t(out.positions.size()));
        if (fresh) {
            append_vertex(out, p, p.indices[c]);
            const glm::dvec3 n = unit(sums[r]);
            out.normals.push_back(glm::vec3(n == glm::dvec3(0) ? faces[c / 3] : n));
        }
        out.indices.push_back(at->second);
    }
    p = std::move(out);
}

void tidy(Scene& scene, float crease) {
    Defects defects;
    defects.instances = std::erase_if(scene.instances, [](const Instance& instance) {
        return !finite(instance.to_world) || glm::row(instance.to_world, 3) != glm::vec4(0, 0, 0, 1);
    });
    for (Mesh& mesh : scene.meshes)
        for (Primitive& p : mesh.primitives) {
            drop_triangles(p, defects);
            compact(p);
            repair_normals(p, defects);
            repair_rest(p, defects);
            if (p.normals.empty() && crease > 0) smooth_normals(p, crease);
        }
    drop_unused(scene);
    defects.report(scene);
}

}  // namespace myriad::scenes
