// "gathering/reorder": lights in the order that maps take them in, and what the list by sets is sorted from; one invocation a light.
#ifndef MYRIAD_PASSES_GATHERING_IO_H
#define MYRIAD_PASSES_GATHERING_IO_H

#include "passes/gather/gather_io.h"

MYRIAD_BEGIN
struct ReorderPush {
    Vpls lights;
    Uints count;
    Uints order;        // by place: which light
    Vpls reordered;
    Uints sets;         // by place: the light's set of lights that pixels gather, which is its number modulo `sets_count`
    Uints listed;       // by place: itself, and its set, as GatherPush::listed
    uint limit, sets_count;
};
MYRIAD_END

#endif
