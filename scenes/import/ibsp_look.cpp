#include "scenes/import/ibsp_look.hpp"

#include <algorithm>
#include <cmath>

#include "scenes/builtin/kit.hpp"

namespace myriad::scenes::importing {
namespace {

using glm::vec3;

constexpr uint32_t lava = 0x8, slime = 0x10, water = 0x20;  // contents
// The light tool takes a surface's light times 3 as what a light map gets where the surface fills the whole sky, and 255 as
// white: radiance 3 / 255 for each of its units.
constexpr float radiance_per_light = 3.0f / 255;
constexpr float plain_light = 1000;  // of a lamp whose name has no number

enum class Pattern { mottle, blocks, tiles, plates };

struct Word {
    const char* word;
    vec3 albedo;
    Pattern pattern;
};
// The first word that is in the name counts, so that the telling ones come first.
constexpr Word words[] = {
    {"rust", {0.26f, 0.12f, 0.06f}, Pattern::plates},   {"dkred", {0.30f, 0.05f, 0.04f}, Pattern::plates},
    {"pentagram", {0.35f, 0.12f, 0.08f}, Pattern::tiles}, {"gold", {0.45f, 0.31f, 0.11f}, Pattern::plates},
    {"brass", {0.42f, 0.29f, 0.12f}, Pattern::plates},  {"copper", {0.40f, 0.20f, 0.11f}, Pattern::plates},
    {"wood", {0.26f, 0.15f, 0.07f}, Pattern::plates},   {"plank", {0.26f, 0.15f, 0.07f}, Pattern::plates},
    {"grass", {0.10f, 0.18f, 0.05f}, Pattern::mottle},  {"moss", {0.14f, 0.19f, 0.08f}, Pattern::blocks},
    {"dirt", {0.20f, 0.14f, 0.09f}, Pattern::mottle},   {"mud", {0.16f, 0.11f, 0.07f}, Pattern::mottle},
    {"sand", {0.42f, 0.34f, 0.22f}, Pattern::mottle},   {"rock", {0.24f, 0.21f, 0.18f}, Pattern::mottle},
    {"terrain", {0.22f, 0.19f, 0.12f}, Pattern::mottle}, {"snow", {0.75f, 0.77f, 0.80f}, Pattern::mottle},
    {"marble", {0.55f, 0.52f, 0.48f}, Pattern::tiles},  {"stucco", {0.42f, 0.36f, 0.28f}, Pattern::mottle},
    {"plaster", {0.50f, 0.47f, 0.42f}, Pattern::mottle}, {"concrete", {0.36f, 0.35f, 0.33f}, Pattern::tiles},
    {"brick", {0.34f, 0.16f, 0.10f}, Pattern::blocks},  {"block", {0.34f, 0.28f, 0.22f}, Pattern::blocks},
    {"stone", {0.36f, 0.32f, 0.27f}, Pattern::blocks},  {"zinc", {0.38f, 0.40f, 0.42f}, Pattern::plates},
    {"chrome", {0.48f, 0.48f, 0.50f}, Pattern::plates}, {"metal", {0.25f, 0.24f, 0.24f}, Pattern::plates},
    {"iron", {0.20f, 0.19f, 0.19f}, Pattern::plates},   {"grate", {0.18f, 0.17f, 0.16f}, Pattern::plates},
    {"support", {0.24f, 0.20f, 0.17f}, Pattern::plates}, {"door", {0.30f, 0.18f, 0.11f}, Pattern::plates},
    {"trim", {0.30f, 0.25f, 0.20f}, Pattern::plates},   {"red", {0.38f, 0.06f, 0.05f}, Pattern::plates},
    {"blue", {0.07f, 0.13f, 0.38f}, Pattern::plates},   {"ceil", {0.32f, 0.30f, 0.28f}, Pattern::tiles},
    {"floor", {0.29f, 0.26f, 0.23f}, Pattern::tiles},   {"wall", {0.36f, 0.31f, 0.25f}, Pattern::blocks},
};
constexpr Word other{"", {0.32f, 0.29f, 0.26f}, Pattern::mottle};

uint64_t hash(const std::string& text) {  // FNV-1a
    uint64_t h = 0xcbf29ce484222325;
    for (const char c : text) h = (h ^ uint8_t(c)) * 0x100000001b3;
    return h;
}

// The number at the end of a name: 5000 of "ironcrosslt2_5000", 3000 of "light1_3k"; 0 where there is none.
float trailing_number(std::string name) {
    float factor = 1;
    if (name.ends_with('k')) factor = 1000, name.pop_back();
    const size_t begin = name.find_last_not_of("0123456789") + 1;
    return name.size() - begin > 0 && name.size() - begin <= 6 ? factor * float(std::stoul(name.substr(begin))) : 0;
}

vec3 emission(const std::string& name, uint32_t contents) {
    const float number = trailing_number(name);
    const float light = number >= 100 ? number : plain_light;
    if (contents & lava) return vec3(1, 0.27f, 0.04f) * (light * radiance_per_light);
    if (contents & slime) return vec3(0.1f, 0.5f, 0.05f);
    // Numbers below 100 count variants of a texture.
    if (name.find("light") == std::string::npos && !(number >= 500 && name.find("lt") != std::string::npos)) return vec3(0);
    const vec3 color = name.find("blue") != std::string::npos ? vec3(0.35f, 0.55f, 1)
                       : name.find("red") != std::string::npos || name.find("pentagram") != std::string::npos ? vec3(1, 0.3f, 0.16f)
                                                                                                                : vec3(1, 0.75f, 0.45f);
    return color * (std::min(light, 1e5f) * radiance_per_light);
}

// 64 texels each way of brightness around 1, that repeat: the games' textures repeat over 64 to 256 units.
class Painter {
public:
    explicit Painter(uint64_t seed) : random_(seed) { grain(); }

