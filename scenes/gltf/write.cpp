#include "scenes/gltf/write.hpp"

#include <algorithm>
#include <array>
#include <cassert>
#include <charconv>
#include <cmath>
#include <deque>
#include <limits>
#include <map>
#include <set>

#include <glm/gtc/matrix_access.hpp>
#include <glm/gtc/type_ptr.hpp>
#include <nlohmann/json.hpp>
#include <png.h>

#include "engine/error.hpp"
#include "scenes/gltf/nodes.hpp"
#include "scenes/gltf/rotation_scale.hpp"

namespace myriad::scenes {
namespace {

using Json = nlohmann::ordered_json;
using Bytes = std::vector<uint8_t>;

enum : int { u16 = 5123, u32 = 5125, f32 = 5126, vertices = 34962, elements = 34963 };

// The double whose shortest text is that of the float, so that JSON says 0.1 and not 0.10000000149011612.
double number(float value) {
    char text[32];
    const auto end = std::to_chars(text, text + sizeof text, value).ptr;
    double out = 0;
    std::from_chars(text, end, out);
    return float(out) == value ? out : double(value);
}

template <class Vector>
Json numbers(const Vector& v) {
    Json out = Json::array();
    for (int i = 0; i < v.length(); ++i) {
        if constexpr (std::is_same_v<typename Vector::value_type, float>) out.push_back(number(v[i]));
        else out.push_back(v[i]);
    }
    return out;
}

Json numbers(const glm::dquat& q) { return {q.x, q.y, q.z, q.w}; }

bool finite(const float* values, size_t count) {
    return std::all_of(values, values + count, [](float v) { return std::isfinite(v); });
}

bool opaque(const Texture& texture) {
    for (size_t i = 3; i < texture.rgba.size(); i += 4)
        if (texture.rgba[i] != 255) return false;
    return true;
}

// libpng's simplified interface: it keeps its errors to itself. Alpha is stored only where there is some.
Bytes png(const Texture& texture, const std::string& place, bool quick) {
    assert(texture.rgba.size() == size_t(texture.width) * texture.height * 4);
    const std::string cannot = place + "texture \"" + texture.name + "\" cannot be written: ";
    if (texture.rgba.empty()) throw InputError(cannot + "it has no pixels; give it some.");
    png_image image{};
    image.version = PNG_IMAGE_VERSION;
    image.width = texture.width;
    image.height = texture.height;
    if (quick) image.flags |= PNG_IMAGE_FLAG_FAST;
    Bytes rgb;
    const bool without_alpha = opaque(texture);
    if (without_alpha) {
        rgb.reserve(texture.rgba.size() / 4 * 3);
        for (size_t i = 0; i < texture.rgba.size(); i += 4) rgb.insert(rgb.end(), {texture.rgba[i], texture.rgba[i + 1], texture.rgba[i + 2]});
    }
    const Bytes& pixels = without_alpha ? rgb : texture.rgba;
    image.format = without_alpha ? PNG_FORMAT_RGB : PNG_FORMAT_RGBA;
    if (pixels.size() > 0x7fffffff) throw InputError(cannot + "PNG ends at 2^31 bytes of pixels; scale it down.");
    png_alloc_size_t size = PNG_IMAGE_PNG_SIZE_MAX(image);  // instead of the exact size, which takes compressing twice
    Bytes out(size);
    const bool ok = png_image_write_to_memory(&image, out.data(), &size, 0, pixels.data(), 0, nullptr);
    const std::string problem = image.message;
    png_image_free(&image);
    if (!ok) throw InputError(cannot + problem + "; scale it down.");
    out.resize(size);
    out.shrink_to_fit();
    return out;
}

// The document, and the pieces of the binary chunk in order: geometry is written from where it lies in the scene.
class Document {
public:
    Document(const Scene& scene, const GlbOptions& options) : scene_(scene), options_(options), place_(scene.name.empty() ? "" : scene.name + ": ") {
        json_["asset"] = {{"version", "2.0"}, {"generator", "Myriad"}};
        add_textures();
        add_materials();
        add_meshes();
        add_nodes();
        add_skins();
        add_clips();
        if (bin_size_) json_["buffers"] = Json::array({Json{{"byteLength", bin_size_}}});
        if (!extensions_.empty()) json_["extensionsUsed"] = extensions_;
    }

