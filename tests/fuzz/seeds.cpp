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

}  // namespace

std::vector<std::string> exr_seeds();  // exr_seeds.cpp

std::vector<std::string> seeds(const std::string& target) {
    if (target == "picture") return pictures();
    if (target == "draco") return draco_streams();
    if (target == "exr") return exr_seeds();
    const std::string glb = scenes::glb_bytes(variety());
    return {glb, taken_apart(glb), by_hand(), compressed_by_draco()};
}

}  // namespace myriad::fuzz
