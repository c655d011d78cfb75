#include "scenes/gltf/nodes.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include <glm/gtc/type_ptr.hpp>

#include "scenes/moment.hpp"

namespace myriad::scenes::gltf {
namespace {

// Where a node stands within its parent, at rest.
Node read_node(const Place& place, const tinygltf::Node& node) {
    Node out;
    const auto check = [&](const std::vector<double>& v, size_t n, const char* what) {
        if (!v.empty() && v.size() != n)
            place.fail(std::string(what) + " has " + std::to_string(v.size()) + " numbers, not " + std::to_string(n), "correct it");
        return !v.empty();
    };
    if (check(node.matrix, 16, "matrix")) {
        out.matrix = glm::make_mat4(node.matrix.data());
        return out;
    }
    if (check(node.translation, 3, "translation")) out.rest.translation = glm::make_vec3(node.translation.data());
    if (check(node.rotation, 4, "rotation")) out.rest.rotation = {node.rotation[3], node.rotation[0], node.rotation[1], node.rotation[2]};
    if (check(node.scale, 3, "scale")) out.rest.scale = glm::make_vec3(node.scale.data());
    return out;
}

// Weights of the node's mesh at rest: the node's own, else the mesh's, else 0; empty where it has no morph targets.
std::vector<float> read_weights(const Place& place, const tinygltf::Node& node) {
    if (node.mesh < 0 || size_t(node.mesh) >= place.model.meshes.size()) return {};
    const auto& mesh = place.model.meshes[size_t(node.mesh)];
    const size_t targets = mesh.primitives.empty() ? 0 : mesh.primitives[0].targets.size();
    const std::vector<double>& given = node.weights.empty() ? mesh.weights : node.weights;
    if (targets == 0) return {};
    if (!given.empty() && given.size() != targets)
        place.fail("there are " + std::to_string(given.size()) + " weights, not " + std::to_string(targets), "give one a morph target");
    place.spend(targets, sizeof(float));
    std::vector<float> out(targets, 0.0f);
    for (size_t i = 0; i < given.size(); ++i) {
        out[i] = float(given[i]);
        if (!std::isfinite(out[i])) place.fail("weight " + std::to_string(i) + " is too large", "correct it");
    }
    return out;
}

// Whether anything in the file can move or deform.
bool has_movement(const tinygltf::Model& model) {
    const auto morphs = [](const tinygltf::Primitive& p) { return !p.targets.empty(); };
    return !model.animations.empty() || !model.skins.empty() ||
           std::ranges::any_of(model.meshes, [&](const tinygltf::Mesh& m) { return std::ranges::any_of(m.primitives, morphs); });
}

// What stands in the hierarchy but cannot be used, by what is the matter.
struct LeftOut {
    size_t orthographic = 0, cameras = 0, lights = 0, instances = 0;