    void write(const Sink& sink) const {
        const auto padded = [](size_t n) { return (n + 3) & ~size_t(3); };
        std::string json = json_.dump(-1, ' ', false, Json::error_handler_t::replace);  // names may be no UTF-8
        json.resize(padded(json.size()), ' ');
        const size_t bin = padded(bin_size_), total = 20 + json.size() + (bin ? 8 + bin : 0);
        if (total > std::numeric_limits<uint32_t>::max())
            throw InputError(place_ + "the scene takes " + std::to_string(total >> 20) + " MiB, and .glb ends at 4096; give it coarser meshes.");
        const auto words = [&](std::initializer_list<uint32_t> w) { sink(w.begin(), w.size() * sizeof(uint32_t)); };
        words({0x46546C67, 2, uint32_t(total), uint32_t(json.size()), 0x4E4F534A});
        sink(json.data(), json.size());
        if (!bin) return;
        words({uint32_t(bin), 0x004E4942});
        constexpr uint8_t zeros[4] = {};
        for (const Piece& piece : pieces_) {
            sink(piece.data, piece.size);
            if (const size_t gap = padded(piece.size) - piece.size) sink(zeros, gap);
        }
    }

private:
    struct Piece {
        const void* data;
        size_t size;
    };

    [[noreturn]] void fail(const std::string& what, const std::string& cure) const { throw InputError(place_ + what + "; " + cure + "."); }

    Json& use_extension(Json& object, const char* name) {
        extensions_.insert(name);
        return object["extensions"][name] = Json::object();
    }

    size_t add_view(const void* data, size_t size, int target) {
        bin_size_ = (bin_size_ + 3) & ~size_t(3);
        Json view = {{"buffer", 0}, {"byteOffset", bin_size_}, {"byteLength", size}};
        if (target) view["target"] = target;
        json_["bufferViews"].push_back(std::move(view));
        pieces_.push_back({data, size});
        bin_size_ += size;
        return json_["bufferViews"].size() - 1;
    }

    size_t add_owned(Bytes bytes, int target) {
        owned_.push_back(std::move(bytes));
        return add_view(owned_.back().data(), owned_.back().size(), target);
    }

    size_t add_accessor(Json accessor) {
        json_["accessors"].push_back(std::move(accessor));
        return json_["accessors"].size() - 1;
    }

    // ---- textures and materials

    void add_textures() {
        std::vector<std::pair<Texture::Wrap, Texture::Wrap>> samplers;
        const auto mode = [](Texture::Wrap wrap) { return wrap == Texture::Wrap::clamp ? 33071 : wrap == Texture::Wrap::mirror ? 33648 : 10497; };
        for (const Texture& in : scene_.textures) {
            const std::pair wraps(in.wrap_u, in.wrap_v);
            const size_t sampler = size_t(std::ranges::find(samplers, wraps) - samplers.begin());
            if (sampler == samplers.size()) {
                samplers.push_back(wraps);
                json_["samplers"].push_back({{"wrapS", mode(in.wrap_u)}, {"wrapT", mode(in.wrap_v)}});
            }
            Json image = {{"bufferView", add_owned(png(in, place_, options_.quick), 0)}, {"mimeType", "image/png"}};
            Json texture = {{"sampler", sampler}, {"source", json_["images"].size()}};
            if (!in.name.empty()) image["name"] = texture["name"] = in.name;
            json_["images"].push_back(std::move(image));
            json_["textures"].push_back(std::move(texture));
        }
    }

