// Materials' textures: how they are used, and in which forms images come.
#include <cmath>

#include "scenes/gltf_kit.hpp"

namespace myriad::scenes {
namespace {

using glm::vec2;

// A PNG of 2 x 1: red, then a grey of 128.
const char* const png = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAAD0lEQVR42mP4z8DQ0NAAAAkBAoAgv9V1AAAAAElFTkSuQmCC";

class GltfTextures : public Gltf {
protected:
    void SetUp() override {
        Gltf::SetUp();
        square();
        add_texcoords();
        primitive()["material"] = 0;
        doc["images"] = {{{"uri", png}}};
        doc["textures"] = {{{"source", 0}}};
        doc["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    }
    json& material() { return doc["materials"][0]; }
    json& base_color() { return material()["pbrMetallicRoughness"]["baseColorTexture"]; }
    Material read_material() { return read().materials.at(0); }
};

void expect_maps(const TextureUse& use, const vec2& from, const vec2& to) {
    const vec2 got = use.transform * vec3(from, 1);
    EXPECT_NEAR(got.x, to.x, 1e-5f) << from.x << ", " << from.y;
    EXPECT_NEAR(got.y, to.y, 1e-5f) << from.x << ", " << from.y;
}

TEST_F(GltfTextures, Transform) {
    expect_maps(read_material().base_color_texture, {0.3f, 0.4f}, {0.3f, 0.4f});
    auto& transform = base_color()["extensions"]["KHR_texture_transform"];
    transform = json::object();
    expect_maps(read_material().base_color_texture, {0.3f, 0.4f}, {0.3f, 0.4f});
    transform = {{"offset", {0, 1}}, {"scale", {1, -1}}};  // the extension's own example: inverts the T axis
    expect_maps(read_material().base_color_texture, {0.3f, 0.4f}, {0.3f, 0.6f});
    // Its other example: the lower left quadrant of the image, turned clockwise by a quarter. So the image's lower left
    // corner, (0, 1), shows at the upper left, which is (0, 0); its centre at the lower right.
    transform = {{"offset", {0, 1}}, {"rotation", 1.57079632679}, {"scale", {0.5, 0.5}}};
    const TextureUse use = read_material().base_color_texture;
    expect_maps(use, {0, 0}, {0, 1});
    expect_maps(use, {0, 1}, {0.5f, 1});
    expect_maps(use, {1, 0}, {0, 0.5f});
    expect_maps(use, {1, 1}, {0.5f, 0.5f});
    // Scale comes before rotation: u is stretched, then turned.
    transform = {{"rotation", 1.57079632679}, {"scale", {3, 1}}};
    expect_maps(read_material().base_color_texture, {1, 0}, {0, -3});
    for (const json& bad : {json{{"offset", {1}}}, json{{"scale", 2}}, json{{"rotation", "x"}}, json{{"texCoord", -1}}, json{{"texCoord", 0.5}}}) {
        transform = bad;
        expect_refused({"material 0", "KHR_texture_transform", bad.begin().key().c_str()});
    }
}

TEST_F(GltfTextures, EveryTextureHasItsOwnUse) {
    const auto info = [](float offset) {
        return json{{"index", 0}, {"texCoord", 1}, {"extensions", {{"KHR_texture_transform", {{"offset", {offset, 0}}}}}}};
    };
    material() = {{"emissiveFactor", {1, 1, 1}}, {"emissiveTexture", info(1)}, {"normalTexture", info(2)},
                  {"pbrMetallicRoughness", {{"baseColorTexture", info(3)}, {"metallicRoughnessTexture", info(4)}}}};
    material()["normalTexture"]["scale"] = 0.25;
    const Material m = read_material();
    expect_maps(m.emissive_texture, {0, 0}, {1, 0});
    expect_maps(m.normal_texture, {0, 0}, {2, 0});
    expect_maps(m.base_color_texture, {0, 0}, {3, 0});
    expect_maps(m.metallic_roughness_texture, {0, 0}, {4, 0});
    for (const auto& use : {m.emissive_texture, m.normal_texture, m.base_color_texture, m.metallic_roughness_texture}) {
        EXPECT_EQ(use.set, 1u);
        EXPECT_EQ(use.texture, 0u);  // one image, once
    }
    EXPECT_EQ(m.normal_scale, 0.25f);
    EXPECT_EQ(read().textures.size(), 1u);
}

TEST_F(GltfTextures, SetsOfCoordinates) {
    EXPECT_EQ(read_material().base_color_texture.set, 0u);
    base_color()["texCoord"] = 1;
    EXPECT_EQ(read_material().base_color_texture.set, 1u);
    base_color()["extensions"]["KHR_texture_transform"] = {{"texCoord", 0}};  // overrides
    EXPECT_EQ(read_material().base_color_texture.set, 0u);
    EXPECT_TRUE(read().warnings.empty());
    base_color()["extensions"]["KHR_texture_transform"] = {{"texCoord", 3}};
    valid = false;  // there is no such set
    const Scene scene = read();
    EXPECT_EQ(scene.materials[0].base_color_texture.set, 0u);
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_NE(scene.warnings[0].find("1 uses of a texture"), std::string::npos) << scene.warnings[0];
}

TEST_F(GltfTextures, OneImageWrappedInTwoWays) {
    doc["samplers"] = {{{"wrapS", 33071}}};
    doc["textures"] = {{{"source", 0}}, {{"source", 0}, {"sampler", 0}}, {{"source", 0}, {"name", "again"}}};
    material()["emissiveFactor"] = {1, 1, 1};
    material()["emissiveTexture"]["index"] = 1;
    material()["normalTexture"]["index"] = 2;
    const Scene scene = read();
    const Material& m = scene.materials[0];
    ASSERT_EQ(scene.textures.size(), 2u);
    EXPECT_EQ(m.base_color_texture.texture, m.normal_texture.texture);
    EXPECT_EQ(scene.textures[m.emissive_texture.texture].wrap_u, Texture::Wrap::clamp);
    EXPECT_EQ(scene.textures[m.base_color_texture.texture].wrap_u, Texture::Wrap::repeat);
}

TEST_F(GltfTextures, Alpha) {
    EXPECT_EQ(read_material().alpha, Material::Alpha::opaque);
    EXPECT_EQ(read_material().alpha_cutoff, 0.5f);
    material()["alphaMode"] = "MASK";
    material()["alphaCutoff"] = 0.75;
    EXPECT_EQ(read_material().alpha, Material::Alpha::mask);
    EXPECT_EQ(read_material().alpha_cutoff, 0.75f);
    material()["alphaMode"] = "BLEND";
    EXPECT_EQ(read_material().alpha, Material::Alpha::blend);
    EXPECT_TRUE(read().warnings.empty());
    material()["alphaCutoff"] = -1;
    expect_refused({"material 0", "alphaCutoff"});
    material()["alphaMode"] = "GLASS";
    expect_refused({"material 0", "GLASS"});
}

TEST_F(GltfTextures, Unlit) {
    doc["extensionsRequired"] = doc["extensionsUsed"] = {"KHR_materials_unlit"};
    material()["extensions"]["KHR_materials_unlit"] = json::object();
    material()["emissiveFactor"] = {1, 1, 1};
    material()["normalTexture"]["index"] = 0;
    material()["pbrMetallicRoughness"]["baseColorFactor"] = {0.5, 0.25, 1, 0.75};
    const Material m = read_material();
    EXPECT_TRUE(m.unlit);
    EXPECT_EQ(m.base_color, glm::vec4(0.5f, 0.25f, 1, 0.75f));
    EXPECT_NE(m.base_color_texture.texture, none);
    EXPECT_EQ(m.emissive, vec3(0));  // the extension: nothing but base colour and alpha counts
    EXPECT_EQ(m.normal_texture.texture, none);
    material()["extensions"].clear();
    EXPECT_FALSE(read_material().unlit);
}

TEST_F(GltfTextures, OtherFormatsFallBackOrAreRefusedByName) {
    for (const char* format : {"KHR_texture_basisu", "EXT_texture_webp"}) {
        valid = false;  // nobody looks into the picture of an unknown format, but the validator
        doc["extensionsUsed"] = {format};
        doc["images"] = {{{"uri", png}}, {{"uri", "picture.unheard"}}};
        doc["textures"] = {{{"source", 0}, {"extensions", {{format, {{"source", 1}}}}}}};
        const Scene scene = read();
        ASSERT_EQ(scene.textures.size(), 1u);
        EXPECT_EQ(scene.textures[0].width, 2u);
        ASSERT_GE(scene.warnings.size(), 1u);
        EXPECT_NE(scene.warnings[0].find(format), std::string::npos) << scene.warnings[0];
        doc["textures"][0].erase("source");
        expect_refused({"texture 0", format});
        doc["extensionsRequired"] = {format};
        expect_refused({"requires", format});
        doc.erase("extensionsRequired");
    }
}

}  // namespace
}  // namespace myriad::scenes
