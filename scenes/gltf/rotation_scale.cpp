#include "scenes/gltf/rotation_scale.hpp"

#include <algorithm>
#include <cmath>

namespace myriad::scenes::gltf {
namespace {

// Any unit vector at a right angle to the unit vector v.
glm::dvec3 perpendicular(const glm::dvec3& v) {
    const glm::dvec3 a = glm::abs(v);
    const glm::dvec3 axis = a.x <= a.y && a.x <= a.z ? glm::dvec3(1, 0, 0) : a.y <= a.z ? glm::dvec3(0, 1, 0) : glm::dvec3(0, 0, 1);
    return glm::normalize(glm::cross(v, axis));
}

// One-sided Jacobi: turns pairs of columns of `a` until all stand at right angles, and collects the turns in `v`, so that
// a = m * v all along. Converges quadratically; 30 sweeps are far more than three columns need.
void orthogonalise(glm::dmat3& a, glm::dmat3& v) {
    for (int sweep = 0; sweep < 30; ++sweep) {
        bool turned = false;
        for (int p = 0; p < 2; ++p)
            for (int q = p + 1; q < 3; ++q) {
                const double pp = glm::dot(a[p], a[p]), qq = glm::dot(a[q], a[q]), pq = glm::dot(a[p], a[q]);
                if (std::abs(pq) <= 1e-15 * std::sqrt(pp * qq)) continue;
                const double zeta = (qq - pp) / (2 * pq);
                const double t = (zeta < 0 ? -1 : 1) / (std::abs(zeta) + std::sqrt(1 + zeta * zeta));
                const double c = 1 / std::sqrt(1 + t * t), s = c * t;
                for (glm::dmat3* m : {&a, &v}) {
                    const glm::dvec3 was = (*m)[p];
                    (*m)[p] = c * was - s * (*m)[q];
                    (*m)[q] = s * was + c * (*m)[q];
                }
                turned = true;
            }
        if (!turned) return;
    }
}

}  // namespace

bool at_right_angles(const glm::dmat3& m) {
    for (int p = 0; p < 3; ++p) {
        if (!(glm::length(m[p]) > 0)) return false;
        const int q = (p + 1) % 3;
        if (!(std::abs(glm::dot(m[p], m[q])) <= 1e-6 * glm::length(m[p]) * glm::length(m[q]))) return false;
    }
    return true;
}

RotationScale rotation_scale(const glm::dmat3& m) {
    // Scaled to about 1 first: squares of what floats can hold would over- or underflow.
    double size = 0;
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r) size = std::max(size, std::abs(m[c][r]));
    if (size == 0) return {.scale = glm::dvec3(0)};
    glm::dmat3 a = m / size, v(1);
    orthogonalise(a, v);

    RotationScale out;
    for (int i = 0; i < 3; ++i) out.scale[i] = glm::length(a[i]);
    // Columns that vanished have no direction left: they get what completes a rotation.
    const double least = 1e-12 * std::max({out.scale.x, out.scale.y, out.scale.z});
    int known = 0, order[3], last = 3;
    for (int i = 0; i < 3; ++i) {
        if (out.scale[i] > least) order[known++] = i;
        else order[--last] = i, out.scale[i] = 0;
    }
    glm::dmat3 u(1);
    for (int k = 0; k < 3; ++k) {
        const int i = order[k];
        if (k < known) u[i] = a[i] / out.scale[i];
        else if (k == 1) u[i] = perpendicular(u[order[0]]);
        else u[i] = glm::cross(u[order[0]], u[order[1]]);
    }
    // v consists of rotations alone. Where u mirrors, the mirror goes into one scale.
    if (glm::determinant(u) < 0) u[2] = -u[2], out.scale[2] = -out.scale[2];
    out.scale *= size;
    out.outer = glm::normalize(glm::quat_cast(u));
    out.inner = glm::normalize(glm::quat_cast(glm::transpose(v)));
    return out;
}

glm::dquat aim(const glm::dvec3& direction) {
    // The shortest turn from the half of Z that is nearer; from +Z, -Z was turned there about X before.
    const glm::dvec3 from(0, 0, direction.z > 0 ? 1 : -1), axis = glm::cross(from, direction);
    const glm::dquat turn = glm::normalize(glm::dquat(1 + glm::dot(from, direction), axis.x, axis.y, axis.z));
    return direction.z > 0 ? turn * glm::dquat(0, 1, 0, 0) : turn;
}

}  // namespace myriad::scenes::gltf
