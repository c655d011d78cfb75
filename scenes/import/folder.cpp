#include "scenes/import/folder.hpp"

#include <algorithm>
#include <cctype>

namespace myriad::scenes::importing {
namespace {

namespace fs = std::filesystem;

std::string lower(std::string text) {
    for (char& c : text) c = char(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

bool inside(const fs::path& path, const fs::path& folder) {
    return std::mismatch(folder.begin(), folder.end(), path.begin(), path.end()).first == folder.end();
}

// Slashes only, and no scheme: a drive letter goes with it, what follows is absolute then.
std::string as_path(std::string name) {
    std::ranges::replace(name, '\\', '/');
    if (lower(name.substr(0, 7)) == "file://") name = name.substr(7);
    if (name.size() > 2 && std::isalpha(static_cast<unsigned char>(name[0])) && name[1] == ':' && name[2] == '/') name = name.substr(2);
    return name;
}

}  // namespace

Folder::Folder(const std::string& scene) {
    std::error_code error;
    const fs::path parent = fs::path(scene).parent_path();
    path_ = fs::canonical(parent.empty() ? "." : parent, error);
}

const std::map<std::string, std::vector<std::string>>& Folder::entries(const fs::path& folder) {
    const auto [at, fresh] = listings_.try_emplace(folder);
    if (!fresh) return at->second;
    std::error_code error;
    for (fs::directory_iterator it(folder, error), end; !error && it != end; it.increment(error)) {
        const std::string name = it->path().filename().string();
        at->second[lower(name)].push_back(name);
    }
    for (auto& [name, spellings] : at->second) std::ranges::sort(spellings);
    return at->second;
}

std::string Folder::walk(const fs::path& relative) {
    fs::path at = path_;
    for (const fs::path& part : relative) {
        if (part.empty() || part == ".") continue;
        if (part == "..") return "";
        const auto& names = entries(at);
        const auto found = names.find(lower(part.string()));
        if (found == names.end()) return "";
        const auto exact = std::ranges::find(found->second, part.string());
        at /= exact != found->second.end() ? *exact : found->second.front();
    }
    std::error_code error;
    at = fs::canonical(at, error);
    return !error && inside(at, path_) && fs::is_regular_file(at, error) ? at.string() : "";
}

std::string Folder::find(const std::string& name) {
    if (name.empty() || name.size() > 4096 || path_.empty() || name.find('\0') != std::string::npos) return "";
    const fs::path path = fs::path(as_path(name)).lexically_normal();
    if (path.is_relative())
        if (std::string found = walk(path); !found.empty()) return found;
    for (const char* sub : {"", "textures", "maps", "images"})
        if (std::string found = walk(sub / path.filename()); !found.empty()) return found;
    return "";
}

}  // namespace myriad::scenes::importing
