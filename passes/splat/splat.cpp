#include "passes/splat/splat.hpp"

#include "passes/kernels.hpp"

namespace myriad::passes {

// A leaf around the view may scan its whole map. Where an invocation's loops are limited it draws one node, not a group's.
SplatPass::SplatPass(engine::Device& device, engine::Constants constants)
    : device_(device), threads_per_group_(device.loop_limit() == ~0u ? 1 : compute::bsh_arity_of(constants)), splat_([&] {
          constants[2] = threads_per_group_;
          return engine::Program(device, engine::passes_kernels, "splat/splat", constants);
      }()), grid_(device) {}

void SplatPass::check_map_size(const engine::Device& device, uint32_t map_size) {
    if (map_size < 2 || map_size > 1024 || map_texels(map_size) > device.loop_limit() - 1024)
        throw InputError("--map-size " + std::to_string(map_size) + " is out of range: this device draws maps from 2 to " +
                         (device.loop_limit() == ~0u ? "1024" : "176") + " texels a side");
}

void SplatPass::record(engine::Recorder& recorder, const SplatInputs& in, const engine::Array<uint>& atlas) {
    check_map_size(device_, in.map_size);
    if (in.changed && !in.tree.empty()) {
        if (!clear_) clear_.emplace(device_, engine::passes_kernels, "splat/clear");
        const uint views = uint(in.changed->count());
        recorder.dispatch(*clear_, SplatClearPush{.changed = recorder.read(*in.changed), .atlas = recorder.write(atlas), .views = views,
                                                  .map_size = in.map_size}, uint64_t(views) * 2 * in.map_size);
    } else {
        recorder.fill(atlas, atlas_nothing);
    }
    if (in.tree.empty()) return;
    grid_.dispatch(recorder, splat_, in.cut.state(), compute::AppendLists::kept_word, in.cut.kept_capacity(), threads_per_group_, [&] {
        return SplatPush{.groups = recorder.read(in.cut.kept()),
                         .count = recorder.read(in.cut.state(), compute::AppendLists::kept_word),
                         .failed = recorder.read(in.cut.state(), compute::AppendLists::failed_word),
                         .tree = in.tree.read(recorder),
                         .views = recorder.read(in.views),
                         .atlas = recorder.write(atlas),
                         .capacity = uint(in.cut.kept_capacity()),
                         .map_size = in.map_size,
                         .first_view = in.first_view,
                         .keeps = in.changed ? 1u : 0u,
                         .changed = in.changed ? recorder.read(*in.changed) : Uints{},
                         .places = in.places ? recorder.read(*in.places) : Uints{},
                         .view_capacity = in.view_capacity,
                         .first_shared = in.first_shared};
    });
}

}  // namespace myriad::passes
