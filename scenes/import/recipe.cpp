#include "scenes/import/recipe.hpp"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <limits>
#include <map>
#include <optional>
#include <string_view>

#include <glm/gtc/matrix_transform.hpp>

#include "engine/error.hpp"
#include "scenes/attributes.hpp"
#include "scenes/builtin/kit.hpp"
#include "scenes/gltf/limits.hpp"
#include "scenes/import/bytes.hpp"
#include "scenes/import/picture.hpp"
#include "scenes/import/recipe_item.hpp"
#include "scenes/import/tidy.hpp"

namespace myriad::scenes::importing {
namespace {

using glm::dmat4;
using glm::dvec3;
using nlohmann::json;

constexpr double most_light = gltf::limits::light, most_size = 1e6;
constexpr size_t most_instances = 4 << 20;
constexpr dvec3 up(0, 1, 0);

struct Box {
    dvec3 lo{std::numeric_limits<double>::infinity()}, hi{-std::numeric_limits<double>::infinity()};
    bool empty() const { return lo.x > hi.x; }
    void add(const dvec3& p) { lo = glm::min(lo, p), hi = glm::max(hi, p); }
    void add(const Box& b) {
        if (!b.empty()) add(b.lo), add(b.hi);
    }
};

Box bounds(const Scene& scene) {
    Box out;
    if (!scene.nodes.empty()) {  // joints and morph targets say where vertices are
        Scene posed = scene;
        const Triangles triangles = flatten(posed, Sharing::never);
        if (triangles.count() > 0) out.add(dvec3(triangles.lo)), out.add(dvec3(triangles.hi));
        return out;
    }
    for (const Instance& instance : scene.instances)
        for (const Primitive& p : scene.meshes[instance.mesh].primitives)
            for (const glm::vec3& v : p.positions) out.add(dvec3(dmat4(instance.to_world) * glm::dvec4(v, 1)));
    return out;
}

// `*` stands for anything, itself included.
bool matches(std::string_view pattern, std::string_view text) {
    size_t p = 0, t = 0, star = pattern.npos, retry = 0;
    while (t < text.size()) {
        if (p < pattern.size() && pattern[p] == '*') star = p++, retry = t;
        else if (p < pattern.size() && pattern[p] == text[t]) ++p, ++t;
        else if (star != pattern.npos) p = star + 1, t = ++retry;
        else return false;
    }
    while (p < pattern.size() && pattern[p] == '*') ++p;
    return p == pattern.size();
}

uint64_t bytes_of(const Scene& scene) {
    uint64_t bytes = 0;
    for (const Texture& texture : scene.textures) bytes += texture.rgba.size();
    for (const Mesh& mesh : scene.meshes)
        for (const Primitive& p : mesh.primitives)
            each_attribute(p, [&](const auto& list) { bytes += list.size() * sizeof list[0]; }), bytes += sizeof(uint32_t) * p.indices.size();
    for (const Clip& clip : scene.clips)
        for (const Track& track : clip.tracks) bytes += sizeof(float) * (track.times.size() + track.values.size());
    return bytes;
}

bool any_matches(const std::vector<std::string>& patterns, const std::string& text) {
    return std::ranges::any_of(patterns, [&](const std::string& pattern) { return matches(pattern, text); });
}

dmat4 rotation(const dvec3& degrees) {  // about x, then y, then z
    dmat4 m(1);
    for (int axis : {2, 1, 0}) {
        dvec3 around(0);
        around[axis] = 1;
        m = glm::rotate(m, glm::radians(degrees[axis]), around);
    }
    return m;
}

// A camera's or a panel's place: looking from `eye` along -Z.
std::optional<glm::mat4> looking(const dvec3& eye, const dvec3& target) {
    const dvec3 d = target - eye;
    if (!(glm::length(d) > 1e-9)) return {};
    const bool steep = std::abs(glm::normalize(d).y) > 0.9999;
    return glm::mat4(glm::inverse(glm::lookAt(eye, target, steep ? dvec3(0, 0, d.y > 0 ? 1 : -1) : up)));
}

class Recipe {
public:
    Recipe(const std::string& path, const json& document, uint64_t most_bytes)
        : path_(path), left_(most_bytes), root_(document, path, {"recipe", "background", "materials", "parts", "room", "boxes", "panels", "lights", "cameras"}) {
        std::error_code error;
        const auto parent = std::filesystem::path(path).parent_path();
        folder_ = std::filesystem::canonical(parent.empty() ? "." : parent, error);
        if (root_.number("recipe", 0, 0, 1e9) != 1) root_.fail("this is no recipe of version 1", "begin with \"recipe\": 1");
    }

