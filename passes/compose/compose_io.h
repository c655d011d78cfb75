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
    Float4s lamps;          // with has_lamps: irradiance, likewise, of lights that are gathered; what it brings counts as direct light
    Float4s beyond;         // with has_beyond: irradiance that the VPLs' bound cuts off, and a part of indirect light
    Float4s indirect, beauty;
    Float4s all_direct;     // with has_lamps: direct and theirs
    uint count, has_irradiance, has_natural, has_mirrored, has_direct, has_lamps, has_beyond;
};
MYRIAD_END

#endif
