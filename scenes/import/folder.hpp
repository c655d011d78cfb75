// The folder of a scene, and the files that the scene may name: those in it or below, and no others.
#pragma once

#include <filesystem>
#include <map>
#include <string>
#include <vector>

namespace myriad::scenes::importing {

class Folder {
public:
    // Of the file `scene`. The current folder where the path names none.
    explicit Folder(const std::string& scene);

    // The regular file that a scene means by `name`, in canonical form, or "" when there is none. Names are taken as
    // exporters write them: with backslashes, in another case, as file: URIs. What is absolute or leaves the folder was
    // right on the machine of the author; then a file of that last name counts, in the folder or in one for textures.
    std::string find(const std::string& name);

    const std::filesystem::path& path() const { return path_; }

private:
    std::string walk(const std::filesystem::path& relative);
    const std::map<std::string, std::vector<std::string>>& entries(const std::filesystem::path& folder);

    std::filesystem::path path_;
    // Of each folder that was looked into: its entries by their names in lower case.
    std::map<std::filesystem::path, std::map<std::string, std::vector<std::string>>> listings_;
};

}  // namespace myriad::scenes::importing
