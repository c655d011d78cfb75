#include "passes/light_tree/light_tree.hpp"

#include "passes/kernels.hpp"

namespace myriad::passes {

using compute::ViewTree;

LightTree::LightTree(engine::Device& device, uint32_t capacity)
    : leaves_(device, engine::passes_kernels, "light_tree/leaves"), merge_(device, engine::passes_kernels, "light_tree/merge"), grid_(device),
      ordered_(device, "vpls", "lights along the curve", capacity), nodes_(device, "light tree", "nodes of lights", ViewTree::node_count(capacity)) {}

void LightTree::record(engine::Recorder& recorder, const ViewTree& views, const engine::Array<Vpl>& lights, const engine::Array<uint>& count) {
    assert(views.capacity() == capacity());
    recorder.dispatch(leaves_,
                      LightLeavesPush{.lights = recorder.read(lights), .order = recorder.read(views.order()), .count = recorder.read(count),
                                      .ordered = recorder.write(ordered_), .nodes = recorder.write(nodes_), .limit = capacity()},
                      capacity());
    for (uint32_t level = view_tree_levels; level-- > 0;)
        grid_.dispatch(recorder, merge_, views.levels(), ViewTree::count_word(level), views.inner_capacity(), 1, [&] {
            return LightMergePush{.views = recorder.read(views.nodes()), .groups = recorder.read(views.groups()), .levels = views.read_levels(recorder),
                                  .nodes = recorder.write(nodes_), .level = level, .capacity = capacity(), .inner = views.inner_capacity()};
        });
}

}  // namespace myriad::passes
