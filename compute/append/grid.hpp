// A dispatch over a count that only the device knows.
#pragma once

#include "compute/append/grid_io.h"
#include "engine/recorder.hpp"

namespace myriad::compute {

class Grid {
public:
    explicit Grid(engine::Device& device);

    // Runs `program` over min(count[index], limit) items, `threads_per_item` invocations each (a divisor of the workgroup
    // size). `push()` returns its push constants; its reads and writes belong inside.
    template <class MakePush>
    void dispatch(engine::Recorder& recorder, const engine::Program& program, const engine::Array<uint>& count, uint64_t index,
                  uint64_t limit, uint32_t threads_per_item, MakePush push) {
        size_grid(recorder, program, count, index, limit, threads_per_item);
        recorder.dispatch_indirect(program, push(), args_);
    }

private:
    void size_grid(engine::Recorder& recorder, const engine::Program& program, const engine::Array<uint>& count, uint64_t index,
                   uint64_t limit, uint32_t threads_per_item);

    engine::Program grid_;
    engine::Array<DispatchArgs> args_;
};

}  // namespace myriad::compute
