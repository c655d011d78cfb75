// The pieces of the cathedral. Each is built around its own origin and says where that is; walls face +z, which is the
// inside. `detail` scales the tessellation.
#pragma once

#include "scenes/builtin/curves.hpp"
#include "scenes/builtin/textures.hpp"

namespace myriad::scenes::cathedral {

using kit::Arch;
using kit::Opening;

// The building, in metres. x runs east along the nave, z south, y up; z = 0 is the axis.
inline constexpr float bay = 5.0f;
inline constexpr int bays = 6;
inline constexpr float nave_end = bay * float(bays);      // where the apse begins, and the centre of its polygon
inline constexpr float wall = 4.8f, wall_thick = 0.9f;     // the middle of the nave's walls
inline constexpr float outer = 9.8f, outer_thick = 0.8f;   // the middle of the aisles' walls
inline constexpr float pier_spring = 5.0f;                 // of arcade and aisle vaults
inline constexpr float triforium = 9.0f, clerestory = 11.6f, vault_spring = 11.0f, wall_top = 19.2f;
inline constexpr Arch nave_arch{4.45f, 7.6f}, aisle_arch{2.175f, 3.3f}, arcade_arch{1.85f, 2.9f};
inline constexpr Opening clerestory_window{{1.45f, 2.5f}, 12.2f, 15.0f}, aisle_window{{1.2f, 2.1f}, 2.3f, 5.2f}, apse_window{{0.95f, 1.75f}, 3.6f, 14.4f};
inline constexpr float rose_radius = 3.3f, rose_height = 12.6f;

using kit::steps;

// Hewn walls, which are textured; plain stone of mouldings and ribs; dark shafts; what is gilded.
struct Stone {
    Primitive wall, plain, dark, gilt;
};
void append(Stone& out, const Stone& in, const glm::mat4& to);

// A moulding (z, y) along x from -half to half, on a wall whose face is z = 0: string courses, sills.
void course(Primitive& out, const kit::Profile& profile, float half, int segments);

// A clustered pier of the nave on y = 0, with the shafts that rise from it to the high vault on its +z side.
void pier(Stone& out, float detail);
// Half a pier against an aisle's wall, whose face is z = 0.
void respond(Stone& out, float detail);
// A bundle of three shafts with a capital, from y0 to y1, before the wall z = 0.
void wall_shafts(Stone& out, float y0, float y1, float detail);

// One bay of the nave's wall above the piers, its middle at z = 0; one of an aisle's outer wall; one side of the apse,
// `width` wide.
void nave_bay(Stone& out, float detail);
void aisle_bay(Stone& out, float detail);
void apse_bay(Stone& out, float width, float thick, float detail);

// Web in `wall`, ribs and boss in `plain`; for the aisles also the transverse rib. Around the middle of the bay, at the
// springing.
void nave_vault(Stone& out, float detail);
void aisle_vault(Stone& out, float detail);
void apse_vault(Stone& out, float detail);
void transverse_rib(Primitive& out, float detail);

// Stone bars of a window of two lights under a round one, in the plane z = 0; x = 0 is its axis, y as in `opening`.
struct Tracery {
    Arch light;            // of each light, measured to the middle of its bars; they spring at opening.spring
    float light_x;         // where the lights' axes are: at -light_x and light_x
    glm::vec2 centre;      // of the round light, and its radius
    float radius;
};
Tracery tracery_of(const Opening& opening);
void tracery(Primitive& out, const Opening& opening, float detail);
void rose_tracery(Primitive& out, float detail);  // around the origin

// The wall at the west end over |x| <= half its width, with the rose and the door.
void west_wall(Stone& out, float half, float detail);

// Panes of coloured glass. A sheet in the plane z = 0; or louvres, see cathedral.cpp, whose planes contain `sun` and the
// direction x. Texture coordinates: 0 to 1 over the bounding rectangle of the opening.
void pane(Primitive& out, const Opening& opening, float detail);
void louvres(Primitive& out, const Opening& opening, glm::vec3 sun, float detail);
void rose_pane(Primitive& out, float detail);

// What glass shows, as radiance from 0 to 1. `warm` prefers reds and golds to blues, `pale` is mostly white.
enum class Glass { warm, cool, pale };
Texture window_glass(const char* name, const Opening& opening, Glass kind, uint32_t seed);
Texture rose_glass(uint32_t seed);

void pew(Primitive& wood, float length, float detail);
void altar(Primitive& stone, Primitive& cloth, Primitive& gold, Primitive& flames, float detail);

}  // namespace myriad::scenes::cathedral
