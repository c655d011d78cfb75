// Uniform, low-discrepancy samples of a triangle mesh; see README.md.
#pragma once

#include <span>
#include <vector>

#include "compute/instances/world.hpp"
#include "compute/surface_sampling/surface_sample.h"

namespace myriad::compute {

struct SurfaceSampling {
    std::vector<SurfaceSample> samples;  // 2^log2_count; none where no triangle is finite
    double area = 0;                     // of the whole surface, without holes
    float radius = 0;                    // of the disc that a sample stands for; discs of all samples cover the surface
    bool empty() const { return samples.empty(); }
};

// The radius of a sample's disc in units of sqrt(area / (n pi)), the radius of a disc of a sample's share of the area.
// Measured (README.md): covers 99.9 % of the surface; 1.5 covers 99 %; 1.0996 would be a perfect hexagonal lattice.
inline constexpr double surface_sample_cover = 1.75;

// Samples stand where there is a surface: not in the holes of cut-outs. A blended one has them wherever trees keep something of it
// (opacity_missing). Deterministic in all arguments but `threads` (0: all there are), which changes no bit, and the same whether
// instances share triangles or are written out. Triangles without area, or with non-finite vertices, get no sample, unless there are no
// others: then samples sit at vertices and have radius 0.
SurfaceSampling sample_surface(const WorldTriangles& world, uint32_t log2_count, uint32_t seed, uint32_t threads = 0);

}  // namespace myriad::compute
