// What is on the tea table, and around it. Each piece stands on y = 0 around its own origin unless it says otherwise;
// `detail` scales the tessellation. Metres.
#pragma once

#include "scenes/builtin/curves.hpp"
#include "scenes/builtin/textures.hpp"

namespace myriad::scenes::teatime {

using kit::steps;

// Two primitives a piece of china: what the ornament is painted on, whose texture coordinates run around (u) and up (v)
// once, and the plain rest.
struct China {
    Primitive painted, plain;
};
void teapot(China& out, float detail);      // spout towards +x
void cup(China& out, float detail);         // handle towards +x
void creamer(China& out, float detail);     // lip towards +x
void sugar_bowl(China& out, float detail);
void plate(China& out, float radius, float detail);  // its well is at 0.17 of its radius below the rim
void liquid(Primitive& out, float radius, float height, float detail);
inline constexpr float tea_height = 0.046f, tea_radius = 0.0402f;  // in a cup

// Along +x, bowl at the origin, lying on y = 0.
void spoon(Primitive& silver, float detail);
void cake_knife(Primitive& silver, Primitive& handle, float detail);

// Sweets. The cake has lost a slice between the angles 0 and `cut`; the slice is the part between -cut/2 and cut/2.
struct Cake {
    Primitive icing, inside, cream, berries, leaves;
};
void cake(Cake& out, float cut, float detail);
void slice(Cake& out, float cut, float detail);
void cupcake(Primitive& paper, Primitive& icing, Primitive& berry, float detail);
void macaron(Primitive& shells, Primitive& filling, float detail);
void biscuit(Primitive& out, float detail);
void cake_stand(China& out, float radius, float height, float detail);  // a plate on a foot; its surface is at `height`
struct Stand {
    float radius, height;  // of a tier's plate
};
void tiered_stand(China& china, Primitive& silver, const std::vector<Stand>& tiers, float detail);

// Flowers stand in the vase; `count` of them.
struct Bouquet {
    Primitive vase, stems, petals, hearts;
};
void bouquet(Bouquet& out, int count, kit::Random& random, float detail);

// A square cloth of `side` on a round table of `radius` whose top is at y = 0, hanging to all sides in folds. Texture
// coordinates: 0 to 1 over the square.
void tablecloth(Primitive& out, float radius, float side, uint32_t seed, float detail);
void napkin(Primitive& out, float side, float detail);  // folded to a triangle

void table(Primitive& wood, float radius, float height, float detail);  // the cloth's underside touches its top
void chair(Primitive& wood, Primitive& cane, float detail);           // bentwood; looks towards +z
void picture_frame(Primitive& gold, Primitive& canvas, float width, float height, float detail);  // on the wall z = 0, around the origin
void sideboard(Primitive& wood, Primitive& brass, float width, float height, float depth, float detail);  // back at z = 0, front towards +z
void books(Scene& scene, const std::vector<uint32_t>& covers, uint32_t paper, const glm::mat4& at, float width, kit::Random& random);
void clock(Primitive& wood, Primitive& face, Primitive& hands, float detail);  // looks towards +z

// Textures.
Texture ornament(const char* name, uint32_t repeats, glm::vec3 ink, uint32_t seed);  // for painted china
Texture tablecloth_linen(uint32_t seed);
Texture wallpaper(uint32_t seed);
Texture carpet(uint32_t seed);
Texture landscape(uint32_t seed);
Texture garden(uint32_t seed);       // what is outside: leaves below, sky above
Texture cut_cake(uint32_t seed);     // u: from the middle outwards, v: upwards
Texture clock_face();

}  // namespace myriad::scenes::teatime
