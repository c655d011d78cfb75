// The entities of a map: text that says what stands where. Lights and cameras are made of them.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "scenes/import/bytes.hpp"
#include "scenes/scene.hpp"

namespace myriad::scenes::importing {

struct Entity {
    std::map<std::string, std::string> keys;

    const std::string& word(const std::string& key) const;  // "" where there is none
    std::optional<float> number(const std::string& key) const;
    std::optional<glm::vec3> vector(const std::string& key) const;
};

// `{ "key" "value" … } …`. What is between is skipped, as the games do.
std::vector<Entity> parse_entities(const View& file, std::string_view text);

// Point and spot lights, whose intensities are for units of `unit` metres; info_player_* as cameras at eye height.
void add_lights_and_cameras(Scene& scene, const std::vector<Entity>& entities, float unit);

}  // namespace myriad::scenes::importing
