// Strands written by the test: ribbons and tubes around them, and files that lie.
#include "scenes/import/embree.hpp"

#include <filesystem>
#include <fstream>
#include <limits>

#include <gtest/gtest.h>
#include <unistd.h>

#include "engine/error.hpp"

namespace myriad::scenes::importing {
namespace {

using glm::vec3;
using glm::vec4;

struct File {
    std::vector<uint32_t> index;
    std::vector<vec4> points;
    std::string more;

    static std::string array(const char* name, uint64_t offset, uint64_t size) {
        return std::string("<") + name + " ofs=\"" + std::to_string(offset) + "\" size=\"" + std::to_string(size) + "\"/>";
    }
    std::string xml() const { return xml(array("indices", 0, index.size()) + array("positions", 4 * index.size(), points.size())); }
    std::string xml(const std::string& arrays) const {
        return "<?xml version=\"1.0\"?><scene><assign type=\"scene\" id=\"a\"><RoundLineSegments><material><code>\"Hair\"</code><parameters>"
               "<float3 name=\"Kr\">0.1 0.2 0.3</float3><float3 name=\"Kt\">0.4 0.4 0.9</float3></parameters></material>" +
               arrays + "</RoundLineSegments></assign><Group><ref id=\"a\"/></Group>" + more + "</scene>";
    }
    Bytes bytes() const {
        Bytes out(4 * index.size() + 16 * points.size());
        if (!index.empty()) std::memcpy(out.data(), index.data(), 4 * index.size());
        if (!points.empty()) std::memcpy(out.data() + 4 * index.size(), points.data(), 16 * points.size());
        return out;
    }
    Scene read(const StrandOptions& options = {}) const { return read(xml(), options); }
    Scene read(const std::string& text, const StrandOptions& options = {}) const {
        const Bytes letters(text.begin(), text.end());
        return read_embree(View(letters, "fur.xml"), [this] { return bytes(); }, options);
    }
};

// Two strands: one along y with a bend, one along x.
File two() { return {{0, 1, 3}, {{0, 0, 0, 0.1f}, {0, 1, 0, 0.1f}, {0.5f, 2, 0, 0.05f}, {3, 0, 0, 0.2f}, {4, 0, 0, 0.1f}}, ""}; }

template <class... Arguments>
std::string refusal(const File& file, const Arguments&... arguments) {
    try {
        file.read(arguments...);
    } catch (const InputError& e) {
        return e.what();
    }
    return "no InputError";
}

TEST(Embree, tubes_stand_around_the_points_at_the_radius) {
    for (uint32_t sides : {3u, 4u, 7u}) {
        const Scene scene = two().read(StrandOptions{.sides = sides});
        const Primitive& p = scene.meshes.at(0).primitives.at(0);
        ASSERT_EQ(p.positions.size(), 5 * sides);
        EXPECT_EQ(p.indices.size(), 3 * 2 * 3 * sides);
        const std::vector<vec4> points = two().points;
        for (size_t i = 0; i < p.positions.size(); ++i) {
            EXPECT_NEAR(glm::distance(p.positions[i], vec3(points[i / sides])), points[i / sides].w, 1e-6f);
            EXPECT_NEAR(glm::dot(p.normals[i], p.positions[i] - vec3(points[i / sides])), points[i / sides].w, 1e-6f);
        }
    }
}

TEST(Embree, fronts_look_outward) {
    const Scene scene = two().read(StrandOptions{.sides = 5});
    const Primitive& p = scene.meshes[0].primitives[0];
    for (size_t t = 0; t < p.indices.size(); t += 3) {
        const uint32_t* c = &p.indices[t];
        const vec3 front = glm::cross(p.positions[c[1]] - p.positions[c[0]], p.positions[c[2]] - p.positions[c[0]]);
        for (int k = 0; k < 3; ++k) EXPECT_GT(glm::dot(front, p.normals[c[k]]), 0);
    }
}

TEST(Embree, ribbons_are_as_wide_as_the_strand) {
    const Scene scene = two().read(StrandOptions{.sides = 2});
    const Primitive& p = scene.meshes[0].primitives[0];
    ASSERT_EQ(p.positions.size(), 10u);
    EXPECT_EQ(p.indices.size(), 3u * 2 * 3);
    EXPECT_NEAR(glm::distance(p.positions[0], p.positions[1]), 0.2f, 1e-6f);
    EXPECT_TRUE(scene.materials[0].double_sided);
}

TEST(Embree, keeps_every_nth_strand_and_makes_it_thicker) {
    const Scene scene = two().read(StrandOptions{.sides = 2, .keep_every = 2});
    const Primitive& p = scene.meshes[0].primitives[0];
    EXPECT_EQ(p.indices.size(), 3u * 2 * 2);
    EXPECT_NEAR(glm::distance(p.positions[0], p.positions[1]), 0.4f, 1e-6f);
}

TEST(Embree, takes_the_color_and_names_what_it_leaves_out) {
    File file = two();
    file.more = "<TriangleMesh><positions>0 0 0</positions></TriangleMesh><TriangleMesh/>";
    const Scene scene = file.read();
    EXPECT_LT(glm::distance(vec3(scene.materials.at(0).base_color), vec3(0.5f, 0.6f, 1)), 1e-6f);
    ASSERT_EQ(scene.warnings.size(), 1u);
    EXPECT_NE(scene.warnings[0].find("TriangleMesh"), std::string::npos);
}

TEST(Embree, finds_the_numbers_beside_the_xml) {
    const auto folder = std::filesystem::temp_directory_path() / ("myriad_embree_" + std::to_string(::getpid()));
    std::filesystem::create_directories(folder);
    const std::string xml = (folder / "fur.xml").string(), text = two().xml();
    std::ofstream(xml) << text;
    try {
        import_scene(xml);
        ADD_FAILURE() << "without numbers";
    } catch (const InputError& e) {
        EXPECT_NE(std::string(e.what()).find("fur.bin.gz: there is no such file"), std::string::npos) << e.what();
    }
    const Bytes bytes = two().bytes();
    std::ofstream(folder / "fur.bin", std::ios::binary).write(reinterpret_cast<const char*>(bytes.data()), std::streamsize(bytes.size()));
    Scene scene = import_scene(xml, {.strands = {.sides = 3}});
    EXPECT_EQ(flatten(scene).triangles.size(), 2u * 3 * 3);
    std::filesystem::remove_all(folder);
}

// Points upon each other, a strand that turns back on itself, one straight at the middle, and numbers that are none.
TEST(Embree, hard_strands_stay_finite) {
    File file{{0, 1, 2, 3, 5, 7},
              {{0, 0, 0, 1}, {0, 0, 0, 1}, {0, 1, 0, 1}, {0, 0, 0, 1}, {0, 1, 0, 0}, {1, 1, 1, 1}, {1, 1, 1, 1}, {2, 2, 2, -1}, {9, 9, 9, 1}}, ""};
    for (bool broken : {false, true}) {
        const Scene scene = file.read(StrandOptions{.sides = 3});
        const Primitive& p = scene.meshes.at(0).primitives.at(0);
        EXPECT_GT(p.positions.size(), 0u);
        for (size_t i = 0; i < p.positions.size(); ++i) {
            EXPECT_TRUE(std::isfinite(glm::length(p.positions[i]))) << i << broken;
            EXPECT_NEAR(glm::length(p.normals[i]), 1, 1e-5f) << i << broken;
        }
        file.points[2].x = std::numeric_limits<float>::quiet_NaN();
        file.points[7].w = std::numeric_limits<float>::infinity();
    }
}

TEST(Embree, refuses_numbers_that_do_not_fit) {
    File file = two();
    const auto says = [](const std::string& message, const std::string& what) { EXPECT_NE(message.find(what), std::string::npos) << message; };
    const auto arrays = [&](uint64_t a, uint64_t b, uint64_t c, uint64_t d) {
        return refusal(file, file.xml(File::array("indices", a, b) + File::array("positions", c, d)));
    };
    says(arrays(0, 3, 12, 6), "fur.xml's .bin file: the points: 6 records of 16 bytes from byte 12 on");
    says(arrays(90, 3, 12, 5), "the segments: ");
    says(arrays(~0ull, 3, 12, 5), "the segments: ");
    says(arrays(0, ~0ull, 12, 5), "fewer bytes");
    says(arrays(0, 3, 12, ~0ull), "the points: ");
    says(arrays(0, 3, 12, 1), "segment 0 begins at point 0 of 1");
    says(arrays(0, 3, 12, 0), "segment 0 begins at point 0 of 0");
    says(refusal(file, StrandOptions{.sides = 1}), "1 sides");
    says(refusal(file, StrandOptions{.sides = 65}), "65 sides");
    says(refusal(file, StrandOptions{.keep_every = 0}), "no strand");
    file.index[1] = 4;  // its next point would be past the last
    says(refusal(file), "segment 1 begins at point 4 of 5");
    file.index[1] = ~0u;
    says(refusal(file), "segment 1");
}

TEST(Embree, refuses_xml_that_is_none) {
    const File file = two();
    const auto says = [&](const std::string& text, const std::string& what) {
        const std::string message = refusal(file, text);
        EXPECT_EQ(message.find("fur.xml: "), 0u) << message;
        EXPECT_NE(message.find(what), std::string::npos) << message;
    };
    says("", "cannot be read");
    says("furBall", "cannot be read");
    says("<scene><Group>", "cannot be read");
    says("<scene/>", "no RoundLineSegments");
    says(file.xml("<indices>0 1 2</indices>" + File::array("positions", 0, 5)), "has no <indices> with ofs and size");
    says(file.xml(File::array("indices", 0, 3)), "has no <positions>");
    std::string deep, many;
    for (int i = 0; i < 100000; ++i) deep += "<a>";
    says(deep, "cannot be read");
    for (int i = 0; i < 100000; ++i) deep += "</a>";
    says(deep, "no RoundLineSegments");
    for (int i = 0; i < 2000; ++i) many += "<RoundLineSegments>" + File::array("indices", 0, 3) + File::array("positions", 12, 5) + "</RoundLineSegments>";
    says("<scene>" + many + "</scene>", "more than 1024");
    // Truncated anywhere, or with a byte changed: a sentence or a scene.
    const std::string whole = file.xml();
    for (size_t size = 0; size < whole.size(); ++size) says(whole.substr(0, size), "cannot be read");
    for (size_t at = 0; at < whole.size(); ++at)
        for (char c : {'<', '\0', '9', '\xff'}) {
            std::string text = whole;
            text[at] = c;
            refusal(file, text);
        }
}

// A megabyte of XML that asks for the same segments again and again.
TEST(Embree, a_small_file_cannot_ask_for_much) {
    File file;
    for (uint32_t i = 0; i < 3000; ++i) file.index.push_back(i);
    for (int i = 0; i < 3001; ++i) file.points.emplace_back(float(i), 0, 0, 1);
    std::string sets;
    for (int i = 0; i < 1000; ++i)
        sets += "<RoundLineSegments>" + File::array("indices", 0, 3000) + File::array("positions", 12000, 3001) + "</RoundLineSegments>";
    EXPECT_NE(refusal(file, "<scene>" + sets + "</scene>").find("fewer bytes than the segments need"), std::string::npos);
}

}  // namespace
}  // namespace myriad::scenes::importing
