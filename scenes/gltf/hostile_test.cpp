// Files made to harm: each is refused in one sentence, before memory or time is spent on it; harmless defects are repaired
// and counted.
#include <cmath>
#include <cstring>
#include <limits>

#include <sys/stat.h>

#include "scenes/gltf/draco_mesh.hpp"
#include "scenes/gltf/image.hpp"
#include "scenes/gltf_kit.hpp"

namespace myriad::scenes {
namespace {

class Hostile : public Gltf {
protected:
    void SetUp() override {
        Gltf::SetUp();
        square();
    }
    void one_warning(const std::string& part) {
        Scene scene = read();
        flatten(scene);
        ASSERT_EQ(scene.warnings.size(), 1u) << testing::PrintToString(scene.warnings);
        EXPECT_NE(scene.warnings[0].find(part), std::string::npos) << scene.warnings[0];
    }
    void use_picture(const json& image) {
        doc["images"] = {image};
        doc["textures"] = {{{"source", 0}}};
        doc["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}}}}}}};
        primitive()["material"] = 0;
    }
    json picture(const std::string& bytes) {
        const int v = view(std::vector<uint8_t>(bytes.begin(), bytes.end()));
        return {{"bufferView", v}, {"mimeType", "image/png"}};
    }
};

// ---- URIs

TEST_F(Hostile, UrisStayInTheFolder) {
    const std::string text = [&] {
        write();
        return doc.dump();
    }();
    std::filesystem::create_directories(folder / "sub");
    std::ofstream(folder.parent_path() / (folder.filename().string() + ".secret")) << std::string(1000, 's');
    const std::string secret = folder.filename().string() + ".secret";
    const std::filesystem::path outside = folder.parent_path() / secret;
    std::filesystem::create_symlink(outside, folder / "link.bin");
    std::filesystem::create_symlink(folder.parent_path(), folder / "up");
    ASSERT_EQ(mkfifo((folder / "pipe").c_str(), 0600), 0);
    std::string hexed;
    for (const char c : "../" + secret) hexed += c == '.' ? "%2e" : c == '/' ? "%2F" : std::string(1, c);
    const auto refused_uri = [&](const std::string& uri) {
        json copy = json::parse(text);
        copy["buffers"][0]["uri"] = uri;
        return refused(file("uri.gltf", copy.dump()));
    };
    for (const std::string& uri : {"../" + secret, "sub/../../" + secret, outside.string(), "//" + outside.string(), hexed, "..\\" + secret,
                                   std::string("link.bin"), "up/" + secret, std::string("..")}) {
        const std::string message = refused_uri(uri);
        EXPECT_NE(message.find("buffer 0: the URI"), std::string::npos) << uri << ": " << message;
        EXPECT_NE(message.find("leaves the scene's folder"), std::string::npos) << uri << ": " << message;
        EXPECT_NE(message.find("; put the file into"), std::string::npos) << uri << ": " << message;
    }
    for (const char* uri : {"http://example.org/data.bin", "file:///etc/passwd", "C:\\data.bin", "HTTPS:data.bin", "x-y+z.1:data.bin", "ht%74p://x"})
        EXPECT_NE(refused_uri(uri).find("is not a path"), std::string::npos) << uri;
    for (const char* uri : {"data.bin%00", "data%0a.bin", "data\x1b[31m.bin", "%7f"})
        EXPECT_NE(refused_uri(uri).find("control character"), std::string::npos) << uri;
    for (const char* uri : {"pipe", "sub", "."}) EXPECT_NE(refused_uri(uri).find("not a regular file"), std::string::npos) << uri;
    for (const char* uri : {"%252e%252e/x", "absent.bin", "sub/absent.bin"}) EXPECT_NE(refused_uri(uri).find("cannot be read"), std::string::npos) << uri;
    EXPECT_NE(refused_uri("").find("empty"), std::string::npos);
    EXPECT_NE(refused_uri(std::string(100000, 'x')).find("too long"), std::string::npos);
    EXPECT_NE(refused_uri("data:application/octet-stream,plain").find("not base64"), std::string::npos);
    EXPECT_LT(refused_uri(std::string(4000, '.')).size(), 1000u) << "what is hostile is not repeated at length";
    std::filesystem::remove(outside);
}

TEST_F(Hostile, UrisOfAllOtherKindsAreRead) {
    write();
    std::filesystem::create_directories(folder / "sub dir");
    for (const char* name : {"a b.bin", "a+b.bin", "100%.bin", "sub dir/c.bin", "\xc3\xa4.bin"}) std::filesystem::copy_file(folder / "data.bin", folder / name);
    std::filesystem::create_symlink("sub dir/c.bin", folder / "inside.bin");
    for (const char* uri : {"data.bin", "./data.bin", "a b.bin", "a%20b.bin", "a+b.bin", "100%.bin", "100%25.bin", "sub%20dir/c.bin", "sub dir\\c.bin",
                            "sub dir/../data.bin", "inside.bin", "%C3%A4.bin"}) {
        json copy = doc;
        copy["buffers"][0]["uri"] = uri;
        EXPECT_EQ(refused(file("uri.gltf", copy.dump())), "(accepted)") << uri;
    }
}

TEST_F(Hostile, PicturesStayInTheFolderToo) {
    use_picture({{"uri", "../../../../etc/passwd"}});
    expect_refused({"texture 0 image 0", "leaves the scene's folder"});
    use_picture({{"uri", "http://example.org/a.png"}});
    expect_refused({"texture 0 image 0", "is not a path"});
    use_picture({{"name", "neither uri nor bufferView"}});
    expect_refused({"texture 0 image 0", "URI is empty"});
}

// ---- bombs

// The same chunk shown by many buffers, the same accessor by many primitives, zeros from nothing.
TEST_F(Hostile, AmplificationIsBounded) {
    bin.resize(1 << 20);
    write();
    for (int i = 0; i < 2000; ++i) doc["buffers"].push_back({{"byteLength", 1 << 20}, {"uri", "data.bin"}});
    EXPECT_EQ(refused(file("many.gltf", doc.dump())), "(accepted)") << "2 GB of buffers, but one file, held once";

    doc["accessors"][0] = {{"componentType", f32}, {"type", "VEC3"}, {"count", 1ull << 33}};
    expect_refused({"primitive 0 POSITION", "8589934592 times", "out of all proportion to the file"});
    doc["accessors"][0] = {{"componentType", f32}, {"type", "VEC3"}, {"count", 1 << 20}};
    const json one = primitive();
    for (int i = 0; i < 1000; ++i) doc["meshes"][0]["primitives"].push_back(one);
    expect_refused({"out of all proportion to the file"});
}

// A mesh placed so often that its instances, which are flat and cannot be shared, would take 130 GB.
TEST_F(Hostile, InstancesThatWouldFillTheMemory) {
    if (uint64_t(sysconf(_SC_PHYS_PAGES)) * uint64_t(sysconf(_SC_PAGESIZE)) > 100ull << 30) GTEST_SKIP() << "this machine has the memory";
    std::vector<uint32_t> many(3 * 300'000);
    for (size_t i = 0; i < many.size(); ++i) many[i] = uint32_t(i % 4);
    primitive()["indices"] = indices<uint32_t>(u32, many);
    doc["nodes"] = json::array();
    doc["scenes"][0]["nodes"] = json::array();
    for (int i = 0; i < 4000; ++i) doc["nodes"].push_back({{"mesh", 0}, {"scale", {1, 1, 0}}}), doc["scenes"][0]["nodes"].push_back(i);
    Scene scene = read();
    try {
        flatten(scene);
        ADD_FAILURE() << "accepted";
    } catch (const OutOfMemory& e) {
        EXPECT_NE(std::string(e.what()).find("GiB written out"), std::string::npos);
    }
}

std::string png_header(uint32_t width, uint32_t height, int depth = 8, int type = 6) {
    std::string data = "IHDR";
    for (const uint32_t n : {width, height})
        for (int shift = 24; shift >= 0; shift -= 8) data.push_back(char(n >> shift));
    data += {char(depth), char(type), 0, 0, 0};
    uint32_t crc = ~0u;
    for (const unsigned char c : data) {
        crc ^= c;
        for (int k = 0; k < 8; ++k) crc = crc & 1 ? 0xedb88320u ^ (crc >> 1) : crc >> 1;
    }
    crc = ~crc;
    std::string out = "\x89PNG\r\n\x1a\n" + std::string("\0\0\0\r", 4) + data;
    for (int shift = 24; shift >= 0; shift -= 8) out.push_back(char(crc >> shift));
    return out + std::string("\0\0\0\0IDAT\x35\xaf\x06\x1e", 12);
}

// A JPEG up to its scan, which is empty.
std::string jpeg_header(int width, int height, int components) {
    std::string out = "\xff\xd8\xff\xc0", scan = "\xff\xda";
    const auto half = [](std::string& to, int n) { to += {char(n >> 8), char(n)}; };
    half(out, 8 + 3 * components), out.push_back(8), half(out, height), half(out, width), out.push_back(char(components));
    half(scan, 6 + 2 * components), scan.push_back(char(components));
    for (int c = 1; c <= components; ++c) out += {char(c), 0x11, 0}, scan += {char(c), 0};
    return out + scan + std::string("\0\x3f\0", 3);
}

TEST_F(Hostile, PicturesThatWouldFillTheMemory) {
    for (const auto& [bytes, complaint] : {std::pair{png_header(30000, 30000), "out of all proportion"}, {png_header(1u << 30, 1u << 30), "cannot be decoded"},
                                           {png_header(100000, 2), "cannot be decoded"}, {png_header(0, 5), "cannot be decoded"},
                                           {png_header(30000, 30000, 16), "out of all proportion"}, {png_header(5, 5), "truncated"},
                                           {jpeg_header(32000, 32000, 3), "out of all proportion"}, {jpeg_header(65000, 65000, 1), "beyond reason"},
                                           {jpeg_header(9, 9, 2), "channels"}, {jpeg_header(9, 9, 3), "cannot be decoded"},
                                           {std::string("GIF89a"), "neither PNG nor JPEG"}, {std::string("\xff\xd8\xff"), "cannot be decoded"}}) {
        use_picture(picture(bytes));
        expect_refused({"texture 0 image 0", complaint});
    }
}

TEST_F(Hostile, DracoCountsAreNotTakenAtTheirWord) {
    const auto decode = [](const std::string& bytes) -> std::string {
        gltf::Document document;
        document.budget.earn(bytes.size());
        try {
            gltf::decode_draco_mesh({document.model, "a.glb", "draco", &document}, {reinterpret_cast<const uint8_t*>(bytes.data()), bytes.size()});
        } catch (const InputError& e) {
            return e.what();
        }
        return "(accepted)";
    };
    const std::string billion = "\x80\x80\x80\x80\x04", header = std::string("DRACO\x02\x02\x01", 8), flags(2, '\0');
    const std::string many = "out of all proportion to the file";
    EXPECT_NE(decode(header + '\1' + flags + '\0' + billion + billion + std::string(200, '\0')).find(many), std::string::npos);  // edgebreaker
    EXPECT_NE(decode(header + '\0' + flags + billion + billion + std::string(200, '\0')).find(many), std::string::npos);         // sequential
    EXPECT_NE(decode(header + '\1' + flags + '\0' + "\3" + billion + std::string(200, '\0')).find(many), std::string::npos);
    EXPECT_NE(decode(std::string("DRACO\x02\x01\x01\x01\0\0", 11)).find("older"), std::string::npos);
    EXPECT_NE(decode(std::string("DRACO\x02\x02\0\x01\0\0", 11)).find("no mesh"), std::string::npos);
    EXPECT_NE(decode("").find("cannot be decoded"), std::string::npos);
}

// Names as long as the file, and as many messages as could repeat them.
TEST_F(Hostile, LongNamesAreShort) {
    const std::string name(1 << 16, 'n');
    doc["meshes"][0]["name"] = name;
    const json one = primitive();
    for (int i = 0; i < 2000; ++i) doc["meshes"][0]["primitives"].push_back(one);
    EXPECT_EQ(refused(write()), "(accepted)");
    doc["extensionsUsed"] = json::array();
    for (int i = 0; i < 100; ++i) doc["extensionsUsed"].push_back(name + std::to_string(i));
    const Scene scene = read();
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_NE(scene.warnings[0].find("and 90 more"), std::string::npos);
    EXPECT_LT(scene.warnings[0].size(), 2000u);
    doc["meshes"][0]["name"] = "\x1b[31mred\n";
    doc["meshes"][0]["primitives"][7]["material"] = 7;
    expect_refused({"mesh 0 \"?[31mred?\" primitive 7", "material 7"});
}

// ---- numbers

TEST_F(Hostile, LightsOfAbsurdStrengthAreRefused) {
    doc["extensionsUsed"] = {"KHR_lights_punctual"};
    doc["nodes"].push_back({{"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}});
    doc["scenes"][0]["nodes"] = {0, 1};
    json& light = (doc["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}, {"name", "lamp"}, {"spot", {{"outerConeAngle", 0.5}}}}})[0];
    EXPECT_EQ(refused(write()), "(accepted)");
    for (const json& bad : {json(1e38), json(1e300), json(-1)}) {
        light["intensity"] = bad;
        expect_refused({"node 1", "light \"lamp\"", "not a number from 0 to"});
    }
    light["intensity"] = 1, light["color"] = {1, -0.5, 1};
    expect_refused({"light \"lamp\"", "not a number from 0 to"});
    light["color"] = {1, 1, 1};
    for (const auto& [inner, outer] : {std::pair{0.5, 0.4}, {-0.1, 0.4}, {0.0, 3.0}, {1e300, 1e300}}) {
        light["spot"] = {{"innerConeAngle", inner}, {"outerConeAngle", outer}};
        expect_refused({"light \"lamp\"", "cone angles"});
    }
    light["spot"] = {{"innerConeAngle", 0}, {"outerConeAngle", 0}};  // a cone of nothing is dark, and no harm
    EXPECT_EQ(refused(write()), "(accepted)");
    doc["materials"] = {{{"emissiveFactor", {1, 1, 1}}, {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 1e38}}}}}}};
    expect_refused({"material 0", "emissiveStrength"});
}

TEST_F(Hostile, CamerasOfAbsurdAngles) {
    doc["nodes"][0]["camera"] = 0;
    for (const double yfov : {0.0, -1.0, 3.2, 1e300}) {
        doc["cameras"] = {{{"type", "perspective"}, {"name", "eye"}, {"perspective", {{"yfov", yfov}, {"znear", 1}}}}};
        expect_refused({"camera \"eye\"", "yfov"});
    }
}

TEST_F(Hostile, WhatHasNoTransformIsLeftOut) {
    doc["extensionsUsed"] = {"KHR_lights_punctual"};
    doc["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "directional"}}, {{"type", "point"}}};
    doc["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.5}, {"znear", 1}}}}};
    const auto light = [](int i) { return json{{"KHR_lights_punctual", {{"light", i}}}}; };
    doc["nodes"] = {{{"mesh", 0}}, {{"camera", 0}, {"extensions", light(0)}, {"scale", {0, 0, 0}}}};
    doc["scenes"][0]["nodes"] = {0, 1};
    Scene scene = read();
    EXPECT_TRUE(scene.cameras.empty() && scene.lights.empty());
    ASSERT_EQ(scene.warnings.size(), 2u);
    EXPECT_NE(scene.warnings[0].find("1 cameras were left out"), std::string::npos);
    EXPECT_NE(scene.warnings[1].find("1 lights were left out"), std::string::npos);

    doc["nodes"][1]["extensions"] = light(1), doc["nodes"][1].erase("camera");  // a point light needs no direction
    EXPECT_EQ(read().lights.size(), 1u);
    doc["nodes"][1] = {{"mesh", 0}, {"translation", {1e300, 0, 0}}};
    one_warning("1 instances of a mesh were left out");
    doc["nodes"][1] = {{"mesh", 0}, {"matrix", {1e38, 0, 0, 0, 0, 1e38, 0, 0, 0, 0, 1, 0, 1e20, 0, 0, 1}}};
    one_warning("1 instances of a mesh were left out");
    doc["nodes"][1] = {{"mesh", 0}, {"scale", {0, 1, 1}}};  // flat, but there
    EXPECT_EQ(read().instances.size(), 2u);
    doc["nodes"][1] = {{"camera", 0}, {"scale", {-1, 2, 3}}, {"rotation", {0, 0.6, 0, 0.8}}};
    const glm::mat3 axes(read().cameras.at(0).to_world);
    EXPECT_NEAR(glm::determinant(axes), 1, 1e-5f) << "a mirrored or stretched camera is a camera still";
}

TEST_F(Hostile, VerticesBeyondReasonAreDropped) {
    const float nan = std::numeric_limits<float>::quiet_NaN(), inf = std::numeric_limits<float>::infinity();
    for (const float bad : {nan, inf, -inf, 1e30f, -1e10f}) {
        primitive()["attributes"]["POSITION"] = accessor(view(std::vector<float>{0, 0, 0, 1, 0, 0, 1, 1, 0, 0, bad, 0}), f32, "VEC3", 4);
        one_warning("1 triangles with a vertex that is not finite or beyond 1e9 m were dropped");
    }
}

TEST_F(Hostile, TextureTransformsOfAbsurdSize) {
    use_picture({{"uri", "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAAD0lEQVR42mP4z8DQ0NAAAAkBAoAgv9V1AAAAAElFTkSuQmCC"}});
    json& texture = doc["materials"][0]["pbrMetallicRoughness"]["baseColorTexture"];
    for (const char* what : {"offset", "scale"}) {
        texture["extensions"] = {{"KHR_texture_transform", {{what, {1e300, 1}}}}};
        expect_refused({"material 0", "KHR_texture_transform", "beyond a million"});
    }
    texture["extensions"] = {{"KHR_texture_transform", {{"rotation", 1e300}}}};  // an angle like any other
    EXPECT_EQ(refused(write()), "(accepted)");
}

}  // namespace
}  // namespace myriad::scenes
