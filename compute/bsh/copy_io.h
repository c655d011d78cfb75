// "bsh/copy": what a refit is held against, for measurements: as many bytes as the tree has, read and written, sixteen an invocation.
#ifndef MYRIAD_COMPUTE_BSH_COPY_IO_H
#define MYRIAD_COMPUTE_BSH_COPY_IO_H

#include "engine/shared.h"

MYRIAD_BEGIN
struct BshCopyPush {
    Uint4s from, to;
    uint count;
};
MYRIAD_END

#endif
