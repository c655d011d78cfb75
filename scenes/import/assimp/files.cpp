#include "scenes/import/assimp/files.hpp"

#include <cstring>

#include <assimp/MemoryIOWrapper.h>

#include "engine/error.hpp"
#include "scenes/import/apart.hpp"
#include "scenes/import/bytes.hpp"

namespace myriad::scenes::importing {

SceneFiles::SceneFiles(std::string name, std::vector<uint8_t> bytes, Folder& folder)
    : name_(std::move(name)), prefix_(name_.substr(0, name_.rfind('/') + 1)), bytes_(std::move(bytes)), folder_(folder) {}

// assimp puts the scene's folder before the names that it finds.
std::string SceneFiles::beside(const char* name) const {
    const std::string text = name;
    return folder_.find(!prefix_.empty() && text.starts_with(prefix_) ? text.substr(prefix_.size()) : text);
}

bool SceneFiles::Exists(const char* name) const { return name == name_ || !beside(name).empty(); }

Assimp::IOStream* SceneFiles::Open(const char* name, const char* mode) {
    if (std::strpbrk(mode, "wa+")) return nullptr;  // nothing is written
    if (name == name_) return new Assimp::MemoryIOStream(bytes_.data(), bytes_.size());
    const std::string path = beside(name);
    if (path.empty()) {
        missing_.insert(std::filesystem::path(name).filename().string());
        return nullptr;
    }
    earn_limits(std::filesystem::file_size(path));
    const auto& bytes = others_.emplace_back(read_file(path, max_file_bytes));
    return new Assimp::MemoryIOStream(bytes.data(), bytes.size());
}

}  // namespace myriad::scenes::importing
