// What the compose kernel and its host share.
#ifndef MYRIAD_PASSES_COMPOSE_IO_H
#define MYRIAD_PASSES_COMPOSE_IO_H

#include "engine/shared.h"

MYRIAD_BEGIN
struct ComposePush {
    Float4s albedo, emitted;
    Float4s irradiance;     // with has_irradiance; then, with has_mirrored, as many of what lobes reflect
    Float4s natural;        // with has_natural: the same of the environment's lights
    Float4s direct;         // with has_direct
    Float4s indirect, beauty;
    uint count, has_irradiance, has_natural, has_mirrored, has_direct;
};
MYRIAD_END

#endif
