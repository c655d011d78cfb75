#include <array>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <filesystem>
#include <functional>
#include <memory>

#include <draco/compression/encode.h>
#include <draco/mesh/triangle_soup_mesh_builder.h>
#include <jpeglib.h>
#include <meshoptimizer.h>
#include <nlohmann/json.hpp>
#include <png.h>

#include "scenes/builtin/kit.hpp"
#include "scenes/gltf/write.hpp"
#include "scenes/scene.hpp"
#include "tests/fuzz/targets.hpp"

namespace myriad::fuzz {
namespace {

using nlohmann::json;

// ---- pictures

std::string png(int depth, int type, int interlace) {
    constexpr uint32_t side = 9;
    std::string out;
    png_structp writer = png_create_write_struct(PNG_LIBPNG_VER_STRING, nullptr, nullptr, nullptr);
    png_infop info = png_create_info_struct(writer);
    png_set_write_fn(writer, &out, [](png_structp p, png_bytep bytes, size_t n) {
        static_cast<std::string*>(png_get_io_ptr(p))->append(reinterpret_cast<char*>(bytes), n);
    }, nullptr);
    png_set_IHDR(writer, info, side, side, depth, type, interlace, PNG_COMPRESSION_TYPE_DEFAULT, PNG_FILTER_TYPE_DEFAULT);
    const png_color palette[] = {{255, 0, 0}, {0, 255, 0}, {0, 0, 255}, {9, 9, 9}};
    const uint8_t alpha[] = {255, 128, 0};
    if (type == PNG_COLOR_TYPE_PALETTE) png_set_PLTE(writer, info, palette, 4), png_set_tRNS(writer, info, alpha, 3, nullptr);
    png_write_info(writer, info);
    std::vector<std::vector<uint8_t>> pixels(side, std::vector<uint8_t>(png_get_rowbytes(writer, info)));
    std::vector<uint8_t*> rows;
    for (size_t y = 0; y < side; ++y) {
        for (size_t i = 0; i < pixels[y].size(); ++i) pixels[y][i] = uint8_t(y * 40 + i * 7);
        rows.push_back(pixels[y].data());
    }
    png_write_image(writer, rows.data());
    png_write_end(writer, nullptr);
    png_destroy_write_struct(&writer, &info);
    return out;
}

std::string jpeg(J_COLOR_SPACE space, int components, bool progressive) {
    jpeg_compress_struct out{};
    jpeg_error_mgr errors{};
    out.err = jpeg_std_error(&errors);
    jpeg_create_compress(&out);
    unsigned char* bytes = nullptr;
    unsigned long size = 0;
    jpeg_mem_dest(&out, &bytes, &size);
    out.image_width = 17, out.image_height = 11;
    out.input_components = components, out.in_color_space = space;
    jpeg_set_defaults(&out);
    jpeg_set_quality(&out, 50, TRUE);
    if (progressive) jpeg_simple_progression(&out);
    jpeg_start_compress(&out, TRUE);
    for (int y = 0; y < 11; ++y) {
        std::vector<uint8_t> row(size_t(17 * components));
        for (size_t i = 0; i < row.size(); ++i) row[i] = uint8_t(y * 20 + int(i) * 3);
        JSAMPROW at = row.data();
        jpeg_write_scanlines(&out, &at, 1);
    }
    jpeg_finish_compress(&out);
    jpeg_destroy_compress(&out);
    std::string result(reinterpret_cast<char*>(bytes), size);
    std::free(bytes);
    return result;
}

std::vector<std::string> pictures() {
    return {png(8, PNG_COLOR_TYPE_RGB, PNG_INTERLACE_NONE),       png(16, PNG_COLOR_TYPE_GRAY_ALPHA, PNG_INTERLACE_NONE),
            png(2, PNG_COLOR_TYPE_PALETTE, PNG_INTERLACE_ADAM7),  png(16, PNG_COLOR_TYPE_RGB_ALPHA, PNG_INTERLACE_ADAM7),
            jpeg(JCS_RGB, 3, false),                              jpeg(JCS_RGB, 3, true),
            jpeg(JCS_GRAYSCALE, 1, false),                        jpeg(JCS_CMYK, 4, true)};
}

// ---- Draco

// A bent sheet of 8 x 8 quads, with normals and texture coordinates.
std::string draco_sheet(int method, int speed, bool quantised) {
    constexpr int n = 8;
    using Corners = std::array<glm::ivec2, 3>;
    ::draco::TriangleSoupMeshBuilder builder;
    builder.Start(n * n * 2);
    const int position = builder.AddAttribute(::draco::GeometryAttribute::POSITION, 3, ::draco::DT_FLOAT32);
    const int normal = builder.AddAttribute(::draco::GeometryAttribute::NORMAL, 3, ::draco::DT_FLOAT32);
    const int texcoord = builder.AddAttribute(::draco::GeometryAttribute::TEX_COORD, 2, ::draco::DT_FLOAT32);
    const auto corner = [](int x, int y) { return glm::vec3(x, y, float((x - 4) * (y - 4)) / 8); };
    int face = 0;
    for (int y = 0; y < n; ++y)
        for (int x = 0; x < n; ++x)
            for (const auto& c : {Corners{{{0, 0}, {1, 0}, {1, 1}}}, Corners{{{0, 0}, {1, 1}, {0, 1}}}}) {
                glm::vec3 p[3], up{0, 0, 1};
                glm::vec2 t[3];
                for (int k = 0; k < 3; ++k) p[k] = corner(x + c[size_t(k)].x, y + c[size_t(k)].y), t[k] = glm::vec2(p[k]) / 8.0f;
                const ::draco::FaceIndex f(uint32_t(face++));
                builder.SetAttributeValuesForFace(position, f, &p[0], &p[1], &p[2]);
                builder.SetAttributeValuesForFace(normal, f, &up, &up, &up);
                builder.SetAttributeValuesForFace(texcoord, f, &t[0], &t[1], &t[2]);
            }
    const auto mesh = builder.Finalize();
    ::draco::Encoder encoder;
    encoder.SetEncodingMethod(method);
    encoder.SetSpeedOptions(speed, speed);
    if (quantised)
        for (const auto type : {::draco::GeometryAttribute::POSITION, ::draco::GeometryAttribute::NORMAL, ::draco::GeometryAttribute::TEX_COORD})
            encoder.SetAttributeQuantization(type, 8);
    ::draco::EncoderBuffer buffer;
    if (!encoder.EncodeMeshToBuffer(*mesh, &buffer).ok()) std::abort();
    return {buffer.data(), buffer.size()};
}

std::vector<std::string> draco_streams() {
    return {draco_sheet(::draco::MESH_EDGEBREAKER_ENCODING, 5, true), draco_sheet(::draco::MESH_EDGEBREAKER_ENCODING, 0, true),
            draco_sheet(::draco::MESH_EDGEBREAKER_ENCODING, 10, false), draco_sheet(::draco::MESH_SEQUENTIAL_ENCODING, 5, true),
            draco_sheet(::draco::MESH_SEQUENTIAL_ENCODING, 10, false)};
}

// ---- meshopt

struct Stream {
    std::string mode, filter, bytes;
    int stride = 0, count = 0;
};

std::vector<Stream> meshopt_streams() {
    std::vector<unsigned> triangles;
    std::vector<std::array<float, 4>> vertices;
    for (unsigned i = 0; i < 60; ++i) triangles.insert(triangles.end(), {i, i + 1, i + 2}), vertices.push_back({float(i), float(i % 7), 0.5f, 1});
    vertices.resize(62);
    std::vector<Stream> out;
    const auto add = [&](const char* mode, const char* filter, int stride, size_t count, size_t bound, const auto& encode) {
        std::string bytes(bound, '\0');
        bytes.resize(encode(reinterpret_cast<unsigned char*>(bytes.data()), bound));
        out.push_back({mode, filter, bytes, stride, int(count)});
    };
    const size_t n = vertices.size(), m = triangles.size();
    for (const char* filter : {"NONE", "EXPONENTIAL"})
        add("ATTRIBUTES", filter, 16, n, meshopt_encodeVertexBufferBound(n, 16), [&](auto* to, size_t size) { return meshopt_encodeVertexBuffer(to, size, vertices.data(), n, 16); });
    for (const char* filter : {"OCTAHEDRAL", "QUATERNION"})
        add("ATTRIBUTES", filter, 8, 2 * n, meshopt_encodeVertexBufferBound(2 * n, 8), [&](auto* to, size_t size) { return meshopt_encodeVertexBuffer(to, size, vertices.data(), 2 * n, 8); });
    add("TRIANGLES", "NONE", 4, m, meshopt_encodeIndexBufferBound(m, n), [&](auto* to, size_t size) { return meshopt_encodeIndexBuffer(to, size, triangles.data(), m); });
    add("INDICES", "NONE", 2, m, meshopt_encodeIndexSequenceBound(m, n), [&](auto* to, size_t size) { return meshopt_encodeIndexSequence(to, size, triangles.data(), m); });
    return out;
}

std::vector<std::string> meshopt_inputs() {
    std::vector<std::string> out;
    for (const Stream& s : meshopt_streams()) {
        const int mode = s.mode == "ATTRIBUTES" ? 0 : s.mode == "TRIANGLES" ? 1 : 2;
        const int filter = s.filter == "NONE" ? 0 : s.filter == "OCTAHEDRAL" ? 1 : s.filter == "QUATERNION" ? 2 : 3;
        out.push_back(std::string{char(mode), char(filter), char(s.stride), char(s.count % 256), char(s.count / 256)} + s.bytes);
    }
    return out;
}

// ---- what convert reads

std::string words(std::initializer_list<uint32_t> list) { return {reinterpret_cast<const char*>(list.begin()), 4 * list.size()}; }

std::string floats(std::initializer_list<float> list) { return {reinterpret_cast<const char*>(list.begin()), 4 * list.size()}; }

// A map of one square, and one patch.
std::string ibsp_map() {
    const std::string entities = "{\n\"classname\" \"worldspawn\"\n}\n{\n\"classname\" \"light\"\n\"origin\" \"0 0 64\"\n\"light\" \"300\"\n}\n"
                                 "{\n\"classname\" \"info_player_deathmatch\"\n\"origin\" \"8 8 24\"\n\"angle\" \"90\"\n}\n";
    std::string shader = "textures/base_floor/tile", vertices;
    shader.resize(64);
    shader += words({0, 1});
    for (int i = 0; i < 13; ++i)
        vertices += floats({float(i % 3) * 32, float(i / 3) * 32, float(i % 2) * 9, 0.5f, 0.25f, 0, 0, 0, 0, 1}) + words({~0u});
    std::string faces = words({0, 0, 1, 0, 4, 0, 6}) + std::string(19 * 4, '\0');
    faces += words({0, 0, 2, 4, 9, 0, 0}) + std::string(17 * 4, '\0') + words({3, 3});
    const std::string models = words({0, 0, 0, 0, 0, 0, 0, 2, 0, 0}), corners = words({0, 1, 2, 0, 2, 3});
    std::string out = "IBSP" + words({46}) + std::string(17 * 8, '\0');
    for (const auto& [lump, bytes] : {std::pair<size_t, const std::string&>(0, entities), {1, shader}, {7, models}, {10, vertices}, {11, corners}, {13, faces}}) {
        out.replace(8 + 8 * lump, 8, words({uint32_t(out.size()), uint32_t(bytes.size())}));
        out += bytes;
    }
    return out;
}

std::string embree_strands() {
    const std::string xml = "<?xml version=\"1.0\"?><scene><assign type=\"scene\" id=\"a\"><RoundLineSegments><material><code>\"Hair\"</code><parameters>"
                            "<float3 name=\"Kr\">0.1 0.2 0.3</float3></parameters></material><indices ofs=\"0\" size=\"3\"/><positions ofs=\"12\" size=\"5\"/>"
                            "</RoundLineSegments></assign><Group><ref id=\"a\"/></Group></scene>";
    return xml + '\0' + words({0, 1, 3}) + floats({0, 0, 0, 0.1f, 0, 1, 0, 0.1f, 0.5f, 2, 0, 0.05f, 3, 0, 0, 0.2f, 4, 0, 0, 0.1f});
}

std::vector<std::string> for_assimp() {
    using namespace std::string_literals;
    return {"\0mtllib a.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 1 0\nvt 0 0\nvn 0 0 1\nusemtl red\ng part\nf 1/1/1 2/1/1 3/1/1\nf 2 4 3\n"s,
            "\1ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nproperty uchar red\nelement face 1\n"
            "property list uchar int vertex_indices\nend_header\n0 0 0 255\n1 0 0 9\n0 1 0 7\n3 0 1 2\n"s,
            "\1ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement face 1\n"
            "property list uchar int vertex_indices\nend_header\n"s + floats({0, 0, 0, 1, 0, 0, 0, 1, 0}) + '\3' + words({0, 1, 2}),
            "\2solid a\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\nendloop\nendfacet\nendsolid a\n"s,
            "\2"s + std::string(80, 'b') + words({1}) + floats({0, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1, 0}) + "\0\0"s,
            "\3<?xml version=\"1.0\"?><COLLADA xmlns=\"http://www.collada.org/2005/11/COLLADASchema\" version=\"1.4.1\"><asset><unit meter=\"0.01\"/><up_axis>Z_UP</up_axis>"
            "</asset><library_geometries><geometry id=\"g\"><mesh><source id=\"p\"><float_array id=\"f\" count=\"9\">0 0 0 1 0 0 0 1 0</float_array><technique_common>"
            "<accessor source=\"#f\" count=\"3\" stride=\"3\"><param name=\"X\" type=\"float\"/><param name=\"Y\" type=\"float\"/><param name=\"Z\" type=\"float\"/></accessor>"
            "</technique_common></source><vertices id=\"v\"><input semantic=\"POSITION\" source=\"#p\"/></vertices><triangles count=\"1\"><input semantic=\"VERTEX\" "
            "source=\"#v\" offset=\"0\"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries><library_visual_scenes><visual_scene id=\"s\"><node>"
            "<instance_geometry url=\"#g\"/></node></visual_scene></library_visual_scenes><scene><instance_visual_scene url=\"#s\"/></scene></COLLADA>"s};
}

std::vector<std::string> ply_files() {
    using namespace std::string_literals;
    const std::string everything =
        "element vertex 4\ncomment four corners\nproperty float x\nproperty float y\nproperty double z\nproperty float nx\nproperty float ny\nproperty float nz\n"
        "property uchar red\nproperty uchar green\nproperty uchar blue\nproperty float u\nproperty float v\nproperty list uchar short extra\n"
        "element face 2\nproperty list uchar int vertex_indices\nelement tristrips 1\nproperty list int int vertex_indices\nend_header\n";
    std::string text = "ply\nformat ascii 1.0\n" + everything;
    for (int i = 0; i < 4; ++i) text += std::to_string(i % 2) + " " + std::to_string(i / 2) + ".5 0 0 0 1 255 128 0 0.5 1 2 7 8\n";
    text += "4 0 1 3 2\n3 0 1 2\n5 0 1 2 -1 3\n";
    std::vector<std::string> out = {for_assimp()[1].substr(1), for_assimp()[2].substr(1), text};
    std::string big = "ply\nformat binary_big_endian 1.0\nelement vertex 3\nproperty short x\nproperty ushort y\nproperty char z\nelement face 1\n"
                      "property list uchar ushort vertex_index\nend_header\n"s;
    big += "\0\1\0\1\1\0\2\0\1\2\0\1\0\3\3\3\0\0\0\1\0\2"s;
    out.push_back(big);
    return out;
}

// Small pictures, put together by hand: no library here writes these formats.
std::vector<std::string> textures() {
    using namespace std::string_literals;
    const auto u16 = [](int v) { return std::string{char(v), char(v >> 8)}; };
    const auto u32 = [](uint32_t v) { return words({v}); };
    const std::string pixels = "\0\x40\x80\xff\x20\x10\0\x7f\xff\x01\x02\x03"s;  // 2 x 2 of three bytes
    const std::string tga = "\0\0\2\0\0\0\0\0\0\0\0\0"s + u16(2) + u16(2) + "\x18\0"s + pixels;
    const std::string packed = "\0\0\x0a\0\0\0\0\0\0\0\0\0"s + u16(3) + u16(2) + "\x18\x20"s + "\x82\1\2\3\2" + pixels.substr(0, 9);
    const std::string mapped = "\0\1\1\0\0\2\0\x18\0\0\0\0"s + u16(2) + u16(2) + "\x8\0"s + pixels.substr(0, 6) + "\0\1\1\0"s;
    const std::string bmp = "BM" + u32(70) + u32(0) + u32(54) + u32(40) + u32(2) + u32(2) + u16(1) + u16(24) + u32(0) + u32(16) + u32(0) + u32(0) + u32(0) + u32(0) +
                            pixels.substr(0, 6) + "\0\0"s + pixels.substr(6) + "\0\0"s;
    const std::string masked = "BM" + u32(0) + u32(0) + u32(70) + u32(56) + u32(2) + u32(uint32_t(-2)) + u16(1) + u16(32) + u32(3) + u32(16) + u32(0) + u32(0) + u32(0) +
                               u32(0) + u32(0xff0000) + u32(0xff00) + u32(0xff) + u32(0xff000000) + pixels + pixels.substr(0, 4);
    const std::string gif = "GIF89a" + u16(2) + u16(2) + "\x80\0\0"s + pixels.substr(0, 6) + "!\xf9\4\1\0\0\1\0"s + "," + u16(0) + u16(0) + u16(2) + u16(2) + "\0"s +
                            "\2\3\x44\2\5\0;"s;
    const auto big16 = [](int v) { return std::string{char(v >> 8), char(v)}; };
    const auto big32 = [](uint32_t v) { return std::string{char(v >> 24), char(v >> 16), char(v >> 8), char(v)}; };
    const std::string psd_head = "8BPS" + big16(1) + std::string(6, '\0') + big16(3) + big32(2) + big32(2) + big16(8) + big16(3) + big32(0) + big32(0) + big32(0);
    std::string rows;
    for (int i = 0; i < 6; ++i) rows += big16(3);
    const std::string psd = psd_head + big16(0) + pixels, psd_packed = psd_head + big16(1) + rows + "\1\7\x9\1\4\5\1\1\2\1\3\4\1\x9\x8\1\6\6"s;
    return {tga, packed, mapped, bmp, masked, gif, psd, psd_packed};
}

std::vector<std::string> recipes() {
    json all = {{"recipe", 1}, {"background", {0.1, 0.2, 0.3}}};
    all["materials"] = {{"oak", {{"base_color", {0.3, 0.2, 0.1}}, {"roughness", 0.5}, {"texture", "picture.png"}}}, {"glow", {{"emissive", {1, 2, 3}}, {"alpha", "mask"}}}};
    all["room"] = {{"size", {4, 3, 4}}, {"floor", "oak"}, {"walls", "glow"}, {"open", {"front"}}, {"at", {0, 0, 1}}};
    all["parts"] = {{{"name", "one"}, {"file", "part.glb"}, {"fit", {{"height", 0.5}}}, {"anchor", "bottom"}, {"materials", {{"*", "oak"}, {"rich", {{"metallic", 0.5}, {"texture", ""}}}}},
                      {"without", {"t*o"}}, {"lights", true}, {"cameras", true}},
                    {{"name", "two"}, {"file", "part.ply"}, {"unit", 0.01}, {"up", "z"}, {"on", "one"}, {"rotate", {90, 0, 10}},
                     {"places", {{{"at", {0.3, 0, 0.1}}, {"turn", 45}, {"scale", 2}}, {{"at", {-1, 0, 0}}}}}},
                    {{"file", "builtin:cornell?cells=1"}, {"scale", 0.5}, {"anchor", "middle"}, {"at", {1, 2, 3}}, {"turn", 30}, {"only", {"*"}}, {"crease", 30}, {"colors", "linear"}}};
    all["boxes"] = {{{"size", {1, 1, 1}}, {"at", {0, 1, 0}}, {"turn", 20}, {"material", "oak"}, {"name", "box"}}};
    all["panels"] = {{{"at", {-1, 1, 0}}, {"size", {1, 1}}, {"toward", {0, 0, 0}}, {"radiance", {8, 9, 10}}}};
    all["lights"] = {{{"type", "spot"}, {"at", {0, 2, 0}}, {"intensity", {20, 18, 14}}, {"inner", 20}, {"outer", 50}}, {{"type", "sun"}, {"toward", {1, -1, 0}}, {"intensity", {1, 1, 1}}},
                     {{"type", "point"}, {"at", {0, 1, 1}}, {"intensity", {1, 1, 1}}}};
    all["cameras"] = {{{"name", "a"}, {"eye", {0, 1, 2}}, {"target", {0, 1, 0}}, {"yfov", 50}}, {{"frame", "two"}, {"from", {1, 1, 1}}}, {{"frame", "all"}, {"from", {0, 0, 1}}}};
    return {all.dump(), R"({"recipe": 1, /* a */ "parts": [{"file": "part.ply"}]} // b)"};
}

// ---- glTF

// A bit of everything that our writer writes.
scenes::Scene variety() {
    scenes::Scene scene;
    scene.name = "variety";
    scene.textures.push_back({"checks", 2, 2, {255, 0, 0, 255, 0, 255, 0, 128, 0, 0, 255, 0, 9, 9, 9, 255}, scenes::Texture::Wrap::mirror, scenes::Texture::Wrap::clamp});
    scenes::Material plain{.name = "plain"}, rich{.name = "rich"};
    rich.base_color_texture = {0, 1, {2, 0, 0, 2, 0.5f, 0}};
    rich.normal_texture.texture = rich.emissive_texture.texture = rich.metallic_roughness_texture.texture = 0;
    rich.emissive = {4, 3, 2};
    rich.alpha = scenes::Material::Alpha::mask;
    rich.double_sided = true;
    scene.materials = {plain, rich};
    scenes::Primitive box, tri{.positions = {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, .normals = {{0, 0, 1}, {0, 0, 1}, {0, 0, 1}}};
    scenes::kit::box(box, {0, 0, 0}, {1, 1, 1}, 1);
    tri.tangents.assign(3, {1, 0, 0, 1}), tri.texcoords.assign(3, {0, 1}), tri.texcoords1.assign(3, {1, 0}), tri.colors.assign(3, {1, 1, 0, 1});
    tri.indices = {0, 1, 2}, tri.material = 1;
    scene.meshes = {{"box", {box}}, {"two", {box, tri}}};
    scene.instances = {{0, glm::mat4(1)}, {1, glm::mat4(glm::mat3(2))}, {1, glm::mat4(1, 1, 0, 0, 0, 1, 0, 0, 0, 0, -1, 0, 3, 0, 0, 1)}};
    for (const auto type : {scenes::Light::Type::point, scenes::Light::Type::spot, scenes::Light::Type::directional})
        scene.lights.push_back({type, "lamp", {0, 2, 0}, {0, -1, 0}, {3, 2, 1}, 0.1f, 0.7f});
    scene.cameras.push_back({"eye", glm::mat4(1), 0.7f});
    return scene;
}

// Two joints that bend a triangle, a morph target, and a clip that moves them, a camera and a light.
scenes::Scene moving() {
    scenes::Scene scene = variety();
    scenes::Primitive p = scene.meshes[1].primitives[1];
    p.joints[0].assign(3, {0, 1, 0, 0});
    p.joint_weights[0].assign(3, {0.25f, 0.75f, 0, 0});
    p.targets.resize(1);
    p.targets[0].positions.assign(3, {0, 1, 0});
    scene.meshes.push_back({"bent", {p}});
    scene.nodes = {{.name = "root"}, {.name = "tip", .parent = 0, .rest = {.translation = {0, 1, 0}}}, {.name = "skin", .weights = {0.5f}}, {.name = "eye", .parent = 1}};
    scene.skins = {{"skin", {0, 1}, {glm::mat4(1), glm::mat4(1)}}};
    scene.instances = {{2, glm::mat4(1), 2, 0}};
    scene.cameras[0].node = 3, scene.lights[0].node = 1;
    using Interpolation = scenes::Track::Interpolation;
    scene.clips = {{"wave",
                    {{Interpolation::linear, 4, {0, 1}, {0, 0, 0, 1, 0, 0, 0.7f, 0.7f}}, {Interpolation::step, 3, {0}, {0, 2, 0}}, {Interpolation::cubic, 1, {0, 1}, {0, 0, 1, 1, 1, 0}}},
                    {{1, 0, scenes::Path::rotation}, {0, 1, scenes::Path::translation}, {2, 2, scenes::Path::weights}}}};
    return scene;
}

// JSON, a zero byte, the binary chunk: the form that mutates well.
std::string taken_apart(const std::string& glb) {
    uint32_t size = 0;
    std::memcpy(&size, &glb[12], 4);
    std::string json = glb.substr(20, size);
    json.erase(json.find_last_not_of(' ') + 1);
    return json + '\0' + (glb.size() > 28 + size ? glb.substr(28 + size) : "");
}

// What others write and we do not: sparse data, strips, external files, data URIs, several scenes, a hierarchy, a matrix.
std::string by_hand() {
    const std::string picture = "data:image/png;base64,iVBORw0KGgoAAAANSUhEUgAAAAIAAAABCAIAAAB7QOjdAAAAD0lEQVR42mP4z8DQ0NAAAAkBAoAgv9V1AAAAAElFTkSuQmCC";
    json doc = {{"asset", {{"version", "2.0"}}}, {"scene", 1}};
    doc["extensionsUsed"] = {"KHR_lights_punctual", "KHR_materials_emissive_strength", "KHR_texture_transform", "EXT_unheard_of"};
    doc["scenes"] = {{{"nodes", {0}}}, {{"nodes", {0, 3}}}};
    doc["buffers"] = {{{"byteLength", 120}}, {{"byteLength", 256}, {"uri", "data.bin"}}, {{"byteLength", 3}, {"uri", "data:application/octet-stream;base64,AAAA"}}};
    doc["bufferViews"] = {{{"buffer", 0}, {"byteLength", 64}, {"byteStride", 16}}, {{"buffer", 0}, {"byteOffset", 64}, {"byteLength", 56}},
                          {{"buffer", 1}, {"byteLength", 256}}};
    doc["accessors"] = {{{"bufferView", 0}, {"componentType", 5126}, {"type", "VEC3"}, {"count", 4},
                         {"sparse", {{"count", 2}, {"indices", {{"bufferView", 1}, {"componentType", 5121}}}, {"values", {{"bufferView", 1}, {"byteOffset", 4}}}}}},
                        {{"bufferView", 1}, {"byteOffset", 32}, {"componentType", 5121}, {"type", "SCALAR"}, {"count", 6}},
                        {{"bufferView", 2}, {"componentType", 5123}, {"normalized", true}, {"type", "VEC2"}, {"count", 4}},
                        {{"bufferView", 2}, {"componentType", 5120}, {"normalized", true}, {"type", "VEC4"}, {"count", 4}},
                        {{"componentType", 5126}, {"type", "VEC3"}, {"count", 4}}};
    doc["images"] = {{{"uri", "picture.png"}}, {{"uri", picture}}, {{"bufferView", 2}, {"mimeType", "image/jpeg"}}};
    doc["samplers"] = {{{"wrapS", 33071}, {"wrapT", 33648}}};
    doc["textures"] = {{{"source", 0}, {"sampler", 0}}, {{"source", 1}}};
    doc["materials"] = {{{"pbrMetallicRoughness", {{"baseColorTexture", {{"index", 0}, {"texCoord", 1}, {"extensions", {{"KHR_texture_transform", {{"offset", {0.5, 0}}, {"rotation", 1}, {"scale", {2, 2}}}}}}}}}},
                         {"emissiveTexture", {{"index", 1}}}, {"emissiveFactor", {1, 1, 1}}, {"alphaMode", "MASK"},
                         {"extensions", {{"KHR_materials_emissive_strength", {{"emissiveStrength", 7}}}}}},
                        {{"alphaMode", "BLEND"}, {"doubleSided", true}}};
    json primitives = json::array();
    for (const int mode : {4, 5, 6})
        primitives.push_back({{"mode", mode}, {"indices", 1}, {"material", mode % 2},
                              {"attributes", {{"POSITION", mode == 6 ? 4 : 0}, {"TEXCOORD_0", 2}, {"TEXCOORD_1", 2}, {"COLOR_0", 3}, {"TANGENT", 3}}}});
    doc["meshes"] = {{{"name", "m"}, {"primitives", primitives}, {"weights", {0.5}}}};
    doc["cameras"] = {{{"type", "perspective"}, {"perspective", {{"yfov", 0.7}, {"znear", 0.1}}}},
                      {{"type", "orthographic"}, {"orthographic", {{"xmag", 1}, {"ymag", 1}, {"zfar", 9}, {"znear", 0}}}}};
    doc["extensions"]["KHR_lights_punctual"]["lights"] = {{{"type", "spot"}, {"intensity", 5}, {"spot", {{"innerConeAngle", 0}, {"outerConeAngle", 0.5}}}},
                                                          {{"type", "directional"}, {"color", {1, 0.5, 0}}}};
    doc["nodes"] = {{{"mesh", 0}, {"scale", {1, -1, 2}}, {"rotation", {0, 0, 0.7, 0.7}}, {"children", {1, 2}}},
                    {{"camera", 0}, {"translation", {0, 1, 2}}},
                    {{"camera", 1}, {"extensions", {{"KHR_lights_punctual", {{"light", 0}}}}}},
                    {{"mesh", 0}, {"matrix", {1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 5, 0, 0, 1}}, {"extensions", {{"KHR_lights_punctual", {{"light", 1}}}}}}};
    std::string bin(120, '\0');
    const float square[] = {0, 0, 0, 0, 1, 0, 0, 0, 1, 1, 0, 0, 0, 1, 0, 0};
    std::memcpy(bin.data(), square, sizeof square);
    const char indices[] = {0, 1, 2, 0, 2, 3}, sparse[] = {1, 3};
    std::memcpy(&bin[64], sparse, 2), std::memcpy(&bin[96], indices, 6);
    return doc.dump() + '\0' + bin;
}

std::string compressed_by_draco() {
    const std::string stream = draco_streams().front();
    json doc = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}, {"nodes", {{{"mesh", 0}}}}};
    doc["extensionsRequired"] = doc["extensionsUsed"] = {"KHR_draco_mesh_compression"};
    doc["buffers"] = {{{"byteLength", stream.size()}}};
    doc["bufferViews"] = {{{"buffer", 0}, {"byteLength", stream.size()}}};
    doc["accessors"] = {{{"componentType", 5126}, {"type", "VEC3"}, {"count", 81}}, {{"componentType", 5125}, {"type", "SCALAR"}, {"count", 384}}};
    doc["meshes"] = {{{"primitives", {{{"indices", 1}, {"attributes", {{"POSITION", 0}}},
                                       {"extensions", {{"KHR_draco_mesh_compression", {{"bufferView", 0}, {"attributes", {{"POSITION", 0}, {"NORMAL", 1}, {"TEXCOORD_0", 2}}}}}}}}}}}};
    return doc.dump() + '\0' + stream;
}

// Views packed by meshopt, and many instances of one mesh.
std::string compressed_by_meshopt() {
    const std::vector<Stream> streams = meshopt_streams();
    const Stream &vertices = streams[0], &triangles = streams[4];
    json doc = {{"asset", {{"version", "2.0"}}}, {"scene", 0}, {"scenes", {{{"nodes", {0}}}}}};
    doc["extensionsRequired"] = doc["extensionsUsed"] = {"EXT_meshopt_compression", "EXT_mesh_gpu_instancing"};
    doc["buffers"] = {{{"byteLength", vertices.bytes.size() + triangles.bytes.size()}},
                      {{"byteLength", 4096}, {"extensions", {{"EXT_meshopt_compression", {{"fallback", true}}}}}}};
    size_t offset = 0;
    for (const Stream* s : {&vertices, &triangles}) {
        doc["bufferViews"].push_back({{"buffer", 1}, {"byteLength", s->count * s->stride},
                                      {"extensions", {{"EXT_meshopt_compression", {{"buffer", 0}, {"byteOffset", offset}, {"byteLength", s->bytes.size()}, {"byteStride", s->stride},
                                                                                   {"count", s->count}, {"mode", s->mode}, {"filter", s->filter}}}}}});
        offset += s->bytes.size();
    }
    doc["bufferViews"][0]["byteStride"] = 16;
    doc["accessors"] = {{{"bufferView", 0}, {"componentType", 5126}, {"type", "VEC3"}, {"count", vertices.count}},
                        {{"bufferView", 1}, {"componentType", 5125}, {"type", "SCALAR"}, {"count", triangles.count}},
                        {{"bufferView", 0}, {"componentType", 5126}, {"type", "VEC4"}, {"count", 5}}};
    doc["meshes"] = {{{"primitives", {{{"indices", 1}, {"attributes", {{"POSITION", 0}}}}}}}};
    doc["nodes"] = {{{"mesh", 0}, {"extensions", {{"EXT_mesh_gpu_instancing", {{"attributes", {{"ROTATION", 2}}}}}}}}};
    return doc.dump() + '\0' + vertices.bytes + triangles.bytes;
}

// Rows in runs, rows as they are, and a run of old.
std::vector<std::string> radiance_pictures() {
    const std::string head = "#?RADIANCE\nFORMAT=32-bit_rle_rgbe\n\n";
    const auto text = [](std::initializer_list<int> bytes) { return std::string(bytes.begin(), bytes.end()); };
    std::string in_runs = head + "-Y 4 +X 8\n", plain = head + "+Y 2 +X 4\n";
    for (int y = 0; y < 4; ++y) in_runs += text({2, 2, 0, 8, 136, 90, 8, 1, 2, 3, 4, 5, 6, 7, 8, 131, 7, 133, 60, 136, 129});
    for (int i = 0; i < 6; ++i) plain += text({90, 80, i, 128});
    return {in_runs, plain + text({1, 1, 1, 2})};
}

}  // namespace

std::vector<std::string> exr_seeds();  // exr_seeds.cpp

std::vector<std::string> seeds(const std::string& target) {
    if (target == "picture") return pictures();
    if (target == "draco") return draco_streams();
    if (target == "exr") return exr_seeds();
    if (target == "environment") return radiance_pictures();
    if (target == "meshopt") return meshopt_inputs();
    if (target == "ibsp") return {ibsp_map()};
    if (target == "embree") return {embree_strands()};
    if (target == "assimp") return for_assimp();
    if (target == "ply") return ply_files();
    if (target == "texture") return textures();
    if (target == "recipe") return recipes();
    const std::string glb = scenes::glb_bytes(variety());
    return {glb, taken_apart(glb), by_hand(), compressed_by_draco(), compressed_by_meshopt(), taken_apart(scenes::glb_bytes(moving()))};
}

}  // namespace myriad::fuzz
