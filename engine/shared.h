// What C++ and GLSL share: with this, a header of structs and formulae compiles as both languages, so that a push constant,
// a buffer's element or a formula is written once. GLSL structs use the scalar layout, which is C++'s for these types.
//
//   MYRIAD_BEGIN … MYRIAD_END   around everything in a shared header (a namespace in C++)
//   MYRIAD_FN                   before a function
//   MYRIAD_INOUT(T)             a parameter that is written
//   MYRIAD_PRECISE              before a variable whose value must not depend on where its formula is compiled into: no fused operations
//   MYRIAD_ARRAY(Name, T, A)    Name: the device address of an array of T aligned to A bytes; GLSL reads `x.at[i]`,
//                               C++ gets the address from Recorder::read or write, never from a buffer itself
#ifndef MYRIAD_ENGINE_SHARED_H
#define MYRIAD_ENGINE_SHARED_H

#ifdef __cplusplus
#include <cmath>
#include <cstdint>
#include <cstring>

#include <glm/glm.hpp>

namespace myriad {
using glm::ivec2, glm::vec2, glm::vec3, glm::vec4, glm::uvec2, glm::uvec3, glm::uvec4, glm::mat4;
using uint = uint32_t;

// A typed device address.
template <class T>
struct Ref {
    uint64_t address = 0;
};

inline float uintBitsToFloat(uint v) { float f; std::memcpy(&f, &v, 4); return f; }
inline uint floatBitsToUint(float v) { uint u; std::memcpy(&u, &v, 4); return u; }
using glm::abs, glm::clamp, glm::cross, glm::dot, glm::floor, glm::max, glm::min, glm::normalize, glm::mix;
using std::pow, std::sqrt;
inline int findMSB(uint v) { return v == 0 ? -1 : 31 - __builtin_clz(v); }
}  // namespace myriad

#define MYRIAD_BEGIN namespace myriad {
#define MYRIAD_END }
#define MYRIAD_FN inline
#define MYRIAD_INOUT(T) T&
#define MYRIAD_PRECISE
#define MYRIAD_ARRAY(Name, T, A) using Name = ::myriad::Ref<T>;

#else
#extension GL_EXT_buffer_reference : require
#extension GL_EXT_scalar_block_layout : require
#extension GL_EXT_control_flow_attributes : enable

#define MYRIAD_BEGIN
#define MYRIAD_END
#define MYRIAD_FN
#define MYRIAD_INOUT(T) inout T
#define MYRIAD_PRECISE precise
#define MYRIAD_ARRAY(Name, T, A) \
    layout(buffer_reference, scalar, buffer_reference_align = A) buffer Name { T at[]; };
#endif

MYRIAD_BEGIN
MYRIAD_ARRAY(Uints, uint, 4)
MYRIAD_ARRAY(Uint2s, uvec2, 8)
MYRIAD_ARRAY(Uint4s, uvec4, 16)
MYRIAD_ARRAY(Floats, float, 4)
MYRIAD_ARRAY(Float4s, vec4, 16)

// What vkCmdDispatchIndirect reads.
struct DispatchArgs {
    uint x, y, z;
};
MYRIAD_ARRAY(DispatchArgsArray, DispatchArgs, 4)

// The grid of at least `groups` workgroups. Devices need only allow 65535 a dimension, so long lists use two.
MYRIAD_FN DispatchArgs grid_of(uint groups) {
    DispatchArgs args;
    args.x = groups < 65535u ? groups : 65535u;
    args.y = args.x == 0u ? 0u : (groups + 65534u) / 65535u;
    args.z = groups == 0u ? 0u : 1u;
    return args;
}
MYRIAD_END

#endif
