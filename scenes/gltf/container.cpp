#include "scenes/gltf/container.hpp"

#include <cstring>
#include <filesystem>
#include <fstream>
#include <map>
#include <new>

#include <nlohmann/json.hpp>

#include "engine/error.hpp"
#include "scenes/gltf/uri.hpp"

namespace myriad::scenes::gltf {
namespace {

using nlohmann::json;

constexpr uint32_t json_chunk = 0x4E4F534A, bin_chunk = 0x004E4942;

Bytes read_file(const std::string& path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error))
        throw InputError(path + ": there is no such file; give a .gltf or .glb file, or builtin:NAME.");
    const auto size = std::filesystem::file_size(path, error);
    if (error || size > limits::file_bytes) throw InputError(path + ": the file is larger than 4 GiB; move its buffers to .bin files.");
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
    Range bin;
    bool binary = false;
};

// Takes the file apart. `bytes` stay where the chunk of buffers is.
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
        } else if (type == bin_chunk && !out.bin.data) {
            out.bin = {bytes.data() + at + 8, size};
        }
        at += 8 + size;
    }
    return out;
}

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
            if (++depth > limits::json_depth)
                throw InputError(path + ": the JSON is nested deeper than " + std::to_string(limits::json_depth) +
                                 " levels; remove what nests so deep.");
        } else if (c == ']' || c == '}') {
            --depth;
        }
    }
}

// The index accessor of a Draco primitive may have no buffer view, for the indices are in the compressed data; tinygltf
// built without Draco refuses such a file. So Draco primitives lose their `indices` before tinygltf sees them.
void strip_draco_indices(json& root) {
    if (!root.contains("meshes")) return;
    for (auto& mesh : root.at("meshes"))
        for (auto& primitive : mesh.at("primitives"))
            if (primitive.contains("extensions") && primitive["extensions"].contains("KHR_draco_mesh_compression"))
                primitive.erase("indices");
}

std::string text(const json& object, const char* key) {
    const auto it = object.find(key);
    return it != object.end() && it->is_string() ? it->get<std::string>() : "";
}

// Removes the array `key` from the root: its elements.
std::vector<json> take(json& root, const char* key) {
    const auto it = root.find(key);
    if (it == root.end() || !it->is_array()) return {};
    std::vector<json> out = std::move(it->get_ref<json::array_t&>());
    root.erase(it);
    return out;
}

// Whether only loaders without EXT_meshopt_compression need this buffer.
bool is_fallback(const json& buffer) {
    const json::json_pointer mark("/extensions/EXT_meshopt_compression/fallback");
    return buffer.contains(mark) && buffer[mark] == true;
}

// The bytes of each buffer, each file and each chunk held once, however many buffers show it.
void read_buffers(const Place& place, const std::vector<json>& buffers, const Container& container) {
    Document& document = *place.document;
    std::map<std::string, Range> known;
    for (size_t i = 0; i < buffers.size(); ++i) {
        const Place here = place.at("buffer " + std::to_string(i));
        const json& buffer = buffers[i];
        const auto length = buffer.is_object() ? buffer.find("byteLength") : buffer.end();
        if (!buffer.is_object() || length == buffer.end() || !length->is_number_unsigned())
            here.fail("it has no valid byteLength", "export the file again");
        Range range;
        const std::string uri = text(buffer, "uri");
        if (is_fallback(buffer)) {
            document.buffers.emplace_back();
            continue;
        }
        if (buffer.contains("uri")) {
            const std::string file = file_of_uri(here, uri);
            const auto it = file.empty() ? known.end() : known.find(file);
            if (it != known.end()) range = it->second;
            else {
                const Bytes& bytes = document.owned.emplace_back(read_uri(here, uri));
                range = {bytes.data(), bytes.size()};
                if (!file.empty()) known[file] = range;
            }
        } else if (i == 0 && container.binary) {
            range = container.bin;
        } else {
            document.buffers.emplace_back();  // a place for what an extension decodes
            continue;
        }
        const uint64_t wanted = length->get<uint64_t>();
        if (wanted > range.size)
            here.fail(std::to_string(range.size) + " bytes of " + std::to_string(wanted) + " are there" + (uri.empty() ? "" : " in " + quote(uri)),
                      "the data is truncated, export or download it again");
        document.buffers.push_back({range.data, size_t(wanted)});
    }
}

void list_images(const Place& place, const std::vector<json>& images) {
    for (size_t i = 0; i < images.size(); ++i) {
        tinygltf::Image& image = place.document->model.images.emplace_back();
        const json& in = images[i];
        if (!in.is_object()) place.fail("image " + std::to_string(i) + " is not an object", "export the file again");
        image.name = text(in, "name");
        image.uri = text(in, "uri");
        image.mimeType = text(in, "mimeType");
        if (const auto view = in.find("bufferView"); view != in.end() && view->is_number_integer()) image.bufferView = view->get<int>();
    }
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

Document read_document(const std::string& path, std::string& warnings) try {
    Document document;
    document.file = path;
    document.folder = std::filesystem::path(path).parent_path().string();
    const Bytes& bytes = document.owned.emplace_back(read_file(path));
    document.budget.earn(bytes.size());
    const Container container = take_apart(path, bytes);
    check_depth(path, container.json);

    const auto unreadable = [&](const std::string& why) {
        return InputError(path + ": this is not a readable glTF file (" + one_line(why) + "); check or export it again.");
    };
    std::string text, error;
    std::vector<json> buffers, images;
    bool ok = false;
    try {
        json root = json::parse(container.json);
        buffers = take(root, "buffers"), images = take(root, "images");
        strip_draco_indices(root);
        text = root.dump();
        root = nullptr;
        tinygltf::TinyGLTF loader;
        loader.SetFsCallbacks({nullptr, nullptr, nullptr, nullptr, nullptr});
        ok = loader.LoadASCIIFromString(&document.model, &error, &warnings, text.data(), unsigned(text.size()), "");
    } catch (const std::bad_alloc&) {
        throw;
    } catch (const std::exception& e) {  // nlohmann's, from values of an unexpected type; and vector::at
        error = e.what();
    }
    if (!ok) throw unreadable(error);
    const Place place{document.model, path, "", &document};
    read_buffers(place, buffers, container);
    list_images(place, images);
    return document;
} catch (const std::bad_alloc&) {
    throw OutOfMemory(path + ": the file asks for more memory than there is; check the sizes in it.");
}

}  // namespace myriad::scenes::gltf