    Scene make() {
        scene_.background = glm::vec3(root_.vector("background", dvec3(0), 0, most_light));
        root_.members("materials", [&](const std::string& name, const json& value, const std::string& place) {
            Material m{.name = name, .metallic = 0};
            change(m, value, place);
            materials_[name] = uint32_t(scene_.materials.size());
            scene_.materials.push_back(m);
        });
        root_.each("parts", [&](const json& value, const std::string& place) { part(value, place); });
        if (root_.has("room")) room();
        root_.each("boxes", [&](const json& value, const std::string& place) { box(value, place); });
        root_.each("panels", [&](const json& value, const std::string& place) { panel(value, place); });
        root_.each("lights", [&](const json& value, const std::string& place) { light(value, place); });
        root_.each("cameras", [&](const json& value, const std::string& place) { camera(value, place); });
        return std::move(scene_);
    }

private:
    // ---- materials

    // The file that a recipe names: a relative path in its own folder.
    std::string file(const Item& item, const std::string& name) const {
        const auto relative = std::filesystem::path(name).lexically_normal();
        std::error_code error;
        const auto found = std::filesystem::canonical(folder_ / relative, error);
        const bool inside = !error && std::mismatch(folder_.begin(), folder_.end(), found.begin(), found.end()).first == folder_.end();
        const std::string quoted = "\"" + name.substr(0, 100) + "\"";
        if (relative.is_absolute() || relative.empty() || *relative.begin() == ".." || (!error && !inside))
            item.fail("the file " + quoted + " is outside of the recipe's folder", "put it in or below that folder");
        if (error || !std::filesystem::is_regular_file(found, error)) item.fail("there is no file " + quoted, "put it beside the recipe");
        return found.string();
    }

    uint32_t texture(const Item& item, const std::string& name) {
        const std::string path = file(item, name);
        const auto [at, fresh] = textures_.try_emplace(path, uint32_t(scene_.textures.size()));
        if (!fresh) return at->second;
        std::string problem;
        auto picture = decode_picture(read_file(path, max_file_bytes), problem);
        if (!picture) item.fail("the texture \"" + name + "\" cannot be decoded (" + problem + ")", "store it as PNG or JPEG");
        picture->name = std::filesystem::path(name).stem().string();
        scene_.textures.push_back(std::move(*picture));
        return at->second;
    }

    // What the recipe says of a material; the rest stays.
    void change(Material& m, const json& value, const std::string& place) {
        const Item item(value, place, {"base_color", "metallic", "roughness", "emissive", "texture", "alpha", "alpha_cutoff", "double_sided", "unlit"});
        if (const auto c = item.numbers("base_color", 3, 4, 0, 1); !c.empty())
            m.base_color = {c[0], c[1], c[2], c.size() == 4 ? c[3] : double(m.base_color.a)};
        m.metallic = float(item.number("metallic", double(m.metallic), 0, 1));
        m.roughness = float(item.number("roughness", double(m.roughness), 0, 1));
        m.emissive = glm::vec3(item.vector("emissive", dvec3(m.emissive), 0, most_light));
        if (const std::string name = item.text("texture", ""); !name.empty()) m.base_color_texture = {.texture = texture(item, name)};
        else if (item.has("texture")) m.base_color_texture = {};
        m.alpha = Material::Alpha(item.choice("alpha", {"opaque", "mask", "blend"}, size_t(m.alpha)));
        m.alpha_cutoff = float(item.number("alpha_cutoff", double(m.alpha_cutoff), 0, 1));
        m.double_sided = item.flag("double_sided", m.double_sided);
        m.unlit = item.flag("unlit", m.unlit);
    }

