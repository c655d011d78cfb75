#include "scenes/import/triangulate.hpp"

#include <algorithm>
#include <cmath>
#include <numeric>

namespace myriad::scenes::importing {
namespace {

constexpr size_t most_corners = 10000;

// Twice the signed area of a triangle in the plane.
double turn(const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) { return (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x); }

bool inside(const glm::dvec2& p, const glm::dvec2& a, const glm::dvec2& b, const glm::dvec2& c) {
    return turn(a, b, p) >= 0 && turn(b, c, p) >= 0 && turn(c, a, p) >= 0;
}

// The corners in the plane that the polygon lies in best, so that it turns counter-clockwise there. Newell's normal.
std::vector<glm::dvec2> flattened(std::span<const glm::vec3> corners) {
    glm::dvec3 normal(0);
    for (size_t i = 0; i < corners.size(); ++i) {
        const glm::dvec3 a = glm::dvec3(corners[i]) - glm::dvec3(corners[0]), b = glm::dvec3(corners[(i + 1) % corners.size()]) - glm::dvec3(corners[0]);
        normal += glm::cross(a, b);
    }
    const glm::dvec3 size = glm::abs(normal);
    std::vector<glm::dvec2> out;
    for (const glm::vec3& c : corners) {  // drops the axis that the normal is nearest to
        const glm::dvec3 p = glm::dvec3(c) - glm::dvec3(corners[0]);
        if (size.x >= size.y && size.x >= size.z) out.push_back(normal.x < 0 ? glm::dvec2(p.z, p.y) : glm::dvec2(p.y, p.z));
        else if (size.y >= size.z) out.push_back(normal.y < 0 ? glm::dvec2(p.x, p.z) : glm::dvec2(p.z, p.x));
        else out.push_back(normal.z < 0 ? glm::dvec2(p.y, p.x) : glm::dvec2(p.x, p.y));
    }
    return out;
}

// Cuts ears (Meisters 1975): a convex corner whose triangle holds no other corner goes, until three are left.
class Ears {
public:
    Ears(const std::vector<glm::dvec2>& points, std::vector<uint32_t>& out) : points_(points), out_(out), next_(points.size()), previous_(points.size()) {
        const uint32_t count = uint32_t(points.size());
        for (uint32_t i = 0; i < count; ++i) next_[i] = (i + 1) % count, previous_[i] = (i + count - 1) % count;
    }

    void cut() {
        // Where nothing is an ear any more, the polygon touches or crosses itself: then what is merely convex goes, then anything.
        enum { ear, convex, any } wanted = ear;
        uint32_t at = 0;
        size_t left = points_.size(), refused = 0;
        while (left > 3) {
            const bool good = wanted == any || (wanted == convex ? is_convex(at) : is_convex(at) && is_ear(at));
            if (good) {
                out_.insert(out_.end(), {previous_[at], at, next_[at]});
                next_[previous_[at]] = next_[at], previous_[next_[at]] = previous_[at];
                --left, refused = 0, wanted = ear;
                at = next_[next_[at]];  // not the neighbour: slivers around one corner would follow
            } else {
                at = next_[at];
                if (++refused == left) refused = 0, wanted = wanted == ear ? convex : any;
            }
        }
        out_.insert(out_.end(), {previous_[at], at, next_[at]});
    }

private:
    double turn_at(uint32_t i) const { return turn(points_[previous_[i]], points_[i], points_[next_[i]]); }
    bool is_convex(uint32_t i) const { return turn_at(i) > 0; }

    bool is_ear(uint32_t i) const {
        const glm::dvec2 &a = points_[previous_[i]], &b = points_[i], &c = points_[next_[i]];
        for (uint32_t k = next_[next_[i]]; k != previous_[i]; k = next_[k]) {
            const glm::dvec2& p = points_[k];
            if (p != a && p != b && p != c && turn_at(k) <= 0 && inside(p, a, b, c)) return false;
        }
        return true;
    }

    const std::vector<glm::dvec2>& points_;
    std::vector<uint32_t>& out_;
    std::vector<uint32_t> next_, previous_;
};

}  // namespace

void triangulate(std::span<const glm::vec3> corners, std::vector<uint32_t>& out) {
    const uint32_t count = uint32_t(corners.size());
    if (count < 3) return;
    const std::vector<glm::dvec2> points = flattened(corners);
    bool fan = true;  // from corner 0 it works for what is convex, and for some more
    for (uint32_t i = 1; i + 1 < count && fan; ++i) fan = turn(points[0], points[i], points[i + 1]) > 0;
    if (fan || count > most_corners) {
        for (uint32_t i = 1; i + 1 < count; ++i) out.insert(out.end(), {0, i, i + 1});
    } else {
        Ears(points, out).cut();
    }
}

}  // namespace myriad::scenes::importing
