#include "scenes/import/assimp/geometry.hpp"

#include <algorithm>
#include <cmath>
#include <map>

#include <assimp/camera.h>
#include <assimp/light.h>
#include <assimp/mesh.h>

#include "engine/error.hpp"
#include "scenes/gltf/limits.hpp"
#include "scenes/import/color.hpp"
#include "scenes/import/tidy.hpp"
#include "scenes/import/triangulate.hpp"

namespace myriad::scenes::importing {
namespace {

glm::vec3 vector(const aiVector3D& v) { return {v.x, v.y, v.z}; }

glm::dmat4 matrix(const aiMatrix4x4& m) {
    glm::dmat4 out;
    for (int c = 0; c < 4; ++c)
        for (int r = 0; r < 4; ++r) out[c][r] = double(m[unsigned(r)][c]);
    return out;
}

class Geometry {
public:
    Geometry(const aiScene& in, const std::string& path, const GeometryOptions& options, Scene& out) : in_(in), path_(path), options_(options), out_(out) {}

    void run() {
        primitives_.reserve(in_.mNumMeshes);
        for (unsigned m = 0; m < in_.mNumMeshes; ++m) primitives_.push_back(primitive(*in_.mMeshes[m], m));
        walk();
        report();
    }

private:
    [[noreturn]] void fail(const std::string& what) const { throw InputError(path_ + ": " + what + "; the file is damaged, export it again."); }

    Primitive primitive(const aiMesh& in, unsigned index) {
        const std::string name = "mesh " + std::to_string(index);
        Primitive out;
        const size_t count = in.mNumVertices;
        if (in.mMaterialIndex >= in_.mNumMaterials) fail(name + " has material " + std::to_string(in.mMaterialIndex) + ", which does not exist");
        out.material = in.mMaterialIndex;
        if (!in.mVertices || count == 0) return out;
        const auto copy3 = [&](const aiVector3D* from, auto& to) {
            to.reserve(count);
            for (size_t i = 0; i < count; ++i) to.push_back(vector(from[i]));
        };
        copy3(in.mVertices, out.positions);
        if (in.mNormals && !options_.without_normals) copy3(in.mNormals, out.normals);
        for (auto [set, to] : {std::pair(0, &out.texcoords), {1, &out.texcoords1}})
            if (in.mTextureCoords[set])
                for (size_t i = 0; i < count; ++i) to->emplace_back(in.mTextureCoords[set][i].x, 1 - in.mTextureCoords[set][i].y);
        if (in.mColors[0])
            for (size_t i = 0; i < count; ++i) out.colors.push_back(color(in.mColors[0][i]));
        out.indices.reserve(size_t(in.mNumFaces) * 3);
        for (unsigned f = 0; f < in.mNumFaces; ++f) {
            const aiFace& face = in.mFaces[f];
            for (unsigned k = 0; k < face.mNumIndices; ++k)
                if (face.mIndices[k] >= count)
                    fail(name + " has index " + std::to_string(face.mIndices[k]) + ", but only " + std::to_string(count) + " vertices");
            if (face.mNumIndices < 3) ++left_out_;
            else if (face.mNumIndices == 3) out.indices.insert(out.indices.end(), face.mIndices, face.mIndices + 3);
            else cut(face, out);
        }
        skinned_ += in.mNumBones > 0;
        morphed_ += in.mNumAnimMeshes > 0;
        weld(out);
        return out;
    }

    // assimp could do this, but not rightly: it cuts an L so that triangles lie outside of it.
    void cut(const aiFace& face, Primitive& out) {
        corners_.clear(), triangles_.clear();
        for (unsigned k = 0; k < face.mNumIndices; ++k) corners_.push_back(out.positions[face.mIndices[k]]);
        triangulate(corners_, triangles_);
        for (uint32_t k : triangles_) out.indices.push_back(face.mIndices[k]);
    }

    glm::vec4 color(const aiColor4D& c) const {
        glm::vec4 out(c.r, c.g, c.b, c.a);
        if (!options_.linear_colors)
            for (int i = 0; i < 3; ++i) out[i] = linear_of_srgb(out[i]);
        return out;
    }

    // Nodes that show the same meshes share one. Depth-first in the file's order, with a stack of its own.
    void walk() {
        std::map<std::vector<unsigned>, uint32_t> known;
        std::vector<std::pair<const aiNode*, glm::dmat4>> stack;
        if (in_.mRootNode) stack.emplace_back(in_.mRootNode, glm::dmat4(1));
        while (!stack.empty()) {
            const auto [node, parent] = stack.back();
            stack.pop_back();
            const glm::dmat4 to_world = parent * matrix(node->mTransformation);
            places_.try_emplace(node->mName.C_Str(), to_world);
            if (node->mNumMeshes) {
                const std::vector<unsigned> numbers(node->mMeshes, node->mMeshes + node->mNumMeshes);
                const auto [at, fresh] = known.try_emplace(numbers, uint32_t(out_.meshes.size()));
                if (fresh) add_mesh(*node, numbers);
                out_.instances.push_back({at->second, glm::mat4(to_world)});
            }
            for (unsigned c = node->mNumChildren; c-- > 0;) stack.emplace_back(node->mChildren[c], to_world);
        }
        for (unsigned c = 0; c < in_.mNumCameras; ++c) add_camera(*in_.mCameras[c]);
        for (unsigned l = 0; l < in_.mNumLights; ++l) add_light(*in_.mLights[l]);
    }

