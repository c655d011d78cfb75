// glTF files, written by the tests themselves: what is read, and that every defect is one sentence with file and place.
#include <cmath>
#include <cstring>
#include <functional>

#include "scenes/gltf_kit.hpp"

namespace myriad::scenes {
namespace {

const std::vector<uint32_t> two_triangles = {0, 1, 2, 0, 2, 3};

// ---- geometry

TEST_F(Gltf, IndexedByEveryType) {
    for (int type : {u8, u16, u32}) {
        doc.erase("meshes"), doc.erase("accessors"), doc.erase("bufferViews"), bin.clear();
        primitive()["attributes"]["POSITION"] = positions();
        if (type == u8) primitive()["indices"] = indices<uint8_t>(u8, {0, 1, 2, 0, 2, 3});
        if (type == u16) primitive()["indices"] = indices<uint16_t>(u16, {0, 1, 2, 0, 2, 3});
        if (type == u32) primitive()["indices"] = indices<uint32_t>(u32, {0, 1, 2, 0, 2, 3});
        for (bool glb : {false, true}) {
            const Scene scene = read(glb);
            const Primitive& p = scene.meshes.at(0).primitives.at(0);
            EXPECT_EQ(p.indices, two_triangles) << type;
            expect_near(p.positions.at(2), {1, 1, 0});
            EXPECT_EQ(scene.instances.size(), 1u);
            ASSERT_EQ(scene.materials.size(), 1u);  // glTF's default material
            EXPECT_EQ(scene.materials[0].metallic, 1);
            EXPECT_EQ(p.material, 0u);
        }
    }
}

TEST_F(Gltf, NotIndexed) {
    primitive()["attributes"]["POSITION"] = accessor(view(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0}), f32, "VEC3", 3);
    EXPECT_EQ(read().meshes[0].primitives[0].indices, (std::vector<uint32_t>{0, 1, 2}));
}

TEST_F(Gltf, StripsAndFans) {
    primitive()["attributes"]["POSITION"] = accessor(view(std::vector<float>{0, 0, 0, 1, 0, 0, 0, 1, 0, 1, 1, 0}), f32, "VEC3", 4);
    primitive()["mode"] = 5;
    for (int mode : {5, 6}) {
        doc["meshes"][0]["primitives"][0]["mode"] = mode;
        if (mode == 6) primitive()["indices"] = indices<uint8_t>(u8, {0, 1, 3, 2});
        Scene scene = read();
        const Triangles t = flatten(scene);
        ASSERT_EQ(t.triangles.size(), 2u);
        for (const auto& n : t.normals) expect_near(n, {0, 0, 1});  // both face the same way
    }
}

TEST_F(Gltf, StridedAndOffset) {
    // Position and texture coordinate interleaved, 24 bytes apart, after one leading float.
    const std::vector<float> data = {9, 0, 0, 0, .1f, .2f, 7, 1, 0, 0, .3f, .4f, 7, 0, 1, 0, .5f, .6f, 7};
    const int v = view(data, 24);
    primitive()["attributes"]["POSITION"] = accessor(v, f32, "VEC3", 3, 4);
    primitive()["attributes"]["TEXCOORD_0"] = accessor(v, f32, "VEC2", 3, 16);
    const Primitive p = read().meshes[0].primitives[0];
    expect_near(p.positions[2], {0, 1, 0});
    EXPECT_EQ(p.texcoords[1], glm::vec2(.3f, .4f));
}

TEST_F(Gltf, NormalisedAndQuantisedIntegers) {
    doc["extensionsRequired"] = {"KHR_mesh_quantization"};
    primitive()["attributes"]["POSITION"] = accessor(view(std::vector<int16_t>{0, 0, 0, 0, 100, 0, 0, 0, 0, -7, 0, 0}, 8), i16, "VEC3", 3);
    primitive()["attributes"]["NORMAL"] = accessor(view(std::vector<int8_t>{0, 0, 127, 0, 0, 0, -127, 0, 0, 0, -128, 0}, 4), i8, "VEC3", 3, 0, true);
    primitive()["attributes"]["TEXCOORD_0"] = accessor(view(std::vector<uint16_t>{0, 65535, 13107, 0, 0, 0}), u16, "VEC2", 3, 0, true);
    const Primitive p = read().meshes[0].primitives[0];
    expect_near(p.positions[1], {100, 0, 0});
    expect_near(p.positions[2], {0, -7, 0});
    expect_near(p.normals[0], {0, 0, 1});
    expect_near(p.normals[2], {0, 0, -1});
    EXPECT_EQ(p.texcoords[0].y, 1);
    EXPECT_NEAR(p.texcoords[1].x, 0.2f, 1e-6f);
}

TEST_F(Gltf, SparsePositions) {
    square();
    doc["accessors"][0]["sparse"] = {{"count", 1},
                                     {"indices", {{"bufferView", view(std::vector<uint8_t>{2})}, {"componentType", u8}}},
                                     {"values", {{"bufferView", view(std::vector<float>{5, 6, 7})}}}};
    expect_near(read().meshes[0].primitives[0].positions[2], {5, 6, 7});
    doc["accessors"][0]["sparse"]["count"] = 50;
    expect_refused({"mesh 0 \"roof\" primitive 0", "POSITION"});
}

TEST_F(Gltf, UnusedVerticesAreLeftOut) {
    std::vector<float> many(300, 0.0f);
    many[3 * 70] = 1, many[3 * 80 + 1] = 1;
    primitive()["attributes"]["POSITION"] = accessor(view(many), f32, "VEC3", 100);
    primitive()["indices"] = indices<uint8_t>(u8, {0, 70, 80});
    const Primitive p = read().meshes[0].primitives[0];
    EXPECT_EQ(p.positions.size(), 3u);
    expect_near(p.positions[p.indices[1]], {1, 0, 0});
}

// ---- hierarchy, cameras, lights

TEST_F(Gltf, HierarchyWithMirroredScale) {
    square();
    doc["nodes"] = {{{"translation", {10, 0, 0}}, {"children", {1, 2}}},
                    {{"mesh", 0}, {"scale", {-2, 1, 1}}},
                    {{"mesh", 0}, {"matrix", {0, 1, 0, 0, -1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 3, 1}}}};  // a quarter turn about z
    Scene scene = read();
    ASSERT_EQ(scene.instances.size(), 2u);
    const Triangles t = flatten(scene);
    expect_near(t.lo, {8, 0, 0});
    expect_near(t.hi, {10, 1, 3});
    for (const auto& n : t.normals) expect_near(n, {0, 0, 1});
}

TEST_F(Gltf, CamerasAndLights) {
    square();
    const float s = std::sqrt(0.5f);
    doc["cameras"] = {{{"type", "perspective"}, {"name", "eye"}, {"perspective", {{"yfov", 0.5}, {"znear", 0.1}}}},
                      {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"znear", 0}, {"zfar", 1}}}}};
    doc["extensionsUsed"] = {"KHR_lights_punctual"};
    doc["extensions"]["KHR_lights_punctual"]["lights"] = {
        {{"type", "point"}, {"name", "bulb"}, {"color", {1, 0.5, 0.25}}, {"intensity", 8}},
        {{"type", "spot"}, {"spot", {{"innerConeAngle", 0.2}, {"outerConeAngle", 0.4}}}},
        {{"type", "directional"}, {"intensity", 3}}};
    const auto light = [](int i) { return json{{"KHR_lights_punctual", {{"light", i}}}}; };
    // A quarter turn about x sends -z to -y... and the scale above must reach positions but not directions.
    doc["nodes"] = {{{"mesh", 0}, {"scale", {2, 2, 2}}, {"children", {1, 2, 3, 4, 5}}},
                    {{"camera", 0}, {"translation", {1, 2, 3}}},
                    {{"camera", 1}},
                    {{"translation", {0, 5, 0}}, {"extensions", light(0)}},
                    {{"name", "torch"}, {"rotation", {-s, 0, 0, s}}, {"extensions", light(1)}},
                    {{"name", "sun"}, {"rotation", {0, s, 0, s}}, {"extensions", light(2)}}};
    const Scene scene = read();
    ASSERT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(scene.cameras[0].name, "eye");
    EXPECT_NEAR(scene.cameras[0].yfov, 0.5f, 1e-6f);
    expect_near(vec3(scene.cameras[0].to_world[3]), {2, 4, 6});
    EXPECT_NEAR(glm::length(vec3(scene.cameras[0].to_world[0])), 1, 1e-6f);
    ASSERT_EQ(scene.lights.size(), 3u);
    EXPECT_EQ(scene.lights[0].name, "bulb");
    expect_near(scene.lights[0].position, {0, 10, 0});
    expect_near(scene.lights[0].intensity, {8, 4, 2});
    EXPECT_EQ(scene.lights[1].type, Light::Type::spot);
    expect_near(scene.lights[1].direction, {0, -1, 0});
    EXPECT_NEAR(scene.lights[1].outer_cone, 0.4f, 1e-6f);
    expect_near(scene.lights[1].intensity, {1, 1, 1});
    EXPECT_EQ(scene.lights[2].type, Light::Type::directional);
    expect_near(scene.lights[2].direction, {-1, 0, 0});
    EXPECT_EQ(scene.warnings.size(), 1u);  // the orthographic camera
}

