// Random numbers of a path: Owen-scrambled Sobol points, pairs of dimensions padded, each in an order of its own (Burley, "Practical Hash-based
// Owen Scrambling", 2020; the scrambling hash is Vegdahl's, 2021). Sample i of a pixel depends on seed, pixel and i alone, so any number of
// samples can be added later, by any thread; each power of two of them is well spread in every pair.
#pragma once

#include <cstdint>

#include <glm/glm.hpp>

namespace myriad::reference {

class Sampler {
public:
    Sampler(uint32_t seed, uint32_t pixel, uint32_t sample) : key_(mixed(mixed(seed) ^ pixel)), sample_(sample) {}

    // The next pair of dimensions, in [0, 1).
    glm::vec2 pair() {
        const uint32_t key = next();
        const uint32_t index = scrambled(reversed(sample_), key);  // the sequence, shuffled for this pair
        return {unit(scrambled(index, mixed(key ^ 1))), unit(scrambled(reversed(second(index)), mixed(key ^ 2)))};
    }
    float one() { return pair().x; }
    // Bits of this sample, for decisions that need no stratification.
    uint32_t dice() { return mixed(next() ^ mixed(sample_ + 0x9e3779b9u)); }

    // A hash of 32 bits onto themselves (Wellons' lowbias32).
    static uint32_t mixed(uint32_t x) {
        x = (x ^ x >> 16) * 0x21f0aaadu;
        x = (x ^ x >> 15) * 0xd35a2d97u;
        return x ^ x >> 15;
    }
    static float unit(uint32_t bits) { return float(bits >> 8) * 0x1p-24f; }

private:
    uint32_t next() { return mixed(key_ + 0x9e3779b9u * ++dimension_); }

    static uint32_t reversed(uint32_t x) {
        x = __builtin_bswap32(x);
        x = (x & 0x0f0f0f0fu) << 4 | (x >> 4 & 0x0f0f0f0fu);
        x = (x & 0x33333333u) << 2 | (x >> 2 & 0x33333333u);
        return (x & 0x55555555u) << 1 | (x >> 1 & 0x55555555u);
    }
    // Owen's scrambling of a number that is given with its bits in reverse: each bit is flipped, or not, by those above it.
    static uint32_t scrambled(uint32_t x, uint32_t key) {
        x ^= x * 0x3d20adeau;
        x += key;
        x *= key >> 16 | 1;
        x ^= x * 0x05526c56u;
        x ^= x * 0x53a22864u;
        return reversed(x);
    }
    // Sobol's second dimension; its first is the index itself, in reverse.
    static uint32_t second(uint32_t index) {
        uint32_t point = 0;
        for (uint32_t column = 1u << 31; index; index >>= 1, column ^= column >> 1)
            if (index & 1) point ^= column;
        return point;
    }

    uint32_t key_, sample_, dimension_ = 0;
};

}  // namespace myriad::reference