    void add_mesh(const aiNode& node, const std::vector<unsigned>& numbers) {
        Mesh mesh;
        const bool named = numbers.size() == 1 && numbers[0] < in_.mNumMeshes && in_.mMeshes[numbers[0]]->mName.length > 0;
        mesh.name = named ? in_.mMeshes[numbers[0]]->mName.C_Str() : node.mName.C_Str();
        for (unsigned m : numbers) {
            if (m >= primitives_.size()) fail("a node shows mesh " + std::to_string(m) + ", which does not exist");
            mesh.primitives.push_back(primitives_[m]);
        }
        out_.meshes.push_back(std::move(mesh));
    }

    glm::dmat4 place_of(const aiString& name) const {
        const auto found = places_.find(name.C_Str());
        return found == places_.end() ? glm::dmat4(1) : found->second;
    }

    void add_camera(const aiCamera& in) {
        const glm::dmat4 node = place_of(in.mName);
        const auto turned = [&](const aiVector3D& v) { return glm::dvec3(node * glm::dvec4(vector(v), 0)); };
        const glm::dvec3 back = glm::normalize(-turned(in.mLookAt)), right = glm::normalize(glm::cross(turned(in.mUp), back));
        const glm::dvec3 eye(node * glm::dvec4(vector(in.mPosition), 1));
        const double aspect = in.mAspect > 0 ? double(in.mAspect) : 16.0 / 9, tangent = std::tan(double(in.mHorizontalFOV) / 2) / aspect;
        Camera out;
        out.name = in.mName.C_Str();
        out.yfov = float(2 * std::atan(tangent));
        if (in.mAspect == 0 && in.mHorizontalFOV < 0.02f) out.yfov = Camera().yfov, ++angles_;  // of Collada's without a name assimp reads none
        out.to_world = glm::mat4(glm::dmat4(glm::dvec4(right, 0), glm::dvec4(glm::cross(back, right), 0), glm::dvec4(back, 0), glm::dvec4(eye, 1)));
        const double sum = glm::dot(right, glm::dvec3(1)) + glm::dot(back, glm::dvec3(1)) + glm::dot(eye, glm::dvec3(1));
        if (!std::isfinite(sum) || !(out.yfov > 1e-3f && out.yfov < 3.14f)) ++cameras_;  // parallel ones among them
        else out_.cameras.push_back(out);
    }

    void add_light(const aiLight& in) {
        const glm::dmat4 node = place_of(in.mName);
        Light out;
        out.name = in.mName.C_Str();
        if (in.mType == aiLightSource_DIRECTIONAL) out.type = Light::Type::directional;
        else if (in.mType == aiLightSource_SPOT) out.type = Light::Type::spot;
        else if (in.mType != aiLightSource_POINT) {
            ++lights_;
            return;
        }
        out.position = glm::vec3(node * glm::dvec4(vector(in.mPosition), 1));
        if (out.type != Light::Type::point) out.direction = glm::vec3(glm::normalize(glm::dvec3(node * glm::dvec4(vector(in.mDirection), 0))));
        out.intensity = {in.mColorDiffuse.r, in.mColorDiffuse.g, in.mColorDiffuse.b};
        // Both angles are whole in assimp and halves in glTF.
        out.outer_cone = std::clamp(in.mAngleOuterCone / 2, 1e-3f, 1.5707963f);
        out.inner_cone = std::clamp(in.mAngleInnerCone / 2, 0.0f, out.outer_cone);
        const float sum = glm::dot(out.position + out.direction + out.intensity, glm::vec3(1));
        const bool sane = glm::all(glm::greaterThanEqual(out.intensity, glm::vec3(0))) && glm::all(glm::lessThanEqual(out.intensity, glm::vec3(float(gltf::limits::light))));
        if (!std::isfinite(sum) || !sane || !(out.outer_cone > 0)) ++lights_;
        else out_.lights.push_back(out);
    }

    void report() {
        const auto say = [&](size_t count, const char* what) {
            if (count) out_.warnings.push_back(std::to_string(count) + " " + what + ".");
        };
        say(left_out_, "points and lines were left out");
        say(skinned_, "meshes with bones are shown in their rest pose");
        say(morphed_, "meshes with morph targets are shown in their base shape");
        say(cameras_, "cameras that are not perspective were left out");
        say(angles_, "cameras have no angle that could be read and got one of 46 degrees");
        say(lights_, "lights that are not point, spot or directional, or have bad numbers, were left out");
        if (in_.mNumAnimations) out_.warnings.push_back("animations are ignored.");
    }

    const aiScene& in_;
    const std::string& path_;
    const GeometryOptions options_;
    Scene& out_;
    std::vector<Primitive> primitives_;
    std::vector<glm::vec3> corners_;    // of one polygon
    std::vector<uint32_t> triangles_;   // likewise
    std::map<std::string, glm::dmat4> places_;  // of nodes, by name: cameras and lights refer to them so
    size_t left_out_ = 0, skinned_ = 0, morphed_ = 0, cameras_ = 0, angles_ = 0, lights_ = 0;
};

}  // namespace

void add_geometry(const aiScene& in, const std::string& path, const GeometryOptions& options, Scene& out) { Geometry(in, path, options, out).run(); }

}  // namespace myriad::scenes::importing