    // KHR_texture_transform: scale, then turn counter-clockwise as seen on the image, whose v points down, then offset.
    Json texture_use(const Material& material, const TextureUse& use) {
        assert(use.texture < scene_.textures.size());
        Json out = {{"index", use.texture}};
        if (use.set) out["texCoord"] = use.set;
        const glm::mat3x2& m = use.transform;
        if (m == TextureUse().transform) return out;
        const std::string name = "a texture transform of material \"" + material.name + "\"";
        if (!finite(glm::value_ptr(m), 6)) fail(name + " is not finite", "correct it");
        const glm::dvec2 u(m[0]), v(m[1]);
        const double angle = u != glm::dvec2(0) ? std::atan2(-u.y, u.x) : std::atan2(v.x, v.y);
        const glm::dvec2 along(std::cos(angle), -std::sin(angle)), across(-along.y, along.x);
        if (std::abs(glm::dot(v, along)) > 1e-5 * glm::length(v)) fail(name + " shears, which glTF cannot say", "leave the shear out");
        Json& transform = use_extension(out, "KHR_texture_transform");
        if (m[2] != glm::vec2(0)) transform["offset"] = numbers(m[2]);
        if (angle != 0) transform["rotation"] = angle;
        const bool upright = angle == 0;  // then the scale is there to the bit
        transform["scale"] = upright ? numbers(glm::vec2(m[0].x, m[1].y)) : numbers(glm::dvec2(glm::dot(u, along), glm::dot(v, across)));
        return out;
    }

    void add_materials() {
        for (const Material& in : scene_.materials) {
            const float values[] = {in.base_color.r, in.base_color.g, in.base_color.b, in.base_color.a, in.metallic, in.roughness,
                                    in.emissive.r, in.emissive.g, in.emissive.b, in.normal_scale, in.alpha_cutoff};
            if (!finite(values, std::size(values))) fail("material \"" + in.name + "\" has a number that is not finite", "correct it");
            Json out = Json::object(), pbr = Json::object();
            if (!in.name.empty()) out["name"] = in.name;
            const auto texture = [&](Json& object, const char* key, const TextureUse& use) {
                if (use.texture != none) object[key] = texture_use(in, use);
                return use.texture != none;
            };
            if (in.base_color != glm::vec4(1)) pbr["baseColorFactor"] = numbers(in.base_color);
            if (in.metallic != 1) pbr["metallicFactor"] = number(in.metallic);
            if (in.roughness != 1) pbr["roughnessFactor"] = number(in.roughness);
            texture(pbr, "baseColorTexture", in.base_color_texture);
            texture(pbr, "metallicRoughnessTexture", in.metallic_roughness_texture);
            if (!pbr.empty()) out["pbrMetallicRoughness"] = std::move(pbr);
            if (texture(out, "normalTexture", in.normal_texture) && in.normal_scale != 1) out["normalTexture"]["scale"] = number(in.normal_scale);
            texture(out, "emissiveTexture", in.emissive_texture);
            add_emission(out, in);
            if (in.alpha != Material::Alpha::opaque) out["alphaMode"] = in.alpha == Material::Alpha::mask ? "MASK" : "BLEND";
            if (in.alpha == Material::Alpha::mask && in.alpha_cutoff != 0.5f) out["alphaCutoff"] = number(in.alpha_cutoff);
            if (in.double_sided) out["doubleSided"] = true;
            if (in.unlit) use_extension(out, "KHR_materials_unlit");
            json_["materials"].push_back(std::move(out));
        }
    }

    // Factors end at 1. The strength beyond is a power of two, so that factor times strength is exact.
    void add_emission(Json& out, const Material& in) {
        if (in.emissive == glm::vec3(0)) return;
        const float greatest = std::max({in.emissive.r, in.emissive.g, in.emissive.b});
        const float strength = greatest > 1 ? std::exp2(std::ceil(std::log2(greatest))) : 1;
        out["emissiveFactor"] = numbers(in.emissive / strength);
        if (strength != 1) use_extension(out, "KHR_materials_emissive_strength")["emissiveStrength"] = number(strength);
    }

    // ---- meshes

    template <class Vector>
    size_t add_attribute(const std::string& name, const std::vector<Vector>& values, bool bounds = false) {
        constexpr size_t length = size_t(Vector::length());
        static_assert(sizeof(Vector) == length * sizeof(float));
        if (!finite(&values[0].x, values.size() * length)) fail(name + " has a number that is not finite", "drop or repair its vertices");
        Json out = {{"bufferView", add_view(values.data(), values.size() * sizeof(Vector), vertices)}, {"componentType", f32}};
        out["count"] = values.size();
        out["type"] = "VEC" + std::to_string(length);
        if (bounds) {
            Vector lo = values[0], hi = values[0];
            for (const Vector& v : values) lo = glm::min(lo, v), hi = glm::max(hi, v);
            out["min"] = numbers(lo);
            out["max"] = numbers(hi);
        }
        return add_accessor(std::move(out));
    }

