// For tests: whether two scenes are the same, and if not, where.
#pragma once

#include <cmath>
#include <string>

#include "scenes/scene.hpp"

namespace myriad::scenes {

// "" where the scenes are the same but for their names and warnings: everything to the bit, only what passes through a
// rotation (cameras, directions of lights) within rounding. Otherwise what differs first.
inline std::string difference(const Scene& a, const Scene& b) {
    const auto near = [](const glm::vec3& x, const glm::vec3& y) { return glm::length(x - y) <= 2e-6f * (1 + glm::length(x)); };
    const auto same_use = [](const TextureUse& x, const TextureUse& y) {
        bool same = x.texture == y.texture && x.set == y.set;
        for (int c = 0; c < 3; ++c) same &= glm::length(x.transform[c] - y.transform[c]) <= 1e-6f * (1 + glm::length(x.transform[c]));
        return same;
    };
    const auto count = [](const char* what, size_t i) { return std::string(what) + " " + std::to_string(i); };
    for (const auto& [what, x, y] : {std::tuple("meshes", a.meshes.size(), b.meshes.size()), {"instances", a.instances.size(), b.instances.size()},
                                     {"materials", a.materials.size(), b.materials.size()}, {"textures", a.textures.size(), b.textures.size()},
                                     {"lights", a.lights.size(), b.lights.size()}, {"cameras", a.cameras.size(), b.cameras.size()},
                                     {"nodes", a.nodes.size(), b.nodes.size()}, {"skins", a.skins.size(), b.skins.size()}, {"clips", a.clips.size(), b.clips.size()}})
        if (x != y) return count(what, x) + " against " + std::to_string(y);
    for (size_t m = 0; m < a.meshes.size(); ++m) {
        const Mesh &x = a.meshes[m], &y = b.meshes[m];
        if (x.name != y.name || x.primitives.size() != y.primitives.size()) return count("mesh", m);
        for (size_t p = 0; p < x.primitives.size(); ++p) {
            const Primitive &s = x.primitives[p], &t = y.primitives[p];
            const std::string where = count("mesh", m) + count(" primitive", p);
            if (s.positions != t.positions) return where + " positions";
            if (s.normals != t.normals) return where + " normals";
            if (s.tangents != t.tangents) return where + " tangents";
            if (s.texcoords != t.texcoords || s.texcoords1 != t.texcoords1) return where + " texcoords";
            if (s.colors != t.colors) return where + " colors";
            for (int set = 0; set < 2; ++set)
                if (s.joints[set] != t.joints[set] || s.joint_weights[set] != t.joint_weights[set]) return where + " joints";
            if (s.targets.size() != t.targets.size()) return where + " morph targets";
            for (size_t k = 0; k < s.targets.size(); ++k)
                if (s.targets[k].positions != t.targets[k].positions || s.targets[k].normals != t.targets[k].normals) return where + count(" morph target", k);
            if (s.indices != t.indices || s.material != t.material) return where + " indices or material";
        }
    }
    for (size_t i = 0; i < a.nodes.size(); ++i) {
        const Node &x = a.nodes[i], &y = b.nodes[i];
        if (x.name != y.name || x.parent != y.parent || x.weights != y.weights || x.matrix != y.matrix) return count("node", i);
        if (x.rest.translation != y.rest.translation || x.rest.rotation != y.rest.rotation || x.rest.scale != y.rest.scale) return count("node", i) + " transform";
    }
    for (size_t i = 0; i < a.skins.size(); ++i)
        if (a.skins[i].name != b.skins[i].name || a.skins[i].joints != b.skins[i].joints || a.skins[i].inverse_bind != b.skins[i].inverse_bind) return count("skin", i);
    for (size_t i = 0; i < a.clips.size(); ++i) {
        const Clip &x = a.clips[i], &y = b.clips[i];
        if (x.name != y.name || x.tracks.size() != y.tracks.size() || x.channels.size() != y.channels.size()) return count("clip", i);
        for (size_t k = 0; k < x.tracks.size(); ++k) {
            const Track &s = x.tracks[k], &t = y.tracks[k];
            if (s.interpolation != t.interpolation || s.width != t.width || s.times != t.times || s.values != t.values) return count("clip", i) + count(" track", k);
        }
        for (size_t k = 0; k < x.channels.size(); ++k) {
            const Channel &s = x.channels[k], &t = y.channels[k];
            if (s.node != t.node || s.track != t.track || s.path != t.path) return count("clip", i) + count(" channel", k);
        }
    }
    for (size_t i = 0; i < a.instances.size(); ++i)
        if (a.instances[i].node != b.instances[i].node || a.instances[i].skin != b.instances[i].skin) return count("instance", i) + " node or skin";
    for (size_t i = 0; i < a.instances.size(); ++i)
        if (a.instances[i].mesh != b.instances[i].mesh || a.instances[i].to_world != b.instances[i].to_world) return count("instance", i);
    for (size_t i = 0; i < a.textures.size(); ++i) {
        const Texture &x = a.textures[i], &y = b.textures[i];
        if (x.name != y.name || x.width != y.width || x.height != y.height || x.rgba != y.rgba || x.wrap_u != y.wrap_u || x.wrap_v != y.wrap_v)
            return count("texture", i);
    }
    for (size_t i = 0; i < a.materials.size(); ++i) {
        const Material &x = a.materials[i], &y = b.materials[i];
        if (x.name != y.name || x.base_color != y.base_color || x.metallic != y.metallic || x.roughness != y.roughness || x.emissive != y.emissive)
            return count("material", i);
        if (x.alpha != y.alpha || x.alpha_cutoff != y.alpha_cutoff || x.unlit != y.unlit || x.double_sided != y.double_sided || x.normal_scale != y.normal_scale)
            return count("material", i) + " alpha, unlit or sides";
        if (!same_use(x.base_color_texture, y.base_color_texture) || !same_use(x.metallic_roughness_texture, y.metallic_roughness_texture) ||
            !same_use(x.emissive_texture, y.emissive_texture) || !same_use(x.normal_texture, y.normal_texture))
            return count("material", i) + " textures";
    }
    for (size_t i = 0; i < a.lights.size(); ++i) {
        const Light &x = a.lights[i], &y = b.lights[i];
        if (x.type != y.type || x.name != y.name || !near(x.intensity, y.intensity) || !near(x.direction, y.direction) || x.node != y.node) return count("light", i);
        if (x.type != Light::Type::directional && x.position != y.position) return count("light", i) + " position";
        if (x.type == Light::Type::spot && (std::abs(x.inner_cone - y.inner_cone) > 1e-6f || x.outer_cone != y.outer_cone))
            return count("light", i) + " cones";
    }
    for (size_t i = 0; i < a.cameras.size(); ++i) {
        const Camera &x = a.cameras[i], &y = b.cameras[i];
        if (x.name != y.name || x.yfov != y.yfov || x.node != y.node) return count("camera", i);
        for (int c = 0; c < 4; ++c)
            if (!near(glm::vec3(x.to_world[c]), glm::vec3(y.to_world[c]))) return count("camera", i) + " transform";
    }
    if (a.background != b.background) return "background";
    return "";
}

}  // namespace myriad::scenes
