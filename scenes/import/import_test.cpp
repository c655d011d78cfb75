// Each format by small files, their defects, and files that are hostile.
#include "scenes/import/import.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>

#include <png.h>
#include <unistd.h>
#include <zlib.h>

#include <gtest/gtest.h>

#include "engine/error.hpp"
#include "scenes/builtin/kit.hpp"
#include "scenes/refusal.hpp"

namespace myriad::scenes {
namespace {

using glm::vec2;
using glm::vec3;
using glm::vec4;

class Import : public testing::Test {
protected:
    void SetUp() override {
        const auto* info = testing::UnitTest::GetInstance()->current_test_info();
        folder = std::filesystem::temp_directory_path() / ("myriad_import_" + std::string(info->name()) + "_" + std::to_string(::getpid()));
        std::filesystem::create_directories(folder);
    }
    void TearDown() override { std::filesystem::remove_all(folder); }

    std::string put(const std::string& name, const std::string& contents) {
        std::filesystem::create_directories((folder / name).parent_path());
        std::ofstream(folder / name, std::ios::binary) << contents;
        return (folder / name).string();
    }
    // A picture of two texels side by side.
    void put_png(const std::string& name, std::array<uint8_t, 8> rgba) {
        png_image image{};
        image.version = PNG_IMAGE_VERSION, image.width = 2, image.height = 1, image.format = PNG_FORMAT_RGBA;
        std::filesystem::create_directories((folder / name).parent_path());
        ASSERT_TRUE(png_image_write_to_file(&image, (folder / name).c_str(), 0, rgba.data(), 0, nullptr));
    }
    Scene read(const std::string& name, const std::string& contents, const ImportOptions& options = {}) {
        return import_scene(put(name, contents), options);
    }
    std::string refused(const std::string& path) { return refusal(path, [&] { import_scene(path); }); }

