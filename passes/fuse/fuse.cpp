#include "passes/fuse/fuse.hpp"

#include "passes/kernels.hpp"

namespace myriad::passes {

using compute::AppendLists;
using engine::passes_kernels;

FusePass::FusePass(engine::Device& device, const compute::ViewTree& tree, bool asks)
    : reach_(device, passes_kernels, "fuse/reach"), mark_(device, passes_kernels, "fuse/mark"), count_(device, passes_kernels, "fuse/count"), inherit_(device, passes_kernels, "fuse/inherit"),
      fuse_(device, passes_kernels, "fuse/fuse"), scan_(device, tree.inner_capacity()), grid_(device),
      marks_(device, "view tree", "marks of view nodes", tree.inner_capacity()), places_(device, "view tree", "maps of view nodes", tree.inner_capacity() + 1),
      above_(device, "view tree", "maps above view nodes", tree.capacity() + tree.inner_capacity()), 
      reached_(device, "view tree", "reached levels", tree.levels().count()), inner_nodes_(device, "view tree", "number of inner view nodes", 1),
      needed_(device, "view tree", "shared maps", 1), needed_report_(device, "view tree", "shared maps report", 1, engine::Location::host) {
    if (!asks) return;
    ask_.emplace(device, passes_kernels, "fuse/ask");
    shared_maps_ = {device, "view tree", "shared maps of views", tree.capacity()};
}

void FusePass::place(engine::Recorder& recorder, AppendLists& lists, const compute::ViewTree& tree, uint32_t first, uint32_t limit, uint32_t maps) {
    recorder.fill(inner_nodes_, 0);
    recorder.dispatch(reach_,
                      FuseReachPush{.groups = recorder.read(tree.groups()), .levels = tree.read_levels(recorder), .reached = {recorder.write(reached_).address},
                                    .inner_nodes = recorder.write(inner_nodes_), .view_capacity = tree.capacity(), .inner = tree.inner_capacity(), .first = first, .limit = limit},
                      view_tree_levels);
    recorder.fill(marks_, 0);
    grid_.dispatch(recorder, mark_, lists.state(), AppendLists::kept_word, lists.kept_capacity(), 1, [&] {
        return FuseMarkPush{.groups = recorder.read(lists.kept()), .count = recorder.read(lists.state(), AppendLists::kept_word),
                            .marks = recorder.write(marks_), .capacity = uint(lists.kept_capacity()), .view_capacity = tree.capacity()};
    });
    recorder.copy(marks_, places_, marks_.bytes());
    scan_.record(recorder, places_, inner_nodes_);
    recorder.dispatch(count_,
                      FuseCountPush{.places = recorder.read(places_), .inner_nodes = recorder.read(inner_nodes_), .lists = lists.write_state(recorder),
                                    .needed = recorder.write(needed_), .room = maps - limit},
                      1);
    recorder.copy(needed_, needed_report_, needed_.bytes());
    lists.end(recorder);  // again: they may have failed
}

void FusePass::record(engine::Recorder& recorder, const AppendLists& lists, const compute::ViewTree& tree, const engine::Array<uint>& count, uint32_t first,
                      uint32_t limit, uint32_t map_size, const engine::Array<uint>& atlas) {
    const auto fuse = [&](uint level) {
        return FusePush{.nodes = recorder.read(tree.nodes()), .levels = {recorder.read(reached_).address}, .count = recorder.read(count),
                        .marks = recorder.read(marks_), .places = recorder.read(places_), .above = recorder.read(above_),
                        .failed = recorder.read(lists.state(), AppendLists::failed_word), .atlas = recorder.write(atlas), .level = level,
                        .view_capacity = tree.capacity(), .inner = tree.inner_capacity(), .map_size = map_size, .first = first, .limit = limit};
    };
    for (uint level = 0; level < view_tree_levels; ++level) {
        grid_.dispatch(recorder, inherit_, reached_, compute::ViewTree::count_word(level), tree.inner_capacity(), 1, [&] {
            return FuseInheritPush{.groups = recorder.read(tree.groups()), .levels = {recorder.read(reached_).address}, .marks = recorder.read(marks_),
                                   .above = recorder.write(above_), .level = level, .view_capacity = tree.capacity(), .inner = tree.inner_capacity()};
        });
        if (level > 0)  // the root inherits nothing
            grid_.dispatch(recorder, fuse_, reached_, compute::ViewTree::count_word(level), tree.inner_capacity(), fuse_threads, [&] { return fuse(level); });
    }
    if (!ask_) return recorder.dispatch(fuse_, fuse(fuse_of_views), uint64_t(limit) * fuse_threads);
    recorder.dispatch(*ask_,
                      FuseAskPush{.nodes = recorder.read(tree.nodes()), .count = recorder.read(count), .places = recorder.read(places_), .above = recorder.read(above_),
                                  .shared_maps = recorder.write(shared_maps_), .view_capacity = tree.capacity(), .map_size = map_size, .first = first, .limit = limit},
                      limit);
}

}  // namespace myriad::passes
