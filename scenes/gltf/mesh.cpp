#include "scenes/gltf/mesh.hpp"

#include <map>
#include <utility>

#include "scenes/attributes.hpp"
#include "scenes/gltf/draco.hpp"
#include "scenes/gltf/skin.hpp"

namespace myriad::scenes::gltf {
namespace {

// Strips and fans become triangle lists; in a strip every second triangle turns around. Triangles that name a vertex
// twice, which join the parts of a strip, cover nothing and are left out.
std::vector<uint32_t> as_list(const std::vector<uint32_t>& in, int mode) {
    if (mode == TINYGLTF_MODE_TRIANGLES) return in;
    std::vector<uint32_t> out;
    for (size_t i = 2; i < in.size(); ++i) {
        const bool fan = mode == TINYGLTF_MODE_TRIANGLE_FAN, odd = i % 2;
        const uint32_t a = fan ? in[0] : in[i - 2], b = in[i - 1], c = in[i];
        if (a == b || b == c || c == a) continue;
        if (fan) out.insert(out.end(), {b, c, a});  // the order that the specification gives
        else out.insert(out.end(), {a, odd ? c : b, odd ? b : c});
    }
    return out;
}

// Keeps only the vertices that are used: exporters let many primitives share one big vertex buffer.
void compact(Primitive& p) {
    if (p.positions.size() <= p.indices.size()) return;
    std::vector<uint32_t> number(p.positions.size(), none), used;
    for (uint32_t& i : p.indices) {
        if (number[i] == none) {
            number[i] = uint32_t(used.size());
            used.push_back(i);
        }
        i = number[i];
    }
    Primitive out;
    each_attribute(out, std::as_const(p), [&](auto& to, const auto& from) {
        if (from.empty()) return;
        to.reserve(used.size());
        for (uint32_t i : used) to.push_back(from[i]);
    });
    out.material = p.material;
    out.indices = std::move(p.indices);
    p = std::move(out);
}

void read_attributes(const Place& place, const tinygltf::Primitive& in, Primitive& out) {
    for (const auto& [name, accessor] : in.attributes) {
        const Place here = place.at(name);
        if (name == "POSITION") out.positions = read_vectors<3>(here, accessor);
        else if (name == "NORMAL") out.normals = read_vectors<3>(here, accessor);
        else if (name == "TANGENT") out.tangents = read_vectors<4>(here, accessor);
        else if (name == "TEXCOORD_0") out.texcoords = read_vectors<2>(here, accessor);
        else if (name == "TEXCOORD_1") out.texcoords1 = read_vectors<2>(here, accessor);
        else if (name == "COLOR_0") out.colors = read_colors(here, accessor);
    }
}

std::vector<uint32_t> read_list(const Place& place, const tinygltf::Primitive& in, size_t vertices) {
    std::vector<uint32_t> indices;
    if (in.indices >= 0) {
        indices = read_indices(place.at("indices"), in.indices);
    } else {
        indices.resize(vertices);
        for (size_t i = 0; i < indices.size(); ++i) indices[i] = uint32_t(i);
    }
    return as_list(indices, in.mode);
}

// What was wrong with primitives, but harmless.
struct Defects {
    JointDefects joints;
    size_t deltas = 0;