    // Two bytes an index where they do: 65535 is kept from use by the specification.
    size_t add_indices(const Primitive& in) {
        const bool narrow = in.positions.size() <= 65535;
        size_t view = 0;
        if (narrow) {
            Bytes bytes(in.indices.size() * 2);
            for (size_t i = 0; i < in.indices.size(); ++i) bytes[2 * i] = uint8_t(in.indices[i]), bytes[2 * i + 1] = uint8_t(in.indices[i] >> 8);
            view = add_owned(std::move(bytes), elements);
        } else {
            view = add_view(in.indices.data(), in.indices.size() * sizeof(uint32_t), elements);
        }
        return add_accessor({{"bufferView", view}, {"componentType", narrow ? u16 : u32}, {"count", in.indices.size()}, {"type", "SCALAR"}});
    }

    Json primitive(const std::string& name, const Primitive& in) {
        const size_t count = in.positions.size();
        for ([[maybe_unused]] const size_t size : {in.normals.size(), in.tangents.size(), in.texcoords.size(), in.texcoords1.size(), in.colors.size()})
            assert(size == 0 || size == count);
        assert(in.material < scene_.materials.size() && in.indices.size() % 3 == 0);
        assert(std::ranges::all_of(in.indices, [&](uint32_t i) { return i < count; }));
        Json attributes = {{"POSITION", add_attribute("a position of " + name, in.positions, true)}};
        if (!in.normals.empty()) attributes["NORMAL"] = add_attribute("a normal of " + name, in.normals);
        if (!in.tangents.empty() && !in.normals.empty() && !in.texcoords.empty())
            attributes["TANGENT"] = add_attribute("a tangent of " + name, in.tangents);
        if (!in.texcoords.empty()) attributes["TEXCOORD_0"] = add_attribute("a texture coordinate of " + name, in.texcoords);
        if (!in.texcoords1.empty()) {  // set 1 has to follow a set 0
            if (in.texcoords.empty()) attributes["TEXCOORD_0"] = add_zeros(count);
            attributes["TEXCOORD_1"] = add_attribute("a texture coordinate of " + name, in.texcoords1);
        }
        if (!in.colors.empty()) attributes["COLOR_0"] = add_attribute("a colour of " + name, in.colors);
        for (int set = 0; set < 2 && !in.joints[set].empty(); ++set) {
            assert(in.joints[set].size() == count && in.joint_weights[set].size() == count);
            const size_t view = add_view(in.joints[set].data(), count * sizeof(glm::u16vec4), vertices);
            attributes["JOINTS_" + std::to_string(set)] = add_accessor({{"bufferView", view}, {"componentType", u16}, {"count", count}, {"type", "VEC4"}});
            attributes["WEIGHTS_" + std::to_string(set)] = add_attribute("a joint's weight of " + name, in.joint_weights[set]);
        }
        Json out = {{"attributes", std::move(attributes)}, {"indices", add_indices(in)}, {"material", in.material}};
        for (const MorphTarget& target : in.targets) out["targets"].push_back(morph_target(name, target, count));
        return out;
    }

    // A target in which nothing moves has positions all the same, for an empty one is not valid: zeros, which take no bytes.
    Json morph_target(const std::string& name, const MorphTarget& in, size_t count) {
        Json out = Json::object();
        if (!in.positions.empty()) out["POSITION"] = add_attribute("a morph target of " + name, in.positions, true);
        else out["POSITION"] = add_accessor({{"componentType", f32}, {"count", count}, {"type", "VEC3"}, {"min", {0, 0, 0}}, {"max", {0, 0, 0}}});
        if (!in.normals.empty()) out["NORMAL"] = add_attribute("a morph target of " + name, in.normals);
        return out;
    }

    size_t add_zeros(size_t count) {
        const size_t view = add_owned(Bytes(count * 8), vertices);
        return add_accessor({{"bufferView", view}, {"componentType", f32}, {"count", count}, {"type", "VEC2"}});
    }

