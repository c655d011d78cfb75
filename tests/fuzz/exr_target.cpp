#include "engine/error.hpp"
#include "tests/fuzz/input_file.hpp"
#include "tests/fuzz/targets.hpp"
#include "tools/exr.hpp"

namespace myriad::fuzz {

void exr(const uint8_t* data, size_t size) {
    static const InputFolder folder;
    try {
        tools::read_exr(folder.put("image.exr", data, size));
    } catch (const Error&) {
    }
}

}  // namespace myriad::fuzz
