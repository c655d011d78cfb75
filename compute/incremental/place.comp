#version 460
#extension GL_GOOGLE_include_directive : require
// Book-keeping of the carried list's places. After "update", the kept count is the number of items dropped: they are holes now. After the last
// step it is the number of blocks opened, which went into holes first; the list's length takes its place, for those who draw the cut.
#include "compute/incremental/incremental_io.h"
layout(local_size_x = 1) in;
layout(push_constant, scalar) uniform Push { PlacePush push; };

void main() {
    CarriedState s = push.memory.at[0].state.at[0];
    AppendState lists = push.lists.at[0];
    if (push.close == 0u) {
        s.dropped = lists.kept;
        s.holes += lists.kept;
        s.invalid = 0u;
        lists.kept = 0u;
        lists.kept_needed = 0u;
    } else {
        s.look = 0u;
        s.made = lists.kept;
        const uint filled = min(s.made, s.holes);
        s.holes -= filled;
        s.items += s.made - filled;
        lists.kept = s.items;
        lists.kept_needed = s.items;
        if (s.items > push.capacity) lists.failed |= append_kept_overflow;
    }
    push.memory.at[0].state.at[0] = s;
    push.lists.at[0] = lists;
}
