// What the host makes of a scene's triangles before anything is rendered; see README.md.
#pragma once

#include "compute/bsh/bsh.hpp"
#include "compute/raytrace/bvh.hpp"
#include "compute/surface_sampling/surface_sampling.hpp"
#include "engine/cache.hpp"

namespace myriad::compute {

// Makes ray trees and hierarchies of these triangles, or takes them from a cache: the bits are the same. What the world
// refers to must outlive this, and so must the cache, which may be null: then all is made anew.
class Derived {
public:
    Derived(WorldTriangles world, engine::Cache* cache);

    const WorldTriangles& world() const { return world_; }

    // `opacity`: as Bvh takes it.
    Bvh bvh(engine::Device& device, BvhQuality quality = BvhQuality::quick, OpacityReader opacity = {});
    // What is kept is the samples in their order, which trees of every arity have in common.
    Bsh bsh(engine::Device& device, uint32_t log2_samples, uint32_t seed, uint arity = bsh_arity_default);
    // Samples as they come, along a curve through space, for who needs no tree.
    SurfaceSampling samples(uint32_t log2_samples, uint32_t seed);

private:
    // The name of what is made by these numbers.
    std::string name(const char* kind, std::initializer_list<uint64_t> numbers) const;

    WorldTriangles world_;
    engine::Cache* cache_;
    engine::Digest content_{};  // of the world and of the program, where there is a cache
};

}  // namespace myriad::compute
