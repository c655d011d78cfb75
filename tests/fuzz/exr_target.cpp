#include "engine/error.hpp"
#include "tests/fuzz/input_file.hpp"
#include "tests/fuzz/targets.hpp"
#include "tools/environment_file.hpp"
#include "tools/exr.hpp"

namespace myriad::fuzz {

void exr(const uint8_t* data, size_t size) {
    static const InputFolder folder;
    try {
        tools::read_exr(folder.put("image.exr", data, size));
    } catch (const Error&) {
    }
}

void environment(const uint8_t* data, size_t size) {
    static const InputFolder folder;
    try {
        std::vector<std::string> warnings;
        scenes::environment_cells(tools::read_environment(folder.put("sky", data, size), 1, 0, warnings), 8, 1);
    } catch (const Error&) {
    }
}

}  // namespace myriad::fuzz