    void add_meshes() {
        mesh_numbers_.assign(scene_.meshes.size(), none);
        for (size_t m = 0; m < scene_.meshes.size(); ++m) {
            const Mesh& in = scene_.meshes[m];
            Json primitives = Json::array();
            for (const Primitive& p : in.primitives)
                if (!p.indices.empty()) primitives.push_back(primitive("mesh \"" + in.name + "\"", p));
            if (primitives.empty()) continue;
            Json out = Json::object();
            if (!in.name.empty()) out["name"] = in.name;
            out["primitives"] = std::move(primitives);
            mesh_numbers_[m] = uint32_t(json_["meshes"].size());
            json_["meshes"].push_back(std::move(out));
        }
    }

    // ---- nodes

    // Adds nodes that have the transform, and `content` in the innermost.
    void add_node(const std::string& name, const std::string& what, const glm::mat4& to_world, Json content) {
        if (!finite(glm::value_ptr(to_world), 16)) fail("the transform of " + what + " \"" + name + "\" is not finite", "correct it");
        Json outer = Json::object();
        if (!name.empty()) outer["name"] = name;
        const glm::dmat3 linear(to_world);
        const bool affine = glm::row(to_world, 3) == glm::vec4(0, 0, 0, 1);
        if (!affine) fail("the transform of " + what + " \"" + name + "\" has a perspective part", "give it a last row of 0 0 0 1");
        if (gltf::at_right_angles(linear)) {
            if (to_world != glm::mat4(1)) {
                outer["matrix"] = Json::array();
                for (int i = 0; i < 16; ++i) outer["matrix"].push_back(number(glm::value_ptr(to_world)[i]));
            }
        } else {
            const gltf::RotationScale parts = gltf::rotation_scale(linear);
            outer["translation"] = numbers(glm::vec3(to_world[3]));
            outer["rotation"] = numbers(parts.outer);
            outer["scale"] = numbers(parts.scale);
            content["rotation"] = numbers(parts.inner);
            nodes_.push_back(std::move(content));
            content = {{"children", Json::array({nodes_.size() - 1})}};
        }
        outer.update(content);
        nodes_.push_back(std::move(outer));
        roots_.push_back(nodes_.size() - 1);
    }

    // The scene's own nodes come first, under their own numbers; what hangs from them is added later.
    void add_hierarchy() {
        for (const Node& in : scene_.nodes) {
            const std::string name = "node \"" + in.name + "\"";
            const double values[] = {in.rest.translation.x, in.rest.translation.y, in.rest.translation.z, in.rest.rotation.x, in.rest.rotation.y,
                                     in.rest.rotation.z, in.rest.rotation.w, in.rest.scale.x, in.rest.scale.y, in.rest.scale.z};
            if (!std::ranges::all_of(values, [](double v) { return std::isfinite(v); })) fail("the transform of " + name + " is not finite", "correct it");
            Json out = Json::object();
            if (!in.name.empty()) out["name"] = in.name;
            if (in.matrix) {
                for (int i = 0; i < 16; ++i) out["matrix"].push_back(glm::value_ptr(*in.matrix)[i]);
            } else {
                if (in.rest.translation != glm::dvec3(0)) out["translation"] = numbers(in.rest.translation);
                if (in.rest.rotation != glm::dquat(1, 0, 0, 0)) out["rotation"] = numbers(in.rest.rotation);
                if (in.rest.scale != glm::dvec3(1)) out["scale"] = numbers(in.rest.scale);
            }
            if (in.parent != none) nodes_[in.parent]["children"].push_back(nodes_.size());
            nodes_.push_back(std::move(out));
        }
    }

    // Roots of the scene's own nodes up to the one that `node` is below: in their order, between instances that stand still.
    void add_roots(uint32_t node) {
        while (scene_.nodes[node].parent != none) node = scene_.nodes[node].parent;
        for (; next_root_ <= node; ++next_root_)
            if (scene_.nodes[next_root_].parent == none) roots_.push_back(next_root_);
    }

    // At its node, or where it stands.
    void add_instance(const Instance& in) {
        if (in.node == none) return add_node(scene_.meshes[in.mesh].name, "an instance of mesh", in.to_world, {{"mesh", mesh_numbers_[in.mesh]}});
        Json& node = nodes_[in.node];
        assert(!node.contains("mesh"));
        add_roots(in.node);
        node["mesh"] = mesh_numbers_[in.mesh];
        if (in.skin != none) node["skin"] = in.skin;
        for (const float weight : scene_.nodes[in.node].weights) node["weights"].push_back(number(weight));
    }

