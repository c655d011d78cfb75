// Flattening, cameras and the `load` dispatch, on scenes built by hand.
#include "scenes/scene.hpp"

#include <cmath>
#include <limits>

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

#include "engine/error.hpp"

namespace myriad::scenes {
namespace {

using glm::mat4;
using glm::vec3;

// One triangle in z = 0 that faces +z, with or without normals, placed by `to_world`.
Scene one_triangle(bool normals, const mat4& to_world = mat4(1)) {
    Primitive p;
    p.positions = {{0, 0, 0}, {1, 0, 0}, {0, 2, 0}};
    if (normals) p.normals.assign(3, {0, 0, 1});
    p.indices = {0, 1, 2};
    Scene scene;
    scene.name = "test";
    scene.materials.resize(1);
    scene.meshes.push_back({"triangle", {p}});
    scene.instances.push_back({0, to_world});
    return scene;
}

vec3 face_normal(const Triangles& t, size_t i) {
    const auto c = t.triangles[i];
    return glm::normalize(glm::cross(t.positions[c.y] - t.positions[c.x], t.positions[c.z] - t.positions[c.x]));
}

void expect_near(const vec3& a, const vec3& b, float tolerance = 1e-5f) {
    EXPECT_LE(glm::length(a - b), tolerance) << a.x << " " << a.y << " " << a.z << " is not " << b.x << " " << b.y << " " << b.z;
}

template <class F>
std::string message_of(F&& f) {
    try {
        f();
    } catch (const InputError& e) {
        return e.what();
    }
    return "(no InputError)";
}

TEST(Flatten, AppliesTransformsAndBounds) {
    Scene scene = one_triangle(true, glm::translate(mat4(1), vec3(10, 0, 5)) * glm::scale(mat4(1), vec3(2, 3, 4)));
    const Triangles t = flatten(scene);
    ASSERT_EQ(t.triangles.size(), 1u);
    expect_near(t.positions[t.triangles[0].y], {12, 0, 5});
    expect_near(t.lo, {10, 0, 5});
    expect_near(t.hi, {12, 6, 5});
    expect_near(t.normals[0], {0, 0, 1});
    EXPECT_TRUE(scene.warnings.empty());
}

TEST(Flatten, NormalsUseTheInverseTranspose) {
    Scene scene = one_triangle(true, glm::scale(mat4(1), vec3(1, 1, 10)));
    scene.meshes[0].primitives[0].normals.assign(3, glm::normalize(vec3(1, 0, 1)));
    expect_near(flatten(scene).normals[0], glm::normalize(vec3(1, 0, 0.1f)));
}

TEST(Flatten, MirroredInstancesKeepTheirFront) {
    for (bool normals : {false, true}) {
        Scene scene = one_triangle(normals, glm::scale(mat4(1), vec3(-1, 1, 1)));
        const Triangles t = flatten(scene);
        expect_near(face_normal(t, 0), {0, 0, 1});  // a mirror in x leaves the front towards +z
        expect_near(t.normals[0], {0, 0, 1});
    }
}

TEST(Flatten, MirroredInDepthTurnsTheFront) {
    Scene scene = one_triangle(true, glm::scale(mat4(1), vec3(1, 1, -1)));
    const Triangles t = flatten(scene);
    expect_near(face_normal(t, 0), {0, 0, -1});
    expect_near(t.normals[0], {0, 0, -1});
}

TEST(Flatten, MissingNormalsSplitVertices) {
    Scene scene = one_triangle(false);
    auto& p = scene.meshes[0].primitives[0];
    p.positions.push_back({0, 0, 1});
    p.indices = {0, 1, 2, 0, 2, 3};
    const Triangles t = flatten(scene);
    ASSERT_EQ(t.positions.size(), 6u);
    for (size_t i = 0; i < 2; ++i)
        for (int k = 0; k < 3; ++k) expect_near(t.normals[t.triangles[i][k]], face_normal(t, i));
}

TEST(Flatten, DropsNonFiniteVerticesWithOneWarning) {
    for (bool normals : {false, true}) {
        Scene scene = one_triangle(normals);
        auto& p = scene.meshes[0].primitives[0];
        p.positions.push_back({std::numeric_limits<float>::quiet_NaN(), 0, 0});
        p.positions.push_back({0, std::numeric_limits<float>::infinity(), 0});
        if (normals) p.normals.resize(5, {0, 0, 1});
        p.indices = {0, 1, 3, 0, 1, 2, 1, 2, 4};
        const Triangles t = flatten(scene);
        ASSERT_EQ(t.triangles.size(), 1u);
        ASSERT_EQ(scene.warnings.size(), 1u);
        EXPECT_NE(scene.warnings[0].find("2 triangles"), std::string::npos) << scene.warnings[0];
        expect_near(t.hi, {1, 2, 0});
        for (const auto& v : t.positions) EXPECT_TRUE(std::isfinite(v.x + v.y + v.z));
    }
}

TEST(Flatten, CleansDenormalsAndBadNormals) {
    Scene scene = one_triangle(true);
    auto& p = scene.meshes[0].primitives[0];
    p.positions[0].x = 1e-42f;
    p.normals[1] = vec3(0);
    p.normals[2] = vec3(std::numeric_limits<float>::quiet_NaN());
    const Triangles t = flatten(scene);
    EXPECT_EQ(t.positions[0].x, 0.0f);
    for (const auto& n : t.normals) expect_near(n, {0, 0, 1});
    EXPECT_EQ(scene.warnings.size(), 2u);
}

// A second triangle without the attribute makes both defaults and padding visible.
Scene with_and_without(const mat4& to_world) {
    Scene scene = one_triangle(true, to_world);
    scene.meshes[0].primitives.push_back(scene.meshes[0].primitives[0]);
    return scene;
}

TEST(Flatten, AttributesThatNobodyHasStayEmpty) {
    Scene scene = one_triangle(true);
    const Triangles t = flatten(scene);
    EXPECT_TRUE(t.colors.empty() && t.texcoords1.empty() && t.tangents.empty());
    EXPECT_EQ(t.texcoords.size(), 3u);
}

TEST(Flatten, ColorsAndSecondSetWithDefaults) {
    for (bool normals : {false, true}) {
        Scene scene = with_and_without(mat4(1));
        auto& p = scene.meshes[0].primitives;
        if (!normals) p[0].normals.clear(), p[1].normals.clear();
        p[0].texcoords = {{1, 2}, {3, 4}, {5, 6}};
        p[1].colors = {{.1f, .2f, .3f, .4f}, {2, -1, 0.5f, 1}, {1, std::numeric_limits<float>::quiet_NaN(), 0, 0}};
        p[1].texcoords1 = {{7, 8}, {9, std::numeric_limits<float>::infinity()}, {-1, 0}};
        const Triangles t = flatten(scene);
        ASSERT_EQ(t.colors.size(), 6u);
        ASSERT_EQ(t.texcoords1.size(), 6u);
        const auto first = t.triangles[0], second = t.triangles[1];
        EXPECT_EQ(t.colors[first.x], glm::vec4(1));
        EXPECT_EQ(t.colors[second.x], glm::vec4(.1f, .2f, .3f, .4f));
        EXPECT_EQ(t.colors[second.y], glm::vec4(1, 0, 0.5f, 1));  // clamped, as glTF says
        EXPECT_EQ(t.colors[second.z], glm::vec4(1));
        EXPECT_EQ(t.texcoords1[first.z], glm::vec2(5, 6));  // a primitive without a second set: the first
        EXPECT_EQ(t.texcoords1[second.x], glm::vec2(7, 8));
        EXPECT_EQ(t.texcoords1[second.y], glm::vec2(0));
        EXPECT_EQ(t.texcoords[second.x], glm::vec2(0));
        ASSERT_EQ(scene.warnings.size(), 2u);
        EXPECT_NE(scene.warnings[0].find("1 non-finite texture coordinates"), std::string::npos);
        EXPECT_NE(scene.warnings[1].find("1 non-finite vertex colours"), std::string::npos);
    }
}

TEST(Flatten, TangentsGoWithTheSurface) {
    // A shear and a stretch: the tangent stays in the surface, perpendicular to the transformed normal.
    mat4 m = glm::scale(mat4(1), vec3(2, 3, 0.5f));
    m[0].z = 1;  // x goes to (2, 0, 1)
    Scene scene = with_and_without(m);
    auto& p = scene.meshes[0].primitives;
    p[0].tangents.assign(3, {1, 0, 0, -1});
    const Triangles t = flatten(scene);
    ASSERT_EQ(t.tangents.size(), 6u);
    const glm::vec4 tangent = t.tangents[t.triangles[0].x];
    expect_near(vec3(tangent), glm::normalize(vec3(2, 0, 1)));
    EXPECT_EQ(tangent.w, -1);
    EXPECT_NEAR(glm::dot(vec3(tangent), t.normals[t.triangles[0].x]), 0, 1e-6f);
    EXPECT_EQ(vec3(t.tangents[t.triangles[1].x]), vec3(0));
}

// Whatever the instance does, cross(normal, tangent) * w must be where the instance takes the bitangent of the mesh.
TEST(Flatten, BitangentsSurviveMirrors) {
    const vec3 n = glm::normalize(vec3(1, 2, 3)), t = glm::normalize(glm::cross(n, vec3(0, 1, 0)));
    for (const vec3 s : {vec3(1), vec3(-1, 1, 1), vec3(1, -1, 1), vec3(1, 1, -1), vec3(-1, -1, 1), vec3(-1)})
        for (float w : {1.0f, -1.0f}) {
            const mat4 m = glm::rotate(mat4(1), 0.7f, vec3(1, 1, 0)) * glm::scale(mat4(1), s);
            Scene scene = one_triangle(true, m);
            scene.meshes[0].primitives[0].normals.assign(3, n);
            scene.meshes[0].primitives[0].tangents.assign(3, glm::vec4(t, w));
            const Triangles out = flatten(scene);
            const glm::vec4 tangent = out.tangents[0];
            expect_near(glm::cross(out.normals[0], vec3(tangent)) * tangent.w, glm::mat3(m) * (glm::cross(n, t) * w));
        }
}

TEST(Flatten, TangentsWithoutNormalsOrLengthAreNone) {
    Scene scene = one_triangle(false);
    scene.meshes[0].primitives[0].tangents.assign(3, {1, 0, 0, 1});
    EXPECT_TRUE(flatten(scene).tangents.empty());  // glTF: they mean nothing beside computed normals
    scene = one_triangle(true);
    scene.meshes[0].primitives[0].tangents = {{0, 0, 0, 1}, {std::numeric_limits<float>::quiet_NaN(), 0, 0, 1}, {1, 0, 0, 1}};
    const Triangles t = flatten(scene);
    EXPECT_EQ(vec3(t.tangents[0]), vec3(0));
    EXPECT_EQ(vec3(t.tangents[1]), vec3(0));
    expect_near(vec3(t.tangents[2]), {1, 0, 0});
}

TEST(Flatten, KeepsZeroAreaTrianglesWithUnitNormals) {
    for (bool normals : {false, true}) {
        Scene scene = one_triangle(normals, glm::scale(mat4(1), vec3(0)));  // a singular instance
        const Triangles t = flatten(scene);
        ASSERT_EQ(t.triangles.size(), 1u);
        for (const auto& n : t.normals) EXPECT_NEAR(glm::length(n), 1, 1e-5f);
    }
}

TEST(Flatten, ExtremeScalesKeepUnitNormals) {
    for (float s : {1e-18f, 1e-6f, 1e6f, 0.5f * farthest}) {
        for (bool normals : {false, true}) {
            Scene scene = one_triangle(normals, glm::scale(mat4(1), vec3(s)));
            expect_near(flatten(scene).normals[0], {0, 0, 1});
        }
    }
}

TEST(Flatten, AnEmptySceneIsEmpty) {
    Scene scene;
    scene.materials.resize(1);
    const Triangles t = flatten(scene);
    EXPECT_TRUE(t.triangles.empty());
    EXPECT_EQ(t.lo, vec3(0));
    EXPECT_EQ(t.hi, vec3(0));
    const Camera camera = framing_camera(t);
    EXPECT_TRUE(std::isfinite(camera.to_world[3].x + camera.to_world[2].z));
}

// How far from the middle of a square picture the outermost vertex is: 1 is its edge.
double reach(const Triangles& t, const Camera& camera) {
    const glm::dmat4 to_camera = glm::inverse(glm::dmat4(camera.to_world));
    double out = 0;
    for (const auto& v : t.positions) {
        const glm::dvec3 c(to_camera * glm::dvec4(v, 1));
        if (!(c.z < 0)) return 1e9;
        out = std::max(out, std::max(std::abs(c.x), std::abs(c.y)) / -c.z / std::tan(camera.yfov / 2));
    }
    return out;
}

TEST(Cameras, FramingFillsThePictureWithEveryVertex) {
    for (const vec3 at : {vec3(0), vec3(1e6f, 0, 0)})
        for (const vec3 size : {vec3(100), vec3(100, 1, 100), vec3(1, 100, 1), vec3(100, 0, 1)}) {
            // Both of the triangle's diagonals, so that all corners of its bounds are vertices of something.
            Scene scene = one_triangle(true, glm::translate(mat4(1), at));
            auto& p = scene.meshes[0].primitives[0];
            p.positions.clear(), p.normals.assign(8, {0, 0, 1}), p.indices = {0, 1, 2, 3, 4, 5, 5, 6, 7};
            for (int i = 0; i < 8; ++i) p.positions.push_back(size * vec3(i & 1, i >> 1 & 1, i >> 2 & 1));
            const Triangles t = flatten(scene);
            const double r = reach(t, framing_camera(t));
            EXPECT_LT(r, 1) << size.x << " " << size.y << " " << size.z;
            EXPECT_GT(r, 0.8) << size.x << " " << size.y << " " << size.z;
        }
}

TEST(Cameras, PickByNameIndexOrDefault) {
    Scene scene = one_triangle(true);
    const Triangles t = flatten(scene);
    EXPECT_EQ(pick_camera(scene, t, "").name, "framing");
    EXPECT_NE(message_of([&] { pick_camera(scene, t, "0"); }).find("has none"), std::string::npos);
    scene.cameras = {{"near", mat4(1), 1}, {"0", mat4(1), 1}, {"far", mat4(1), 1}};
    EXPECT_EQ(pick_camera(scene, t, "").name, "near");
    EXPECT_EQ(pick_camera(scene, t, "far").name, "far");
    EXPECT_EQ(pick_camera(scene, t, "2").name, "far");
    EXPECT_EQ(pick_camera(scene, t, "0").name, "0");  // a name wins over an index
    for (const char* bad : {"3", "Far", "-1", "99999999999999999999", "1x"}) {
        const std::string message = message_of([&] { pick_camera(scene, t, bad); });
        EXPECT_NE(message.find("\"near\""), std::string::npos) << message;
        EXPECT_NE(message.find("\"far\""), std::string::npos) << message;
    }
}

TEST(Load, NamesWhatExists) {
    const auto message = [](const char* source) { return message_of([&] { load(source); }); };
    EXPECT_NE(message("builtin:nothing").find("atrium, cathedral, cornell, hairball, particles, teatime"), std::string::npos);
    EXPECT_NE(message("builtin:").find("atrium, cathedral, cornell, hairball, particles, teatime"), std::string::npos);
    EXPECT_NE(message("builtin:cornell?colour=1").find("known: light, cells"), std::string::npos);
    EXPECT_NE(message("builtin:cornell?light=sun").find("panel, point"), std::string::npos);
    EXPECT_NE(message("builtin:cornell?cells=8x").find("1 to 256"), std::string::npos);
    EXPECT_NE(message("builtin:cornell?cells=nan").find("1 to 256"), std::string::npos);
    EXPECT_NE(message("builtin:cornell?cells").find("1 to 256"), std::string::npos);
    EXPECT_NE(message("builtin:cornell?").find("(no InputError)"), std::string::npos);
    EXPECT_NE(message("/no/such/file.glb").find("/no/such/file.glb"), std::string::npos);
    EXPECT_EQ(builtin_names().size(), 6u);
}

}  // namespace
}  // namespace myriad::scenes
