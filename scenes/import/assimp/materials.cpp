#include "scenes/import/assimp/materials.hpp"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "scenes/gltf/limits.hpp"
#include "scenes/import/apart.hpp"
#include "scenes/import/color.hpp"
#include "scenes/import/assimp/files.hpp"
#include "scenes/import/bytes.hpp"
#include "scenes/import/picture.hpp"

namespace myriad::scenes::importing {
namespace {

constexpr float default_grey = 0.8f;  // of what has no material of its own; Blender's too

float unit(float v) { return std::isfinite(v) ? std::clamp(v, 0.0f, 1.0f) : 0; }

float luminance(const glm::vec3& c) { return glm::dot(c, glm::vec3(0.2126f, 0.7152f, 0.0722f)); }

bool get(const aiMaterial& m, const char* key, unsigned type, unsigned index, aiColor3D& out) { return m.Get(key, type, index, out) == aiReturn_SUCCESS; }
bool get(const aiMaterial& m, const char* key, unsigned type, unsigned index, float& out) {
    return m.Get(key, type, index, out) == aiReturn_SUCCESS && std::isfinite(out);
}

Texture::Wrap wrap(int mode) {
    if (mode == aiTextureMapMode_Mirror) return Texture::Wrap::mirror;
    return mode == aiTextureMapMode_Clamp || mode == aiTextureMapMode_Decal ? Texture::Wrap::clamp : Texture::Wrap::repeat;
}

// (u, v) with v up -> scale, turn, move; as a map of (u, v) with v down, which is what glTF has.
glm::mat3x2 as_gltf(const aiUVTransform& t) {
    const float values[] = {t.mScaling.x, t.mScaling.y, t.mTranslation.x, t.mTranslation.y, t.mRotation};
    if (!std::ranges::all_of(values, [](float v) { return std::isfinite(v) && std::abs(v) < 1e6f; })) return TextureUse().transform;
    const glm::dmat3 scale(t.mScaling.x, 0, 0, 0, t.mScaling.y, 0, 0, 0, 1);
    const double c = std::cos(t.mRotation), s = std::sin(t.mRotation);
    const glm::dmat3 turn(c, s, 0, -s, c, 0, 0, 0, 1), move(1, 0, 0, 0, 1, 0, t.mTranslation.x, t.mTranslation.y, 1), flip(1, 0, 0, 0, -1, 0, 0, 1, 1);
    const glm::dmat3 m = flip * move * turn * scale * flip;
    return {glm::vec2(m[0]), glm::vec2(m[1]), glm::vec2(m[2])};
}

// The texel of `from` at texel (x, y) of a picture of another size.
const uint8_t* texel(const Texture& from, uint32_t x, uint32_t y, uint32_t width, uint32_t height) {
    const uint64_t u = uint64_t(x) * from.width / width, v = uint64_t(y) * from.height / height;
    return &from.rgba[(v * from.width + u) * 4];
}

bool has_alpha(const Texture& texture) {
    for (size_t i = 3; i < texture.rgba.size(); i += 4)
        if (texture.rgba[i] != 255) return true;
    return false;
}

// Whether alpha says "there" or "not there" and hardly anything between.
bool all_or_nothing(const Texture& texture) {
    size_t between = 0;
    for (size_t i = 3; i < texture.rgba.size(); i += 4) between += texture.rgba[i] > 16 && texture.rgba[i] < 239;
    return between <= texture.rgba.size() / 4 / 10;
}

// Height maps come where normal maps do. Those are bluish all over.
bool is_normal_map(const Texture& texture) {
    uint64_t sum[3] = {};
    for (size_t i = 0; i < texture.rgba.size(); i += 4)
        for (int c = 0; c < 3; ++c) sum[c] += texture.rgba[i + size_t(c)];
    const double count = double(texture.rgba.size() / 4), r = double(sum[0]) / count, g = double(sum[1]) / count, b = double(sum[2]) / count;
    return b > 180 && std::abs(r - 127) < 40 && std::abs(g - 127) < 40;
}

std::string list(const std::set<std::string>& names) {
    std::string out;
    size_t shown = 0;
    for (const std::string& name : names) {
        if (++shown > 5) return out + " and " + std::to_string(names.size() - 5) + " more";
        out += (out.empty() ? "" : ", ") + name.substr(0, 100);
    }
    return out;
}

}  // namespace

Materials::Materials(const aiScene& in, Folder& folder, bool linear, Scene& out) : in_(in), folder_(folder), linear_(linear), out_(out) {}

glm::vec3 Materials::color(const aiColor3D& c) const {
    glm::vec3 out(c.r, c.g, c.b);
    for (int i = 0; i < 3; ++i) out[i] = !std::isfinite(out[i]) ? 0 : linear_ || out[i] > 1 ? std::max(out[i], 0.0f) : linear_of_srgb(unit(out[i]));
    return out;
}

const Materials::Picture& Materials::picture(const std::string& name) {
    const aiTexture* embedded = in_.GetEmbeddedTexture(name.c_str());
    const std::string key = embedded ? "*" + std::to_string(reinterpret_cast<uintptr_t>(embedded)) : folder_.find(name);
    const std::string shown = std::filesystem::path(name).filename().string();
    const auto [at, fresh] = pictures_.try_emplace(key);
    Picture& out = at->second;
    if (key.empty()) missing_.insert(name);
    if (key.empty() || !fresh) return out;

    std::string problem;
    const auto decode = [&](std::span<const uint8_t> bytes) {
        if (auto decoded = decode_picture(bytes, problem)) out.texture = std::move(*decoded);
        out.shows_alpha = bytes.size() > 4 && (std::memcmp(bytes.data(), "\x89PNG", 4) == 0 || std::memcmp(bytes.data(), "GIF8", 4) == 0);
    };
    if (embedded && embedded->mHeight == 0) {
        decode({reinterpret_cast<const uint8_t*>(embedded->pcData), embedded->mWidth});
    } else if (embedded) {
        out.texture.width = embedded->mWidth, out.texture.height = embedded->mHeight;
        out.texture.rgba.reserve(size_t(embedded->mWidth) * embedded->mHeight * 4);
        for (size_t i = 0; i < size_t(embedded->mWidth) * embedded->mHeight; ++i) {
            const aiTexel& t = embedded->pcData[i];
            out.texture.rgba.insert(out.texture.rgba.end(), {t.r, t.g, t.b, t.a});
        }
        out.shows_alpha = true;
    } else {
        earn_limits(std::filesystem::file_size(key));
        decode(read_file(key, max_file_bytes));
    }
    out.texture.name = std::filesystem::path(shown).stem().string();
    if (out.texture.rgba.empty()) undecoded_.insert(shown + (problem.empty() ? "" : " (" + problem + ")"));
    return out;
}

Materials::Slot Materials::slot(const aiMaterial& material, std::initializer_list<aiTextureType> types) {
    for (const aiTextureType type : types) {
        aiString name;
        aiTextureMapMode modes[3] = {aiTextureMapMode_Wrap, aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
        unsigned set = 0;
        if (material.GetTexture(type, 0, &name, nullptr, &set, nullptr, nullptr, modes) != aiReturn_SUCCESS || name.length == 0) continue;
        const Picture& found = picture(name.C_Str());
        if (found.texture.rgba.empty()) continue;
        Slot out{&found, {}, wrap(modes[0]), wrap(modes[1])};
        if (set <= 1) out.use.set = set;
        else ++other_sets_;
        aiUVTransform transform;
        if (material.Get(AI_MATKEY_UVTRANSFORM(type, 0), transform) == aiReturn_SUCCESS) out.use.transform = as_gltf(transform);
        return out;
    }
    return {};
}

TextureUse Materials::use(const Slot& slot) { return use(slot, {}, ""); }

// The texture of a slot, or one made of it, once for each wrapping.
TextureUse Materials::use(const Slot& slot, Texture made, const std::string& key) {
    TextureUse out = slot.use;
    const auto unique = std::tuple(std::to_string(reinterpret_cast<uintptr_t>(slot.picture)) + key, int(slot.wrap_u), int(slot.wrap_v));
    const auto [at, fresh] = textures_.try_emplace(unique, uint32_t(out_.textures.size()));
    out.texture = at->second;
    if (!fresh) return out;
    Texture texture = made.rgba.empty() ? slot.picture->texture : std::move(made);
    texture.wrap_u = slot.wrap_u, texture.wrap_v = slot.wrap_v;
    out_.textures.push_back(std::move(texture));
    return out;
}

// The base colour's texture, with alpha from wherever it is.
void Materials::add_alpha(const aiMaterial& material, Material& out, const Slot& base) {
    float opacity = 1;
    get(material, AI_MATKEY_OPACITY, opacity);
    out.base_color.a = unit(opacity);
    if (out.base_color.a < 0.999f) out.alpha = Material::Alpha::blend;

    Slot mask = slot(material, {aiTextureType_OPACITY});
    if (!mask && !base) return;
    const bool own_alpha = base && base.picture->shows_alpha && has_alpha(base.picture->texture);
    if (!mask || (base && mask.picture == base.picture && own_alpha)) {
        Texture texture = base.picture->texture;
        if (own_alpha) {
            if (out.alpha == Material::Alpha::opaque) out.alpha = all_or_nothing(texture) ? Material::Alpha::mask : Material::Alpha::blend;
        } else {
            for (size_t i = 3; i < texture.rgba.size(); i += 4) texture.rgba[i] = 255;
        }
        out.base_color_texture = use(base, std::move(texture), " colour");
        return;
    }
    // Two pictures as one, in the size of the larger; the mask is laid as the colour is.
    const Texture& cover = mask.picture->texture;
    const Slot& laid = base ? base : mask;
    const bool by_alpha = has_alpha(cover);
    Texture made;
    made.name = base ? base.picture->texture.name : cover.name;
    made.width = std::max(cover.width, base ? base.picture->texture.width : 0);
    made.height = std::max(cover.height, base ? base.picture->texture.height : 0);
    made.rgba.reserve(size_t(made.width) * made.height * 4);
    constexpr uint8_t white[4] = {255, 255, 255, 255};
    for (uint32_t y = 0; y < made.height; ++y)
        for (uint32_t x = 0; x < made.width; ++x) {
            const uint8_t* c = base ? texel(base.picture->texture, x, y, made.width, made.height) : white;
            const uint8_t* m = texel(cover, x, y, made.width, made.height);
            made.rgba.insert(made.rgba.end(), {c[0], c[1], c[2], by_alpha ? m[3] : uint8_t((m[0] + m[1] + m[2]) / 3)});
        }
    if (out.alpha == Material::Alpha::opaque) out.alpha = all_or_nothing(made) ? Material::Alpha::mask : Material::Alpha::blend;
    out.base_color_texture = use(laid, std::move(made), " alpha " + std::to_string(reinterpret_cast<uintptr_t>(mask.picture)));
}

void Materials::add_metal_and_roughness(const aiMaterial& material, Material& out) {
    out.metallic = 0;
    float metallic = 0, roughness = 0, exponent = 0;
    if (get(material, AI_MATKEY_METALLIC_FACTOR, metallic)) out.metallic = unit(metallic);
    if (get(material, AI_MATKEY_ROUGHNESS_FACTOR, roughness)) out.roughness = unit(roughness);
    else if (get(material, AI_MATKEY_SHININESS, exponent) && exponent >= 0) out.roughness = std::pow(2 / (exponent + 2), 0.25f);

    const Slot metal = slot(material, {aiTextureType_METALNESS}), rough = slot(material, {aiTextureType_DIFFUSE_ROUGHNESS});
    if (!metal && !rough) return;
    const Slot& laid = rough ? rough : metal;
    const auto side = [&](auto member) { return std::max(metal ? metal.picture->texture.*member : 0, rough ? rough.picture->texture.*member : 0); };
    Texture made;
    made.name = laid.picture->texture.name;
    made.width = side(&Texture::width), made.height = side(&Texture::height);
    made.rgba.reserve(size_t(made.width) * made.height * 4);
    for (uint32_t y = 0; y < made.height; ++y)
        for (uint32_t x = 0; x < made.width; ++x) {
            // One picture for both has them in glTF's channels; of two, each is grey.
            const int channel = metal.picture == rough.picture ? 1 : 0;
            const uint8_t r = rough ? texel(rough.picture->texture, x, y, made.width, made.height)[channel] : 255;
            const uint8_t m = metal ? texel(metal.picture->texture, x, y, made.width, made.height)[2 * channel] : 255;
            made.rgba.insert(made.rgba.end(), {0, r, m, 255});
        }
    if (metal) out.metallic = 1;
    if (rough) out.roughness = 1;
    out.metallic_roughness_texture = use(laid, std::move(made), " metal " + std::to_string(reinterpret_cast<uintptr_t>(metal.picture)));
}

void Materials::add(const aiMaterial& material, bool has_colors) {
    Material out;
    aiString name;
    if (material.Get(AI_MATKEY_NAME, name) == aiReturn_SUCCESS) out.name = name.C_Str();
    out.double_sided = true;
    add_metal_and_roughness(material, out);

    const Slot base = slot(material, {aiTextureType_BASE_COLOR, aiTextureType_DIFFUSE});
    aiColor3D diffuse(default_grey), specular;
    const bool pbr = get(material, AI_MATKEY_BASE_COLOR, diffuse), given = pbr || get(material, AI_MATKEY_COLOR_DIFFUSE, diffuse);
    glm::vec3 albedo = color(diffuse);
    if (!given || out.name == AI_DEFAULT_MATERIAL_NAME) albedo = glm::vec3(has_colors || base ? 1 : default_grey), out.roughness = 1;
    else if (base && !pbr && luminance(albedo) == 0) albedo = glm::vec3(1);  // exporters leave black where the texture is all
    if (!base && !pbr && luminance(albedo) < 0.02f && get(material, AI_MATKEY_COLOR_SPECULAR, specular) && luminance(color(specular)) > 0.2f)
        albedo = color(specular), out.metallic = 1;
    out.base_color = glm::vec4(glm::min(albedo, glm::vec3(1)), 1);
    add_alpha(material, out, base);

    aiColor3D emissive(0, 0, 0);
    float strength = 1;
    get(material, AI_MATKEY_COLOR_EMISSIVE, emissive);
    get(material, AI_MATKEY_EMISSIVE_INTENSITY, strength);
    out.emissive = glm::min(color(emissive) * std::max(strength, 0.0f), glm::vec3(float(gltf::limits::light)));
    if (const Slot glow = slot(material, {aiTextureType_EMISSION_COLOR, aiTextureType_EMISSIVE})) {
        out.emissive_texture = use(glow);
        if (out.emissive == glm::vec3(0)) out.emissive = glm::vec3(1);
    }
    if (const Slot normals = slot(material, {aiTextureType_NORMALS, aiTextureType_NORMAL_CAMERA, aiTextureType_HEIGHT})) {
        if (is_normal_map(normals.picture->texture)) out.normal_texture = use(normals);
        else ++bumps_;
    }
    out_.materials.push_back(std::move(out));
}

void Materials::report(std::vector<std::string>& warnings) const {
    const auto say = [&](size_t count, const std::string& what) {
        if (count) warnings.push_back(std::to_string(count) + " " + what + ".");
    };
    say(missing_.size(), "textures are not in the scene's folder and were left out: " + list(missing_));
    say(undecoded_.size(), "textures cannot be decoded and were left out: " + list(undecoded_));
    say(bumps_, "materials have a bump map, which was left out; normal maps are kept");
    say(other_sets_, "textures on a third set of coordinates or beyond are mapped by the first");
}

}  // namespace myriad::scenes::importing
