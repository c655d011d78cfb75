#include "scenes/import/embree.hpp"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <set>

#include <glm/gtc/constants.hpp>
#include <pugixml.hpp>

namespace myriad::scenes::importing {
namespace {

using glm::vec3;

constexpr uint32_t most_sides = 64;
constexpr uint64_t most_triangles = 1 << 28;  // what a scene may hold, with room for others
constexpr int most_sets = 1024;
constexpr uint64_t most_text = 16 << 20, most_numbers = 1 << 30;  // bytes

struct Node {
    float x, y, z, radius;

    vec3 at() const { return {x, y, z}; }
    bool finite() const { return std::isfinite(x) && std::isfinite(y) && std::isfinite(z) && std::isfinite(radius); }
};
static_assert(sizeof(Node) == 16);

// Where an array lies in the .bin file.
struct Array {
    uint64_t offset, size;
};
struct StrandSet {
    Array indices, points;
    vec3 color;
};

// Any unit vector that is square to `v`.
vec3 square_to(const vec3& v) {
    const vec3 a = glm::abs(v);
    const vec3 axis = a.x <= a.y && a.x <= a.z ? vec3(1, 0, 0) : a.y <= a.z ? vec3(0, 1, 0) : vec3(0, 0, 1);
    return glm::normalize(glm::cross(v, axis));
}

// Sweeps a strand's outline along its points.
class Sweeper {
public:
    Sweeper(Primitive& out, uint32_t sides, float thickness, const vec3& middle)
        : out_(out), sides_(sides), thickness_(thickness), middle_(middle) {}

    void strand(const Node* nodes, size_t count) {
        points_.clear();
        for (size_t i = 0; i < count; ++i)  // a point on the one before it has no direction to give
            if (nodes[i].finite() && (points_.empty() || glm::distance(nodes[i].at(), vec3(points_.back())) > 0))
                points_.emplace_back(nodes[i].at(), std::abs(nodes[i].radius) * thickness_);
        if (points_.size() < 2) return;
        const uint32_t first = uint32_t(out_.positions.size());
        vec3 side(0);
        for (size_t i = 0; i < points_.size(); ++i) {
            const vec3 along = direction(i);
            side = carried(side, along, vec3(points_[i]));
            add_ring(vec3(points_[i]), points_[i].w, side, glm::cross(along, side));
        }
        for (uint32_t i = 0; i + 1 < points_.size(); ++i)
            for (uint32_t k = 0; k < (sides_ == 2 ? 1 : sides_); ++k) {
                const uint32_t a = first + i * sides_ + k, b = first + i * sides_ + (k + 1) % sides_;
                for (uint32_t corner : {a, b, a + sides_, b, b + sides_, a + sides_}) out_.indices.push_back(corner);
            }
    }

private:
    vec3 direction(size_t i) const {
        const vec3 before = i ? glm::normalize(vec3(points_[i]) - vec3(points_[i - 1])) : vec3(0);
        const vec3 after = i + 1 < points_.size() ? glm::normalize(vec3(points_[i + 1]) - vec3(points_[i])) : vec3(0);
        const vec3 sum = before + after;
        return glm::length(sum) > 1e-3f ? glm::normalize(sum) : i ? before : after;  // where a strand turns back, the way it came
    }
    // The last ring's side, made square to the new direction, so that a strand does not twist.
    vec3 carried(const vec3& side, const vec3& along, const vec3& at) const {
        const vec3 next = side == vec3(0) ? glm::cross(along, at - middle_) : side - along * glm::dot(side, along);
        const float length = glm::length(next);
        return length > 1e-6f && std::isfinite(length) ? next / length : square_to(along);
    }
    void add_ring(const vec3& at, float radius, const vec3& side, const vec3& up) {
        for (uint32_t k = 0; k < sides_; ++k) {
            const float angle = 2 * glm::pi<float>() * float(k) / float(sides_);
            const vec3 out = sides_ == 2 ? (k ? -side : side) : std::cos(angle) * side + std::sin(angle) * up;
            out_.positions.push_back(at + radius * out);
            out_.normals.push_back(sides_ == 2 ? up : out);
        }
    }

    Primitive& out_;
    const uint32_t sides_;
    const float thickness_;
    const vec3 middle_;
    std::vector<glm::vec4> points_;
};

Array array_of(const View& xml, const pugi::xml_node& parent, const char* name) {
    const pugi::xml_node node = parent.child(name);
    if (!node.attribute("ofs") || !node.attribute("size"))
        xml.fail(std::string(parent.name()) + " has no <" + name + "> with ofs and size", "only strands whose numbers lie in a .bin file are read");
    return {node.attribute("ofs").as_ullong(), node.attribute("size").as_ullong()};
}

// Embree's hair reflects Kr and lets Kt through; our strands are opaque and reflect both.
vec3 color_of(const pugi::xml_node& strands) {
    vec3 sum(0);
    bool found = false;
    for (const pugi::xml_node parameter : strands.child("material").child("parameters").children("float3"))
        if (const std::string name = parameter.attribute("name").value(); name == "Kr" || name == "Kt") {
            vec3 k(0);
            if (std::sscanf(parameter.text().get(), "%f %f %f", &k.x, &k.y, &k.z) == 3) sum += k, found = true;
        }
    const bool usable = found && std::isfinite(sum.x) && std::isfinite(sum.y) && std::isfinite(sum.z);
    return usable ? glm::clamp(sum, 0.0f, 1.0f) : vec3(0.5f);
}

// Finds the strands, and names what else there is.
struct Finder : pugi::xml_tree_walker {
    const View& xml;
    std::vector<StrandSet> sets;
    std::set<std::string> others;

