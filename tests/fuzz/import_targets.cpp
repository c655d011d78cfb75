#include <algorithm>
#include <iterator>

#include "engine/error.hpp"
#include "scenes/gltf/write.hpp"
#include "scenes/import/bytes.hpp"
#include "scenes/import/embree.hpp"
#include "scenes/import/ibsp.hpp"
#include "scenes/import/import.hpp"
#include "scenes/import/picture.hpp"
#include "scenes/import/ply.hpp"
#include "scenes/import/recipe.hpp"
#include "scenes/import/tidy.hpp"
#include "tests/fuzz/input_file.hpp"
#include "tests/fuzz/targets.hpp"

namespace myriad::fuzz {
namespace {

// What convert does with what a reader hands over.
template <class Reader>
void converted(const Reader& reader) {
    try {
        scenes::Scene scene = reader();
        scenes::tidy(scene, 40);
        scenes::write_glb(scene, [](const void*, size_t) {}, {.quick = true});
    } catch (const Error&) {
    }
}

}  // namespace

void ibsp(const uint8_t* data, size_t size) {
    const scenes::importing::Bytes bytes(data, data + size);
    converted([&] { return scenes::importing::read_ibsp(scenes::importing::View(bytes, "fuzz.bsp")); });
}

void embree(const uint8_t* data, size_t size) {
    const uint8_t* zero = std::find(data, data + size, 0);
    const scenes::importing::Bytes xml(data, zero), numbers(zero == data + size ? zero : zero + 1, data + size);
    converted([&] {
        const auto read_numbers = [&] { return scenes::importing::gunzip(numbers, "fuzz.bin", 1 << 24); };
        return scenes::importing::read_embree(scenes::importing::View(xml, "fuzz.xml"), read_numbers);
    });
}

void assimp(const uint8_t* data, size_t size) {
    if (size == 0) return;
    static const InputFolder folder;
    const char* const endings[] = {".obj", ".ply", ".stl", ".dae", ".fbx", ".ply.gz"};
    const std::string path = folder.put("scene" + std::string(endings[data[0] % std::size(endings)]), data + 1, size - 1);
    converted([&] { return scenes::import_scene(path); });
}

void ply(const uint8_t* data, size_t size) {
    converted([&] { return scenes::importing::read_ply({data, size}, "fuzz.ply", {}).scene; });
}

void texture(const uint8_t* data, size_t size) {
    std::string problem;
    scenes::importing::decode_picture({data, size}, problem);
}

void recipe(const uint8_t* data, size_t size) {
    static const InputFolder folder;
    [[maybe_unused]] static const bool filled = [] {
        const std::string scene = seeds("gltf").front(), mesh = seeds("ply").front(), picture = seeds("picture").front();
        folder.put("part.glb", scene.data(), scene.size()), folder.put("part.ply", mesh.data(), mesh.size());
        folder.put("picture.png", picture.data(), picture.size());
        return true;
    }();
    const std::string path = folder.put("recipe.json", data, size);
    converted([&] { return scenes::importing::import_recipe(path, {}).scene; });
}

}  // namespace myriad::fuzz