TEST_F(Gltf, NodesInACycleAreRefused) {
    square();
    doc["nodes"] = {{{"mesh", 0}, {"children", {1}}}, {{"children", {0}}}};
    expect_refused({"node 0", "cycle"});
    doc.erase("scenes"), doc.erase("scene");
    expect_refused({"cycle"});
    doc["nodes"] = {{{"children", {1, 2}}}, {{"children", {3}}}, {{"children", {3}}}, {{"mesh", 0}}};
    expect_refused({"node 3", "two parents"});
}

TEST_F(Gltf, ADeepChainOfNodesIsFine) {
    valid = false;  // the validator's stack is not deep enough
    square();
    doc["nodes"] = json::array();
    for (int i = 0; i < 50000; ++i) doc["nodes"].push_back({{"children", {i + 1}}});
    doc["nodes"].push_back({{"mesh", 0}});
    EXPECT_EQ(read().instances.size(), 1u);
}

// ---- materials

// A PNG of 2 x 1: red, then a grey of 128.
const char* const png8 = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAAD0lEQVR42mP4z8DQ0NAAAAkBAoAgv9V1AAAAAElFTkSuQmCC";
// The same with 16 bits a channel.
const char* const png16 = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABEAIAAAAr0DSeAAAAEElEQVR42mP4/58BCBrAAAAhdgT/uWK2LgAAAABJRU5ErkJggg==";