    explicit Finder(const View& file) : xml(file) {}

    bool for_each(pugi::xml_node& node) override {
        const std::string name = node.name();
        if (name == "RoundLineSegments") {
            if (sets.size() == size_t(most_sets)) xml.fail("there are more than " + std::to_string(most_sets) + " RoundLineSegments");
            sets.push_back({array_of(xml, node, "indices"), array_of(xml, node, "positions"), color_of(node)});
        } else if (name.size() > 3 && name[0] >= 'A' && name[0] <= 'Z' && name != "Group" && others.size() < 8) {
            others.insert(name);  // what makes a scene has a capital
        }
        return true;
    }
};

void add_set(Scene& scene, const View& numbers, const StrandSet& set, const StrandOptions& options, uint64_t& triangles) {
    const auto index = numbers.records<uint32_t>(set.indices.offset, set.indices.size, "the segments");
    const auto nodes = numbers.records<Node>(set.points.offset, set.points.size, "the points");
    for (size_t i = 0; i < index.size(); ++i)
        if (nodes.empty() || index[i] >= nodes.size() - 1)
            numbers.fail("segment " + std::to_string(i) + " begins at point " + std::to_string(index[i]) + " of " + std::to_string(nodes.size()));

    // The strands: each as [begin, end) of the segments.
    std::vector<std::pair<size_t, size_t>> strands;
    for (size_t i = 0; i < index.size(); ++i)
        if (i && index[i] == index[i - 1] + 1) strands.back().second = i + 1;
        else strands.emplace_back(i, i + 1);
    glm::dvec3 sum(0);
    uint64_t roots = 0;
    for (const auto& [begin, end] : strands)
        if (const Node& root = nodes[index[begin]]; root.finite()) sum += glm::dvec3(root.at()), ++roots;
    for (size_t s = 0; s < strands.size(); s += options.keep_every) triangles += 2 * options.sides * (strands[s].second - strands[s].first);
    if (triangles > most_triangles) numbers.fail("it makes more than 2^28 triangles", "give fewer sides, or keep fewer strands");

    Material material;
    material.name = "strands";
    material.base_color = glm::vec4(set.color, 1);
    material.metallic = 0;
    material.roughness = 0.6f;
    material.double_sided = options.sides == 2;
    Primitive primitive;
    primitive.material = uint32_t(scene.materials.size());
    scene.materials.push_back(std::move(material));
    Sweeper sweeper(primitive, options.sides, float(options.keep_every), roots ? vec3(sum / double(roots)) : vec3(0));
    for (size_t s = 0; s < strands.size(); s += options.keep_every)
        sweeper.strand(&nodes[index[strands[s].first]], strands[s].second - strands[s].first + 1);
    scene.instances.push_back({uint32_t(scene.meshes.size()), glm::mat4(1)});
    scene.meshes.push_back({"strands", {}});
    scene.meshes.back().primitives.push_back(std::move(primitive));
}

}  // namespace

Scene read_embree(const View& xml, const std::function<Bytes()>& numbers, const StrandOptions& options) {
    if (options.sides < 2 || options.sides > most_sides)
        xml.fail("a strand cannot have " + std::to_string(options.sides) + " sides", "give 2 (ribbons) to " + std::to_string(most_sides));
    if (options.keep_every == 0) xml.fail("no strand would be kept", "keep every first, second … one");
    pugi::xml_document document;
    const auto text = xml.records<char>(0, xml.size(), "the text");
    if (const auto result = document.load_buffer(text.data(), text.size()); !result)
        xml.fail("the XML cannot be read (" + std::string(result.description()) + " at byte " + std::to_string(result.offset) + ")");
    Finder finder(xml);
    document.traverse(finder);
    if (finder.sets.empty()) xml.fail("there are no RoundLineSegments in it", "only Embree's strands are read from XML");

    Scene scene;
    scene.name = xml.name();
    for (const std::string& other : finder.others) scene.warnings.push_back(other + " is not read: only RoundLineSegments are.");
    const Bytes bytes = numbers();
    const View view(bytes, xml.name() + "'s .bin file");
    // Sets that share their numbers would let a small file ask for much.
    uint64_t room = bytes.size() / sizeof(uint32_t), triangles = 0;
    for (const StrandSet& set : finder.sets) {
        if (set.indices.size > room) view.fail("it has fewer bytes than the segments need");
        room -= set.indices.size;
    }
    for (const StrandSet& set : finder.sets) add_set(scene, view, set, options, triangles);
    return scene;
}

Imported import_embree(const std::string& path, const ImportOptions& options) {
    const Bytes xml = read_file(path, most_text);
    const auto numbers = [&] {
        const std::filesystem::path stem = std::filesystem::path(path).replace_extension();
        const std::string plain = stem.string() + ".bin", packed = plain + ".gz";
        const std::string& file = std::filesystem::exists(plain) ? plain : packed;
        return gunzip(read_file(file, most_numbers), file, most_numbers);
    };
    return {.scene = read_embree(View(xml, path), numbers, options.strands)};
}

}  // namespace myriad::scenes::importing
