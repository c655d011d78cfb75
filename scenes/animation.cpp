#include "scenes/animation.hpp"

#include <algorithm>
#include <cassert>
#include <cmath>

#include <glm/gtc/matrix_transform.hpp>

namespace myriad::scenes {
namespace {

// The rotation of unit length along `q`; none where it has no length.
glm::dquat unit(const glm::dquat& q) {
    const double length = glm::length(q);
    return length > 0 && std::isfinite(length) ? q / length : glm::dquat(1, 0, 0, 0);
}

// By the shorter of the two ways between rotations: q and -q are the same one.
glm::dquat turn(const glm::dquat& from, glm::dquat to, double t) {
    double cosine = glm::dot(from, to);
    if (cosine < 0) to = -to, cosine = -cosine;
    if (cosine > 0.9999995) return unit(from * (1 - t) + to * t);  // an angle of less than 0.001: its sine would be rounding
    const double angle = std::acos(std::min(cosine, 1.0));
    return unit(from * (std::sin((1 - t) * angle) / std::sin(angle)) + to * (std::sin(t * angle) / std::sin(angle)));
}

void store(const glm::dquat& q, double* out) { out[0] = q.x, out[1] = q.y, out[2] = q.z, out[3] = q.w; }

}  // namespace

glm::dmat4 Transform::matrix() const {
    return glm::translate(glm::dmat4(1), translation) * glm::mat4_cast(unit(rotation)) * glm::scale(glm::dmat4(1), scale);
}

double Clip::duration() const {
    double last = 0;
    for (const Track& track : tracks)
        if (!track.times.empty()) last = std::max(last, double(track.times.back()));
    return last;
}

void sample(const Track& track, bool rotation, double seconds, double* out) {
    using Interpolation = Track::Interpolation;
    const bool cubic = track.interpolation == Interpolation::cubic;
    const size_t width = track.width, keys = track.times.size();
    assert(keys > 0 && track.values.size() == keys * width * (cubic ? 3 : 1) && (!rotation || width == 4));
    // Part 0, 1, 2 of a cubic key: the tangent before it, its value, the tangent after it.
    const auto number = [&](size_t key, size_t part, size_t c) { return double(track.values[(cubic ? 3 * key + part : key) * width + c]); };
    const auto quaternion = [&](size_t key) {
        return unit(glm::dquat(number(key, 1, 3), number(key, 1, 0), number(key, 1, 1), number(key, 1, 2)));
    };

    const size_t after = size_t(std::upper_bound(track.times.begin(), track.times.end(), seconds) - track.times.begin());
    const size_t key = after > 0 ? after - 1 : 0;
    const bool between = after > 0 && after < keys && seconds > double(track.times[key]);
    if (!between || track.interpolation == Interpolation::step) {
        for (size_t c = 0; c < width; ++c) out[c] = number(key, 1, c);
        if (rotation) store(quaternion(key), out);
        return;
    }
    const double length = double(track.times[after]) - double(track.times[key]), t = (seconds - double(track.times[key])) / length;
    if (!cubic) {
        if (rotation) return store(turn(quaternion(key), quaternion(after), t), out);
        for (size_t c = 0; c < width; ++c) out[c] = number(key, 1, c) * (1 - t) + number(after, 1, c) * t;
        return;
    }
    // Hermite's (glTF 2.0, appendix C); tangents are per second.
    const double t2 = t * t, t3 = t2 * t;
    for (size_t c = 0; c < width; ++c)
        out[c] = (2 * t3 - 3 * t2 + 1) * number(key, 1, c) + (t3 - 2 * t2 + t) * length * number(key, 2, c) +
                 (3 * t2 - 2 * t3) * number(after, 1, c) + (t3 - t2) * length * number(after, 0, c);
    if (rotation) store(unit(glm::dquat(out[3], out[0], out[1], out[2])), out);
}

}  // namespace myriad::scenes
