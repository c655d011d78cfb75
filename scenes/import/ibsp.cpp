#include "scenes/import/ibsp.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>

#include <glm/gtc/matrix_transform.hpp>
#include <glm/gtc/type_ptr.hpp>

#include "scenes/import/ibsp_entities.hpp"
#include "scenes/import/ibsp_look.hpp"

namespace myriad::scenes::importing {
namespace {

using glm::vec2;
using glm::vec3;

// The file: a header of lumps, each an array of records.
struct Lump {
    uint32_t offset, bytes;
};
struct Shader {
    char name[64];
    uint32_t flags, contents;
};
struct Model {
    float lo[3], hi[3];
    uint32_t face, faces, brush, brushes;
};
struct Vertex {
    float position[3], st[2], lightmap[2], normal[3];
    uint8_t color[4];
};
struct Face {
    uint32_t shader, effect, type;
    uint32_t vertex, vertices, meshvert, meshverts;
    uint32_t lightmap, lightmap_place[4];
    float lightmap_frame[9], normal[3];
    uint32_t width, height;  // of a patch, in control points
};
static_assert(sizeof(Shader) == 72 && sizeof(Model) == 40 && sizeof(Vertex) == 44 && sizeof(Face) == 104);

namespace lump_of {
enum : uint32_t { entities = 0, shaders = 1, models = 7, vertices = 10, meshverts = 11, faces = 13 };
}
namespace type {
enum : uint32_t { polygon = 1, patch = 2, mesh = 3 };
}
constexpr uint32_t not_drawn = 0x4 | 0x80 | 0x100 | 0x200;  // surface flags: sky, nodraw, hint, skip
constexpr uint32_t sky = 0x4;
constexpr uint32_t fog = 0x40;                              // contents
constexpr uint64_t most_bytes = 256 << 20;                   // the largest maps have 40 MB
constexpr int most_steps = 64;                              // a patch is cut into, each way
// Faces may share vertices, so that a small file can ask for much: what is made is bounded. Real maps have some 10^5 of each.
constexpr uint64_t most_elements = 1 << 23;

struct Point {
    vec3 position, normal;
    vec2 texcoord;
};

class Reader {
public:
    Reader(const View& file, const IbspOptions& options) : file_(file), options_(options) {
        shaders_ = lump<Shader>(lump_of::shaders, "shaders");
        models_ = lump<Model>(lump_of::models, "models");
        vertices_ = lump<Vertex>(lump_of::vertices, "vertices");
        meshverts_ = lump<uint32_t>(lump_of::meshverts, "meshverts");
        faces_ = lump<Face>(lump_of::faces, "faces");
        const auto text = lump<char>(lump_of::entities, "entities");
        entities_ = parse_entities(file, {text.data(), text.size()});
        material_of_.resize(shaders_.size(), none);
    }

    Scene read() {
        scene_.name = file_.name();
        if (models_.empty()) file_.fail("there is no model, not even the world");
        add_model(0, vec3(0));  // the world
        for (const Entity& entity : entities_)
            if (const uint32_t number = model_of(entity); number != none) add_model(number, entity.vector("origin").value_or(vec3(0)));
        add_lights_and_cameras(scene_, entities_, options_.unit);
        if (sky_) scene_.background = sky_radiance;
        if (scene_.materials.empty()) scene_.materials.emplace_back();
        return std::move(scene_);
    }

private:
    template <class T>
    std::vector<T> lump(uint32_t number, const std::string& what) const {
        const Lump at = file_.record<Lump>(8 + 8 * uint64_t(number), "the header");
        if (at.bytes % sizeof(T)) file_.fail(what + ": " + std::to_string(at.bytes) + " bytes are no whole number of records of " + std::to_string(sizeof(T)));
        return file_.records<T>(at.offset, at.bytes / sizeof(T), what);
    }

    // "model" "*N" of doors, lifts and triggers.
    uint32_t model_of(const Entity& entity) const {
        const std::string& model = entity.word("model");
        if (model.size() < 2 || model.size() > 8 || model[0] != '*') return none;
        if (!std::all_of(model.begin() + 1, model.end(), [](char c) { return c >= '0' && c <= '9'; })) return none;
        const unsigned long number = std::stoul(model.substr(1));
        if (number >= models_.size())
            file_.fail("an entity has model " + model + ", but there are only " + std::to_string(models_.size()) + " models");
        return number == 0 ? none : uint32_t(number);
    }
    void add_model(uint32_t number, const vec3& origin) {
        const Model& model = models_[number];
        if (model.face > faces_.size() || model.faces > faces_.size() - model.face)
            file_.fail("model " + std::to_string(number) + " has faces beyond the " + std::to_string(faces_.size()) + " that there are");
        Mesh mesh;
        mesh.name = number == 0 ? "world" : "model " + std::to_string(number);
        primitive_of_.clear();
        for (uint32_t i = 0; i < model.faces; ++i) add_face(mesh, model.face + i);
        if (mesh.primitives.empty()) return;  // triggers
        scene_.instances.push_back({uint32_t(scene_.meshes.size()), glm::translate(glm::mat4(1), origin)});
        scene_.meshes.push_back(std::move(mesh));
    }