    void report(Scene& scene) const {
        warn(scene, orthographic, "orthographic cameras were left out");
        warn(scene, cameras, "cameras were left out, for their nodes are scaled to nothing, not finite or beyond 1e9 m");
        warn(scene, lights, "lights were left out, for their nodes are scaled to nothing, not finite or beyond 1e9 m");
        warn(scene, instances, "instances of a mesh were left out, for their transforms are not finite or beyond 1e9 m");
    }
};

// False where the transform leaves no camera.
bool add_camera(const Place& place, const tinygltf::Node& node, const tinygltf::Camera& in, const glm::dmat4& to_world, Scene& scene) {
    const std::string name = !node.name.empty() ? node.name : in.name;  // one glTF camera may stand at several nodes
    const double yfov = in.perspective.yfov;
    if (!(yfov > 1e-4) || !(yfov < 3.14159)) place.at("camera " + quote(name)).fail("yfov is not between 0 and pi", "correct it");
    Camera camera{.name = name, .yfov = float(yfov)};
    if (!place_camera(camera, to_world)) return false;
    scene.cameras.push_back(camera);
    return true;
}

// False where the transform leaves no light.
bool add_light(const Place& place, const tinygltf::Node& node, const tinygltf::Value& extension, const glm::dmat4& to_world, Scene& scene) {
    const int index = index_in(place.at(lights_extension), extension, "light").value_or(-1);
    if (index < 0 || size_t(index) >= place.model.lights.size()) place.fail("there is no light " + std::to_string(index), "export the file again");
    const auto& in = place.model.lights[size_t(index)];
    Light light;
    light.name = !node.name.empty() ? node.name : in.name;
    const Place here = place.at("light " + quote(light.name));
    if (in.type == "directional") light.type = Light::Type::directional;
    else if (in.type == "spot") light.type = Light::Type::spot;
    else if (in.type != "point") here.fail("its type is " + quote(in.type), "use point, spot or directional");
    if (in.color.size() != 0 && in.color.size() != 3) here.fail("its colour has not three numbers", "correct it");
    for (int c = 0; c < 3; ++c) {
        const double value = (in.color.empty() ? 1 : in.color[size_t(c)]) * in.intensity;
        if (!(value >= 0 && value <= limits::light)) here.fail("its colour times its intensity is not a number from 0 to 1e18", "correct it");
        light.intensity[c] = float(value);
    }
    if (light.type == Light::Type::spot) {
        light.inner_cone = float(in.spot.innerConeAngle);
        light.outer_cone = float(in.spot.outerConeAngle);
        if (!(light.inner_cone >= 0) || !(light.inner_cone <= light.outer_cone) || !(light.outer_cone <= 1.5707964f))
            here.fail("its cone angles are not 0 <= inner <= outer <= pi/2", "correct them");
    }
    if (!place_light(light, to_world)) return false;
    scene.lights.push_back(light);
    return true;
}

// EXT_mesh_gpu_instancing: transforms of the mesh within the node; one attribute that says how many is enough.
std::vector<glm::dmat4> instance_transforms(const Place& outer, const tinygltf::Value& extension) {
    const Place place = outer.at(instancing_extension);
    // An object without members is none in tinygltf: no attributes, and so one instance.
    const tinygltf::Value none, &attributes = extension.Has("attributes") ? extension.Get("attributes") : none;
    if (extension.Has("attributes") && !attributes.IsObject()) place.fail("attributes are not an object", "export the file again");
    std::optional<size_t> count;
    std::vector<glm::vec3> translations, scales;
    std::vector<glm::vec4> rotations;
    for (const std::string& name : attributes.Keys()) {
        const Place here = place.at(quote(name));
        const int accessor = index_in(place, attributes, name.c_str()).value_or(-1);
        if (name == "TRANSLATION") translations = read_vectors<3>(here, accessor);
        else if (name == "ROTATION") rotations = read_vectors<4>(here, accessor);
        else if (name == "SCALE") scales = read_vectors<3>(here, accessor);
        const size_t size = FloatReader(here, accessor, 0).count();
        if (count.value_or(size) != size)
            here.fail("there are " + std::to_string(size) + " but " + std::to_string(*count) + " of another attribute", "export the file again");
        count = size;
    }
    place.spend(count.value_or(1), sizeof(glm::dmat4) + sizeof(Instance));
    std::vector<glm::dmat4> out;
    out.reserve(count.value_or(1));
    for (size_t i = 0; i < count.value_or(1); ++i) {
        const glm::dvec4 r = rotations.empty() ? glm::dvec4(0, 0, 0, 1) : glm::dvec4(rotations[i]);
        out.push_back(Transform{translations.empty() ? glm::dvec3(0) : glm::dvec3(translations[i]), glm::dquat(r.w, r.x, r.y, r.z),
                                scales.empty() ? glm::dvec3(1) : glm::dvec3(scales[i])}.matrix());
    }
    return out;
}

// Walks the hierarchy with a stack of its own: neither a deep chain nor a cycle can hurt. Transforms are multiplied in double.
class Walk {
public:
    Walk(const Place& place, Scene& scene) : place_(place), scene_(scene), seen_(place.model.nodes.size(), false) {
        if (has_movement(place.model)) hierarchy_.of_file.assign(place.model.nodes.size(), none);
    }

    Hierarchy run(const std::vector<int>& roots) {
        push(place_, roots, {glm::dmat4(1), none});
        while (!stack_.empty()) {
            const auto [index, parent] = stack_.back();
            stack_.pop_back();
            visit(index, parent);
        }
        left_out_.report(scene_);
        return std::move(hierarchy_);
    }

private:
    // A node that was visited.
    struct Visited {
        glm::dmat4 to_world;
        uint32_t node;  // in scene.nodes, or none
    };

    void push(const Place& place, const std::vector<int>& nodes, const Visited& parent) {
        for (auto it = nodes.rbegin(); it != nodes.rend(); ++it) {  // reversed, so that they are visited in file order
            if (*it < 0 || size_t(*it) >= seen_.size()) place.fail("there is no node " + std::to_string(*it), "export the file again");
            if (seen_[size_t(*it)])
                place.fail("node " + std::to_string(*it) + " is in a cycle or has two parents", "make the hierarchy a tree");
            seen_[size_t(*it)] = true;
            stack_.emplace_back(*it, parent);
        }
    }

    uint32_t keep(Node node, uint32_t parent) {
        node.parent = parent;
        scene_.nodes.push_back(std::move(node));
        return uint32_t(scene_.nodes.size() - 1);
    }

    void visit(int index, const Visited& parent) {
        const auto& node = place_.model.nodes[size_t(index)];
        const Place place = place_.at("node " + std::to_string(index) + " " + quote(node.name));
        Node read = read_node(place, node);
        Visited here{parent.to_world * (read.matrix ? *read.matrix : read.rest.matrix()), none};
        if (!hierarchy_.of_file.empty()) {
            read.name = node.name;
            read.weights = read_weights(place, node);
            here.node = hierarchy_.of_file[size_t(index)] = keep(std::move(read), parent.node);
        }
        const size_t cameras = scene_.cameras.size(), lights = scene_.lights.size();
        if (node.mesh >= 0) add_instances(place, node, here);
        if (node.camera >= 0) add_camera(place, node, here.to_world);
        if (const auto* light = extension(node, lights_extension)) left_out_.lights += !add_light(place, node, *light, here.to_world, scene_);
        for (size_t i = cameras; i < scene_.cameras.size(); ++i) scene_.cameras[i].node = here.node;
        for (size_t i = lights; i < scene_.lights.size(); ++i) scene_.lights[i].node = here.node;
        push(place, node.children, here);
    }

