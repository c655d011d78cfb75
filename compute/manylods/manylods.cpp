#include "compute/manylods/manylods.hpp"

#include "compute/kernels.hpp"

namespace myriad::compute {

using engine::compute_kernels;

namespace {

static_assert(bsh_max_blocks == cut_max_blocks);

// The root's block holds what is left when the binary levels are taken so many at a time.
uint32_t root_children(const Bsh& tree) {
    const uint32_t rest = tree.depth() % tree.shape().arity_log2;
    return rest || tree.depth() == 0 ? 1u << rest : tree.arity();
}

}  // namespace

ManyLods::ManyLods(engine::Device& device, const engine::Constants& constants)
    : arity_(bsh_arity_of(constants)), seed_(device, compute_kernels, "manylods/seed", constants), open_(device, compute_kernels, "manylods/open", constants),
      walk_(device, compute_kernels, "manylods/walk", constants) {}

void ManyLods::record(engine::Recorder& recorder, AppendLists& lists, const ManyLodsInputs& in) const {
    assert(in.first_view + in.limit <= cut_max_views && in.tree.blocks() < cut_max_blocks && in.tree.arity() == arity_);
    auto push = [&](const AppendRef& ref) {
        return ManyLodsPush{.lists = ref,
                            .tree = in.tree.read(recorder),
                            .views = recorder.read(in.views),
                            .epsilon = in.epsilon,
                            .map_size = in.map_size,
                            .first_view = in.first_view};
    };
    const uint32_t limit = in.tree.empty() ? 0 : in.limit;
    lists.begin(recorder, seed_, in.view_count, in.first_view, limit);
    if (limit > 0) {
        lists.step(recorder, seed_, root_children(in.tree), push);
        for (uint32_t level = 0; level < in.tree.levels(); ++level) lists.step(recorder, open_, arity_, push);
    }
    lists.end(recorder);
}

void ManyLods::record_walk(engine::Recorder& recorder, const engine::Array<uvec2>& kept, const engine::Array<uint>& state,
                           const ManyLodsInputs& in) const {
    assert(in.tree.arity() == arity_);
    recorder.fill(state, 0);
    if (in.tree.empty()) return;
    recorder.dispatch(walk_,
                      WalkPush{.tree = in.tree.read(recorder),
                               .views = recorder.read(in.views),
                               .kept = recorder.write(kept),
                               .state = {recorder.write(state).address},
                               .count = recorder.read(in.view_count),
                               .epsilon = in.epsilon,
                               .map_size = in.map_size,
                               .kept_capacity = uint(kept.count()),
                               .first_view = in.first_view,
                               .limit = in.limit},
                      in.limit);
}

}  // namespace myriad::compute
