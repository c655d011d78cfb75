// What a scene asks for and the passes do not do: a fallback is never silent.
#pragma once

#include <string>

#include "scenes/scene.hpp"

namespace myriad::passes {

// One sentence that counts what is shown differently than the scene says; empty where nothing is.
std::string unshaded(const scenes::Scene& scene);

}  // namespace myriad::passes
