#include "scenes/gltf.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <new>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/quaternion.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "engine/error.hpp"
#include "scenes/gltf/accessor.hpp"
#include "scenes/gltf/container.hpp"
#include "scenes/gltf/material.hpp"
#include "scenes/gltf/mesh.hpp"

namespace myriad::scenes {
namespace {

using gltf::Place;

constexpr const char* lights_extension = "KHR_lights_punctual";
constexpr std::array supported_extensions = {"KHR_draco_mesh_compression", lights_extension, "KHR_materials_emissive_strength",
                                             "KHR_materials_unlit", "KHR_mesh_quantization", "KHR_texture_transform"};

bool supported(const std::string& extension) {
    return std::find(supported_extensions.begin(), supported_extensions.end(), extension) != supported_extensions.end();
}

void check_extensions(const Place& place, Scene& scene) {
    for (const auto& name : place.model.extensionsRequired)
        if (!supported(name)) place.fail("the file requires the extension " + name + ", which Myriad does not have", "export without it");
    std::string ignored;
    for (const auto& name : place.model.extensionsUsed)
        if (!supported(name)) ignored += (ignored.empty() ? "" : ", ") + name;
    if (!ignored.empty()) scene.warnings.push_back("ignored extensions: " + ignored + ".");
}

glm::mat4 local_transform(const Place& place, const tinygltf::Node& node) {
    const auto check = [&](const std::vector<double>& v, size_t n, const char* what) {
        if (!v.empty() && v.size() != n)
            place.fail(std::string(what) + " has " + std::to_string(v.size()) + " numbers, not " + std::to_string(n), "correct it");
        return !v.empty();
    };
    glm::dmat4 m(1);
    if (check(node.matrix, 16, "matrix")) return glm::mat4(glm::make_mat4(node.matrix.data()));
    if (check(node.translation, 3, "translation")) m = glm::translate(m, glm::make_vec3(node.translation.data()));
    if (check(node.rotation, 4, "rotation")) {
        const auto& r = node.rotation;
        const glm::dquat q(r[3], r[0], r[1], r[2]);
        if (glm::length(q) > 0) m *= glm::mat4_cast(glm::normalize(q));
    }
    if (check(node.scale, 3, "scale")) m = glm::scale(m, glm::make_vec3(node.scale.data()));
    return glm::mat4(m);
}

bool finite(const glm::mat4& m) {
    return std::all_of(glm::value_ptr(m), glm::value_ptr(m) + 16, [](float x) { return std::isfinite(x); });
}

void add_camera(const Place& place, const tinygltf::Node& node, const glm::mat4& to_world, Scene& scene) {
    if (size_t(node.camera) >= place.model.cameras.size())
        place.fail("there is no camera " + std::to_string(node.camera), "export the file again");
    const auto& in = place.model.cameras[size_t(node.camera)];
    const std::string name = !node.name.empty() ? node.name : in.name;  // one glTF camera may stand at several nodes
    const float yfov = float(in.perspective.yfov);
    if (in.type != "perspective") {
        scene.warnings.push_back("camera \"" + name + "\" is not a perspective camera and was left out.");
        return;
    }
    if (!(yfov > 0) || !(yfov < 3.14159f)) place.fail("yfov of camera \"" + name + "\" is not between 0 and pi", "correct it");
    // A camera has a place and a direction; scale in the hierarchy above it does not concern it.
    Camera camera{name, glm::mat4(1), yfov};
    for (int c = 0; c < 3; ++c) camera.to_world[c] = glm::vec4(glm::normalize(glm::vec3(to_world[c])), 0);
    camera.to_world[3] = to_world[3];
    if (!finite(camera.to_world)) place.fail("the transform of camera \"" + name + "\" is singular", "correct its scale");
    scene.cameras.push_back(camera);
}

void add_light(const Place& place, const tinygltf::Node& node, const tinygltf::Value& extension, const glm::mat4& to_world, Scene& scene) {
    const int index = extension.Has("light") && extension.Get("light").IsInt() ? extension.Get("light").Get<int>() : -1;
    if (index < 0 || size_t(index) >= place.model.lights.size()) place.fail("there is no light " + std::to_string(index), "export the file again");
    const auto& in = place.model.lights[size_t(index)];
    Light light;
    light.name = !node.name.empty() ? node.name : in.name;
    const Place here = place.at("light \"" + light.name + "\"");
    if (in.type == "directional") light.type = Light::Type::directional;
    else if (in.type == "spot") light.type = Light::Type::spot;
    else if (in.type != "point") here.fail("its type is \"" + in.type + "\"", "use point, spot or directional");
    light.position = glm::vec3(to_world[3]);
    light.direction = glm::normalize(-glm::vec3(to_world[2]));
    if (in.color.size() != 0 && in.color.size() != 3) here.fail("its colour has not three numbers", "correct it");
    for (int c = 0; c < 3; ++c) light.intensity[c] = float((in.color.empty() ? 1 : in.color[size_t(c)]) * in.intensity);
    if (light.type == Light::Type::spot) {
        light.inner_cone = float(in.spot.innerConeAngle);
        light.outer_cone = float(in.spot.outerConeAngle);
        if (!(light.inner_cone >= 0) || !(light.inner_cone <= light.outer_cone) || !(light.outer_cone <= 1.5707964f))
            here.fail("its cone angles are not 0 <= inner <= outer <= pi/2", "correct them");
    }
    const float sum = glm::dot(light.direction, glm::vec3(1)) + glm::dot(light.position, glm::vec3(1)) + glm::dot(light.intensity, glm::vec3(1));
    if (!std::isfinite(sum) || glm::any(glm::lessThan(light.intensity, glm::vec3(0))))
        here.fail("its intensity is negative or its transform is singular", "correct it");
    scene.lights.push_back(light);
}

// Walks the hierarchy with a stack of its own: neither a deep chain nor a cycle can hurt.
class Walk {
public:
    Walk(const Place& place, Scene& scene) : place_(place), scene_(scene), seen_(place.model.nodes.size(), false) {}