TEST_F(Gltf, MaterialsAndTextures) {
    square();
    add_texcoords();
    primitive()["material"] = 0;
    doc["extensionsUsed"] = {"KHR_materials_emissive_strength", "EXT_unheard_of"};
    doc["images"] = {{{"uri", png8}}, {{"uri", png16}}};
    doc["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
    doc["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 1}}};
    doc["materials"] = {{{"name", "glow"},
                         {"doubleSided", true},
                         {"emissiveFactor", {1, 0.5, 0}},
                         {"emissiveTexture", {{"index", 1}}},
                         {"pbrMetallicRoughness", {{"baseColorFactor", {0.1, 0.2, 0.3, 1}}, {"metallicFactor", 0}, {"roughnessFactor", 0.25},
                                                   {"baseColorTexture", {{"index", 0}}}}},
                         {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 40}}}}}}};
    const Scene scene = read();
    ASSERT_EQ(scene.materials.size(), 1u);
    const Material& m = scene.materials[0];
    EXPECT_EQ(m.name, "glow");
    EXPECT_TRUE(m.double_sided);
    expect_near(m.emissive, {40, 20, 0}, 1e-4f);
    expect_near(vec3(m.base_color), {0.1f, 0.2f, 0.3f});
    EXPECT_EQ(m.metallic, 0);
    EXPECT_EQ(m.roughness, 0.25f);
    EXPECT_EQ(m.metallic_roughness_texture.texture, none);
    const std::vector<uint8_t> pixels = {255, 0, 0, 255, 128, 128, 128, 255};
    for (uint32_t which : {m.base_color_texture.texture, m.emissive_texture.texture}) {
        ASSERT_LT(which, scene.textures.size());
        EXPECT_EQ(scene.textures[which].width, 2u);
        EXPECT_EQ(scene.textures[which].height, 1u);
        EXPECT_EQ(scene.textures[which].rgba, pixels);
    }
    EXPECT_EQ(scene.textures[m.base_color_texture.texture].wrap_u, Texture::Wrap::clamp);
    EXPECT_EQ(scene.textures[m.base_color_texture.texture].wrap_v, Texture::Wrap::mirror);
    EXPECT_EQ(scene.textures[m.emissive_texture.texture].wrap_u, Texture::Wrap::repeat);
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_NE(scene.warnings[0].find("EXT_unheard_of"), std::string::npos);
}

