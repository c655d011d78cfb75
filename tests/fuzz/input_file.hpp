// For targets that read files: a folder in memory where the system has one, kept for the life of the process.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <fstream>
#include <string>

namespace myriad::fuzz {

class InputFolder {
public:
    InputFolder() {
        const std::filesystem::path memory = "/dev/shm", base = std::filesystem::is_directory(memory) ? memory : std::filesystem::temp_directory_path();
        std::string name = (base / "myriad-fuzz-XXXXXX").string();
        path_ = mkdtemp(name.data());
    }
    ~InputFolder() {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    InputFolder(const InputFolder&) = delete;

    // The path of the file that now holds the bytes.
    std::string put(const std::string& name, const void* bytes, size_t count) const {
        const auto path = path_ / name;
        std::filesystem::create_directories(path.parent_path());
        std::ofstream(path, std::ios::binary).write(static_cast<const char*>(bytes), std::streamsize(count));
        return path.string();
    }

private:
    std::filesystem::path path_;
};

}  // namespace myriad::fuzz
