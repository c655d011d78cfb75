#include "passes/brute/brute.hpp"

#include <algorithm>

#include "passes/kernels.hpp"

namespace myriad::passes {
namespace {

// Views that an invocation takes its triangle through: so many that fetching it costs nothing, so few that their maps stay in caches.
constexpr uint32_t views_a_slice = 64;

engine::Constants constants(const compute::WorldTriangles& world, uint32_t own_texels) {
    engine::Constants constants = world.constants();
    constants[2] = world.opacity.everywhere();
    constants[3] = own_texels;
    return constants;
}

}  // namespace

BrutePass::BrutePass(engine::Device& device, const compute::WorldTriangles& world, uint32_t own_texels)
    : device_(device), program_(device, engine::passes_kernels, "brute/brute", constants(world, own_texels)), triangles_(world.count()),
      solid_(world.opacity.everywhere()) {}

void BrutePass::record(engine::Recorder& recorder, const Geometry& geometry, const engine::Array<View>& views, const engine::Array<uint>& count,
                       uint32_t first, uint32_t limit, uint32_t map_size, const engine::Array<uint>& atlas) {
    recorder.fill(atlas, atlas_nothing);
    if (triangles_ == 0) return;
    const uint32_t workgroup = program_.workgroup_size();
    const uint32_t groups = (triangles_ + workgroup - 1) / workgroup;
    // A view may loop over all texels of a map, and over the group's lanes, in each half.
    const uint32_t loops = map_texels(map_size) + 2 * 128 + 64;
    const uint32_t slice = std::clamp((device_.loop_limit() - 1024) / loops, 1u, views_a_slice);
    const uint32_t slices = (limit + slice - 1) / slice;
    const uint32_t at_once = std::max(1u, (1u << 30) / (groups * workgroup));  // slices a dispatch: threads are counted in 32 bits
    for (uint32_t done = 0; done < slices; done += at_once)
        recorder.dispatch(program_,
                          BrutePush{.geometry = geometry.read(recorder),
                                    .opacity = solid_ ? OpacityRef{} : geometry.opacity()(recorder),
                                    .views = recorder.read(views),
                                    .count = recorder.read(count),
                                    .atlas = recorder.write(atlas),
                                    .triangles = triangles_,
                                    .first_view = first,
                                    .limit = limit,
                                    .first_slice = done,
                                    .slice = slice,
                                    .groups_a_slice = groups,
                                    .map_size = map_size},
                          uint64_t(groups) * workgroup * std::min(at_once, slices - done));
}

}  // namespace myriad::passes