    uint32_t material(const Item& item, const char* key) {
        if (!item.has(key)) return plain();
        const std::string name = item.text(key, "");
        const auto found = materials_.find(name);
        if (found == materials_.end()) item.fail("there is no material \"" + name.substr(0, 60) + "\"", "add it to the recipe's materials");
        return found->second;
    }

    uint32_t plain() {
        if (plain_ == none) plain_ = kit::add_material(scene_, "plain", glm::vec3(0.8f)), scene_.materials.back().metallic = 0;
        return plain_;
    }

    // ---- parts

    void part(const json& value, const std::string& where) {
        const Item item(value, where, {"name", "file", "unit", "up", "crease", "colors", "only", "without", "materials", "lights", "cameras",
                                       "rotate", "fit", "scale", "anchor", "at", "turn", "on", "places"});
        Scene part = load_part(item);
        select(item, part);
        override_materials(item, part);

        // The part's own frame: turned, sized, and with its anchor at the origin.
        Box box = bounds(part);
        if (box.empty()) item.fail("nothing of it is left", "check \"only\" and \"without\"");
        transform(part, rotation(item.vector("rotate", dvec3(0), -3600, 3600)), item.number("scale", 1, 1e-9, 1e9));
        box = bounds(part);
        if (item.has("fit")) {
            transform(part, dmat4(1), fit(item, box));
            box = bounds(part);
        }
        const dvec3 middle = (box.lo + box.hi) / 2.0;
        const dvec3 anchors[] = {dvec3(0), {middle.x, box.lo.y, middle.z}, middle};
        const dvec3 anchor = anchors[item.choice("anchor", {"origin", "bottom", "middle"}, 0)];
        transform(part, glm::translate(dmat4(1), -anchor), 1);
        box.lo -= anchor, box.hi -= anchor;

        // Where it stands: once, or at several places.
        double floor = 0;
        if (item.has("on")) {
            const std::string name = item.text("on", "");
            const auto found = placed_.find(name);
            if (found == placed_.end()) item.fail("there is no part \"" + name.substr(0, 60) + "\" before it to stand on", "name one, or move this one down");
            floor = found->second.hi.y;
        }
        std::vector<dmat4> places;
        const auto place = [&](const Item& one) {
            const dvec3 at = one.vector("at", dvec3(0)) + dvec3(0, floor, 0);
            const dmat4 turned = glm::rotate(glm::translate(dmat4(1), at), glm::radians(one.number("turn", 0, -3600, 3600)), up);
            places.push_back(&one == &item ? turned : glm::scale(turned, dvec3(one.number("scale", 1, 1e-6, 1e6))));
        };
        if (item.has("places")) {
            if (item.has("at") || item.has("turn")) item.fail("it has \"places\", and \"at\" or \"turn\" besides", "put these into the places");
            item.each("places", [&](const json& v, const std::string& w) { place(Item(v, w, {"at", "turn", "scale"})); });
        } else {
            place(item);
        }
        if (part.instances.size() * places.size() > most_instances - std::min<size_t>(most_instances, scene_.instances.size()))
            item.fail("the scene would have more than " + std::to_string(most_instances) + " instances", "give it fewer places");
        if ((part.nodes.size() + 1) * places.size() > most_instances - std::min<size_t>(most_instances, scene_.nodes.size()))
            item.fail("the scene would have more than " + std::to_string(most_instances) + " nodes", "give it fewer places");
        add(std::move(part), places, item.text("name", item.text("file", "")), box);
    }

