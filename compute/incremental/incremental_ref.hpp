// The plain CPU twin: sets of open blocks, a view at a time.
#pragma once

#include <set>
#include <vector>

#include "compute/incremental/incremental.hpp"
#include "compute/manylods/manylods_ref.hpp"

namespace myriad::compute {

class CarriedCutRef {
public:
    // One frame over views [0, views.size()) of at most `most` views. `edges`: as in CarrySettings.
    void update(const HostTree& tree, const std::vector<View>& views, uint32_t most, float epsilon, uint map_size, uint32_t edges);
    std::vector<NodeView> cut(const HostTree& tree, const std::vector<View>& views, float epsilon, uint map_size) const;
    uint64_t invalid() const { return invalid_; }

private:
    std::vector<std::set<uint>> open_;  // by view: the open nodes' slots
    uint64_t invalid_ = 0;
};

}  // namespace myriad::compute