    std::filesystem::path folder;
};

bool says(const Scene& scene, const std::string& part) {
    return std::ranges::any_of(scene.warnings, [&](const std::string& w) { return w.find(part) != std::string::npos; });
}

size_t triangles(const Scene& scene) {
    size_t count = 0;
    for (const Instance& i : scene.instances)
        for (const Primitive& p : scene.meshes[i.mesh].primitives) count += p.indices.size() / 3;
    return count;
}

// The corners of the whole scene in the world.
std::pair<vec3, vec3> bounds(Scene scene) {
    const Triangles t = flatten(scene);
    return {t.lo, t.hi};
}

void expect_near(const vec3& a, const vec3& b, float tolerance = 1e-5f) {
    EXPECT_LE(glm::length(a - b), tolerance) << a.x << " " << a.y << " " << a.z << " is not " << b.x << " " << b.y << " " << b.z;
}

float linear(float srgb) { return std::pow((srgb + 0.055f) / 1.055f, 2.4f); }

// ---- OBJ

constexpr const char* square_obj = "mtllib a.mtl\nv 0 0 0\nv 2 0 0\nv 2 3 0\nv 0 3 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nusemtl paint\nf 1/1 2/2 3/3 4/4\n";

TEST_F(Import, ObjWithItsMaterial) {
    put("a.mtl", "newmtl paint\nKd 0.5 0.6 0.7\nKs 0.2 0.2 0.2\nNs 30\nd 0.5\nKe 1 2 0\nmap_Kd wood.png\n");
    put_png("wood.png", {10, 20, 30, 255, 40, 50, 60, 255});
    const Scene scene = read("a.obj", square_obj);
    EXPECT_TRUE(scene.warnings.empty()) << scene.warnings.front();
    ASSERT_EQ(triangles(scene), 2u);
    const Primitive& p = scene.meshes[0].primitives[0];
    EXPECT_EQ(p.positions.size(), 4u);  // the corners that are the same are one vertex
    for (size_t i = 0; i < 4; ++i) {
        EXPECT_EQ(p.texcoords[i].x, p.positions[i].x / 2);
        EXPECT_EQ(p.texcoords[i].y, 1 - p.positions[i].y / 3);  // v points down in glTF
        EXPECT_EQ(p.normals[i], vec3(0, 0, 1));
    }
    const Material& m = scene.materials.at(p.material);
    EXPECT_EQ(m.name, "paint");
    expect_near(m.base_color, {linear(0.5f), linear(0.6f), linear(0.7f)});
    EXPECT_EQ(m.base_color.a, 0.5f);
    EXPECT_EQ(m.alpha, Material::Alpha::blend);
    EXPECT_EQ(m.metallic, 0);
    EXPECT_NEAR(m.roughness, 0.5f, 1e-6f);  // (2 / 32)^(1/4)
    EXPECT_EQ(m.emissive, vec3(1, 2, 0));
    EXPECT_TRUE(m.double_sided);
    ASSERT_EQ(scene.textures.size(), 1u);
    EXPECT_EQ(scene.textures[m.base_color_texture.texture].rgba, (std::vector<uint8_t>{10, 20, 30, 255, 40, 50, 60, 255}));
    expect_near(read("a.obj", square_obj, {.linear_colors = true}).materials[0].base_color, {0.5f, 0.6f, 0.7f});
}

TEST_F(Import, ObjMetal) {
    put("a.mtl", "newmtl paint\nKd 0 0 0\nKs 0.9 0.8 0.7\nNs 500\n");
    const Scene scene = read("a.obj", square_obj, {.linear_colors = true});
    EXPECT_EQ(scene.materials[0].metallic, 1);
    expect_near(scene.materials[0].base_color, {0.9f, 0.8f, 0.7f});
}

TEST_F(Import, ObjTexturesAsTheyAreNamed) {
    put("a.mtl", "newmtl paint\nmap_Kd C:\\Users\\me\\Pictures\\WOOD.PNG\n");
    put_png("Textures/wood.png", {10, 20, 30, 255, 40, 50, 60, 255});
    EXPECT_EQ(read("a.obj", square_obj).textures.size(), 1u);
    put("a.mtl", "newmtl paint\nmap_Kd textures\\wood.png\n");
    EXPECT_EQ(read("a.obj", square_obj).textures.size(), 1u);
    put("a.mtl", "newmtl paint\nmap_Kd gone.png\nmap_Ke broken.jpg\n");
    put("broken.jpg", "\xff\xd8\xff\xe0 and so on");
    const Scene scene = read("a.obj", square_obj);
    EXPECT_TRUE(scene.textures.empty());
    EXPECT_TRUE(says(scene, "1 textures are not in the scene's folder and were left out: gone.png"));
    EXPECT_TRUE(says(scene, "1 textures cannot be decoded and were left out: broken.jpg ("));
}

TEST_F(Import, NothingOutsideTheFolderIsOpened) {
    put_png("secret.png", {1, 1, 1, 255, 1, 1, 1, 255});
    put("secret.mtl", "newmtl paint\nKd 1 0 0\n");
    std::filesystem::create_symlink(folder / "secret.png", put("scene/x", "") + ".png");
    for (const char* name : {"../secret.png", "x.png"}) {
        put("scene/a.mtl", std::string("newmtl paint\nmap_Kd ") + name + "\n");
        const Scene scene = read("scene/a.obj", square_obj);
        EXPECT_TRUE(scene.textures.empty()) << name;
        EXPECT_TRUE(says(scene, "not in the scene's folder")) << name;
    }
    put("scene/a.mtl", "newmtl paint\nmap_Kd " + (folder / "secret.png").string() + "\n");
    EXPECT_TRUE(read("scene/a.obj", square_obj).textures.empty());
    const Scene scene = read("scene/a.obj", std::string("mtllib ../secret.mtl\n") + std::strchr(square_obj, '\n'));
    EXPECT_TRUE(says(scene, "secret.mtl"));
    EXPECT_NE(scene.materials[0].base_color.g, 0);
}

TEST_F(Import, AlphaFromWhereverItIs) {
    const auto material = [&](const std::string& mtl) {
        put("a.mtl", "newmtl paint\nKd 1 1 1\n" + mtl);
        Scene scene = read("a.obj", square_obj);
        return std::pair(scene.materials[0], scene.textures.empty() ? Texture() : scene.textures[scene.materials[0].base_color_texture.texture]);
    };
    put_png("leaf.png", {10, 20, 30, 0, 40, 50, 60, 255});
    put_png("glass.png", {10, 20, 30, 100, 40, 50, 60, 100});
    put_png("hole.png", {0, 0, 0, 255, 255, 255, 255, 255});
    put_png("wood.png", {1, 2, 3, 255, 4, 5, 6, 255});
    EXPECT_EQ(material("map_Kd leaf.png\n").first.alpha, Material::Alpha::mask);
    EXPECT_EQ(material("map_Kd leaf.png\nmap_d leaf.png\n").first.alpha, Material::Alpha::mask);
    EXPECT_EQ(material("map_Kd leaf.png\nmap_d leaf.png\n").second.rgba[3], 0);
    EXPECT_EQ(material("map_Kd glass.png\n").first.alpha, Material::Alpha::blend);
    EXPECT_EQ(material("map_Kd wood.png\n").first.alpha, Material::Alpha::opaque);
    const auto [m, texture] = material("map_Kd wood.png\nmap_d hole.png\n");
    EXPECT_EQ(m.alpha, Material::Alpha::mask);
    EXPECT_EQ(texture.rgba, (std::vector<uint8_t>{1, 2, 3, 0, 4, 5, 6, 255}));
    EXPECT_EQ(material("map_d hole.png\n").second.rgba, (std::vector<uint8_t>{255, 255, 255, 0, 255, 255, 255, 255}));
}

TEST_F(Import, ObjWithoutMaterialsAndNormals) {
    // A roof of two slopes that meet at a right angle, one vertex a place: sharp by default, smooth when asked for.
    const std::string roof = "v -1 0 0\nv 0 1 0\nv 1 0 0\nv -1 0 1\nv 0 1 1\nv 1 0 1\nf 4 5 2 1\nf 5 6 3 2\n";
    const Scene sharp = read("roof.obj", roof);
    EXPECT_EQ(sharp.materials.size(), 1u);
    expect_near(sharp.materials[0].base_color, vec3(0.8f));
    EXPECT_EQ(sharp.meshes[0].primitives[0].positions.size(), 8u);
    EXPECT_EQ(read("roof.obj", roof, {.crease = 100.0f}).meshes[0].primitives[0].positions.size(), 6u);
    EXPECT_TRUE(read("roof.obj", roof, {.crease = 0.0f}).meshes[0].primitives[0].normals.empty());
    EXPECT_TRUE(says(read("roof.obj", "mtllib gone.mtl\n" + roof), "gone.mtl"));
}

TEST_F(Import, ObjPolygons) {
    // A concave L of six corners, with its area kept; a line and a point left out; a degenerate triangle dropped.
    const Scene scene = read("l.obj", "v 0 0 0\nv 2 0 0\nv 2 1 0\nv 1 1 0\nv 1 2 0\nv 0 2 0\nf 1 2 3 4 5 6\nl 1 2\np 3\nf 1 2 2\n");
    double area = 0;
    const Primitive& p = scene.meshes[0].primitives[0];
    for (size_t t = 0; t < p.indices.size(); t += 3) {
        const vec3 n = glm::cross(p.positions[p.indices[t + 1]] - p.positions[p.indices[t]], p.positions[p.indices[t + 2]] - p.positions[p.indices[t]]);
        EXPECT_GT(n.z, 0);
        area += n.z / 2;
    }
    EXPECT_EQ(area, 3);
    EXPECT_TRUE(says(scene, "2 points and lines"));
}

TEST_F(Import, ObjVertexColors) {
    const Scene scene = read("c.obj", "v 0 0 0 1 0.5 0\nv 1 0 0 1 0.5 0\nv 0 1 0 0 0.5 1\nf 1 2 3\n");
    const Primitive& p = scene.meshes[0].primitives[0];
    ASSERT_EQ(p.colors.size(), 3u);
    expect_near(p.colors[0], {1, linear(0.5f), 0});
    EXPECT_EQ(vec3(scene.materials[0].base_color), vec3(1));
}

TEST_F(Import, UnitsAndAxes) {
    const std::string box = "v 0 0 0\nv 1 2 3\nv 1 0 0\nf 1 2 3\n";
    const auto size = [&](const ImportOptions& options) {
        const auto [lo, hi] = bounds(read("u.obj", box, options));
        return hi - lo;
    };
    expect_near(size({}), {1, 2, 3});
    expect_near(size({.unit = 0.0254}), {0.0254f, 0.0508f, 0.0762f});
    expect_near(size({.up = Axis::z}), {1, 3, 2});
    expect_near(size({.up = Axis::x}), {2, 1, 3});
    const auto [lo, hi] = bounds(read("u.obj", box, {.up = Axis::z}));
    expect_near(lo, {0, 0, -2});  // turned, not mirrored: the file's +Y goes to -Z
    expect_near(hi, {1, 3, 0});
}

// ---- PLY and STL

const std::string ply_head = "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n";
const std::string ply_faces = "element face 1\nproperty list uchar int vertex_indices\nend_header\n";

TEST_F(Import, Ply) {
    const Scene scene = read("a.ply", ply_head + "property uchar red\nproperty uchar green\nproperty uchar blue\n" + ply_faces +
                                          "0 0 0 255 0 0\n1 0 0 255 0 0\n1 1 0 255 0 0\n0 1 0 0 188 0\n4 0 1 2 3\n");
    ASSERT_EQ(triangles(scene), 2u);
    const Primitive& p = scene.meshes[0].primitives[0];
    EXPECT_EQ(p.positions.size(), 4u);
    EXPECT_NEAR(p.colors[3].g, linear(188 / 255.0f), 1e-5f);
    EXPECT_EQ(vec3(scene.materials[0].base_color), vec3(1));
    EXPECT_EQ(p.normals[0], vec3(0, 0, 1));
}

// A triangle and a strip of two, in each encoding, with properties and elements that nobody asked for.
std::string binary_ply(bool big) {
    std::string text = std::string("ply\r\nformat binary_") + (big ? "big" : "little") + "_endian 1.0\nobj_info x\nelement vertex 4\nproperty double x\nproperty float y\n"
                       "property short z\nproperty list uchar float spare\nelement edge 2\nproperty int a\nelement face 1\nproperty uchar flags\n"
                       "property list int ushort vertex_index\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n";
    const auto add = [&](auto value) {
        auto raw = std::bit_cast<std::array<char, sizeof value>>(value);
        if (big) std::ranges::reverse(raw);
        text.append(raw.data(), raw.size());
    };
    for (const auto& [x, y, z] : {std::tuple(0.0, 0.f, short(0)), {1.0, 0.f, short(0)}, {1.0, 1.f, short(-5)}, {0.0, 1.f, short(0)}}) {
        add(x), add(y), add(z), add(uint8_t(1)), add(7.f);
    }
    add(1), add(2);
    add(uint8_t(9)), add(3), add(uint16_t(0)), add(uint16_t(1)), add(uint16_t(2));
    add(6), add(0), add(1), add(2), add(3), add(-1), add(0);
    return text;
}

TEST_F(Import, PlyBinary) {
    for (const bool big : {false, true}) {
        const Scene scene = read("b.ply", binary_ply(big), {.crease = 0.0f});
        ASSERT_EQ(triangles(scene), 3u);
        const Primitive& p = scene.meshes[0].primitives[0];
        EXPECT_EQ(p.positions[2], vec3(1, 1, -5));
        EXPECT_EQ(p.indices, (std::vector<uint32_t>{0, 1, 2, 0, 1, 2, 2, 1, 3}));  // the second of a strip is turned
    }
    const std::string path = (folder / "b.PLY.gz").string(), text = binary_ply(false);  // and compressed; case does not count
    gzFile file = gzopen(path.c_str(), "wb");
    gzwrite(file, text.data(), unsigned(text.size()));
    gzclose(file);
    EXPECT_EQ(triangles(import_scene(path)), 3u);
    std::filesystem::resize_file(path, std::filesystem::file_size(path) / 2);
    EXPECT_NE(refused(path).find("gzip"), std::string::npos);
}

TEST_F(Import, PlyThatIsNone) {
    const std::string rows = "0 0 0\n1 0 0\n1 1 0\n0 1 0\n";
    const auto refuse = [&](const std::string& text) { return refused(put("r.ply", text)); };
    EXPECT_NE(refuse("plyers\n").find("begin with"), std::string::npos);
    EXPECT_NE(refuse("ply\nformat ascii 1.0\n").find("no end"), std::string::npos);
    EXPECT_NE(refuse("ply\nend_header\n").find("no format"), std::string::npos);
    EXPECT_NE(refuse("ply\nformat morse 1.0\nend_header\n").find("morse"), std::string::npos);
    EXPECT_NE(refuse("ply\nformat ascii 1.0\nproperty float x\nend_header\n").find("makes no sense"), std::string::npos);
    EXPECT_NE(refuse("ply\nformat ascii 1.0\nelement vertex -4\nend_header\n").find("makes no sense"), std::string::npos);
    EXPECT_NE(refuse("ply\nformat ascii 1.0\nelement vertex 1\nproperty long x\nend_header\n").find("makes no sense"), std::string::npos);
    EXPECT_NE(refuse("ply\nformat ascii 1.0\nelement vertex 1\nproperty list float int x\nend_header\n").find("makes no sense"), std::string::npos);
    EXPECT_NE(refuse("ply\nformat ascii 1.0\nelement vertex 1\nproperty float x\nend_header\n1\n").find("no x, y and z"), std::string::npos);
    EXPECT_NE(refuse("ply\nformat ascii 1.0\nelement vertex 18446744073709551615\nproperty float x\nend_header\n1\n").find("announced"), std::string::npos);
    EXPECT_NE(refuse(ply_head + ply_faces + rows + "3 0 1 4\n").find("only 4 vertices"), std::string::npos);
    EXPECT_NE(refuse(ply_head + ply_faces + rows + "3 0 1 -1\n").find("corner -1"), std::string::npos);
    EXPECT_NE(refuse(ply_head + ply_faces + rows + "3 0 1 0.5\n").find("corner 0.5"), std::string::npos);
    EXPECT_NE(refuse(ply_head + ply_faces + rows + "300 0 1 2\n").find("announced"), std::string::npos);
    for (const char* count : {"1e20", "1e120", "inf", "-1", "2.5", "nan"}) EXPECT_NE(refuse(ply_head + ply_faces + rows + count + " 0 1 2\n").find("a list has"), std::string::npos);
    const std::string xyz = "property float x\nproperty float y\nproperty float z\n";
    EXPECT_NE(refuse("ply\nformat ascii 1.0\nelement vertex 1\n" + xyz + "element vertex 1\n" + xyz + "property float u\nproperty float v\nend_header\n0 0 0\n0 0 0 1 1\n").find("vertices twice"), std::string::npos);
    EXPECT_NE(refuse(ply_head + ply_faces + rows + "3 0 1\n").find("end too early"), std::string::npos);
    EXPECT_NE(refuse(ply_head + ply_faces + "0 0 zero\n").find("\"zero\" is not a number"), std::string::npos);
    const Scene odd = read("o.ply", ply_head + ply_faces + "0 0 0\n+1 0 0\n1e0 1 nan\n0 1. 0\n4 0 1 2 3\n");
    EXPECT_TRUE(says(odd, "not finite"));
}

std::string binary_stl(const std::vector<vec3>& corners, vec3 normal) {
    std::string out(80, ' ');
    const uint32_t count = uint32_t(corners.size() / 3);
    out.append(reinterpret_cast<const char*>(&count), 4);
    for (size_t i = 0; i < corners.size(); ++i) {
        if (i % 3 == 0) out.append(reinterpret_cast<const char*>(&normal), 12);
        out.append(reinterpret_cast<const char*>(&corners[i]), 12);
        if (i % 3 == 2) out.append(2, '\0');
    }
    return out;
}

TEST_F(Import, Stl) {
    // Millimetres, +Z up; the normals of the file are wrong and do not count; corners become shared vertices.
    const std::vector<vec3> corners = {{0, 0, 0}, {1000, 0, 0}, {1000, 2000, 0}, {0, 0, 0}, {1000, 2000, 0}, {0, 2000, 0}};
    const Scene scene = read("a.stl", binary_stl(corners, {0, 0, -1}));
    ASSERT_EQ(triangles(scene), 2u);
    EXPECT_EQ(scene.meshes[0].primitives[0].positions.size(), 4u);
    const auto [lo, hi] = bounds(scene);
    expect_near(lo, {0, 0, -2});
    expect_near(hi, {1, 0, 0});
    Scene copy = scene;
    expect_near(flatten(copy).normals[0], {0, 1, 0});
    EXPECT_EQ(triangles(read("b.stl", "solid x\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid x\n")), 1u);
}

// ---- Collada and FBX

std::string collada(const std::string& unit, const std::string& up) {
    return "<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\"><asset>" + unit + up +
           "</asset><library_cameras><camera id=\"c\" name=\"c\"><optics><technique_common><perspective><yfov>60</yfov><aspect_ratio>2</aspect_ratio>"
           "<znear>0.1</znear><zfar>10</zfar></perspective></technique_common></optics></camera></library_cameras>"
           "<library_lights><light id=\"l\"><technique_common><point><color> 3 2 1</color></point></technique_common></light></library_lights>"
           "<library_effects><effect id=\"e\"><profile_COMMON><technique sid=\"t\"><lambert><diffuse><color>  1 0.5 0 1 </color></diffuse></lambert>"
           "</technique></profile_COMMON></effect></library_effects><library_materials><material id=\"m\" name=\"clay\"><instance_effect url=\"#e\"/>"
           "</material></library_materials><library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"a\" count=\"9\">\n"
           "0 0 0 1 0 0 0 2 3</float_array><technique_common><accessor source=\"#a\" count=\"3\" stride=\"3\"><param name=\"X\" type=\"float\"/>"
           "<param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor></technique_common></source><vertices id=\"v\">"
           "<input semantic=\"POSITION\" source=\"#p\"/></vertices><triangles count=\"1\" material=\"s\"><input semantic=\"VERTEX\" source=\"#v\" offset=\"0\"/>"
           "<p>0 1 2</p></triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id=\"scene\">"
           "<node id=\"n\" name=\"n\"><scale>-1 1 1</scale><instance_geometry url=\"#g\"><bind_material><technique_common><instance_material symbol=\"s\" "
           "target=\"#m\"/></technique_common></bind_material></instance_geometry></node><node id=\"n2\" name=\"n2\"><translate>5 0 0</translate>"
           "<instance_geometry url=\"#g\"/></node><node id=\"cn\" name=\"cn\"><translate>0 0 7</translate><instance_camera url=\"#c\"/></node>"
           "<node id=\"ln\" name=\"ln\"><translate>0 8 0</translate><instance_light url=\"#l\"/></node></visual_scene></library_visual_scenes>"
           "<scene><instance_visual_scene url=\"#scene\"/></scene></COLLADA>";
}

TEST_F(Import, Collada) {
    const Scene scene = read("a.dae", collada("<unit meter=\"0.01\"/>", "<up_axis>Z_UP</up_axis>"));
    ASSERT_EQ(scene.instances.size(), 2u);
    expect_near(scene.materials[0].base_color, {1, linear(0.5f), 0});
    const auto [lo, hi] = bounds(scene);  // x from -1 (mirrored) to 6, y from 0 to 2, z from 0 to 3, in centimetres, +Z up
    expect_near(lo, {-0.01f, 0, -0.02f});
    expect_near(hi, {0.06f, 0.03f, 0});
    EXPECT_LT(glm::determinant(glm::mat3(scene.instances[0].to_world)), 0);
    ASSERT_EQ(scene.cameras.size(), 1u);
    EXPECT_EQ(scene.cameras[0].name, "cn");
    EXPECT_NEAR(scene.cameras[0].yfov, 1.0471976f, 1e-5f);
    expect_near(scene.cameras[0].to_world[3], {0, 0.07f, 0});
    expect_near(-scene.cameras[0].to_world[2], {0, -1, 0});  // along the file's -Z
    ASSERT_EQ(scene.lights.size(), 1u);
    expect_near(scene.lights[0].position, {0, 0, -0.08f});
    EXPECT_EQ(scene.lights[0].intensity, vec3(3, 2, 1));
}

TEST_F(Import, ColladaFrameMayBeOverruled) {
    const std::string text = collada("<unit name=\"inch\" meter=\"0,0254\"/>", "<up_axis>Z_UP</up_axis>");
    const auto size = [&](const ImportOptions& options) {
        const auto [lo, hi] = bounds(read("a.dae", text, options));
        return hi - lo;
    };
    expect_near(size({}), vec3(7, 3, 2) * 0.0254f);
    expect_near(size({.unit = 1}), {7, 3, 2}, 1e-4f);
    expect_near(size({.unit = 0.01, .up = Axis::y}), {0.07f, 0.02f, 0.03f});
}

std::string fbx(int up, double unit) {
    return "; FBX 7.4.0 project file\nFBXHeaderExtension:  {\n\tFBXHeaderVersion: 1003\n\tFBXVersion: 7400\n}\nGlobalSettings:  {\n\tVersion: 1000\n\tProperties70:  {\n"
           "\t\tP: \"UpAxis\", \"int\", \"Integer\", \"\"," + std::to_string(up) + "\n\t\tP: \"UpAxisSign\", \"int\", \"Integer\", \"\",1\n"
           "\t\tP: \"UnitScaleFactor\", \"double\", \"Number\", \"\"," + std::to_string(unit) + "\n\t}\n}\n"
           "Objects:  {\n\tGeometry: 10, \"Geometry::\", \"Mesh\" {\n\t\tVertices: *12 {\n\t\t\ta: 0,0,0,1,0,0,1,2,3,0,2,3\n\t\t}\n"
           "\t\tPolygonVertexIndex: *4 {\n\t\t\ta: 0,1,2,-4\n\t\t}\n\t\tGeometryVersion: 124\n\t\tLayerElementMaterial: 0 {\n\t\t\tVersion: 101\n\t\t\tName: \"\"\n"
           "\t\t\tMappingInformationType: \"AllSame\"\n\t\t\tReferenceInformationType: \"IndexToDirect\"\n\t\t\tMaterials: *1 {\n\t\t\t\ta: 0\n\t\t\t}\n\t\t}\n"
           "\t\tLayer: 0 {\n\t\t\tVersion: 100\n\t\t\tLayerElement:  {\n\t\t\t\tType: \"LayerElementMaterial\"\n\t\t\t\tTypedIndex: 0\n\t\t\t}\n\t\t}\n\t}\n"
           "\tModel: 20, \"Model::sheet\", \"Mesh\" {\n\t\tVersion: 232\n\t}\n"
           "\tMaterial: 30, \"Material::paint\", \"\" {\n\t\tVersion: 102\n\t\tShadingModel: \"lambert\"\n\t\tProperties70:  {\n"
           "\t\t\tP: \"DiffuseColor\", \"Color\", \"\", \"A\",1,0.5,0\n\t\t}\n\t}\n}\n"
           "Connections:  {\n\tC: \"OO\",20,0\n\tC: \"OO\",10,20\n\tC: \"OO\",30,20\n}\n";
}

TEST_F(Import, Fbx) {
    const Scene scene = read("a.fbx", fbx(1, 1));
    ASSERT_EQ(triangles(scene), 2u);
    EXPECT_EQ(scene.materials[0].name, "paint");
    expect_near(scene.materials[0].base_color, {1, linear(0.5f), 0});
    const auto size = [&](const Scene& s) {
        const auto [lo, hi] = bounds(s);
        return hi - lo;
    };
    expect_near(size(scene), {0.01f, 0.02f, 0.03f});
    expect_near(size(read("z.fbx", fbx(2, 100))), {1, 3, 2});
    expect_near(size(read("z.fbx", fbx(2, 100), {.unit = 2, .up = Axis::y})), {2, 4, 6});
}

// ---- what is no scene

TEST_F(Import, OneOfTheScenesOfAFile) {
    const std::string path = put("two.gltf", R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"name": "a", "nodes": [0]}, {"name": "b", "nodes": [1]}],
        "nodes": [{"mesh": 0, "translation": [1, 0, 0]}, {"mesh": 0, "translation": [2, 0, 0]}],
        "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}], "buffers": [{"uri": "t.bin", "byteLength": 36}],
        "bufferViews": [{"buffer": 0, "byteLength": 36}],
        "accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}]})");
    const float corners[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    put("t.bin", std::string(reinterpret_cast<const char*>(corners), sizeof corners));
    const auto x = [](const Scene& scene) { return scene.instances.at(0).to_world[3].x; };
    EXPECT_EQ(x(import_scene(path)), 1);
    EXPECT_EQ(x(import_scene(path + "#b")), 2);
    EXPECT_EQ(x(import_scene(path + "#1")), 2);
    EXPECT_THROW(import_scene(path + "#c"), InputError);
    EXPECT_NE(refused(put("one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n") + "#b").find("only glTF has scenes"), std::string::npos);
}

TEST_F(Import, Endings) {
    EXPECT_NE(refused(put("a.xyz", "")).find("give one of .gltf, .glb, "), std::string::npos);
    EXPECT_NE(refused((folder / "none.obj").string()).find("there is no such file"), std::string::npos);
    std::filesystem::create_directories(folder / "folder.obj");
    EXPECT_NE(refused((folder / "folder.obj").string()).find("there is no such file"), std::string::npos);
    // What an ending says is what is tried, and nothing else.
    EXPECT_NE(refused(put("a.fbx", ply_head)).find("cannot be read"), std::string::npos);
    for (const char* ending : {"obj", "ply", "stl", "fbx", "dae"}) EXPECT_NE(refused(put(std::string("empty.") + ending, "")).find("empty"), std::string::npos);
}

TEST_F(Import, IndicesOutOfRange) {
    for (const char* faces : {"f 1 2 4\n", "f 1 2 -7\n", "f 1/9/9 2 3\n", "f 1 2 99999999999999\n"})
        refused(put("a.obj", std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\n") + faces));
    refused(put("a.ply", ply_head + ply_faces + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n3 0 1 77\n"));
    refused(put("b.ply", "ply\nformat ascii 1.0\nelement vertex 2000000000\nproperty float x\nend_header\n"));
    refused(put("b.stl", binary_stl({}, {}).substr(0, 80) + "\xff\xff\xff\xff" + std::string(50, 'x')));
}

// A file that is cut off, or has a byte wrong: a scene or one sentence, each time.
TEST_F(Import, DamagedFiles) {
    put("a.mtl", "newmtl paint\nKd 0.5 0.6 0.7\nmap_Kd wood.png\n");
    put_png("wood.png", {10, 20, 30, 255, 40, 50, 60, 255});
    const std::vector<std::pair<std::string, std::string>> files = {
        {"d.obj", square_obj},
        {"d.ply", ply_head + ply_faces + "0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 0 1 2 3\n"},
        {"e.ply", binary_ply(true)},
        {"d.stl", binary_stl({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, {0, 0, 1})},
        {"d.dae", collada("<unit meter=\"0.01\"/>", "<up_axis>Z_UP</up_axis>")},
        {"d.fbx", fbx(1, 1)}};
    kit::Random random(5);
    for (const auto& [name, contents] : files) {
        size_t read_well = 0;
        for (int i = 0; i < 60; ++i) {
            std::string damaged = contents;
            if (i % 3 == 0) damaged.resize(random.below(uint32_t(damaged.size())));
            else
                for (int k = 0; k < 1 + i % 4; ++k) damaged[random.below(uint32_t(damaged.size()))] = i % 3 == 1 ? char(random.below(256)) : "0-9e.{</ "[random.below(9)];
            if (refused(put(name, damaged)) == "(accepted)") ++read_well;
        }
        EXPECT_LT(read_well, 60u) << name;
    }
}

}  // namespace
}  // namespace myriad::scenes
