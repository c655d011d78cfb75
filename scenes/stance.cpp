#include "scenes/stance.hpp"

#include <algorithm>

namespace myriad::scenes {

std::vector<Stance> stances(const Scene& scene, const Playback& playback) {
    std::vector<Stance> out(scene.instances.size(), Stance::still);
    if (scene.nodes.empty()) return out;
    std::vector<bool> moves(scene.nodes.size()), morphs(scene.nodes.size());
    for (const uint32_t clip : playback.clips)
        for (const Channel& channel : scene.clips[clip].channels) (channel.path == Path::weights ? morphs : moves)[channel.node] = true;
    for (size_t i = 0; i < scene.nodes.size(); ++i)  // parents come first
        if (const uint32_t parent = scene.nodes[i].parent; parent != none && moves[parent]) moves[i] = true;
    for (size_t i = 0; i < out.size(); ++i) {
        const Instance& instance = scene.instances[i];
        if (instance.node == none) continue;
        const auto& primitives = scene.meshes[instance.mesh].primitives;
        const bool morphed = std::ranges::any_of(primitives, [](const Primitive& p) { return !p.targets.empty(); });
        const auto& weights = scene.nodes[instance.node].weights;
        bool moving = morphed && morphs[instance.node], posed = morphed && std::ranges::any_of(weights, [](float w) { return w != 0; });
        if (instance.skin == none) {
            moving = moving || moves[instance.node];
        } else {
            moving = moving || std::ranges::any_of(scene.skins[instance.skin].joints, [&](uint32_t joint) { return moves[joint]; });
            posed = true;
        }
        out[i] = moving ? Stance::moving : posed ? Stance::posed : Stance::still;
    }
    return out;
}

}  // namespace myriad::scenes
