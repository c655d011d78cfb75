#include "scenes/import/ply.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstring>
#include <sstream>

#include "scenes/import/bytes.hpp"
#include "scenes/import/color.hpp"
#include "scenes/import/tidy.hpp"
#include "scenes/import/triangulate.hpp"

namespace myriad::scenes::importing {
namespace {

enum class Type { i8, u8, i16, u16, i32, u32, f32, f64 };

struct Property {
    std::string name;
    Type type = Type::f32;
    std::optional<Type> count;  // of a list, the type of its length
};

struct Element {
    std::string name;
    uint64_t count = 0;
    std::vector<Property> properties;
};

enum class Encoding { ascii, little, big };

std::optional<Type> type_of(const std::string& name) {
    constexpr std::array<std::pair<std::string_view, Type>, 16> names = {{
        {"char", Type::i8}, {"uchar", Type::u8}, {"short", Type::i16}, {"ushort", Type::u16}, {"int", Type::i32}, {"uint", Type::u32},
        {"float", Type::f32}, {"double", Type::f64}, {"int8", Type::i8}, {"uint8", Type::u8}, {"int16", Type::i16}, {"uint16", Type::u16},
        {"int32", Type::i32}, {"uint32", Type::u32}, {"float32", Type::f32}, {"float64", Type::f64}}};
    for (const auto& [known, type] : names)
        if (name == known) return type;
    return {};
}

size_t size_of(Type type) {
    constexpr size_t sizes[] = {1, 1, 2, 2, 4, 4, 4, 8};
    return sizes[size_t(type)];
}

struct Header {
    Encoding encoding = Encoding::ascii;
    std::vector<Element> elements;
    size_t size = 0;  // bytes up to the data
    bool textured = false;
};

// Some bytes of the file as a message may repeat them.
std::string quoted(std::string text) {
    std::ranges::replace_if(text, [](unsigned char c) { return c < ' ' || c > '~'; }, '?');
    return "\"" + text.substr(0, 60) + "\"";
}

Header read_header(std::span<const uint8_t> bytes, const View& file) {
    constexpr size_t longest = 1 << 16, most = 1000;
    Header out;
    bool formatted = false;
    for (bool first = true;; first = false) {
        const auto begin = bytes.begin() + std::ptrdiff_t(out.size);
        const auto end = std::find(begin, bytes.end(), '\n');
        if (end == bytes.end() || out.size > longest) file.fail("its header has no end", "give a whole .ply file");
        std::string line(begin, end);
        out.size += line.size() + 1;
        if (line.ends_with('\r')) line.pop_back();
        std::istringstream in(line);
        std::string word, a, b, c, d;
        in >> word;
        if (first && word != "ply") file.fail("it does not begin with \"ply\"", "give a .ply file");
        if (word == "end_header") break;
        if (word == "format") {
            in >> a;
            formatted = true;
            if (a == "binary_little_endian") out.encoding = Encoding::little;
            else if (a == "binary_big_endian") out.encoding = Encoding::big;
            else if (a != "ascii") file.fail("its format is " + quoted(a), "use ascii or binary");
        } else if (word == "comment") {
            in >> a;
            out.textured |= a == "TextureFile";
        } else if (word == "element") {
            Element element;
            in >> element.name >> a;
            const auto [at, error] = std::from_chars(a.data(), a.data() + a.size(), element.count);
            if (error != std::errc() || at != a.data() + a.size() || out.elements.size() == most) file.fail("the header's line " + quoted(line) + " makes no sense");
            out.elements.push_back(std::move(element));
        } else if (word == "property") {
            Property property;
            in >> a;
            const bool list = a == "list";
            if (list) in >> b >> c >> property.name;
            else c = a, in >> property.name;
            const auto type = type_of(c), count = type_of(b);
            const bool sane = type && (!list || (count && *count < Type::f32)) && !property.name.empty() && !out.elements.empty() && out.elements.back().properties.size() < most;
            if (!sane) file.fail("the header's line " + quoted(line) + " makes no sense");
            property.type = *type;
            if (list) property.count = count;
            out.elements.back().properties.push_back(std::move(property));
        }
    }
    if (!formatted) file.fail("its header has no format", "give a whole .ply file");
    return out;
}

// The data, value after value.
class Values {
public:
    Values(std::span<const uint8_t> bytes, Encoding encoding, const View& file) : at_(bytes.data()), end_(at_ + bytes.size()), encoding_(encoding), file_(file) {}

    double next(Type type) { return encoding_ == Encoding::ascii ? ascii() : binary(type); }