    Scene load_part(const Item& item) {
        ImportOptions options;
        if (item.has("unit")) options.unit = item.number("unit", 1, 1e-9, 1e9);
        if (item.has("up")) options.up = Axis(item.choice("up", {"x", "y", "z"}, 1));
        if (item.has("crease")) options.crease = float(item.number("crease", 0, 0, 180));
        options.linear_colors = item.choice("colors", {"srgb", "linear"}, 0);
        const std::string name = item.required("file");
        const bool builtin = name.starts_with("builtin:");
        if (name.ends_with(".json")) item.fail("it is a recipe itself", "give a scene");
        Scene part;
        try {
            part = import_scene(builtin ? name : file(item, name), options);
        } catch (const InputError& e) {
            throw InputError(item.place() + ": " + e.what());
        }
        const uint64_t bytes = bytes_of(part);
        if (bytes > left_) item.fail("the parts up to it take too much memory", "give fewer, coarser ones, or one with many places");
        left_ -= bytes;
        for (const std::string& warning : part.warnings) scene_.warnings.push_back(name + ": " + warning);
        if (!item.flag("lights", false)) part.lights.clear();
        if (!item.flag("cameras", false)) part.cameras.clear();
        return part;
    }

    void select(const Item& item, Scene& part) const {
        const auto only = item.texts("only"), without = item.texts("without");
        std::erase_if(part.instances, [&](const Instance& instance) {
            const std::string& name = part.meshes[instance.mesh].name;
            return (item.has("only") && !any_matches(only, name)) || any_matches(without, name);
        });
    }

    // By patterns of names: a material of the recipe in place of the part's, or changes of it.
    void override_materials(const Item& item, Scene& part) {
        item.members("materials", [&](const std::string& pattern, const json& value, const std::string& place) {
            bool used = false;
            for (Material& m : part.materials) {
                if (!matches(pattern, m.name)) continue;
                used = true;
                if (value.is_string()) {
                    const auto found = materials_.find(value.get<std::string>());
                    if (found == materials_.end()) throw InputError(place + ": there is no material \"" + value.get<std::string>().substr(0, 60) + "\"; add it to the recipe's materials.");
                    replaced_.emplace(&m - part.materials.data(), found->second);
                } else {
                    // Its textures are the recipe's; those of the part are numbered after them when it is added.
                    Material changed = m;
                    change(changed, value, place);
                    if (value.contains("texture")) overlaid_[size_t(&m - part.materials.data())] = changed.base_color_texture;
                    changed.base_color_texture = m.base_color_texture;
                    m = changed;
                }
            }
            if (!used) {
                std::string known;
                for (const Material& m : part.materials) known += (known.empty() ? "\"" : ", \"") + m.name.substr(0, 60) + "\"";
                throw InputError(place + ": no material has such a name; known are " + known.substr(0, 500) + ".");
            }
        });
    }

    static double fit(const Item& item, const Box& box) {
        const Item size(item.value("fit"), item.place_of("fit"), {"width", "height", "depth", "longest"});
        const dvec3 has = box.hi - box.lo;
        double scale = 0;
        for (const auto& [key, length] : {std::pair("width", has.x), {"height", has.y}, {"depth", has.z}, {"longest", std::max({has.x, has.y, has.z})}}) {
            if (!size.has(key)) continue;
            if (scale) size.fail("it has more than one length", "give one");
            if (!(length > 0)) size.fail(std::string("the part has no ") + key, "fit another length");
            scale = size.number(key, 1, 1e-9, most_size) / length;
        }
        if (!scale) size.fail("it has no length", "give width, height, depth or longest");
        return scale;
    }

