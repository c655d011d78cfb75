// Which meshes flatten() stores once for all their instances.
#pragma once

#include <vector>

#include "scenes/stance.hpp"

namespace myriad::scenes {

struct MeshUse {
    uint64_t instances = 0;         // that can share
    uint64_t triangles = 0, bytes = 0;
    glm::dvec3 lo{0}, hi{0};        // of all vertices that are finite
    bool share = false;

    // Bytes saved by storing it once; negative where instances cost more.
    double saves() const;
};

struct SharingPlan {
    std::vector<MeshUse> meshes;
    std::vector<bool> shares;       // an instance each: its mesh is stored once, and it is one of those who share it
};
// Only instances that stand still share. `stances`: one an instance; empty: all do.
SharingPlan plan_sharing(const Scene& scene, Sharing sharing, const std::vector<Stance>& stances = {});

// Whether rays can be traced in the mesh's own space: the transform is affine and regular, what is rounded off world
// coordinates is small beside the mesh (sharing_most_distortion), and nothing is beyond `farthest` in either space.
bool can_share(const MeshUse& mesh, const glm::mat4& to_world);

}  // namespace myriad::scenes
