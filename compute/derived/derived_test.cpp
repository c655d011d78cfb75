#include "compute/derived/derived.hpp"

#include <filesystem>
#include <fstream>
#include <random>

#include "compute/opacity/opacity_testing.hpp"
#include "engine/temp_folder.hpp"
#include "engine/testing.hpp"
#include "engine/transfer.hpp"

namespace myriad::compute {
namespace {

namespace fs = std::filesystem;

struct Soup {
    std::vector<vec3> positions;
    std::vector<uvec4> triangles;
    std::vector<Instance> instances;
    explicit Soup(uint32_t count) {
        std::mt19937 random(count);
        std::uniform_real_distribution<float> number(-1, 1);
        for (uint32_t i = 0; i < 3 * count; ++i) positions.push_back({number(random), number(random), number(random)});
        for (uint32_t i = 0; i < count; ++i) triangles.push_back({3 * i, 3 * i + 1, 3 * i + 2, i % 3});
    }
    WorldTriangles world() const { return {positions, triangles, instances}; }
};

class DerivedTest : public engine::DeviceTest {
protected:
    // Bounds say all about the tree of rays and of samples, and where leaves are.
    struct Made {
        std::vector<SurfaceSample> samples;
        double area;
        float radius;
        uint64_t nodes, triangles, dropped, bytes;
        uint depth;
        bool operator==(const Made& o) const {
            return samples.size() == o.samples.size() && std::memcmp(samples.data(), o.samples.data(), samples.size() * sizeof(SurfaceSample)) == 0 &&
                   area == o.area && radius == o.radius && nodes == o.nodes && triangles == o.triangles && dropped == o.dropped && bytes == o.bytes &&
                   depth == o.depth;
        }
    };
    Made make(const Soup& soup, engine::Cache* cache, uint32_t log2_samples = 10, uint32_t seed = 1, BvhQuality quality = BvhQuality::quick) {
        Derived derived(soup.world(), cache);
        const Bvh bvh = derived.bvh(device, quality);
        const Bsh bsh = derived.bsh(device, log2_samples, seed);
        return {bsh.empty() ? std::vector<SurfaceSample>() : engine::download(device, bsh.samples()), bsh.area(), bsh.sample_radius(),
                bvh.nodes(), bvh.triangles(), bvh.dropped(), bvh.bytes(), bvh.depth()};
    }
    SurfaceSampling sampled(const Soup& soup, engine::Cache* cache) { return Derived(soup.world(), cache).samples(10, 1); }
    void made_opaque(const OpacityScene& scene, engine::Cache* cache) {
        EXPECT_FALSE(Derived(scene.world(), cache).bvh(device).asks());
    }
    const engine::TempFolder temporary;
    const fs::path& folder = temporary.path;
};

TEST_F(DerivedTest, is_the_same_made_stored_and_found) {
    for (const uint32_t count : {0, 1, 2, 1000}) {
        const Soup soup(count);
        engine::Cache cache(folder);
        const Made without = make(soup, nullptr), stored = make(soup, &cache);
        EXPECT_EQ(cache.found(), 0u);
        EXPECT_EQ(cache.missing(), 2u);
        const Made found = make(soup, &cache);
        EXPECT_EQ(cache.found(), 2u);
        EXPECT_TRUE(without == stored) << count;
        EXPECT_TRUE(without == found) << count;
    }
}

// The samples' order is that of the binary tree: what was kept of a tree of one arity serves all.
TEST_F(DerivedTest, trees_of_every_arity_share_an_entry) {
    const Soup soup(100);
    engine::Cache cache(folder);
    Derived derived(soup.world(), &cache);
    const Bsh eight = derived.bsh(device, 9, 1);
    for (const uint arity : {2u, 4u}) {
        const Bsh found = derived.bsh(device, 9, 1, arity), made = Derived(soup.world(), nullptr).bsh(device, 9, 1, arity);
        EXPECT_EQ(found.arity(), arity);
        EXPECT_EQ(found.shape().blocks, made.shape().blocks);
        const auto a = engine::download(device, found.samples()), b = engine::download(device, made.samples());
        EXPECT_EQ(std::memcmp(a.data(), b.data(), a.size() * sizeof(SurfaceSample)), 0);
    }
    EXPECT_EQ(cache.missing(), 1u);
    EXPECT_EQ(cache.found(), 2u);
}

TEST_F(DerivedTest, samples_without_a_tree) {
    for (const uint32_t count : {0, 1000}) {
        const Soup soup(count);
        engine::Cache cache(folder);
        const SurfaceSampling without = sampled(soup, nullptr), stored = sampled(soup, &cache), found = sampled(soup, &cache);
        EXPECT_EQ(cache.missing(), 1u);
        EXPECT_EQ(cache.found(), 1u);
        for (const SurfaceSampling* s : {&stored, &found}) {
            EXPECT_TRUE(s->area == without.area && s->radius == without.radius && s->samples.size() == without.samples.size());
            EXPECT_EQ(std::memcmp(s->samples.data(), without.samples.data(), without.samples.size() * sizeof(SurfaceSample)), 0);
        }
    }
}

TEST_F(DerivedTest, whatever_it_is_made_of_and_by_makes_another) {
    engine::Cache cache(folder);
    const Soup soup(100);
    make(soup, &cache);
    const auto misses = [&](const Soup& other, uint32_t log2_samples = 10, uint32_t seed = 1, BvhQuality quality = BvhQuality::quick) {
        const uint64_t before = cache.missing();
        make(other, &cache, log2_samples, seed, quality);
        return cache.missing() - before;
    };
    EXPECT_EQ(misses(soup), 0u);
    EXPECT_EQ(misses(soup, 9), 1u);
    EXPECT_EQ(misses(soup, 10, 2), 1u);
    EXPECT_EQ(misses(soup, 10, 1, BvhQuality::best), 1u);
    Soup moved = soup;
    moved.positions[17].y = std::nextafter(moved.positions[17].y, 2.0f);
    EXPECT_EQ(misses(moved), 2u);
    Soup reordered = soup;
    std::swap(reordered.triangles[3], reordered.triangles[4]);
    EXPECT_EQ(misses(reordered), 2u);
    Soup shared = soup;
    shared.instances = {{{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0, 0, 0}, 0, 0, 100, 0}};
    EXPECT_EQ(misses(shared), 2u);
    Soup elsewhere = shared;
    elsewhere.instances[0].at.x = 5;
    EXPECT_EQ(misses(elsewhere), 2u);
}

// Cut-outs: what is found asks as what was made did, and another alpha, which moves no triangle, makes another.
TEST_F(DerivedTest, alpha_is_part_of_it) {
    std::mt19937 random(5);
    OpacityScene scene = OpacityScene::soup(500, 0.5f, random);
    const DeviceOpacity opacity(device, scene);
    engine::Cache cache(folder);
    const auto made = [&] {
        Derived derived(scene.world(), &cache);
        const Bvh bvh = derived.bvh(device, BvhQuality::quick, opacity.reader());
        EXPECT_TRUE(bvh.asks());
        return engine::download(device, derived.bsh(device, 10, 1).samples());
    };
    const auto first = made(), found = made();
    EXPECT_EQ(cache.found(), 2u);
    EXPECT_EQ(std::memcmp(first.data(), found.data(), first.size() * sizeof(SurfaceSample)), 0);
    const OpacityScene was = scene;
    uint64_t missing = cache.missing();
    const auto changed = [&](const char* what) {
        made();
        EXPECT_EQ(cache.missing(), missing += 2) << what;
        scene = was;
    };
    scene.materials[3].cutoff = 0.4f, changed("cutoff");
    scene.texels[7] ^= 1u << 24, changed("texel");
    scene.colors[5].a *= 0.5f, changed("colour");
    scene.texcoords[8].x += 0.1f, changed("first set");
    scene.texcoords1[8].x += 0.1f, changed("second set");

    for (OpacityMaterial& m : scene.materials) m.cutoff = 0;  // opaque: nothing of it matters
    made_opaque(scene, &cache);
    missing = cache.missing();
    scene.texels[7] ^= 1u << 24;
    made_opaque(scene, &cache);
    EXPECT_EQ(cache.missing(), missing);
}

TEST_F(DerivedTest, damaged_entries_are_made_anew) {
    const Soup soup(300);
    engine::Cache cache(folder);
    const Made first = make(soup, &cache);
    for (const auto& file : fs::directory_iterator(folder)) {
        std::fstream entry(file.path(), std::ios::in | std::ios::out | std::ios::binary);
        entry.seekp(200), entry.put('!');
    }
    EXPECT_TRUE(make(soup, &cache) == first);
    EXPECT_EQ(cache.damaged(), 2u);
    EXPECT_TRUE(make(soup, &cache) == first);
    EXPECT_EQ(cache.found(), 2u);
}

}  // namespace
}  // namespace myriad::compute