    void add_instances(const Place& place, const tinygltf::Node& node, const Visited& at) {
        if (size_t(node.mesh) >= place.model.meshes.size()) place.fail("there is no mesh " + std::to_string(node.mesh), "export the file again");
        const uint32_t mesh = uint32_t(node.mesh);
        const auto* instancing = extension(node, instancing_extension);
        const auto add = [&](const glm::dmat4& m, uint32_t number, uint32_t skin) {
            if (sane(m)) scene_.instances.push_back({mesh, glm::mat4(m), number, skin});
            else ++left_out_.instances;
        };
        const uint32_t skin = node.skin >= 0 && at.node != none ? uint32_t(node.skin) : none;
        if (!instancing) return add(at.to_world, at.node, skin);
        // A node each below the one that has them, and where a mesh stands its weights are.
        const std::vector<float> weights = at.node != none ? std::exchange(scene_.nodes[at.node].weights, {}) : std::vector<float>();
        for (const glm::dmat4& within : instance_transforms(place, *instancing)) {
            uint32_t number = at.node;
            if (number != none) {
                place.spend(1, sizeof(Node) + weights.size() * sizeof(float));
                number = keep({.matrix = within, .weights = weights}, at.node);
            }
            add(at.to_world * within, number, none);
        }
    }

    void add_camera(const Place& place, const tinygltf::Node& node, const glm::dmat4& to_world) {
        const auto& cameras = place.model.cameras;
        if (size_t(node.camera) >= cameras.size()) place.fail("there is no camera " + std::to_string(node.camera), "export the file again");
        const tinygltf::Camera& camera = cameras[size_t(node.camera)];
        if (camera.type != "perspective") ++left_out_.orthographic;
        else left_out_.cameras += !gltf::add_camera(place, node, camera, to_world, scene_);
    }

    const Place& place_;
    Scene& scene_;
    std::vector<bool> seen_;
    std::vector<std::pair<int, Visited>> stack_;
    Hierarchy hierarchy_;
    LeftOut left_out_;
};

// The roots of a file without scenes: every node that is nobody's child.
std::vector<int> roots_without_scene(const Place& place) {
    const auto& nodes = place.model.nodes;
    std::vector<bool> child(nodes.size(), false);
    for (const auto& node : nodes)
        for (int c : node.children)
            if (c >= 0 && size_t(c) < child.size()) child[size_t(c)] = true;
    std::vector<int> roots;
    for (size_t i = 0; i < child.size(); ++i)
        if (!child[i]) roots.push_back(int(i));
    if (roots.empty() && !nodes.empty()) place.fail("the nodes form a cycle", "make the hierarchy a tree");
    return roots;
}

}  // namespace

int pick_scene(const Place& place, const std::string& choice) {
    const auto& scenes = place.model.scenes;
    if (choice.empty()) {
        const int which = scenes.empty() ? -1 : std::max(place.model.defaultScene, 0);
        if (which >= 0 && size_t(which) >= scenes.size()) place.fail("there is no scene " + std::to_string(which), "export the file again");
        return which;
    }
    for (size_t i = 0; i < scenes.size(); ++i)
        if (scenes[i].name == choice) return int(i);
    const bool digits = choice.size() <= 9 && std::all_of(choice.begin(), choice.end(), [](char c) { return c >= '0' && c <= '9'; });
    if (digits && std::stoul(choice) < scenes.size()) return int(std::stoul(choice));
    std::string known;
    for (size_t i = 0; i < std::min<size_t>(scenes.size(), 100); ++i) known += (i ? ", " : "") + std::to_string(i) + " " + quote(scenes[i].name);
    place.fail("there is no scene " + quote(choice), scenes.empty() ? "the file has none, leave the choice out" : "choose one of " + known);
}

Hierarchy read_nodes(const Place& place, int which, Scene& scene) {
    return Walk(place, scene).run(which < 0 ? roots_without_scene(place) : place.model.scenes[size_t(which)].nodes);
}

void read_background(const Place& place, int which, Scene& scene) {
    if (which < 0) return;
    const tinygltf::Scene& in = place.model.scenes[size_t(which)];
    if (!in.extras.Has(background_extra)) return;
    const tinygltf::Value& radiance = in.extras.Get(background_extra);
    bool good = radiance.IsArray() && radiance.ArrayLen() == 3;
    for (int c = 0; c < 3 && good; ++c) {
        const double value = radiance.Get(c).IsNumber() ? radiance.Get(c).GetNumberAsDouble() : -1;
        good = value >= 0 && value <= limits::light;
        scene.background[c] = float(value);
    }
    if (!good) place.at("scene " + std::to_string(which)).fail(std::string(background_extra) + " is not three numbers from 0 to 1e18", "correct it");
}

}  // namespace myriad::scenes::gltf
