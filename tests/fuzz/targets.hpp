// What is fuzzed: each target takes any bytes, and must end in time, in bounded memory, without a crash and without an
// exception that is no myriad::Error. libFuzzer drives them (CMake preset "fuzz"), and so does replay_test.cpp.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace myriad::fuzz {

// `glTF…`: a .glb file. Otherwise JSON, and after the first zero byte, if there is one, the binary chunk of a GLB that is
// put together around both, so that a mutation need not guess lengths. Loads, flattens, picks a camera, checks the result.
void gltf(const uint8_t* data, size_t size);
void picture(const uint8_t* data, size_t size);  // PNG, JPEG
void draco(const uint8_t* data, size_t size);    // a Draco stream
void exr(const uint8_t* data, size_t size);      // an EXR file, as `myriad compare` reads it

struct Target {
    const char* name;
    void (*run)(const uint8_t* data, size_t size);
};
inline constexpr Target targets[] = {{"gltf", gltf}, {"picture", picture}, {"draco", draco}, {"exr", exr}};

// Where each target starts from: small valid inputs, made by our own writers and by the libraries' encoders. The same
// bytes every time.
std::vector<std::string> seeds(const std::string& target);

}  // namespace myriad::fuzz