    // Appends the part, an instance of all it has for each place.
    void add(Scene part, const std::vector<dmat4>& places, const std::string& name, const Box& box) {
        const uint32_t first_texture = uint32_t(scene_.textures.size()), first_mesh = uint32_t(scene_.meshes.size());
        std::vector<uint32_t> numbers;
        for (size_t i = 0; i < part.materials.size(); ++i) {
            if (const auto it = replaced_.find(ptrdiff_t(i)); it != replaced_.end()) {
                numbers.push_back(it->second);
                continue;
            }
            Material m = std::move(part.materials[i]);
            for (TextureUse* use : {&m.base_color_texture, &m.metallic_roughness_texture, &m.emissive_texture, &m.normal_texture})
                if (use->texture != none) use->texture += first_texture;
            if (const auto it = overlaid_.find(i); it != overlaid_.end()) m.base_color_texture = it->second;
            numbers.push_back(uint32_t(scene_.materials.size()));
            scene_.materials.push_back(std::move(m));
        }
        replaced_.clear(), overlaid_.clear();
        std::ranges::move(part.textures, std::back_inserter(scene_.textures));
        for (Mesh& mesh : part.meshes) {
            for (Primitive& p : mesh.primitives) p.material = numbers[p.material];
            scene_.meshes.push_back(std::move(mesh));
        }
        Box all;
        std::vector<uint32_t> first_of_place;
        for (const dmat4& to_world : places) {
            const uint32_t first_skin = uint32_t(scene_.skins.size()), offset = add_nodes(part, to_world);
            first_of_place.push_back(offset);
            for (const Instance& instance : part.instances) {
                Instance& placed = scene_.instances.emplace_back(instance);
                placed.mesh += first_mesh;
                placed.to_world = glm::mat4(to_world * dmat4(instance.to_world));
                if (placed.node != none) placed.node += offset;
                if (placed.skin != none) placed.skin += first_skin;
            }
            for (int corner = 0; corner < 8; ++corner) {
                const dvec3 p(corner & 1 ? box.hi.x : box.lo.x, corner & 2 ? box.hi.y : box.lo.y, corner & 4 ? box.hi.z : box.lo.z);
                all.add(dvec3(to_world * glm::dvec4(p, 1)));
            }
        }
        placed_[name].add(all);
        everything_.add(all);
        if (places.empty()) return;
        add_clips(part, first_of_place);
        Scene rest;  // lights and cameras come once, at the first place
        rest.lights = std::move(part.lights), rest.cameras = std::move(part.cameras);
        for (Light& light : rest.lights) {
            light.position = glm::vec3(places[0] * glm::dvec4(light.position, 1));
            light.direction = glm::normalize(glm::vec3(places[0] * glm::dvec4(light.direction, 0)));
            if (light.node != none) light.node += first_of_place[0];
            scene_.lights.push_back(light);
        }
        for (Camera& camera : rest.cameras) {
            camera.to_world = glm::mat4(places[0] * dmat4(camera.to_world));
            for (int c = 0; c < 3; ++c) camera.to_world[c] = glm::normalize(camera.to_world[c]);
            if (camera.node != none) camera.node += first_of_place[0];
            scene_.cameras.push_back(camera);
        }
    }

    // Nodes and skins of the part, below one that is the place; returns what is added to their numbers.
    uint32_t add_nodes(const Scene& part, const dmat4& to_world) {
        if (part.nodes.empty()) return 0;
        const uint32_t place = uint32_t(scene_.nodes.size()), offset = place + 1;
        scene_.nodes.push_back({.matrix = to_world});
        for (Node node : part.nodes) {
            node.parent = node.parent == none ? place : node.parent + offset;
            scene_.nodes.push_back(std::move(node));
        }
        for (Skin skin : part.skins) {
            for (uint32_t& joint : skin.joints) joint += offset;
            scene_.skins.push_back(std::move(skin));
        }
        return offset;
    }

    // A clip plays at all places of the part, and with those of the same name that other parts have.
    void add_clips(Scene& part, const std::vector<uint32_t>& first_of_place) {
        std::vector<bool> joined(scene_.clips.size());  // by a clip of this part
        for (Clip& in : part.clips) {
            size_t i = 0;
            while (i < joined.size() && (joined[i] || in.name.empty() || scene_.clips[i].name != in.name)) ++i;
            if (i == joined.size()) i = scene_.clips.size(), scene_.clips.push_back({.name = in.name});
            else joined[i] = true;
            Clip& clip = scene_.clips[i];
            const uint32_t first_track = uint32_t(clip.tracks.size());
            std::ranges::move(in.tracks, std::back_inserter(clip.tracks));
            for (const uint32_t offset : first_of_place)
                for (const Channel& channel : in.channels) clip.channels.push_back({channel.node + offset, channel.track + first_track, channel.path});
        }
    }

    // `framed`: a camera that frames all frames it too.
    void add_shape(const std::string& name, std::vector<Primitive> primitives, bool framed) {
        Scene shape;
        kit::add_instance(scene_, kit::add_mesh(scene_, name, std::move(primitives)));
        shape.meshes.push_back(scene_.meshes.back());
        shape.instances.push_back({});
        const Box box = bounds(shape);
        placed_[name].add(box);
        if (framed) everything_.add(box);
    }

