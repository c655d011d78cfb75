// "append/grid": the grid of a kernel that runs over as many items as an append list holds.
#ifndef MYRIAD_COMPUTE_GRID_IO_H
#define MYRIAD_COMPUTE_GRID_IO_H

#include "engine/shared.h"

MYRIAD_BEGIN
struct GridPush {
    Uints count;             // count.at[0] items …
    DispatchArgsArray args;
    uint limit;              // … but no more than these
    uint threads_per_item, workgroup_size;
};
MYRIAD_END

#endif
