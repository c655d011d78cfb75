// Which light is chosen, of a table whose shares add up to 1. Include it after share_end(light), the end of a light's share.

// The first light whose share ends beyond `selection`. A light without power has none.
uint light_for(float selection, uint lights) {
    uint low = 0u;
    uint high = lights - 1u;
    while (low < high) {
        const uint middle = (low + high) / 2u;
        if (share_end(middle) > selection) high = middle;
        else low = middle + 1u;
    }
    return low;
}
