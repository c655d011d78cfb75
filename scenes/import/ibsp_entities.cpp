#include "scenes/import/ibsp_entities.hpp"

#include <algorithm>
#include <charconv>
#include <cmath>

#include <glm/gtc/constants.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace myriad::scenes::importing {
namespace {

using glm::vec3;

constexpr size_t most_entities = 1 << 16;  // the games know 1024
constexpr float eye_height = 26;           // of a player above his origin, in Quake's units
// The light tool adds light * 7500 / d^2 (d in units, 255 is white) to a light map that faces the light, and the game shows
// colour times light map: radiance albedo * 7500 light / (255 d^2). From a point light of intensity I it is
// albedo / pi * I / d^2: hence pi * 7500 / 255 W/sr for each of its units, and the square of metres per unit.
constexpr float intensity_per_light = glm::pi<float>() * 7500 / 255;

// As many numbers as stand there, up to `count`; fewer, or one that is not finite: none.
std::optional<vec3> numbers(const std::string& text, int count) {
    vec3 out(0);
    const char *at = text.data(), *end = at + text.size();
    for (int i = 0; i < count; ++i) {
        while (at != end && (*at == ' ' || *at == '\t' || *at == '+')) ++at;
        const auto [next, error] = std::from_chars(at, end, out[i]);
        if (error != std::errc() || !std::isfinite(out[i])) return {};
        at = next;
    }
    return out;
}

// A camera with a level horizon; z is up.
glm::mat4 looking(const vec3& from, const vec3& way) {
    const vec3 back = -glm::normalize(way);
    const vec3 right = std::hypot(back.x, back.y) > 1e-4f ? glm::normalize(vec3(-back.y, back.x, 0)) : vec3(0, -1, 0);
    return {glm::vec4(right, 0), glm::vec4(glm::cross(back, right), 0), glm::vec4(back, 0), glm::vec4(from, 1)};
}

// The games' angles, in degrees: pitch is down, yaw 0 is along +X.
vec3 way_of(float pitch, float yaw) {
    const float p = glm::radians(pitch), y = glm::radians(yaw);
    return {std::cos(p) * std::cos(y), std::cos(p) * std::sin(y), -std::sin(p)};
}

class Placer {
public:
    Placer(Scene& scene, const std::vector<Entity>& entities, float unit) : scene_(scene), unit_(unit) {
        for (const Entity& entity : entities)
            if (const std::string& name = entity.word("targetname"); !name.empty())
                if (const auto at = entity.vector("origin")) places_.try_emplace(name, *at);
    }

    void light(const Entity& entity) {
        const auto at = entity.vector("origin");
        const float strength = entity.number("light").value_or(entity.number("_light").value_or(300));
        if (!at || !(strength > 0)) return;
        vec3 color = glm::max(entity.vector("_color").value_or(vec3(1)), vec3(0));
        const float brightest = std::max({color.x, color.y, color.z});
        color = brightest > 0 ? color / brightest : vec3(1);
        Light light;
        light.name = "light " + std::to_string(scene_.lights.size() + 1);
        light.position = *at;
        light.intensity = color * (std::min(strength, 1e6f) * intensity_per_light * unit_ * unit_);
        // A light with a target is a cone that has a radius there and fades over 32 units.
        if (const auto target = places_.find(entity.word("target")); target != places_.end() && target->second != light.position) {
            const vec3 way = target->second - light.position;
            const float distance = glm::length(way), radius = std::max(entity.number("radius").value_or(64), 1.0f);
            light.type = Light::Type::spot;
            light.direction = way / distance;
            light.outer_cone = std::atan((radius + 16) / distance);
            light.inner_cone = std::atan(std::max(radius - 16, 0.0f) / distance);
        }
        scene_.lights.push_back(light);
    }

    void camera(const Entity& entity, const std::string& kind) {
        const auto at = entity.vector("origin");
        if (!at) return;
        Camera camera;
        const int count = ++cameras_[kind];
        camera.name = kind + (count > 1 ? std::to_string(count) : "");
        camera.yfov = 2 * std::atan(0.75f);  // the games' 90 degrees across a 4:3 screen
        const vec3 eye = *at + vec3(0, 0, eye_height);
        const vec3 angles = entity.vector("angles").value_or(vec3(0, entity.number("angle").value_or(0), 0));
        const auto target = places_.find(entity.word("target"));
        const bool aimed = target != places_.end() && glm::distance(target->second, eye) > 0;
        camera.to_world = looking(eye, aimed ? target->second - eye : way_of(angles.x, angles.y));
        scene_.cameras.push_back(camera);
    }

private:
    Scene& scene_;
    const float unit_;
    std::map<std::string, vec3> places_;
    std::map<std::string, int> cameras_;
};

}  // namespace

const std::string& Entity::word(const std::string& key) const {
    static const std::string nothing;
    const auto found = keys.find(key);
    return found == keys.end() ? nothing : found->second;
}
std::optional<float> Entity::number(const std::string& key) const {
    const auto out = numbers(word(key), 1);
    return out ? std::optional(out->x) : std::nullopt;
}
std::optional<vec3> Entity::vector(const std::string& key) const { return numbers(word(key), 3); }

std::vector<Entity> parse_entities(const View& file, std::string_view text) {
    std::vector<Entity> out;
    std::optional<std::string> key;
    for (size_t i = 0; i < text.size() && text[i] != '\0'; ++i) {
        if (text[i] == '{') {
            if (out.size() == most_entities) file.fail("there are more than " + std::to_string(most_entities) + " entities");
            out.emplace_back();
            key.reset();
        } else if (text[i] == '"') {
            const size_t begin = i + 1;
            i = std::min(text.find('"', begin), text.size());
            std::string word(text.substr(begin, i - begin));
            if (!key) {
                key = std::move(word);
            } else {
                if (!out.empty()) out.back().keys.insert_or_assign(std::move(*key), std::move(word));
                key.reset();
            }
        }
    }
    return out;
}

void add_lights_and_cameras(Scene& scene, const std::vector<Entity>& entities, float unit) {
    Placer placer(scene, entities, unit);
    constexpr std::string_view player = "info_player_";
    const std::string overview = "info_player_intermission";
    for (const Entity& entity : entities)
        if (entity.word("classname") == overview) placer.camera(entity, "intermission");
    for (const Entity& entity : entities) {
        const std::string& kind = entity.word("classname");
        if (kind == "light") placer.light(entity);
        else if (kind.starts_with(player) && kind != overview) placer.camera(entity, kind.substr(player.size()));
    }
}

}  // namespace myriad::scenes::importing