    // Fails where `count` rows of at least one value each, or `bytes` bytes a row, are more than there is left.
    void expect(uint64_t count, uint64_t bytes, const std::string& what) const {
        const uint64_t left = uint64_t(end_ - at_), least = std::max<uint64_t>(encoding_ == Encoding::ascii ? 1 : bytes, 1);
        if (count > left / least) file_.fail(std::to_string(count) + " " + what + " are announced, but only " + std::to_string(left) + " bytes are left", "the file is truncated, get it again");
    }

private:
    double ascii() {
        while (at_ != end_ && std::isspace(*at_)) ++at_;
        if (at_ == end_) file_.fail("the data end too early", "the file is truncated, get it again");
        const char* from = reinterpret_cast<const char*>(at_) + (*at_ == '+');
        double value = 0;
        const auto [to, error] = std::from_chars(from, reinterpret_cast<const char*>(end_), value);
        if (error == std::errc::invalid_argument || (to != reinterpret_cast<const char*>(end_) && !std::isspace(static_cast<unsigned char>(*to))))
            file_.fail(quoted(std::string(at_, std::find_if(at_, std::min(end_, at_ + 60), [](uint8_t c) { return std::isspace(c); }))) + " is not a number");
        at_ = reinterpret_cast<const uint8_t*>(to);
        return value;
    }

    template <class T>
    double as() const {
        std::array<uint8_t, sizeof(T)> raw;
        std::memcpy(raw.data(), at_, sizeof(T));
        if (encoding_ == Encoding::big) std::ranges::reverse(raw);
        return double(std::bit_cast<T>(raw));
    }

    double binary(Type type) {
        const size_t size = size_of(type);
        if (size_t(end_ - at_) < size) file_.fail("the data end too early", "the file is truncated, get it again");
        double value = 0;
        switch (type) {
            case Type::i8: value = as<int8_t>(); break;
            case Type::u8: value = *at_; break;
            case Type::i16: value = as<int16_t>(); break;
            case Type::u16: value = as<uint16_t>(); break;
            case Type::i32: value = as<int32_t>(); break;
            case Type::u32: value = as<uint32_t>(); break;
            case Type::f32: value = as<float>(); break;
            case Type::f64: value = as<double>(); break;
        }
        at_ += size;
        return value;
    }

    const uint8_t *at_, *end_;
    const Encoding encoding_;
    const View& file_;
};

uint64_t least_bytes(const Element& element) {
    uint64_t bytes = 0;
    for (const Property& p : element.properties) bytes += size_of(p.count.value_or(p.type));
    return bytes;
}

// What of a vertex a property is: a number in the rows that read_vertices() fills, or none.
uint32_t column(const std::string& name) {
    constexpr std::array<std::array<std::string_view, 4>, 12> names = {{
        {"x"}, {"y"}, {"z"}, {"nx"}, {"ny"}, {"nz"}, {"red", "r", "diffuse_red"}, {"green", "g", "diffuse_green"}, {"blue", "b", "diffuse_blue"},
        {"alpha", "a", "diffuse_alpha"}, {"u", "s", "texture_u", "texture_s"}, {"v", "t", "texture_v", "texture_t"}}};
    for (uint32_t c = 0; c < names.size(); ++c)
        for (std::string_view known : names[c])
            if (!known.empty() && name == known) return c;
    return none;
}

double scale_of_color(Type type) { return type == Type::u8 ? 1 / 255.0 : type == Type::u16 ? 1 / 65535.0 : 1; }

class Ply {
public:
    Ply(std::span<const uint8_t> bytes, const View& file, const ImportOptions& options)
        : file_(file), options_(options), header_(read_header(bytes, file)), values_(bytes.subspan(header_.size), header_.encoding, file) {}

    Imported read() {
        for (const Element& element : header_.elements) {
            if (element.properties.empty()) continue;
            values_.expect(element.count, least_bytes(element), "of element " + quoted(element.name));
            if (element.name == "vertex") vertices(element);
            else lists(element);
        }
        if (mesh_.positions.empty()) file_.fail("it has no vertices", "give a file with a mesh");
        triangles();
        weld(mesh_);
        Imported out;
        Scene& scene = out.scene;
        scene.materials.push_back({.name = "default", .base_color = glm::vec4(glm::vec3(mesh_.colors.empty() ? default_grey : 1), 1), .metallic = 0, .double_sided = true});
        if (header_.textured) scene.warnings.push_back("the texture that the file names was left out: its coordinates belong to corners of faces.");
        scene.meshes.push_back({"mesh", {}});
        scene.meshes[0].primitives.push_back(std::move(mesh_));
        scene.instances.push_back({});
        return out;
    }

private:
    void skip_list(const Property& p) {
        const double count = values_.next(*p.count);
        for (double i = 0; i < count; ++i) values_.next(p.type);  // each takes a byte: it ends with the file
    }

