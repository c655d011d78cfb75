// Materials of fixed-function days, and of those after, as glTF's: colour, metal, roughness, emission, alpha.
#pragma once

#include <map>
#include <set>
#include <string>
#include <tuple>
#include <vector>

#include <assimp/material.h>
#include <assimp/scene.h>

#include "scenes/import/folder.hpp"
#include "scenes/scene.hpp"

namespace myriad::scenes::importing {

// - Base colour: the PBR one, else the diffuse one; a metal (black diffuse, bright specular) takes its specular colour.
// - Roughness: the PBR one, else from the Phong exponent n: the fourth root of 2 / (n + 2).
// - Alpha: opacity, and the texture for it, or the alpha of a colour texture in PNG or GIF. Masked where alpha is all or
//   nothing, blended otherwise.
// - Separate textures for metal and roughness, colour and opacity become one each.
// All are double-sided: these formats do not know that a side could be missing.
class Materials {
public:
    // `linear`: colours are linear already.
    Materials(const aiScene& in, Folder& folder, bool linear, Scene& out);

    // Appends material `index` of the file to the scene. Colours of a mesh that has some are not darkened by the grey
    // that readers give to what has no material.
    void add(const aiMaterial& material, bool has_colors);

    // What was left out, a sentence each.
    void report(std::vector<std::string>& warnings) const;

private:
    struct Picture {
        Texture texture;          // without its wrapping; no pixels where it cannot be had
        bool shows_alpha = false; // PNG and GIF: alpha means transparency
    };
    struct Slot {
        const Picture* picture = nullptr;
        TextureUse use;
        Texture::Wrap wrap_u = Texture::Wrap::repeat, wrap_v = Texture::Wrap::repeat;
        explicit operator bool() const { return picture; }
    };

    glm::vec3 color(const aiColor3D& c) const;
    const Picture& picture(const std::string& name);
    Slot slot(const aiMaterial& material, std::initializer_list<aiTextureType> types);
    TextureUse use(const Slot& slot);
    TextureUse use(const Slot& slot, Texture made, const std::string& key);
    void add_alpha(const aiMaterial& material, Material& out, const Slot& base);
    void add_metal_and_roughness(const aiMaterial& material, Material& out);

    const aiScene& in_;
    Folder& folder_;
    const bool linear_;
    Scene& out_;
    std::map<std::string, Picture> pictures_;                  // by file or place in the scene
    std::map<std::tuple<std::string, int, int>, uint32_t> textures_;  // by what they were made of, and their wrapping
    std::set<std::string> missing_, undecoded_;
    size_t bumps_ = 0, other_sets_ = 0;
};

}  // namespace myriad::scenes::importing
