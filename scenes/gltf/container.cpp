#include "scenes/gltf/container.hpp"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <new>

#include <nlohmann/json.hpp>

#include "engine/error.hpp"

namespace myriad::scenes::gltf {
namespace {

using Bytes = std::vector<unsigned char>;

constexpr uint32_t json_chunk = 0x4E4F534A, bin_chunk = 0x004E4942;

Bytes read_file(const std::string& path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        throw InputError(path + ": there is no such file; give a .gltf or .glb file, or builtin:NAME.");
    const auto size = std::filesystem::file_size(path, error);
    // tinygltf counts the bytes of a file in 32 bits, some in int.
    if (error || size > 0x7fffffff) throw InputError(path + ": the file is larger than 2 GiB; move its buffers to .bin files.");
    Bytes bytes(size);
    std::ifstream file(path, std::ios::binary);
    if (!file.read(reinterpret_cast<char*>(bytes.data()), std::streamsize(size)))
        throw InputError(path + ": the file cannot be read; check its permissions.");
    return bytes;
}

uint32_t u32(const Bytes& bytes, size_t at) {
    uint32_t value;
    std::memcpy(&value, &bytes[at], 4);
    return value;
}

struct Container {
    std::string json;
    Bytes bin;
    bool binary = false;
};

// Takes the file apart. The chunks are checked here because tinygltf accepts a BIN chunk that ends 8 bytes past the file.
Container take_apart(const std::string& path, const Bytes& bytes) {
    if (bytes.size() < 4 || std::memcmp(bytes.data(), "glTF", 4) != 0) return {std::string(bytes.begin(), bytes.end()), {}, false};
    const auto bad = [&](const std::string& what) {
        return InputError(path + ": the GLB container is damaged (" + what + "); export or download it again.");
    };
    if (bytes.size() < 20) throw bad("shorter than its header");
    if (u32(bytes, 4) != 2) throw InputError(path + ": this is glTF version " + std::to_string(u32(bytes, 4)) + "; convert it to version 2.");
    const uint64_t length = u32(bytes, 8);
    if (length > bytes.size()) throw bad("truncated");
    Container out;
    out.binary = true;
    for (uint64_t at = 12; at + 8 <= length;) {
        const uint64_t size = u32(bytes, at), type = u32(bytes, at + 4);
        if (at + 8 + size > length) throw bad("a chunk ends beyond the file");
        const auto begin = bytes.begin() + std::ptrdiff_t(at + 8), end = begin + std::ptrdiff_t(size);
        if (at == 12) {
            if (type != json_chunk) throw bad("the first chunk is not JSON");
            out.json.assign(begin, end);
        } else if (type == bin_chunk && out.bin.empty()) {
            out.bin.assign(begin, end);
        }
        at += 8 + size;
    }
    return out;
}

// tinygltf copies `extras` by recursion: deep nesting would overflow the stack.
void check_depth(const std::string& path, const std::string& json) {
    int depth = 0;
    bool quoted = false;
    for (size_t i = 0; i < json.size(); ++i) {
        const char c = json[i];
        if (quoted) {
            if (c == '\\') ++i;
            else if (c == '"') quoted = false;
        } else if (c == '"') {
            quoted = true;
        } else if (c == '[' || c == '{') {
            if (++depth > 200) throw InputError(path + ": the JSON is nested deeper than 200 levels; remove what nests so deep.");
        } else if (c == ']' || c == '}') {
            --depth;
        }
    }
}

// The index accessor of a Draco primitive may have no buffer view, for the indices are in the compressed data; tinygltf
// built without Draco refuses such a file. So Draco primitives lose their `indices` before tinygltf sees them.
void strip_draco_indices(const std::string& path, std::string& text) {
    if (text.find("KHR_draco_mesh_compression") == std::string::npos) return;
    try {
        nlohmann::json json = nlohmann::json::parse(text);
        for (auto& mesh : json.at("meshes"))
            for (auto& primitive : mesh.at("primitives"))
                if (primitive.contains("extensions") && primitive["extensions"].contains("KHR_draco_mesh_compression"))
                    primitive.erase("indices");
        text = json.dump();
    } catch (const nlohmann::json::exception& e) {
        throw InputError(path + ": the JSON is not valid glTF (" + e.what() + "); export it again.");
    }
}

// A GLB again, from its parts: tinygltf knows a BIN chunk only in this form.
Bytes put_together(const Container& in) {
    const auto padded = [](size_t n) { return (n + 3) & ~size_t(3); };
    Bytes out;
    const auto word = [&](size_t value) {
        for (int shift = 0; shift < 32; shift += 8) out.push_back(uint8_t(value >> shift));
    };
    const size_t json = padded(in.json.size()), bin = padded(in.bin.size());
    out.reserve(28 + json + bin);
    out.insert(out.end(), {'g', 'l', 'T', 'F'});
    word(2), word(20 + json + (bin ? 8 + bin : 0)), word(json), word(json_chunk);
    out.insert(out.end(), in.json.begin(), in.json.end());
    out.resize(20 + json, ' ');
    if (bin) {
        word(bin), word(bin_chunk);
        out.insert(out.end(), in.bin.begin(), in.bin.end());
        out.resize(28 + json + bin, 0);
    }
    return out;
}

// Keeps encoded bytes instead of decoding. An image in a buffer view is skipped: `bytes` and `size` are unchecked there.
bool keep_encoded(tinygltf::Image* image, int, std::string*, std::string*, int, int, const unsigned char* bytes, int size, void*) {
    if (image->bufferView < 0) image->image.assign(bytes, bytes + size);
    image->as_is = true;
    return true;
}

// One sentence of whatever a library reported, which may be several lines.
std::string one_line(std::string text) {
    while (!text.empty() && std::isspace(static_cast<unsigned char>(text.back()))) text.pop_back();
    for (char& c : text)
        if (static_cast<unsigned char>(c) < ' ') c = ' ';
    if (text.size() > 300) text = text.substr(0, 300) + " …";
    return text;
}

}  // namespace

tinygltf::Model read_model(const std::string& path, std::string& warnings) {
    tinygltf::Model model;
    std::string error;
    bool ok = false;
    Container container = take_apart(path, read_file(path));
    check_depth(path, container.json);
    strip_draco_indices(path, container.json);
    const std::string folder = std::filesystem::path(path).parent_path().string();
    tinygltf::TinyGLTF loader;
    loader.SetImageLoader(keep_encoded, nullptr);
    try {
        if (container.binary) {
            const Bytes glb = put_together(container);
            ok = loader.LoadBinaryFromMemory(&model, &error, &warnings, glb.data(), unsigned(glb.size()), folder);
        } else {
            ok = loader.LoadASCIIFromString(&model, &error, &warnings, container.json.data(), unsigned(container.json.size()), folder);
        }
    } catch (const std::bad_alloc&) {
        throw OutOfMemory(path + ": the file asks for more memory than there is; check the sizes in it.");
    } catch (const std::exception& e) {  // nlohmann's, from values of an unexpected type; and vector::at
        ok = false, error = e.what();
    }
    if (!ok) throw InputError(path + ": this is not a readable glTF file (" + one_line(error) + "); check or export it again.");
    return model;
}

}  // namespace myriad::scenes::gltf
