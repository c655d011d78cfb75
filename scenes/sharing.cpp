#include "scenes/sharing.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

namespace myriad::scenes {
namespace {

// What a mesh or an instance takes on the device: positions, attributes, indices, and its part of the ray tree.
constexpr uint64_t bytes_a_triangle = 16 + 40 + 16, bytes_an_instance = 2 * 64 + 88 + 24;

uint64_t bytes_a_vertex(const Primitive& p) {
    return 12 + 12 + 8 + (p.colors.empty() ? 0 : 16) + (p.texcoords1.empty() ? 0 : 8) + (p.tangents.empty() ? 0 : 16);
}

MeshUse measure(const Mesh& mesh) {
    MeshUse use;
    glm::dvec3 lo(std::numeric_limits<double>::infinity()), hi(-lo);
    for (const Primitive& p : mesh.primitives) {
        use.triangles += p.indices.size() / 3;
        use.bytes += bytes_a_triangle * (p.indices.size() / 3) + bytes_a_vertex(p) * (p.normals.empty() ? p.indices.size() : p.positions.size());
        for (const glm::vec3& v : p.positions)
            if (std::isfinite(v.x) && std::isfinite(v.y) && std::isfinite(v.z)) lo = glm::min(lo, glm::dvec3(v)), hi = glm::max(hi, glm::dvec3(v));
    }
    if (lo.x <= hi.x) use.lo = lo, use.hi = hi;
    return use;
}

}  // namespace

double MeshUse::saves() const { return double(bytes) * (double(instances) - 1) - double(bytes_an_instance * instances); }

bool can_share(const MeshUse& mesh, const glm::mat4& to_world) {
    const glm::dmat4 m(to_world);
    if (m[0][3] != 0 || m[1][3] != 0 || m[2][3] != 0 || m[3][3] != 1) return false;
    const glm::dmat3 linear(m);
    const double size = std::max({mesh.hi.x - mesh.lo.x, mesh.hi.y - mesh.lo.y, mesh.hi.z - mesh.lo.z});
    const glm::dvec3 most = glm::max(glm::abs(mesh.lo), glm::abs(mesh.hi));
    const glm::dmat3 inverse = glm::inverse(linear);
    double largest = 0;
    for (int i = 0; i < 3; ++i) {
        // Along axis i of the mesh: what world coordinates as large as these are worth there.
        double reach = 0;
        for (int j = 0; j < 3; ++j) {
            const double far = std::abs(m[0][j]) * most.x + std::abs(m[1][j]) * most.y + std::abs(m[2][j]) * most.z + std::abs(m[3][j]);
            reach += std::abs(inverse[j][i]) * far;
            largest = std::max(largest, far);
            if (!(std::abs(linear[j][i]) < 1e12) || !(std::abs(inverse[j][i]) < 1e12)) return false;
        }
        if (!(reach <= sharing_most_distortion * size)) return false;
    }
    // In either space what is farther is dropped, and must be the same triangles whether they are shared or not; a little nearer,
    // for coordinates are computed in 32 bits there.
    return std::max({largest, most.x, most.y, most.z}) < 0.999 * double(farthest) && largest > 1e-12;
}

SharingPlan plan_sharing(const Scene& scene, Sharing sharing, const std::vector<Stance>& stances) {
    SharingPlan plan{std::vector<MeshUse>(scene.meshes.size()), std::vector<bool>(scene.instances.size())};
    if (sharing == Sharing::never) return plan;
    for (size_t i = 0; i < scene.meshes.size(); ++i) plan.meshes[i] = measure(scene.meshes[i]);
    double all = 0, saved = 0;
    for (size_t i = 0; i < scene.instances.size(); ++i) {
        MeshUse& use = plan.meshes[scene.instances[i].mesh];
        all += double(use.bytes);
        const bool still = stances.empty() || stances[i] == Stance::still;
        plan.shares[i] = still && use.triangles > 0 && can_share(use, scene.instances[i].to_world);
        use.instances += plan.shares[i];
    }
    const bool always = sharing == Sharing::always;
    for (size_t i = 0; i < plan.meshes.size(); ++i) {
        MeshUse& use = plan.meshes[i];
        use.share = use.instances > 1 && (always || (use.triangles >= sharing_least_triangles && use.saves() > 0));
        if (use.share) saved += use.saves();
    }
    const bool pays = always || (saved >= double(sharing_least_bytes) && saved >= sharing_least_part * all);
    for (MeshUse& use : plan.meshes) use.share = use.share && pays;
    for (size_t i = 0; i < scene.instances.size(); ++i) plan.shares[i] = plan.shares[i] && plan.meshes[scene.instances[i].mesh].share;
    return plan;
}

}  // namespace myriad::scenes