    void report(Scene& scene) const {
        warn(scene, joints.sums, "vertices have joint weights that do not sum to 1; they were made to");
        warn(scene, joints.sets, "primitives have more than eight joints a vertex; the others were left out");
        warn(scene, deltas, "displacements of morph targets are not finite or beyond 1e9 m and were set to 0");
    }
};

std::vector<glm::vec3> read_deltas(const Place& place, const std::map<std::string, int>& in, const char* name, size_t vertices, Defects& defects) {
    const auto it = in.find(name);
    if (it == in.end()) return {};
    std::vector<glm::vec3> out = read_vectors<3>(place.at(name), it->second);
    if (out.size() != vertices)
        place.fail("there are " + std::to_string(out.size()) + " of " + name + " but " + std::to_string(vertices) + " vertices", "export the file again");
    for (glm::vec3& d : out)
        if (!glm::all(glm::lessThanEqual(glm::abs(d), glm::vec3(farthest)))) d = glm::vec3(0), ++defects.deltas;
    return out;
}

// What of a primitive is read: joints only where some instance has a skin.
Primitive read_primitive(const Place& place, const tinygltf::Primitive& in, bool skinned, Defects& defects) {
    Primitive out;
    JointSets joints;
    if (const auto* draco = extension(in, draco_extension)) {
        out = decode_draco(place, in, *draco, skinned ? &joints : nullptr);
    } else {
        read_attributes(place, in, out);
        if (skinned) joints = read_joint_sets(place, in);
        out.indices = read_list(place, in, out.positions.size());
    }
    if (out.positions.empty()) place.fail("POSITION is missing or empty", "export the mesh with positions");
    const std::pair<const char*, size_t> others[] = {{"NORMAL", out.normals.size()}, {"TANGENT", out.tangents.size()},
        {"TEXCOORD_0", out.texcoords.size()}, {"TEXCOORD_1", out.texcoords1.size()}, {"COLOR_0", out.colors.size()}};
    for (const auto& [name, size] : others)
        if (size && size != out.positions.size())
            place.fail("there are " + std::to_string(size) + " of " + name + " but " + std::to_string(out.positions.size()) + " of POSITION",
                       "export the file again");
    if (out.normals.empty()) out.tangents.clear();  // glTF 2.0, 3.7.2.1: they mean nothing beside computed normals
    if (out.indices.size() % 3) place.fail("the number of indices is not a multiple of 3", "export the mesh as triangles");
    for (uint32_t i : out.indices)
        if (i >= out.positions.size())
            place.fail("index " + std::to_string(i) + " is out of range, there are " + std::to_string(out.positions.size()) + " vertices",
                       "export the file again");
    if (in.material >= 0 && size_t(in.material) >= place.model.materials.size())
        place.fail("there is no material " + std::to_string(in.material), "export the file again");
    out.material = in.material >= 0 ? uint32_t(in.material) : none;
    if (skinned) {
        defects.joints.sets += in.attributes.contains("JOINTS_2");
        set_joints(place, joints, out, defects.joints);
    }
    for (size_t k = 0; k < in.targets.size(); ++k) {
        const Place here = place.at("target " + std::to_string(k));
        out.targets.push_back({read_deltas(here, in.targets[k], "POSITION", out.positions.size(), defects),
                               out.normals.empty() ? std::vector<glm::vec3>() : read_deltas(here, in.targets[k], "NORMAL", out.positions.size(), defects)});
    }
    compact(out);
    return out;
}

}  // namespace

void read_meshes(const Place& place, Scene& scene) {
    size_t lines = 0;
    Defects defects;
    scene.meshes.resize(place.model.meshes.size());
    std::vector<bool> shown(scene.meshes.size(), false), skinned(shown);
    for (const Instance& instance : scene.instances) {
        shown[instance.mesh] = true;
        if (instance.skin != none) skinned[instance.mesh] = true;
    }
    for (size_t m = 0; m < scene.meshes.size(); ++m) {
        const auto& in = place.model.meshes[m];
        const std::string name = "mesh " + std::to_string(m) + " " + quote(in.name);
        Mesh& mesh = scene.meshes[m];
        mesh.name = in.name;
        for (size_t p = 0; shown[m] && p < in.primitives.size(); ++p) {
            const int mode = in.primitives[p].mode;
            if (mode < TINYGLTF_MODE_TRIANGLES || mode > TINYGLTF_MODE_TRIANGLE_FAN) {
                ++lines;
                continue;
            }
            const Place here = place.at(name + " primitive " + std::to_string(p));
            if (in.primitives[p].targets.size() != in.primitives[0].targets.size())
                here.fail("it has " + std::to_string(in.primitives[p].targets.size()) + " morph targets, and the first has " +
                              std::to_string(in.primitives[0].targets.size()), "export the file again");
            mesh.primitives.push_back(read_primitive(here, in.primitives[p], skinned[m], defects));
        }
    }
    warn(scene, lines, "primitives made of points or lines were left out");
    defects.report(scene);
}

}  // namespace myriad::scenes::gltf