    void add_skins() {
        for (const Skin& in : scene_.skins) {
            assert(in.joints.size() == in.inverse_bind.size() && !in.joints.empty());
            const size_t floats = 16 * in.joints.size();
            if (!finite(&in.inverse_bind[0][0].x, floats)) fail("skin \"" + in.name + "\" has a matrix that is not finite", "correct it");
            Json out = Json::object();
            if (!in.name.empty()) out["name"] = in.name;
            out["joints"] = in.joints;
            out["inverseBindMatrices"] = add_accessor({{"bufferView", add_view(in.inverse_bind.data(), floats * sizeof(float), 0)},
                                                       {"componentType", f32}, {"count", in.joints.size()}, {"type", "MAT4"}});
            json_["skins"].push_back(std::move(out));
        }
    }

    // Accessor over floats of a track.
    size_t add_floats(const std::vector<float>& values, int width, bool bounds) {
        Json out = {{"bufferView", add_view(values.data(), values.size() * sizeof(float), 0)}, {"componentType", f32}};
        out["count"] = values.size() / size_t(width);
        out["type"] = width == 1 ? "SCALAR" : "VEC" + std::to_string(width);
        if (bounds) out["min"] = {number(values.front())}, out["max"] = {number(values.back())};
        return add_accessor(std::move(out));
    }

    void add_clips() {
        constexpr const char* interpolations[] = {"STEP", "LINEAR", "CUBICSPLINE"};
        constexpr const char* paths[] = {"translation", "rotation", "scale", "weights"};
        std::map<std::vector<float>, size_t> times;  // many tracks share theirs
        for (const Clip& in : scene_.clips) {
            if (in.channels.empty()) continue;  // glTF wants at least one
            Json out = Json::object();
            if (!in.name.empty()) out["name"] = in.name;
            std::vector<bool> weights(in.tracks.size());
            for (const Channel& channel : in.channels) {
                if (channel.path == Path::weights) weights[channel.track] = true;
                out["channels"].push_back({{"sampler", channel.track}, {"target", {{"node", channel.node}, {"path", paths[size_t(channel.path)]}}}});
            }
            for (size_t t = 0; t < in.tracks.size(); ++t) {
                const Track& track = in.tracks[t];
                if (!finite(track.values.data(), track.values.size()) || !finite(track.times.data(), track.times.size()))
                    fail("animation \"" + in.name + "\" has a key that is not finite", "correct it");
                const auto [at, fresh] = times.try_emplace(track.times, 0);
                if (fresh) at->second = add_floats(track.times, 1, true);
                out["samplers"].push_back({{"input", at->second}, {"interpolation", interpolations[size_t(track.interpolation)]},
                                           {"output", add_floats(track.values, weights[t] ? 1 : int(track.width), false)}});
            }
            json_["animations"].push_back(std::move(out));
        }
    }

    void add_cameras() {
        for (const Camera& in : scene_.cameras) {
            if (!(in.yfov > 0 && in.yfov < 3.14159f)) fail("the angle of camera \"" + in.name + "\" is not between 0 and pi", "correct it");
            Json camera = {{"type", "perspective"}, {"perspective", {{"yfov", number(in.yfov)}, {"znear", 0.01}}}};
            if (!in.name.empty()) camera["name"] = in.name;
            json_["cameras"].push_back(std::move(camera));
            if (in.node != none) {
                nodes_[in.node]["camera"] = json_["cameras"].size() - 1;
                continue;
            }
            // A camera has a place and a direction: what may have scaled it is gone.
            glm::mat4 to_world = in.to_world;
            if (!gltf::at_right_angles(glm::dmat3(to_world))) {
                const gltf::RotationScale parts = gltf::rotation_scale(glm::dmat3(to_world));
                to_world = glm::mat4(glm::mat4_cast(parts.outer * parts.inner));
                to_world[3] = in.to_world[3];
            }
            add_node(in.name, "camera", to_world, {{"camera", json_["cameras"].size() - 1}});
        }
    }

