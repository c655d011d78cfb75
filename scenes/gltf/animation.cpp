#include "scenes/gltf/animation.hpp"

#include <algorithm>
#include <cmath>
#include <map>
#include <set>

namespace myriad::scenes::gltf {
namespace {

struct LeftOut {
    size_t paths = 0, weights = 0, instanced = 0, keys = 0, rotations = 0;

    void report(Scene& scene) const {
        warn(scene, paths, "channels of animations were left out, for they move something else than a node's translation, rotation, scale or weights");
        warn(scene, weights, "channels of animations were left out, for they are weights of nodes without morph targets");
        warn(scene, instanced, "channels of animations were left out, for they are weights of nodes with EXT_mesh_gpu_instancing");
        warn(scene, keys, "keys of animations were left out, for another has the same time");
        warn(scene, rotations, "keys of animations are rotations of no length, which turn nothing");
    }
};

constexpr std::pair<const char*, Path> paths[] = {
    {"translation", Path::translation}, {"rotation", Path::rotation}, {"scale", Path::scale}, {"weights", Path::weights}};

Track::Interpolation interpolation(const Place& place, const std::string& name) {
    if (name.empty() || name == "LINEAR") return Track::Interpolation::linear;
    if (name == "STEP") return Track::Interpolation::step;
    if (name == "CUBICSPLINE") return Track::Interpolation::cubic;
    place.fail("its interpolation is " + quote(name), "use STEP, LINEAR or CUBICSPLINE");
}

std::vector<float> read_all(const FloatReader& reader) {
    std::vector<float> out(reader.count() * size_t(reader.components()));
    if (!out.empty()) reader.read(out.data());
    return out;
}

// Of several keys at one time the last counts: it is what is seen from then on.
size_t drop_doubles(Track& track, size_t numbers) {
    size_t kept = 0;
    for (size_t i = 0; i < track.times.size(); ++i) {
        if (i + 1 < track.times.size() && track.times[i] == track.times[i + 1]) continue;
        track.times[kept] = track.times[i];
        std::copy_n(track.values.begin() + ptrdiff_t(i * numbers), numbers, track.values.begin() + ptrdiff_t(kept * numbers));
        ++kept;
    }
    const size_t dropped = track.times.size() - kept;
    track.times.resize(kept), track.values.resize(kept * numbers);
    return dropped;
}

Track read_track(const Place& place, const tinygltf::AnimationSampler& in, Path path, uint32_t width, LeftOut& left_out) {
    Track out{.interpolation = interpolation(place, in.interpolation), .width = width};
    const size_t numbers = size_t(width) * (out.interpolation == Track::Interpolation::cubic ? 3 : 1);  // a key
    const Place input = place.at("input"), output = place.at("output");
    out.times = read_all(FloatReader(input, in.input, 1));
    if (out.times.empty()) input.fail("there are no keys", "export the animation again");
    for (size_t i = 0; i < out.times.size(); ++i)
        if (!std::isfinite(out.times[i]) || (i && out.times[i] < out.times[i - 1]))
            input.fail("time " + std::to_string(i) + " is not a number, or before the one before it", "sort the keys, or export the animation again");
    FloatReader reader(output, in.output, path == Path::weights ? 1 : int(width));
    if (path == Path::rotation || path == Path::weights) reader.normalize();
    const size_t found = reader.count() * size_t(reader.components());
    if (found != out.times.size() * numbers)
        output.fail("there are " + std::to_string(found) + " numbers, where " + std::to_string(out.times.size()) + " keys take " +
                        std::to_string(out.times.size() * numbers), "export the animation again");
    out.values = read_all(reader);
    if (!std::all_of(out.values.begin(), out.values.end(), [](float v) { return std::isfinite(v); }))
        output.fail("there is a number that is not finite", "export the animation again");
    left_out.keys += drop_doubles(out, numbers);
    for (size_t i = 0; path == Path::rotation && i < out.times.size(); ++i) {
        const float* q = &out.values[i * numbers + (numbers > width ? width : 0)];
        left_out.rotations += q[0] == 0 && q[1] == 0 && q[2] == 0 && q[3] == 0;
    }
    return out;
}

void read_clip(const Place& place, const tinygltf::Animation& in, const Hierarchy& hierarchy, Scene& scene, LeftOut& left_out) {
    Clip& clip = scene.clips.emplace_back();
    clip.name = in.name;
    std::map<std::pair<int, Path>, uint32_t> tracks;  // a sampler may serve several channels
    std::set<std::pair<uint32_t, Path>> moved;
    for (size_t c = 0; c < in.channels.size(); ++c) {
        const tinygltf::AnimationChannel& channel = in.channels[c];
        const Place here = place.at("channel " + std::to_string(c));
        const auto path = std::ranges::find(paths, channel.target_path, [](const auto& p) { return std::string(p.first); });
        if (path == std::end(paths)) ++left_out.paths;
        if (path == std::end(paths) || channel.target_node < 0) continue;
        if (size_t(channel.target_node) >= hierarchy.of_file.size())
            here.fail("there is no node " + std::to_string(channel.target_node), "export the animation again");
        const uint32_t node = hierarchy.of_file[size_t(channel.target_node)];
        if (node == none) continue;
        if (path->second != Path::weights && scene.nodes[node].matrix)
            here.fail("it moves node " + std::to_string(channel.target_node) + ", which has a matrix", "give that node translation, rotation and scale");
        // Each instance has a node of its own, and those have the weights.
        const bool instanced = path->second == Path::weights && extension(place.model.nodes[size_t(channel.target_node)], instancing_extension);
        left_out.instanced += instanced;
        if (instanced) continue;
        const uint32_t width = path->second == Path::weights ? uint32_t(scene.nodes[node].weights.size()) : path->second == Path::rotation ? 4 : 3;
        left_out.weights += width == 0;
        if (width == 0) continue;
        if (channel.sampler < 0 || size_t(channel.sampler) >= in.samplers.size())
            here.fail("there is no sampler " + std::to_string(channel.sampler), "export the animation again");
        if (!moved.emplace(node, path->second).second)
            here.fail("a channel before it moves the " + channel.target_path + " of the same node", "leave one of them out");
        const auto [known, fresh] = tracks.try_emplace({channel.sampler, path->second}, uint32_t(clip.tracks.size()));
        const Place sampler = place.at("sampler " + std::to_string(channel.sampler));
        if (fresh) clip.tracks.push_back(read_track(sampler, in.samplers[size_t(channel.sampler)], path->second, width, left_out));
        if (clip.tracks[known->second].width != width)
            sampler.fail("it moves the weights of nodes with different numbers of morph targets", "give each a sampler of its own");
        clip.channels.push_back({node, known->second, path->second});
    }
}

}  // namespace

void read_animations(const Place& place, const Hierarchy& hierarchy, Scene& scene) {
    LeftOut left_out;
    for (size_t i = 0; i < place.model.animations.size(); ++i) {
        const auto& in = place.model.animations[i];
        read_clip(place.at("animation " + std::to_string(i) + " " + quote(in.name)), in, hierarchy, scene, left_out);
    }
    left_out.report(scene);
}

void prune_nodes(Scene& scene) {
    const size_t count = scene.nodes.size();
    std::vector<bool> moves(count), needed(count);
    for (const Clip& clip : scene.clips)
        for (const Channel& channel : clip.channels) {
            needed[channel.node] = true;
            if (channel.path != Path::weights) moves[channel.node] = true;
        }
    for (size_t i = 0; i < count; ++i)
        if (const uint32_t parent = scene.nodes[i].parent; parent != none && moves[parent]) moves[i] = true;
    const auto settle = [&](uint32_t& node, bool keep) {
        if (node == none) return;
        if (keep || moves[node]) needed[node] = true;
        else node = none;
    };
    for (Instance& instance : scene.instances)
        settle(instance.node, instance.skin != none || (instance.node != none && !scene.nodes[instance.node].weights.empty()));
    for (Light& light : scene.lights) settle(light.node, false);
    for (Camera& camera : scene.cameras) settle(camera.node, false);
    for (const Skin& skin : scene.skins)
        for (const uint32_t joint : skin.joints) needed[joint] = true;
    for (size_t i = count; i-- > 0;)
        if (needed[i] && scene.nodes[i].parent != none) needed[scene.nodes[i].parent] = true;

    std::vector<uint32_t> number(count, none);
    std::vector<Node> kept;
    for (size_t i = 0; i < count; ++i) {
        if (!needed[i]) continue;
        number[i] = uint32_t(kept.size());
        kept.push_back(std::move(scene.nodes[i]));
        if (kept.back().parent != none) kept.back().parent = number[kept.back().parent];
    }
    scene.nodes = std::move(kept);
    const auto renumber = [&](uint32_t& node) {
        if (node != none) node = number[node];
    };
    for (Instance& instance : scene.instances) renumber(instance.node);
    for (Light& light : scene.lights) renumber(light.node);
    for (Camera& camera : scene.cameras) renumber(camera.node);
    for (Skin& skin : scene.skins)
        for (uint32_t& joint : skin.joints) renumber(joint);
    for (Clip& clip : scene.clips)
        for (Channel& channel : clip.channels) renumber(channel.node);
}

}  // namespace myriad::scenes::gltf
