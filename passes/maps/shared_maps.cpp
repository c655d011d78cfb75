#include "passes/maps/shared_maps.hpp"

namespace myriad::passes {

namespace {

uint32_t checked(uint32_t views) {
    if (views > compute::ViewTree::most_views)
        throw InputError("megaviews takes up to " + std::to_string(compute::ViewTree::most_views) + " views, and " + std::to_string(views) +
                         " are asked for; lower --vpls");
    return views;
}

engine::Constants sharing(engine::Constants constants) {
    constants[shared_maps_constant] = 1;
    return constants;
}

}  // namespace

SharedMaps::SharedMaps(engine::Device& device, uint32_t max_views, const engine::Constants& constants, bool asks)
    : tree_(device, checked(max_views)), megaviews_(device, constants), splat_(device, sharing(constants)), fuse_(device, tree_, asks) {}

void SharedMaps::record(engine::Recorder& recorder, compute::AppendLists& lists, const compute::SceneTree& scene, const engine::Array<uint>& count, uint32_t first,
                        uint32_t limit, float epsilon, uint32_t map_size, const engine::Array<uint>& atlas, uint32_t maps) {
    {
        auto scope = recorder.scope("pairs");
        megaviews_.record(recorder, lists, {scene, tree_, first, limit, epsilon, map_size});
        fuse_.place(recorder, lists, tree_, first, limit, maps);
    }
    {
        auto scope = recorder.scope("splat");
        splat_.record(recorder, {.cut = lists, .tree = scene, .views = tree_.nodes(), .first_view = first, .map_size = map_size, .places = &fuse_.places(),
                                 .view_capacity = tree_.capacity(), .first_shared = limit}, atlas);
    }
    auto scope = recorder.scope("fuse");
    fuse_.record(recorder, lists, tree_, count, first, limit, map_size, atlas);
}

}  // namespace myriad::passes