    // ---- helper geometry

    // Walls seen from inside; those that `open` names are left out.
    void room() {
        const Item item(root_.value("room"), path_ + ": room", {"size", "at", "floor", "walls", "ceiling", "open"});
        if (!item.has("size")) item.fail("there is no size", "give it one: [width, height, depth]");
        const dvec3 size = item.vector("size", dvec3(1), 1e-6, most_size), at = item.vector("at", dvec3(0));
        const std::vector<std::string> open = item.texts("open"), sides = {"floor", "ceiling", "left", "right", "back", "front"};
        for (const std::string& side : open)
            if (std::ranges::find(sides, side) == sides.end()) item.fail("there is no side \"" + side.substr(0, 60) + "\" to open", "name floor, ceiling, left, right, back or front");
        const glm::vec3 lo(at - dvec3(size.x / 2, 0, size.z / 2)), hi(at + dvec3(size.x / 2, size.y, size.z / 2)), s(size);
        const glm::vec3 x(s.x, 0, 0), y(0, s.y, 0), z(0, 0, s.z);
        const uint32_t floor = material(item, "floor"), walls = material(item, "walls"), ceiling = material(item, "ceiling");
        struct Side {
            glm::vec3 origin, u, v;  // u x v points inward
            uint32_t material;
        };
        const Side geometry[] = {{{lo.x, lo.y, hi.z}, x, -z, floor}, {{lo.x, hi.y, lo.z}, x, z, ceiling}, {{lo.x, lo.y, hi.z}, -z, y, walls},
                                 {{hi.x, lo.y, lo.z}, z, y, walls}, {{lo.x, lo.y, lo.z}, x, y, walls}, {{hi.x, lo.y, hi.z}, -x, y, walls}};
        std::vector<Primitive> primitives;
        for (size_t i = 0; i < sides.size(); ++i) {
            if (std::ranges::find(open, sides[i]) != open.end()) continue;
            Primitive& p = primitives.emplace_back();
            p.material = geometry[i].material;
            kit::quad(p, geometry[i].origin, geometry[i].u, geometry[i].v, 1, 1);
        }
        if (!primitives.empty()) add_shape("room", std::move(primitives), false);
    }

    void box(const json& value, const std::string& where) {
        const Item item(value, where, {"name", "size", "at", "turn", "material"});
        if (!item.has("size")) item.fail("there is no size", "give it one: [width, height, depth]");
        const dvec3 size = item.vector("size", dvec3(1), 1e-6, most_size), at = item.vector("at", dvec3(0));
        Primitive solid, placed;
        kit::box(solid, glm::vec3(-size.x / 2, 0, -size.z / 2), glm::vec3(size.x / 2, size.y, size.z / 2), float(std::max({size.x, size.y, size.z})));
        placed.material = material(item, "material");
        kit::append(placed, solid, glm::mat4(glm::rotate(glm::translate(dmat4(1), at), glm::radians(item.number("turn", 0, -3600, 3600)), up)));
        add_shape(item.text("name", "box"), {std::move(placed)}, true);
    }

    // ---- lights and cameras

    void panel(const json& value, const std::string& where) {
        const Item item(value, where, {"name", "at", "size", "toward", "radiance"});
        const auto size = item.numbers("size", 2, 2, 1e-6, most_size);
        const dvec3 at = item.vector("at", dvec3(0)), toward = item.vector("toward", at - up);
        if (size.empty()) item.fail("there is no size", "give it one: [width, height]");
        const auto frame = looking(at, toward);
        if (!frame) item.fail("\"toward\" is where the panel is", "give the point that it shines at");
        const glm::vec3 u = glm::vec3((*frame)[0]) * float(size[0]), v = glm::vec3((*frame)[1]) * float(size[1]);
        Primitive p;
        kit::quad(p, glm::vec3(at) + (u - v) * 0.5f, -u, v, 1, 1);  // its front is where the frame looks
        p.material = kit::add_material(scene_, item.text("name", "panel"), glm::vec3(0));
        scene_.materials.back().metallic = 0;
        scene_.materials.back().emissive = glm::vec3(item.vector("radiance", dvec3(1), 0, most_light));
        add_shape(item.text("name", "panel"), {std::move(p)}, false);
    }

