// One libFuzzer program a target: MYRIAD_FUZZ_TARGET is its name. `PROGRAM --seeds FOLDER` writes the seeds and ends.
#include <cstring>
#include <filesystem>
#include <fstream>

#include "tests/fuzz/targets.hpp"

#define MYRIAD_TEXT(x) #x
#define MYRIAD_NAME(x) MYRIAD_TEXT(x)

extern "C" int LLVMFuzzerInitialize(int* argc, char*** argv) {
    if (*argc == 3 && !std::strcmp((*argv)[1], "--seeds")) {
        const std::filesystem::path folder = (*argv)[2];
        std::filesystem::create_directories(folder);
        int number = 0;
        for (const std::string& seed : myriad::fuzz::seeds(MYRIAD_NAME(MYRIAD_FUZZ_TARGET)))
            std::ofstream(folder / ("seed-" + std::to_string(number++)), std::ios::binary) << seed;
        std::exit(0);
    }
    return 0;
}

extern "C" int LLVMFuzzerTestOneInput(const uint8_t* data, size_t size) {
    myriad::fuzz::MYRIAD_FUZZ_TARGET(data, size);
    return 0;
}