    void run() {
        const auto& model = place_.model;
        std::vector<int> roots;
        if (!model.scenes.empty()) {
            const int which = std::max(model.defaultScene, 0);
            if (size_t(which) >= model.scenes.size()) place_.fail("there is no scene " + std::to_string(which), "export the file again");
            roots = model.scenes[size_t(which)].nodes;
        } else {  // a file without scenes: every node that is nobody's child
            std::vector<bool> child(model.nodes.size(), false);
            for (const auto& node : model.nodes)
                for (int c : node.children)
                    if (c >= 0 && size_t(c) < child.size()) child[size_t(c)] = true;
            for (size_t i = 0; i < child.size(); ++i)
                if (!child[i]) roots.push_back(int(i));
            if (roots.empty() && !model.nodes.empty()) place_.fail("the nodes form a cycle", "make the hierarchy a tree");
        }
        push(place_, roots, glm::mat4(1));
        while (!stack_.empty()) {
            const auto [index, to_world] = stack_.back();
            stack_.pop_back();
            visit(index, to_world);
        }
    }

private:
    void push(const Place& place, const std::vector<int>& nodes, const glm::mat4& to_world) {
        for (auto it = nodes.rbegin(); it != nodes.rend(); ++it) {  // reversed, so that they are visited in file order
            if (*it < 0 || size_t(*it) >= seen_.size()) place.fail("there is no node " + std::to_string(*it), "export the file again");
            if (seen_[size_t(*it)])
                place.fail("node " + std::to_string(*it) + " is in a cycle or has two parents", "make the hierarchy a tree");
            seen_[size_t(*it)] = true;
            stack_.emplace_back(*it, to_world);
        }
    }

    void visit(int index, const glm::mat4& parent) {
        const auto& node = place_.model.nodes[size_t(index)];
        const Place place = place_.at("node " + std::to_string(index) + " \"" + node.name + "\"");
        const glm::mat4 to_world = parent * local_transform(place, node);
        if (node.mesh >= 0) {
            if (size_t(node.mesh) >= scene_.meshes.size()) place.fail("there is no mesh " + std::to_string(node.mesh), "export the file again");
            scene_.instances.push_back({uint32_t(node.mesh), to_world});
        }
        if (node.camera >= 0) add_camera(place, node, to_world, scene_);
        if (const auto light = node.extensions.find(lights_extension); light != node.extensions.end())
            add_light(place, node, light->second, to_world, scene_);
        push(place, node.children, to_world);
    }

    const Place& place_;
    Scene& scene_;
    std::vector<bool> seen_;
    std::vector<std::pair<int, glm::mat4>> stack_;
};

}  // namespace

Scene load_gltf(const std::string& path) try {
    std::string warnings;
    gltf::Document document = gltf::read_document(path, warnings);
    const tinygltf::Model& model = document.model;
    Scene scene;
    scene.name = path;
    const Place place{model, path, "", &document};
    check_extensions(place, scene);
    gltf::read_materials(place, scene);
    gltf::read_meshes(place, scene);
    Walk(place, scene).run();
    if (!model.skins.empty()) scene.warnings.push_back("skins are ignored: meshes are shown in their rest pose.");
    if (!model.animations.empty()) scene.warnings.push_back("animations are ignored.");
    return scene;
} catch (const std::bad_alloc&) {
    throw OutOfMemory(path + ": the scene does not fit in memory; make it smaller.");
}

}  // namespace myriad::scenes
