// The lists of a primitive that hold something of each vertex. For scenes/ only.
#pragma once

#include "scenes/scene.hpp"

namespace myriad::scenes {

// Calls f(list of a, the same of b) for each such list; a gets as many morph targets as b has. f takes vectors of any type.
template <class A, class B, class F>
void each_attribute(A& a, B& b, F&& f) {
    f(a.positions, b.positions), f(a.normals, b.normals), f(a.tangents, b.tangents);
    f(a.texcoords, b.texcoords), f(a.texcoords1, b.texcoords1), f(a.colors, b.colors);
    for (int set = 0; set < 2; ++set) f(a.joints[set], b.joints[set]), f(a.joint_weights[set], b.joint_weights[set]);
    if constexpr (!std::is_const_v<A>) a.targets.resize(b.targets.size());
    for (size_t k = 0; k < b.targets.size(); ++k) f(a.targets[k].positions, b.targets[k].positions), f(a.targets[k].normals, b.targets[k].normals);
}

// Calls f(list) for each.
template <class F>
void each_attribute(const Primitive& p, F&& f) {
    each_attribute(p, p, [&](const auto& list, const auto&) { f(list); });
}

}  // namespace myriad::scenes
