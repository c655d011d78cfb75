#include "scenes/gltf/skin.hpp"

#include <algorithm>
#include <cmath>

#include <glm/gtc/matrix_access.hpp>

#include "scenes/moment.hpp"

namespace myriad::scenes::gltf {
namespace {

// Weights that are stored in a byte sum to 1 within half of 1/255 each; what is farther off was not meant to.
constexpr double rounding(int weights) { return weights * 0.5 / 255 + 1e-6; }

// Makes the weights of each vertex sum to 1, within what a float can say, and those that count nothing exactly 0.
void normalise(Primitive& p, JointDefects& defects) {
    const double off = rounding(p.joint_weights[1].empty() ? 4 : 8);
    for (size_t i = 0; i < p.positions.size(); ++i) {
        double sum = 0;
        bool bad = false;
        for (auto& set : p.joint_weights)
            for (int k = 0; k < 4 && !set.empty(); ++k) {
                float& w = set[i][k];
                if (!(w >= 0) || !std::isfinite(w)) w = 0, bad = true;
                sum += double(w);
            }
        defects.sums += bad || std::abs(sum - 1) > off;
        if (!(sum > 0)) {
            p.joint_weights[0][i] = glm::vec4(1, 0, 0, 0);  // with its first joint, as others do
        } else if (std::abs(sum - 1) > 1e-7) {  // once they were made to, rounding leaves less
            for (auto& set : p.joint_weights)
                if (!set.empty()) set[i] = glm::vec4(glm::dvec4(set[i]) / sum);
        }
        for (int set = 0; set < 2; ++set)  // what has no weight may say any joint, and does
            for (int k = 0; k < 4 && !p.joints[set].empty(); ++k)
                if (!(p.joint_weights[set][i][k] > 0)) p.joints[set][i][k] = 0;
    }
}

std::vector<glm::mat4> read_inverse_bind(const Place& outer, int accessor, size_t joints, size_t& singular) {
    if (accessor < 0) return std::vector<glm::mat4>(joints, glm::mat4(1));
    const Place place = outer.at("inverseBindMatrices");
    const FloatReader reader(place, accessor, 16);
    if (reader.count() < joints)
        place.fail("there are " + std::to_string(reader.count()) + " but " + std::to_string(joints) + " joints", "export the file again");
    std::vector<glm::mat4> out(reader.count());
    if (!out.empty()) reader.read(&out[0][0].x);
    out.resize(joints);
    for (size_t k = 0; k < joints; ++k) {
        if (!sane(glm::dmat4(out[k]))) place.fail("matrix " + std::to_string(k) + " is not finite or beyond 1e9 m", "export the file again");
        out[k] = glm::row(out[k], 3, glm::vec4(0, 0, 0, 1));  // as the specification has it
        singular += std::abs(glm::determinant(glm::dmat3(out[k]))) < 1e-30;
    }
    return out;
}

Skin read_skin(const Place& place, const Hierarchy& hierarchy, const tinygltf::Skin& in, size_t& singular) {
    Skin out;
    out.name = in.name;
    if (in.joints.empty()) place.fail("it has no joints", "export the file again");
    place.spend(in.joints.size(), sizeof(uint32_t) + sizeof(glm::mat4));
    for (const int joint : in.joints) {
        if (joint < 0 || size_t(joint) >= place.model.nodes.size()) place.fail("there is no node " + std::to_string(joint), "export the file again");
        const uint32_t node = hierarchy.of_file[size_t(joint)];
        if (node == none) place.fail("its joint, node " + std::to_string(joint) + ", is not in the scene", "export the skeleton with the mesh");
        out.joints.push_back(node);
    }
    out.inverse_bind = read_inverse_bind(place, in.inverseBindMatrices, out.joints.size(), singular);
    return out;
}

// The highest joint that a mesh refers to, plus one; 0 where it has no joints.
uint32_t joints_of(const Mesh& mesh) {
    uint32_t count = 0;
    for (const Primitive& p : mesh.primitives)
        for (const auto& set : p.joints)
            for (const glm::u16vec4& j : set) count = std::max({count, j.x + 1u, j.y + 1u, j.z + 1u, j.w + 1u});
    return count;
}

}  // namespace

JointSets read_joint_sets(const Place& place, const tinygltf::Primitive& in) {
    JointSets out;
    for (size_t set = 0; set < out.size(); ++set)
        for (const auto& [prefix, list] : {std::pair("JOINTS_", &out[set].joints), {"WEIGHTS_", &out[set].weights}}) {
            const std::string name = prefix + std::to_string(set);
            const auto it = in.attributes.find(name);
            if (it == in.attributes.end()) continue;
            FloatReader reader(place.at(name), it->second, 4);
            if (list == &out[set].weights) reader.normalize();  // integers mean nothing else
            list->resize(reader.count());
            if (reader.count()) reader.read(&(*list)[0].x);
        }
    return out;
}

void set_joints(const Place& place, const JointSets& sets, Primitive& out, JointDefects& defects) {
    for (size_t set = 0; set < sets.size(); ++set) {
        const auto& [joints, weights] = sets[set];
        if (joints.empty() && weights.empty()) break;
        if (joints.size() != out.positions.size() || weights.size() != out.positions.size())
            place.fail("there are " + std::to_string(joints.size()) + " of JOINTS_" + std::to_string(set) + " and " + std::to_string(weights.size()) +
                           " of WEIGHTS_" + std::to_string(set) + " but " + std::to_string(out.positions.size()) + " of POSITION", "export the file again");
        out.joint_weights[set] = weights;
        out.joints[set].reserve(joints.size());
        for (const glm::vec4& j : joints) {
            for (int k = 0; k < 4; ++k)
                if (!(j[k] >= 0 && j[k] <= 65535 && j[k] == std::floor(j[k])))
                    place.fail("JOINTS_" + std::to_string(set) + " has an element that is no joint's index", "export the file again");
            out.joints[set].emplace_back(j);
        }
    }
    if (!out.joints[0].empty()) normalise(out, defects);
}

void read_skins(const Place& place, const Hierarchy& hierarchy, Scene& scene) {
    std::vector<uint32_t> number(place.model.skins.size(), none), joints(scene.meshes.size(), none);
    size_t singular = 0, boneless = 0;
    for (Instance& instance : scene.instances) {
        if (instance.skin == none) continue;
        if (instance.skin >= number.size()) place.fail("there is no skin " + std::to_string(instance.skin), "export the file again");
        const auto& in = place.model.skins[instance.skin];
        const Place here = place.at("skin " + std::to_string(instance.skin) + " " + quote(in.name));
        if (joints[instance.mesh] == none) joints[instance.mesh] = joints_of(scene.meshes[instance.mesh]);
        if (joints[instance.mesh] == 0) {
            ++boneless, instance.skin = none;
            continue;
        }
        uint32_t& skin = number[instance.skin];
        if (skin == none) skin = uint32_t(scene.skins.size()), scene.skins.push_back(read_skin(here, hierarchy, in, singular));
        if (joints[instance.mesh] > scene.skins[skin].joints.size())
            here.fail("mesh " + std::to_string(instance.mesh) + " refers to joint " + std::to_string(joints[instance.mesh] - 1) + ", and there are " +
                          std::to_string(scene.skins[skin].joints.size()), "export the file again");
        instance.skin = skin;
    }
    warn(scene, boneless, "instances with a skin but without joints stand at their nodes");
    warn(scene, singular, "inverse bind matrices are singular: what they move is flat");
}

}  // namespace myriad::scenes::gltf