    void light(const json& value, const std::string& where) {
        const Item item(value, where, {"name", "type", "at", "toward", "intensity", "inner", "outer"});
        if (!item.has("type")) item.fail("there is no type", "give point, spot or sun");
        Light out;
        out.type = Light::Type(item.choice("type", {"point", "spot", "sun"}, 0));
        out.name = item.text("name", "");
        const dvec3 at = item.vector("at", dvec3(0)), toward = item.vector("toward", at - up);
        if (out.type != Light::Type::point && !(glm::length(toward - at) > 1e-9)) item.fail("\"toward\" is where the light is", "give the point that it shines at");
        out.position = glm::vec3(at);
        if (out.type != Light::Type::point) out.direction = glm::vec3(glm::normalize(toward - at));
        out.intensity = glm::vec3(item.vector("intensity", dvec3(1), 0, most_light));
        out.outer_cone = float(glm::radians(item.number("outer", 45, 0.1, 90)));
        out.inner_cone = float(glm::radians(item.number("inner", 0, 0, 90)));
        if (out.inner_cone > out.outer_cone) item.fail("its inner cone is wider than the outer one", "correct it");
        scene_.lights.push_back(out);
    }

    void camera(const json& value, const std::string& where) {
        const Item item(value, where, {"name", "eye", "target", "frame", "from", "yfov"});
        Camera out;
        out.name = item.text("name", "");
        out.yfov = float(glm::radians(item.number("yfov", 45, 1, 170)));
        dvec3 eye, target;
        if (item.has("frame")) {
            if (item.has("eye") || item.has("target")) item.fail("it has \"frame\", and \"eye\" or \"target\" besides", "leave either out");
            const std::string name = item.text("frame", "");
            const auto found = placed_.find(name);
            if (name != "all" && found == placed_.end()) item.fail("there is no part \"" + name.substr(0, 60) + "\" to frame", "name one, or all");
            const Box& box = name == "all" ? everything_ : found->second;
            if (box.empty()) item.fail("there is nothing to frame", "add parts");
            const dvec3 from = item.vector("from", dvec3(0.6, 0.45, 1));
            if (!(glm::length(from) > 1e-9)) item.fail("\"from\" is no direction", "correct it");
            target = (box.lo + box.hi) / 2.0;
            const double radius = std::max(glm::length(box.hi - box.lo) / 2, 1e-6);
            eye = target + glm::normalize(from) * (1.05 * radius / std::sin(double(out.yfov) / 2));
        } else {
            if (!item.has("eye") || !item.has("target")) item.fail("there is no \"eye\" or no \"target\"", "give both, or \"frame\"");
            eye = item.vector("eye", dvec3(0)), target = item.vector("target", dvec3(0));
        }
        const auto frame = looking(eye, target);
        if (!frame) item.fail("its target is where it stands", "correct it");
        out.to_world = *frame;
        scene_.cameras.push_back(out);
    }

    const std::string path_;
    uint64_t left_;                            // bytes that parts may still take
    const Item root_;
    std::filesystem::path folder_;
    Scene scene_;
    std::map<std::string, uint32_t> materials_, textures_;  // by name; by path
    uint32_t plain_ = none;
    std::map<ptrdiff_t, uint32_t> replaced_;   // of the part at hand: its material to the scene's
    std::map<size_t, TextureUse> overlaid_;    // likewise: the scene's texture on its material
    std::map<std::string, Box> placed_;        // parts and shapes by name
    Box everything_;
};

}  // namespace

Scene read_recipe(const std::string& path, uint64_t most) {
    const json document = read_json(path);
    return Recipe(path, document, most).make();
}

Imported import_recipe(const std::string& path, const ImportOptions&) {
    Imported out;
    out.scene = read_recipe(path);
    out.crease = 0;
    return out;
}

}  // namespace myriad::scenes::importing