    void vertices(const Element& element) {
        if (element.count >= none) file_.fail("it has more than 2^32 vertices", "cut it up");
        if (!mesh_.positions.empty()) file_.fail("it has vertices twice");  // with other attributes, perhaps
        std::array<double, 12> row{};
        std::vector<std::pair<uint32_t, double>> columns;  // of each property, and what its values are multiplied by
        std::array<bool, 12> has{};
        for (const Property& p : element.properties) {
            const uint32_t c = p.count ? none : column(p.name);
            columns.emplace_back(c, c != none && c >= 6 && c <= 9 ? scale_of_color(p.type) : 1);
            if (c != none) has[c] = true;
        }
        if (!has[0] || !has[1] || !has[2]) file_.fail("its vertices have no x, y and z", "export it again");
        const bool normals = has[3] && has[4] && has[5], colors = has[6] && has[7] && has[8], texcoords = has[10] && has[11];
        const auto channel = [&](double v) { return options_.linear_colors ? float(v) : linear_of_srgb(float(v)); };
        row[9] = 1;
        for (uint64_t i = 0; i < element.count; ++i) {
            for (size_t k = 0; k < columns.size(); ++k) {
                if (element.properties[k].count) skip_list(element.properties[k]);
                else if (const double v = values_.next(element.properties[k].type); columns[k].first != none) row[columns[k].first] = v * columns[k].second;
            }
            mesh_.positions.emplace_back(row[0], row[1], row[2]);
            if (normals) mesh_.normals.emplace_back(row[3], row[4], row[5]);
            if (colors) mesh_.colors.emplace_back(channel(row[6]), channel(row[7]), channel(row[8]), row[9]);
            if (texcoords) mesh_.texcoords.emplace_back(row[10], 1 - row[11]);
        }
    }

    // Faces and strips, whose corners are kept until all vertices are known; and what is neither.
    void lists(const Element& element) {
        const bool face = element.name == "face", strips = element.name == "tristrips";
        for (uint64_t i = 0; i < element.count; ++i)
            for (const Property& p : element.properties) {
                const bool corners = p.count && ((face && (p.name == "vertex_indices" || p.name == "vertex_index")) || (strips && p.name == "vertex_indices"));
                if (!p.count) values_.next(p.type);
                else if (!corners) skip_list(p);
                else if (strips) strip(p);
                else polygon(p);
            }
    }

    uint64_t length(const Property& p) {
        const double count = values_.next(*p.count);
        if (!(count >= 0 && count < double(none)) || count != std::floor(count)) file_.fail("a list has " + std::to_string(count) + " entries");
        values_.expect(uint64_t(count), size_of(p.type), "corners of a face");
        return uint64_t(count);
    }

    uint32_t index(double value) const {
        if (!(value >= 0 && value < double(none)) || value != std::floor(value)) file_.fail("a face has corner " + std::to_string(value));
        return uint32_t(value);
    }

    void polygon(const Property& p) {
        const uint64_t count = length(p);
        for (uint64_t k = 0; k < count; ++k) corners_.push_back(index(values_.next(p.type)));
        sizes_.push_back(uint32_t(count));
    }

    // Indices of strips, -1 between them; every second triangle is turned.
    void strip(const Property& p) {
        const uint64_t count = length(p);
        uint32_t a = none, b = none;
        bool odd = false;
        for (uint64_t k = 0; k < count; ++k) {
            const double value = values_.next(p.type);
            if (value == -1) {
                a = b = none, odd = false;
                continue;
            }
            const uint32_t c = index(value);
            if (a != none) {
                corners_.insert(corners_.end(), {odd ? b : a, odd ? a : b, c});
                sizes_.push_back(3);
                odd = !odd;
            }
            a = b, b = c;
        }
    }

    void triangles() {
        for (uint32_t i : corners_)
            if (i >= mesh_.positions.size()) file_.fail("a face has corner " + std::to_string(i) + ", but there are only " + std::to_string(mesh_.positions.size()) + " vertices");
        std::vector<glm::vec3> polygon;
        std::vector<uint32_t> cut;
        const uint32_t* at = corners_.data();
        for (uint32_t size : sizes_) {
            if (size == 3) {
                mesh_.indices.insert(mesh_.indices.end(), at, at + 3);
            } else if (size > 3) {
                polygon.clear(), cut.clear();
                for (uint32_t k = 0; k < size; ++k) polygon.push_back(mesh_.positions[at[k]]);
                triangulate(polygon, cut);
                for (uint32_t k : cut) mesh_.indices.push_back(at[k]);
            }
            at += size;
        }
        corners_ = {}, sizes_ = {};
    }

    static constexpr float default_grey = 0.8f;  // as of what other formats leave without a material

    const View& file_;
    const ImportOptions& options_;
    const Header header_;
    Values values_;
    Primitive mesh_;
    std::vector<uint32_t> corners_, sizes_;  // of all faces, one after the other
};

}  // namespace

Imported read_ply(std::span<const uint8_t> bytes, const std::string& name, const ImportOptions& options) {
    const View file(bytes, name);
    return Ply(bytes, file, options).read();
}

Imported import_ply(const std::string& path, const ImportOptions& options) {
    const Bytes bytes = gunzip(read_file(path, max_file_bytes), path, max_file_bytes);
    return read_ply(bytes, path, options);
}

}  // namespace myriad::scenes::importing
