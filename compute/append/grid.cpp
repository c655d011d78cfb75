#include "compute/append/grid.hpp"

#include "compute/kernels.hpp"

namespace myriad::compute {

Grid::Grid(engine::Device& device) : grid_(device, engine::compute_kernels, "append/grid"), args_(device, "lists", "grid", 1) {}

void Grid::size_grid(engine::Recorder& recorder, const engine::Program& program, const engine::Array<uint>& count, uint64_t index,
                     uint64_t limit, uint32_t threads_per_item) {
    assert(threads_per_item > 0 && program.workgroup_size() % threads_per_item == 0);
    recorder.dispatch(grid_,
                      GridPush{.count = recorder.read(count, index),
                               .args = recorder.write(args_),
                               .limit = uint(limit),
                               .threads_per_item = threads_per_item,
                               .workgroup_size = program.workgroup_size()},
                      1);
}

}  // namespace myriad::compute
