// What assimp may open: the scene's file, and files that it names in the scene's folder.
#pragma once

#include <cstdint>
#include <deque>
#include <set>
#include <string>
#include <vector>

#include <assimp/IOStream.hpp>
#include <assimp/IOSystem.hpp>

#include "scenes/import/folder.hpp"

namespace myriad::scenes::importing {

class SceneFiles : public Assimp::IOSystem {
public:
    // `bytes` are the file's, decompressed where it was compressed; `name` is what assimp calls it.
    SceneFiles(std::string name, std::vector<uint8_t> bytes, Folder& folder);

    bool Exists(const char* name) const override;
    char getOsSeparator() const override { return '/'; }
    Assimp::IOStream* Open(const char* name, const char* mode) override;
    void Close(Assimp::IOStream* stream) override { delete stream; }

    // Names that were asked for and are not there.
    const std::set<std::string>& missing() const { return missing_; }

private:
    std::string beside(const char* name) const;

    const std::string name_, prefix_;
    const std::vector<uint8_t> bytes_;
    Folder& folder_;
    std::deque<std::vector<uint8_t>> others_;  // stay until the end: streams point into them
    std::set<std::string> missing_;
};

}  // namespace myriad::scenes::importing
