#include "scenes/import/assimp/read.hpp"

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <set>

#include <assimp/BaseImporter.h>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/scene.h>

#include "engine/error.hpp"
#include "scenes/import/apart.hpp"
#include "scenes/import/assimp/files.hpp"
#include "scenes/import/assimp/geometry.hpp"
#include "scenes/import/assimp/materials.hpp"
#include "scenes/import/bytes.hpp"
#include "scenes/import/tidy.hpp"

namespace myriad::scenes::importing {
namespace {

std::string lower(std::string text) {
    for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

// One sentence of whatever assimp reported, which may be several lines.
std::string one_line(std::string text) {
    std::ranges::replace_if(text, [](unsigned char c) { return c < ' ' || c == 0x7f; }, ' ');
    while (!text.empty() && (text.back() == ' ' || text.back() == '.')) text.pop_back();
    return text.size() > 200 ? text.substr(0, 200) + " …" : text;
}

// Only what the ending says: otherwise assimp tries fifty formats on a file that its own reader refuses.
void keep_reader(Assimp::Importer& importer, const std::string& ending) {
    for (size_t i = importer.GetImporterCount(); i-- > 0;) {
        std::set<std::string> endings;
        Assimp::BaseImporter* reader = importer.GetImporter(i);
        reader->GetExtensionList(endings);
        if (!endings.contains(ending)) importer.UnregisterLoader(reader);  // which leaks it; the process ends soon
    }
}

// assimp 5.2 takes no number that has a space between it and its element's beginning. The spaces go to the far side of the
// bracket, inside the tag, where they mean nothing.
void close_up_numbers(std::vector<uint8_t>& xml) {
    const auto space = [](uint8_t c) { return c == ' ' || c == '\t' || c == '\r' || c == '\n'; };
    for (size_t i = 0; i + 1 < xml.size(); ++i) {
        if (xml[i] != '>' || !space(xml[i + 1])) continue;
        size_t end = i + 1;
        while (end < xml.size() && space(xml[end])) ++end;
        const bool in_tag = i > 0 && xml[i - 1] != '-' && xml[i - 1] != '?' && xml[i - 1] != '/' && xml[i - 1] != ']';
        if (in_tag && end < xml.size() && (std::isdigit(xml[end]) || xml[end] == '-' || xml[end] == '+' || xml[end] == '.')) xml[i] = ' ', xml[end - 1] = '>';
        i = end - 1;
    }
}

// The value of an attribute or element of Collada's <asset>, wherever it stands in the beginning of the file.
std::string after(const std::string& text, const std::string& mark, const char* ends) {
    const size_t at = text.find(mark);
    if (at == std::string::npos) return "";
    const size_t begin = at + mark.size(), end = text.find_first_of(ends, begin);
    return end == std::string::npos ? "" : text.substr(begin, end - begin);
}

// assimp has applied Collada's unit and axis to the root. Where the options say otherwise, that is taken back.
void set_collada_frame(const std::vector<uint8_t>& bytes, const ImportOptions& options, Imported& out) {
    const std::string head(bytes.begin(), bytes.begin() + std::ptrdiff_t(std::min<size_t>(bytes.size(), 1 << 16)));
    if (options.unit) {
        const size_t at = head.find("<unit");
        std::string text = at == std::string::npos ? "" : after(head.substr(at, head.find('>', at) - at), "meter=\"", "\"");
        std::ranges::replace(text, ',', '.');
        double unit = 1;
        std::from_chars(text.data(), text.data() + text.size(), unit);
        if (unit > 0 && std::isfinite(unit)) transform(out.scene, glm::dmat4(1), 1 / unit);
    }
    if (options.up) {
        const std::string axis = after(head, "<up_axis>", "<");
        if (axis.find("Z_UP") != std::string::npos) transform(out.scene, glm::transpose(upright(Axis::z)), 1);
        if (axis.find("X_UP") != std::string::npos) transform(out.scene, glm::transpose(upright(Axis::x)), 1);
    }
}

// FBX tells its frame in metadata, and assimp leaves it to us: axes 0 to 2, units in centimetres.
void set_fbx_frame(const aiScene& in, Imported& out) {
    out.unit = 0.01;
    if (!in.mMetaData) return;
    int32_t up = 1;
    double centimetres = 1;
    if (float narrow = 1; in.mMetaData->Get("UnitScaleFactor", centimetres) || (in.mMetaData->Get("UnitScaleFactor", narrow) && (centimetres = double(narrow), true)))
        if (centimetres > 0 && std::isfinite(centimetres)) out.unit = 0.01 * centimetres;
    if (in.mMetaData->Get("UpAxis", up) && up >= 0 && up <= 2) out.up = Axis(up);
}

Imported read(const std::string& path, const ImportOptions& options) {
    std::filesystem::path name = std::filesystem::path(path).filename();
    if (lower(name.extension().string()) == ".gz") name = name.stem();
    const std::string ending = lower(name.extension().string()).substr(1);
    Folder folder(path);
    std::vector<uint8_t> bytes = gunzip(read_file(path, max_file_bytes), path, max_file_bytes);
    if (bytes.empty()) throw InputError(path + ": the file is empty; give one with a scene in it.");
    if (ending == "dae") close_up_numbers(bytes);
    const std::vector<uint8_t> collada = ending == "dae" ? bytes : std::vector<uint8_t>();

    Assimp::Importer importer;
    keep_reader(importer, ending);
    auto* files = new SceneFiles(name.string(), std::move(bytes), folder);  // the importer's to delete
    importer.SetIOHandler(files);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_READ_ANIMATIONS, false);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
    const aiScene* in = importer.ReadFile(name.string(), 0);
    if (!in) {
        const std::string problem = one_line(importer.GetErrorString());
        if (problem.find("bad_alloc") != std::string::npos) throw std::bad_alloc();
        throw InputError(path + ": the file cannot be read (" + problem + "); export it again, or in another format.");
    }

    Imported out;
    out.scene.name = path;
    Materials materials(*in, folder, options.linear_colors, out.scene);
    std::vector<bool> colored(in->mNumMaterials);
    for (unsigned m = 0; m < in->mNumMeshes; ++m)
        if (in->mMeshes[m]->mMaterialIndex < in->mNumMaterials && in->mMeshes[m]->mColors[0]) colored[in->mMeshes[m]->mMaterialIndex] = true;
    for (unsigned m = 0; m < in->mNumMaterials; ++m) materials.add(*in->mMaterials[m], colored[m]);
    // STL has normals of faces, which programs leave 0 or wrong: those of the corners' order are right.
    add_geometry(*in, path, {.linear_colors = options.linear_colors, .without_normals = ending == "stl"}, out.scene);
    if (!files->missing().empty()) {
        std::string names;
        for (const std::string& missing : files->missing()) names += (names.empty() ? "" : ", ") + missing.substr(0, 100);
        out.scene.warnings.push_back("files that the scene names are not in its folder: " + names + ".");
    }
    materials.report(out.scene.warnings);

    if (ending == "stl") out.unit = 1e-3, out.up = Axis::z;
    if (ending == "fbx") set_fbx_frame(*in, out);
    if (ending == "dae") set_collada_frame(collada, options, out);
    return out;
}

}  // namespace

Imported read_assimp(const std::string& path, const ImportOptions& options) {
    std::error_code error;
    const uint64_t size = std::filesystem::file_size(path, error);
    return read_apart(path, ApartLimits::for_file(error ? 0 : size), options, [&] { return read(path, options); });
}

}  // namespace myriad::scenes::importing