    void add_lights() {
        if (scene_.lights.empty()) return;
        constexpr const char* extension = "KHR_lights_punctual";
        Json lights = Json::array();
        for (const Light& in : scene_.lights) {
            const std::string name = "light \"" + in.name + "\"";
            if (!finite(&in.position.x, 3) || !finite(&in.direction.x, 3) || !finite(&in.intensity.x, 3) || glm::length(in.direction) == 0)
                fail(name + " has a number that is not finite, or no direction", "correct it");
            if (glm::any(glm::lessThan(in.intensity, glm::vec3(0)))) fail(name + " has a negative intensity", "correct it");
            Json light = {{"type", in.type == Light::Type::spot ? "spot" : in.type == Light::Type::point ? "point" : "directional"}};
            if (!in.name.empty()) light["name"] = in.name;
            const float greatest = std::max({in.intensity.r, in.intensity.g, in.intensity.b});
            if (greatest > 0) light["color"] = numbers(glm::dvec3(in.intensity) / double(greatest));
            light["intensity"] = number(greatest);
            if (in.type == Light::Type::spot) {
                // The specification wants the inner cone inside of the outer one, not equal to it.
                if (!(in.outer_cone > 0 && in.outer_cone <= 1.5707964f && in.inner_cone >= 0 && in.inner_cone <= in.outer_cone))
                    fail(name + " has cones that are not 0 <= inner <= outer <= pi/2", "correct them");
                const float inner = std::min(in.inner_cone, std::nextafter(in.outer_cone, 0.0f));
                light["spot"] = {{"innerConeAngle", number(inner)}, {"outerConeAngle", number(std::min(in.outer_cone, 1.5707963f))}};
            }
            if (in.node != none) {
                use_extension(nodes_[in.node], extension)["light"] = lights.size();
                lights.push_back(std::move(light));
                continue;
            }
            Json node = Json::object();
            if (!in.name.empty()) node["name"] = in.name;
            if (in.position != glm::vec3(0)) node["translation"] = numbers(in.position);
            node["rotation"] = numbers(gltf::aim(glm::normalize(glm::dvec3(in.direction))));
            use_extension(node, extension)["light"] = lights.size();
            lights.push_back(std::move(light));
            nodes_.push_back(std::move(node));
            roots_.push_back(nodes_.size() - 1);
        }
        json_["extensions"][extension]["lights"] = std::move(lights);
    }

    void add_nodes() {
        add_hierarchy();
        for (const Instance& in : scene_.instances) {
            assert(in.mesh < scene_.meshes.size());
            if (mesh_numbers_[in.mesh] != none) add_instance(in);
        }
        for (uint32_t i = 0; i < scene_.nodes.size(); ++i) add_roots(i);
        add_cameras();
        add_lights();
        Json scene = Json::object();
        if (!nodes_.empty()) {
            scene["nodes"] = std::move(roots_);
            json_["nodes"] = std::move(nodes_);
        }
        const glm::vec3& background = scene_.background;
        if (background != glm::vec3(0)) {
            if (!finite(&background.x, 3) || glm::any(glm::lessThan(background, glm::vec3(0)))) fail("the background is negative or not finite", "correct it");
            scene["extras"][gltf::background_extra] = numbers(background);
        }
        json_["scene"] = 0;
        json_["scenes"] = Json::array({std::move(scene)});
    }

    const Scene& scene_;
    const GlbOptions options_;
    const std::string place_;  // what each message starts with
    Json json_ = Json::object(), nodes_ = Json::array(), roots_ = Json::array();
    std::set<std::string> extensions_;
    uint32_t next_root_ = 0;              // of scene_.nodes: those before are in roots_, if they are roots
    std::vector<uint32_t> mesh_numbers_;  // a scene's mesh to a file's, or none
    std::vector<Piece> pieces_;
    std::deque<Bytes> owned_;  // what pieces_ points at and the scene does not hold
    size_t bin_size_ = 0;
};

}  // namespace

void write_glb(const Scene& scene, const Sink& sink, const GlbOptions& options) { Document(scene, options).write(sink); }

std::string glb_bytes(const Scene& scene, const GlbOptions& options) {
    std::string out;
    write_glb(scene, [&](const void* bytes, size_t count) { out.append(static_cast<const char*>(bytes), count); }, options);
    return out;
}

}  // namespace myriad::scenes
