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
void environment(const uint8_t* data, size_t size);  // an EXR or Radiance file, as `myriad render --env` reads it
// Five bytes say how (mode, filter, stride, count), the rest is a stream of EXT_meshopt_compression.
void meshopt(const uint8_t* data, size_t size);
void ibsp(const uint8_t* data, size_t size);     // a map of Quake III; what `myriad convert` would write of it is written
void embree(const uint8_t* data, size_t size);   // XML, and after the first zero byte the numbers, gzipped or not
void assimp(const uint8_t* data, size_t size);   // the first byte says which ending the file has
void ply(const uint8_t* data, size_t size);
void texture(const uint8_t* data, size_t size);  // TGA, BMP, GIF and PSD, as textures of imported scenes come
void recipe(const uint8_t* data, size_t size);   // beside a few parts that it may name

struct Target {
    const char* name;
    void (*run)(const uint8_t* data, size_t size);
};
inline constexpr Target targets[] = {{"gltf", gltf},     {"picture", picture}, {"draco", draco}, {"exr", exr},         {"meshopt", meshopt}, {"ibsp", ibsp},
                                     {"embree", embree}, {"assimp", assimp},   {"ply", ply},     {"texture", texture}, {"recipe", recipe},
                                     {"environment", environment}};

// Where each target starts from: small valid inputs, made by our own writers and by the libraries' encoders. The same
// bytes every time.
std::vector<std::string> seeds(const std::string& target);

}  // namespace myriad::fuzz