    void add_face(Mesh& mesh, uint32_t number) {
        const Face& face = faces_[number];
        const std::string where = "face " + std::to_string(number);
        if (face.shader >= shaders_.size())
            file_.fail(where + " has shader " + std::to_string(face.shader) + " of " + std::to_string(shaders_.size()));
        const Shader& shader = shaders_[face.shader];
        sky_ |= (shader.flags & sky) != 0;
        if ((shader.flags & not_drawn) || (shader.contents & fog)) return;
        if (face.type != type::polygon && face.type != type::patch && face.type != type::mesh) return;  // flares
        if (face.vertex > vertices_.size() || face.vertices > vertices_.size() - face.vertex)
            file_.fail(where + " has vertices beyond the " + std::to_string(vertices_.size()) + " that there are");
        if (face.type == type::patch) add_patch(mesh, face, where);
        else add_triangles(mesh, face, where);
    }

    void add_triangles(Mesh& mesh, const Face& face, const std::string& where) {
        if (face.meshvert > meshverts_.size() || face.meshverts > meshverts_.size() - face.meshvert || face.meshverts % 3)
            file_.fail(where + " has triangles beyond the " + std::to_string(meshverts_.size()) + " corners that there are");
        if (face.meshverts == 0) return;
        spend(face.vertices + face.meshverts / 3);
        Primitive& out = primitive(mesh, face.shader);
        const uint32_t first = uint32_t(out.positions.size());
        for (uint32_t i = 0; i < face.vertices; ++i) append(out, point(face.vertex + i));
        for (uint32_t i = 0; i < face.meshverts; i += 3) {
            const uint32_t* corner = &meshverts_[face.meshvert + i];
            for (int k = 0; k < 3; ++k)
                if (corner[k] >= face.vertices)
                    file_.fail(where + " has a triangle with vertex " + std::to_string(corner[k]) + " of " + std::to_string(face.vertices));
            for (int k : {0, 2, 1}) out.indices.push_back(first + corner[k]);  // Quake's front is clockwise
        }
    }

    // A grid of biquadratic Bézier patches that share their borders.
    void add_patch(Mesh& mesh, const Face& face, const std::string& where) {
        const uint32_t w = face.width, h = face.height;
        if (w < 3 || h < 3 || w % 2 == 0 || h % 2 == 0 || uint64_t(w) * h != face.vertices)
            file_.fail(where + " is a patch of " + std::to_string(w) + " x " + std::to_string(h) + " points, but has " +
                       std::to_string(face.vertices));
        std::vector<Point> control(face.vertices);
        for (uint32_t i = 0; i < face.vertices; ++i) control[i] = point(face.vertex + i);
        const auto at = [&](uint32_t x, uint32_t y) -> const Point& { return control[y * w + x]; };

        // One cut for all patches of a column, and of a row: inside a face there are no gaps.
        std::vector<int> columns(w / 2, 1), rows(h / 2, 1);
        for (uint32_t y = 0; y < h; ++y)
            for (uint32_t x = 0; x < w / 2; ++x)
                columns[x] = std::max(columns[x], steps(at(2 * x, y).position, at(2 * x + 1, y).position, at(2 * x + 2, y).position));
        for (uint32_t y = 0; y < h / 2; ++y)
            for (uint32_t x = 0; x < w; ++x)
                rows[y] = std::max(rows[y], steps(at(x, 2 * y).position, at(x, 2 * y + 1).position, at(x, 2 * y + 2).position));

        uint64_t across = 1, down = 1;
        for (int n : columns) across += uint64_t(n);
        for (int n : rows) down += uint64_t(n);
        spend(3 * across * down);

        Primitive& out = primitive(mesh, face.shader);
        const uint32_t first = uint32_t(out.positions.size());
        for (uint32_t y = 0; y < h / 2; ++y)
            for (int j = y == 0 ? 0 : 1; j <= rows[y]; ++j)
                for (uint32_t x = 0; x < w / 2; ++x)
                    for (int i = x == 0 ? 0 : 1; i <= columns[x]; ++i) {
                        std::array<Point, 9> nine;
                        for (uint32_t k = 0; k < 9; ++k) nine[k] = at(2 * x + k % 3, 2 * y + k / 3);
                        append(out, on_patch(nine, float(i) / float(columns[x]), float(j) / float(rows[y])));
                    }
        for (uint32_t y = 0; y + 1 < down; ++y)
            for (uint32_t x = 0; x + 1 < across; ++x) {
                const uint32_t a = first + y * uint32_t(across) + x, b = a + 1, c = a + uint32_t(across), d = c + 1;
                for (uint32_t corner : {a, b, c, b, d, c}) out.indices.push_back(corner);
            }
    }

