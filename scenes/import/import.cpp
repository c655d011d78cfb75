#include "scenes/import/import.hpp"

#include <algorithm>
#include <cctype>
#include <filesystem>
#include <new>

#include "engine/error.hpp"
#include "scenes/gltf.hpp"
#include "scenes/import/assimp/read.hpp"
#include "scenes/import/embree.hpp"
#include "scenes/import/ibsp.hpp"
#include "scenes/import/ply.hpp"
#include "scenes/import/recipe.hpp"
#include "scenes/import/tidy.hpp"

namespace myriad::scenes {
namespace {

Imported read_gltf(const std::string& path, const ImportOptions&) {
    const auto [file, choice] = split_choice(path);
    return {.scene = load_gltf(file, choice), .crease = 0};  // glTF says that what has no normals is flat
}

std::string lower(std::string text) {
    for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

const Format& format_of(const std::string& path) {
    const std::string name = lower(std::filesystem::path(path).filename().string());
    const Format* found = nullptr;
    size_t length = 0;
    std::string known;
    for (const Format& format : formats())
        for (const std::string& ending : format.endings) {
            known += (known.empty() ? "" : ", ") + ending;
            if (name.ends_with(ending) && ending.size() > length) found = &format, length = ending.size();  // the longest: .ply.gz
        }
    if (!found) throw InputError(path + ": no format that Myriad reads has this ending; give one of " + known + ".");
    return *found;
}

}  // namespace

const std::vector<Format>& formats() {
    static const std::vector<Format> list = {
        {{".gltf", ".glb"}, "glTF 2.0, with the files that it names", read_gltf},
        {{".obj", ".obj.gz"}, "Wavefront OBJ with its MTL; metres, +Y up", importing::read_assimp},
        {{".ply", ".ply.gz"}, "PLY, vertex colours too; metres, +Y up", importing::import_ply},
        {{".stl", ".stl.gz"}, "STL; millimetres, +Z up", importing::read_assimp},
        {{".fbx"}, "Autodesk FBX; the file says its unit and axis", importing::read_assimp},
        {{".dae"}, "Collada; the file says its unit and axis", importing::read_assimp},
        {{".json"}, "a recipe, which composes a scene from parts: scenes/import/RECIPES.md", importing::import_recipe},
        {{".bsp"}, "maps of Quake III and OpenArena (IBSP 46)", importing::import_ibsp},
        {{".xml"}, "strands of Embree's scenes, with their .bin or .bin.gz beside", importing::import_embree},
    };
    return list;
}

Scene import_scene(const std::string& source, const ImportOptions& options, uint32_t seed) try {
    Imported in;
    if (source.starts_with("builtin:")) {
        in.scene = load(source, seed);
        in.crease = 0;
    } else {
        const auto [path, choice] = split_choice(source);
        const Format& format = format_of(path);
        std::error_code error;
        if (format.read != read_gltf && !choice.empty()) throw InputError(source + ": only glTF has scenes to choose from; leave the # out.");
        if (!std::filesystem::is_regular_file(path, error)) throw InputError(source + ": there is no such file; give one that exists.");
        in = format.read(source, options);
    }
    in.scene.name = source;
    transform(in.scene, upright(options.up.value_or(in.up)), options.unit.value_or(in.unit));
    tidy(in.scene, options.crease.value_or(in.crease));
    return std::move(in.scene);
} catch (const std::bad_alloc&) {
    throw OutOfMemory(source + ": the scene does not fit in memory; make it smaller.");
}

}  // namespace myriad::scenes