TEST_F(Gltf, ImagesAreChecked) {
    square();
    primitive()["material"] = 0;
    doc["textures"] = {{{"source", 0}}};
    doc["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
    const int v = view(std::vector<uint8_t>{1, 2, 3, 4});
    doc["images"] = {{{"bufferView", v}, {"mimeType", "image/png"}}};
    expect_refused({"texture 0 image 0", "cannot be decoded"});
    doc["bufferViews"][size_t(v)]["byteOffset"] = 1 << 30;
    expect_refused({"texture 0 image 0", "ends beyond buffer 0"});
    doc["images"] = {{{"uri", "absent.png"}}};
    expect_refused({"absent.png"});
    doc["images"] = json::array();
    expect_refused({"texture 0", "no image"});
    doc["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"]["index"] = 9;
    expect_refused({"material 0", "texture 9"});
}

// ---- what is refused

TEST_F(Gltf, UnknownRequiredExtension) {
    square();
    doc["extensionsRequired"] = {"KHR_lights_punctual", "KHR_texture_basisu"};
    expect_refused({"KHR_texture_basisu"});
}

TEST_F(Gltf, IndexOutOfRange) {
    square();
    primitive()["indices"] = indices<uint16_t>(u16, {0, 1, 4});
    expect_refused({"mesh 0 \"roof\" primitive 0", "index 4"});
}

TEST_F(Gltf, BrokenReferencesAndRanges) {
    square();
    const json good = doc;
    const auto broken = [&](const std::function<void()>& damage, std::initializer_list<const char*> words) {
        doc = good;
        damage();
        expect_refused(words);
    };
    const auto accessors = [&](size_t i) -> json& { return doc["accessors"][i]; };
    broken([&] { primitive()["attributes"].erase("POSITION"); }, {"primitive 0", "POSITION"});
    broken([&] { primitive()["attributes"]["POSITION"] = 77; }, {"primitive 0 POSITION", "accessor 77"});
    broken([&] { primitive()["attributes"]["POSITION"] = -1; }, {"primitive 0"});
    broken([&] { primitive()["indices"] = 77; }, {"indices"});
    broken([&] { primitive()["indices"] = 0; }, {"indices"});
    broken([&] { primitive()["material"] = 3; }, {"material 3"});
    broken([&] { accessors(0)["count"] = 5; }, {"POSITION", "needs 5 elements", "48 bytes"});
    broken([&] { accessors(0)["count"] = 4000000000000000000ull; }, {"POSITION"});
    broken([&] { accessors(0)["byteOffset"] = 4; }, {"POSITION"});
    broken([&] { accessors(0)["byteOffset"] = 18446744073709551600ull; }, {"POSITION"});
    broken([&] { accessors(0)["type"] = "VEC2"; }, {"POSITION", "2 components"});
    broken([&] { accessors(0)["bufferView"] = 50; }, {"bufferView 50"});
    broken([&] { accessors(0).erase("bufferView"), accessors(0)["count"] = 2000000000; }, {"POSITION"});
    broken([&] { doc["bufferViews"][0]["byteLength"] = 1000000; }, {"bufferView 0 ends beyond buffer 0"});
    broken([&] { doc["bufferViews"][0]["byteOffset"] = 18446744073709551615ull; }, {"bufferView 0"});
    broken([&] { doc["bufferViews"][0]["buffer"] = 2; }, {"buffer 2"});
    broken([&] { doc["nodes"][0]["mesh"] = 8; }, {"node 0", "mesh 8"});
    broken([&] { doc["nodes"][0]["camera"] = 8; }, {"node 0", "camera 8"});
    broken([&] { doc["nodes"][0]["children"] = {8}; }, {"node 0", "node 8"});
    broken([&] { doc["nodes"][0]["matrix"] = {1, 2, 3}; }, {"node 0", "3 numbers, not 16"});
    broken([&] { doc["nodes"][0]["extensions"]["KHR_lights_punctual"]["light"] = 5; }, {"node 0", "light 5"});
    broken([&] { doc["scene"] = 4; }, {"scene 4"});
    broken([&] { doc["scenes"][0]["nodes"] = {9}; }, {"node 9"});
    broken([&] { doc["extensionsUsed"] = {"x"}; }, {"(accepted)"});  // the check can fail
}

TEST_F(Gltf, DamagedFiles) {
    square();
    const std::string good = write(true);
    std::ifstream stream(good, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
    // Cut anywhere, a GLB is refused, never read past its end.
    for (size_t length = 0; length + 1 < bytes.size(); length += 7) {
        const std::string message = refused(file("cut.glb", bytes.substr(0, length)));
        EXPECT_EQ(message.find("(accepted)"), std::string::npos) << length;
    }
    // Any byte changed: refused or read, but never a crash; what is read can be flattened.
    for (size_t i = 0; i < bytes.size(); ++i)
        for (unsigned char flip : {0x01, 0x10, 0x80}) {
            std::string damaged = bytes;
            damaged[i] = char(damaged[i] ^ flip);
            try {
                Scene scene = load(file("flip.glb", damaged));
                flatten(scene);
            } catch (const Error&) {
            }
        }
    EXPECT_NE(refused(file("text.gltf", "not glTF at all")).find("not a readable glTF"), std::string::npos);
    EXPECT_NE(refused(file("empty.gltf", "")).find("not a readable glTF"), std::string::npos);
    EXPECT_NE(refused(file("deep.gltf", std::string(500000, '['))).find("nested"), std::string::npos);
    EXPECT_NE(refused((folder / "absent.glb").string()).find("no such file"), std::string::npos);
    EXPECT_NE(refused(folder.string()).find("no such file"), std::string::npos);
}

TEST_F(Gltf, TruncatedExternalBuffer) {
    square();
    const std::string path = write();
    std::filesystem::resize_file(folder / "data.bin", 20);
    EXPECT_NE(refused(path).find("data.bin"), std::string::npos);
    std::filesystem::remove(folder / "data.bin");
    EXPECT_NE(refused(path).find("data.bin"), std::string::npos);
}

// ---- Draco, on the scene of the papers

std::string sponza() {
    for (std::filesystem::path at = std::filesystem::absolute(__FILE__); at.has_relative_path(); at = at.parent_path())
        if (const auto path = at / "shared/data/sponza.glb"; std::filesystem::exists(path)) return path.string();
    return "";
}

TEST(Draco, Sponza) {
    if (sponza().empty()) GTEST_SKIP() << "shared/data/sponza.glb is absent";
    Scene scene = load(sponza());
    const Triangles t = flatten(scene);
    EXPECT_EQ(t.triangles.size(), 262267u);
    ASSERT_EQ(scene.cameras.size(), 2u);
    EXPECT_EQ(scene.cameras[0].name, "nave");
    EXPECT_EQ(scene.cameras[1].name, "gallery");
    ASSERT_EQ(scene.lights.size(), 2u);
    EXPECT_EQ(scene.lights[0].name, "sun");
    EXPECT_EQ(scene.lights[0].type, Light::Type::directional);
    EXPECT_LT(scene.lights[0].direction.y, -0.5f);
    EXPECT_EQ(scene.lights[1].name, "lamp");
    EXPECT_EQ(scene.lights[1].type, Light::Type::spot);
    EXPECT_EQ(scene.materials.at(0).name, "stone");
    const vec3 size = t.hi - t.lo;
    EXPECT_NEAR(size.x, 37.2f, 0.2f);
    EXPECT_NEAR(size.y, 15.6f, 0.2f);
    EXPECT_NEAR(size.z, 22.9f, 0.2f);
    for (const auto& n : t.normals) ASSERT_NEAR(glm::length(n), 1, 1e-4f);
    EXPECT_EQ(t.texcoords.size(), t.positions.size());
}

TEST(Draco, DamagedDataIsRefusedOrRead) {
    if (sponza().empty()) GTEST_SKIP() << "shared/data/sponza.glb is absent";
    std::ifstream stream(sponza(), std::ios::binary);
    std::string bytes((std::istreambuf_iterator<char>(stream)), {});
    const auto path = std::filesystem::temp_directory_path() / ("myriad_draco_" + std::to_string(::getpid()) + ".glb");
    const auto try_load = [&](const std::string& data) {
        std::ofstream(path, std::ios::binary) << data;
        try {
            Scene scene = load(path.string());
            return std::string("(accepted)");
        } catch (const InputError& e) {
            return std::string(e.what());
        }
    };
    const size_t start = bytes.find("DRACO");
    ASSERT_NE(start, std::string::npos);
    std::string headless = bytes;
    headless[start] = 'X';
    const std::string message = try_load(headless);
    EXPECT_NE(message.find("mesh 0 \"Mesh_0\" primitive 0 KHR_draco_mesh_compression"), std::string::npos) << message;
    for (size_t i = start + 5; i < bytes.size(); i += bytes.size() / 6) {
        std::string damaged = bytes;
        for (size_t k = i; k < std::min(i + 64, bytes.size()); ++k) damaged[k] = char(damaged[k] ^ 0x5a);
        try_load(damaged);
    }
    std::filesystem::remove(path);
}

}  // namespace
}  // namespace myriad::scenes