    // Into how many chords a quadratic Bézier curve is cut: a chord over 1/n of it is |a - 2b + c| / (4 n^2) off at most.
    int steps(const vec3& a, const vec3& b, const vec3& c) const {
        const float n = std::ceil(std::sqrt(glm::length(a - 2.0f * b + c) / (4 * options_.tolerance)));
        return n >= 1 ? int(std::min(n, float(most_steps))) : 1;  // 1 where the points are no numbers
    }

    static Point on_patch(const std::array<Point, 9>& p, float u, float v) {
        const float bu[3] = {(1 - u) * (1 - u), 2 * u * (1 - u), u * u}, bv[3] = {(1 - v) * (1 - v), 2 * v * (1 - v), v * v};
        const float du[3] = {2 * u - 2, 2 - 4 * u, 2 * u}, dv[3] = {2 * v - 2, 2 - 4 * v, 2 * v};
        Point out{vec3(0), vec3(0), vec2(0)};
        vec3 along(0), down(0);
        for (int k = 0; k < 9; ++k) {
            const float weight = bu[k % 3] * bv[k / 3];
            out.position += weight * p[size_t(k)].position;
            out.normal += weight * p[size_t(k)].normal;
            out.texcoord += weight * p[size_t(k)].texcoord;
            along += du[k % 3] * bv[k / 3] * p[size_t(k)].position;
            down += bu[k % 3] * dv[k / 3] * p[size_t(k)].position;
        }
        // Where control points coincide there is no tangent plane, and the tools' normals have to do.
        const vec3 normal = glm::cross(along, down);
        const float length = glm::length(normal);
        if (length > 1e-4f * glm::length(along) * glm::length(down) && length > 1e-9f) out.normal = normal / length;
        else if (const float l = glm::length(out.normal); l > 0) out.normal /= l;
        return out;
    }

    Point point(uint32_t number) const {
        const Vertex& v = vertices_[number];
        return {glm::make_vec3(v.position), glm::make_vec3(v.normal), {v.st[0], v.st[1]}};
    }
    static void append(Primitive& out, const Point& p) {
        out.positions.push_back(p.position);
        out.normals.push_back(p.normal);
        out.texcoords.push_back(p.texcoord);
    }

    // The primitive of a shader in the model at hand, and its material, made when first asked for.
    Primitive& primitive(Mesh& mesh, uint32_t shader) {
        if (material_of_[shader] == none) {
            const Shader& s = shaders_[shader];
            material_of_[shader] = uint32_t(scene_.materials.size());
            add_look(scene_, std::string(s.name, std::find(s.name, s.name + sizeof s.name, '\0')), s.contents);
        }
        const auto [known, is_new] = primitive_of_.try_emplace(shader, mesh.primitives.size());
        if (is_new) mesh.primitives.push_back({.material = material_of_[shader]});
        return mesh.primitives[known->second];
    }

    void spend(uint64_t elements) {
        if (elements > most_elements - spent_)
            file_.fail("it makes more than " + std::to_string(most_elements) + " vertices and triangles", "it is no map that a game could show");
        spent_ += elements;
    }

    const View& file_;
    const IbspOptions options_;
    std::vector<Shader> shaders_;
    std::vector<Model> models_;
    std::vector<Vertex> vertices_;
    std::vector<uint32_t> meshverts_;
    std::vector<Face> faces_;
    std::vector<Entity> entities_;
    Scene scene_;
    std::vector<uint32_t> material_of_;        // by shader
    std::map<uint32_t, size_t> primitive_of_;  // by shader, in the model at hand
    uint64_t spent_ = 0;
    bool sky_ = false;
};

}  // namespace

Scene read_ibsp(const View& file, const IbspOptions& options) {
    if (file.record<uint32_t>(0, "the header") != 0x50534249) file.fail("it does not begin with \"IBSP\"", "give a map of Quake III or OpenArena");
    const uint32_t version = file.record<uint32_t>(4, "the header");
    if (version != 46) file.fail("this is IBSP version " + std::to_string(version), "only version 46 (Quake III, OpenArena) is read");
    return Reader(file, options).read();
}

Imported import_ibsp(const std::string& path, const ImportOptions& options) {
    const Bytes bytes = read_file(path, most_bytes);
    const float unit = float(options.unit.value_or(ibsp_unit));
    return {.scene = read_ibsp(View(bytes, path), {.unit = unit, .tolerance = 0.01f / unit}), .unit = ibsp_unit, .up = Axis::z};
}

}  // namespace myriad::scenes::importing
