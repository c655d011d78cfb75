#include "tools/reference/resume.hpp"

#include "engine/digest.hpp"
#include "engine/error.hpp"
#include "tools/message.hpp"

namespace myriad::reference {
namespace {

template <class T>
engine::Bytes bytes(const std::vector<T>& values) { return std::as_bytes(std::span<const T>(values)); }

// Numbers one after the other, for structs have gaps of any content.
class Numbers {
public:
    template <class T>
    void add(const T& value) {
        const auto* bytes = reinterpret_cast<const std::byte*>(&value);
        bytes_.insert(bytes_.end(), bytes, bytes + sizeof value);
    }
    void add(const scenes::TextureUse& use) { add(use.texture), add(use.set), add(use.transform); }
    engine::Bytes all() const { return bytes_; }

private:
    std::vector<std::byte> bytes_;
};

}  // namespace

std::string scene_digest(const scenes::Scene& scene, std::span<const scenes::Light> lights, const scenes::Triangles& t, const scenes::Camera& camera) {
    Numbers rest;
    for (const scenes::Material& m : scene.materials) {
        rest.add(m.base_color), rest.add(m.metallic), rest.add(m.roughness), rest.add(m.emissive), rest.add(m.normal_scale);
        rest.add(m.base_color_texture), rest.add(m.metallic_roughness_texture), rest.add(m.emissive_texture), rest.add(m.normal_texture);
        rest.add(m.alpha), rest.add(m.alpha_cutoff), rest.add(m.unlit), rest.add(m.double_sided);
    }
    for (const scenes::Light& l : lights) {
        rest.add(l.type), rest.add(l.position), rest.add(l.direction), rest.add(l.intensity);
        rest.add(l.inner_cone), rest.add(l.outer_cone), rest.add(l.radius);
    }
    rest.add(scene.background), rest.add(camera.to_world), rest.add(camera.yfov);
    std::vector<engine::Bytes> parts = {bytes(t.positions), bytes(t.normals), bytes(t.texcoords), bytes(t.colors), bytes(t.texcoords1), bytes(t.tangents), bytes(t.triangles)};
    for (const scenes::Texture& texture : scene.textures) {
        rest.add(texture.width), rest.add(texture.height), rest.add(texture.wrap_u), rest.add(texture.wrap_v);
        parts.push_back(bytes(texture.rgba));
    }
    if (const auto& e = scene.environment) rest.add(e->width), rest.add(e->height), rest.add(e->rotation), parts.push_back(bytes(e->texels));
    parts.push_back(rest.all());
    return engine::hex(engine::digest(parts)).substr(0, 32);
}

Film resumed(const tools::Image& image, const Film& film, const std::map<std::string, std::string>& about) {
    const auto refuse = [&](const std::string& what, const std::string& there, const std::string& here) {
        throw InputError("'" + image.origin + "' has " + what + " " + there + ", and " + here + " is asked for; give the settings that it was made with, or leave --resume out");
    };
    const auto size = [](uint32_t w, uint32_t h) { return std::to_string(w) + "x" + std::to_string(h); };
    if (image.width != film.width() || image.height != film.height()) refuse("the size", size(image.width, image.height), size(film.width(), film.height()));
    for (const auto& [key, value] : about) {
        const auto at = image.metadata.find(key);
        const std::string there = at == image.metadata.end() ? "none" : at->second;
        if (there == value) continue;
        if (key != "git_revision") refuse(key, there, value);
        tools::say("warning", "'" + image.origin + "' was begun by revision " + there + "; where " + value + " samples differently, its pixels are a mixture.");
    }
    for (const auto& [key, value] : image.metadata)
        if (key != "samples" && !about.contains(key)) refuse(key, value, "none");
    return Film(image);
}

}  // namespace myriad::reference
