// The builder of sparse octrees, for scenes and for views; see README.md.
#pragma once

#include <cstddef>
#include <optional>

#include "compute/append/grid.hpp"
#include "compute/octree/octree_io.h"
#include "compute/sort/sort.hpp"

namespace myriad::compute {

// The least cube around a box of finite corners, as 2^depth cells a side.
OctreeCube octree_cube(const vec3& least, const vec3& most, uint32_t depth);

// What the tree took and whether it fitted; read after the work that was recorded is done.
struct OctreeReport {
    OctreeState state{};
    bool ok() const { return state.failed == 0; }
    uint64_t needed() const { return state.needed; }
};

class Octree {
public:
    static constexpr uint64_t max_capacity = uint64_t(1) << 28;  // items, and nodes

    // `shape`: how the sort works, and whether a tile is one invocation's; what fits the device, unless a test asks for something else.
    Octree(engine::Device& device, uint64_t max_items, uint64_t max_nodes, uint32_t depth, std::optional<SortShape> shape = {});
    Octree(const Octree&) = delete;  // it knows which of its arrays the sort ended in

    // Keys and indices of points, those of min(count[index], max_items): for items that are points. Others fill item_keys() and item_indices() by a kernel of
    // their own, with octree_key.
    void record_keys(engine::Recorder& recorder, const engine::Array<vec4>& points, const engine::Array<uint>& count, uint64_t index, const OctreeCube& cube);
    const engine::Array<uvec2>& item_keys() const { return item_keys_; }
    const engine::Array<uint>& item_indices() const { return item_indices_; }

    // Sorts the items and builds the tree. Both arrays of items change.
    void record(engine::Recorder& recorder, const engine::Array<uint>& count, uint64_t index = 0);

    // For kernels that walk the tree; counts as reads of all of it.
    OctreeRef read(engine::Recorder& recorder) const;
    const engine::Array<uint>& first() const { return first_; }
    const engine::Array<uvec2>& keys() const { return keys_; }
    const engine::Array<uint>& sorted_items() const { return *sorted_items_; }  // of the last record()
    // The state as words: nodes of a level are at count_word + level.
    const engine::Array<uint>& state() const { return state_; }
    static constexpr uint64_t count_word = offsetof(OctreeState, count) / sizeof(uint);

    // Runs `program` over the nodes of each level from the leaves up, one invocation a node, each level after the one below it: to merge what nodes hold. `push(level)`
    // returns its push constants; its reads and writes belong inside. Invocation i is for node state.first[level] + i, if i < state.count[level].
    template <class MakePush>
    void bottom_up(engine::Recorder& recorder, const engine::Program& program, MakePush push) {
        for (uint32_t level = depth_ + 1; level-- > 0;)
            grid_.dispatch(recorder, program, state_, count_word + level, max_nodes_, 1, [&] { return push(level); });
    }

    // Copies the state to where report() finds it after the submission.
    void end(engine::Recorder& recorder) const;
    OctreeReport report() const;

    uint32_t depth() const { return depth_; }
    uint64_t max_items() const { return max_items_; }

private:
    uint32_t depth_;
    uint64_t max_items_, max_nodes_;
    SortShape shape_;
    engine::Program make_keys_, setup_, count_, finish_, write_;
    Sort sort_;
    Scan scan_;
    Grid grid_;
    engine::Array<uvec2> item_keys_, keys_;
    engine::Array<uint> item_indices_, first_, counters_, counts_, state_, report_;
    engine::Array<DispatchArgs> args_;
    const engine::Array<uint>* sorted_items_ = nullptr;
};

}  // namespace myriad::compute
