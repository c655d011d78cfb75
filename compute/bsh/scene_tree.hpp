// What walks and draws a scene's tree asks of it, whichever it is: the hierarchy over samples (compute/bsh), or the octree (compute/svo).
#pragma once

#include "compute/bsh/bsh_io.h"
#include "engine/recorder.hpp"

namespace myriad::compute {

class SceneTree {
public:
    virtual ~SceneTree() = default;

    // For a kernel that walks the tree, by compute/svo/tree.glsl.
    virtual BshRef read(engine::Recorder& recorder) const = 0;
    virtual bool empty() const = 0;   // there is nothing in it, and it must not be read
    virtual uint arity() const = 0;   // slots of a block
    virtual uint levels() const = 0;  // opening steps from the root to the leaves
};

}  // namespace myriad::compute