    void blocks() { courses(4, 2, 1.5f); }
    void tiles() { courses(2, 2, 1.0f); }
    void plates() {
        courses(1, 2, 1.0f);
        for (int y : {5, 58})
            for (int x = 5; x < size; x += 9) at(x, y) *= 1.5f, at(x, y + 1) *= 0.6f;  // rivets
    }
    Texture texture(const std::string& name, const vec3& albedo) const {
        Texture out;
        out.name = name;
        out.width = out.height = size;
        for (const float value : value_)
            for (int c = 0; c < 4; ++c) out.rgba.push_back(c == 3 ? 255 : kit::srgb8(std::clamp(albedo[c] * value, 0.0f, 0.9f)));
        return out;
    }

private:
    static constexpr int size = 64;

    float& at(int x, int y) { return value_[size_t((y & (size - 1)) * size + (x & (size - 1)))]; }

    // Mottle: octaves of noise that repeat at the texture's edge.
    void grain() {
        for (float& value : value_) value = 1;
        for (int cells = 4; cells <= size; cells *= 2) {
            std::vector<float> lattice(size_t(cells * cells));
            for (float& v : lattice) v = random_.real(-0.09f, 0.09f);
            const auto node = [&](int x, int y) { return lattice[size_t((y % cells) * cells + x % cells)]; };
            const int step = size / cells;
            for (int y = 0; y < size; ++y)
                for (int x = 0; x < size; ++x) {
                    const float u = float(x % step) / float(step), v = float(y % step) / float(step);
                    const int i = x / step, j = y / step;
                    at(x, y) += (node(i, j) * (1 - u) + node(i + 1, j) * u) * (1 - v) + (node(i, j + 1) * (1 - u) + node(i + 1, j + 1) * u) * v;
                }
        }
    }
    // Rows of equal pieces, each second one shifted by half a piece, with dark joints; each piece has its own brightness.
    void courses(int rows, int columns, float joint) {
        const int height = size / rows, width = size / columns;
        for (int row = 0; row < rows; ++row)
            for (int column = 0; column < columns; ++column) {
                const float shade = random_.real(0.78f, 1.18f);
                for (int y = 0; y < height; ++y)
                    for (int x = 0; x < width; ++x) {
                        float& value = at(column * width + x + (row % 2) * width / 2, row * height + y);
                        const float edge = float(std::min({x, width - 1 - x, y, height - 1 - y}));
                        value *= edge < joint ? 0.45f : shade * (edge < joint + 1 ? 1.12f : 1.0f);
                    }
            }
    }

    kit::Random random_;
    float value_[size * size];
};

}  // namespace

void add_look(Scene& scene, const std::string& shader, uint32_t contents) {
    std::string name = shader;
    std::transform(name.begin(), name.end(), name.begin(), [](char c) { return c >= 'A' && c <= 'Z' ? char(c - 'A' + 'a') : c; });
    const auto found = std::find_if(std::begin(words), std::end(words), [&](const Word& w) { return name.find(w.word) != std::string::npos; });
    const Word& word = found == std::end(words) ? other : *found;

    Material material;
    material.name = shader;
    material.metallic = 0;
    material.roughness = 0.9f;
    material.emissive = emission(name, contents);
    kit::Random random(hash(name));
    const float shade = random.real(0.8f, 1.2f);
    const vec3 albedo = word.albedo * shade * vec3(random.real(0.93f, 1.07f), 1, random.real(0.93f, 1.07f));
    if (contents & water) {
        material.base_color = {0.03f, 0.10f, 0.12f, 0.6f};
        material.alpha = Material::Alpha::blend;
    } else if (material.emissive != vec3(0)) {
        material.base_color = glm::vec4(albedo, 1);
    } else {
        Painter painter(random.bits());
        if (word.pattern == Pattern::blocks) painter.blocks();
        if (word.pattern == Pattern::tiles) painter.tiles();
        if (word.pattern == Pattern::plates) painter.plates();
        material.base_color_texture.texture = uint32_t(scene.textures.size());
        scene.textures.push_back(painter.texture(shader, albedo));
    }
    scene.materials.push_back(std::move(material));
}

}  // namespace myriad::scenes::importing
