// Triangles that are there in part, for tests: materials of all kinds over a mesh. Tests only.
#pragma once

#include <random>

#include "compute/raytrace/bvh.hpp"
#include "engine/transfer.hpp"

namespace myriad::compute {

struct OpacityScene {
    std::vector<vec3> positions;
    std::vector<uvec4> triangles;
    std::vector<vec2> texcoords, texcoords1;
    std::vector<vec4> colors;
    std::vector<OpacityMaterial> materials;
    std::vector<uint> texels;

    std::vector<Instance> instances;  // empty: nothing is shared

    Opacity opacity() const { return {triangles, texcoords, texcoords1, colors, materials, texels}; }
    WorldTriangles world() const { return {positions, triangles, instances, opacity()}; }

    // A texture of noise in all channels, or of one alpha.
    TextureRef texture(uint width, uint height, std::mt19937& random, uint use, int alpha = -1) {
        const TextureRef t{uint(texels.size()), width, height, use, {1, 0}, {0, 1}, {0, 0}};
        for (uint i = 0; i < width * height; ++i) texels.push_back(alpha < 0 ? uint(random()) : (uint(random()) & 0xffffffu) | uint(alpha) << 24);
        return t;
    }
    uint material(const OpacityMaterial& m) {
        materials.push_back(m);
        return uint(materials.size() - 1);
    }
    void triangle(const vec3 (&p)[3], const vec2 (&uv)[3], uint material) {
        const uint n = uint(positions.size());
        for (int k = 0; k < 3; ++k) positions.push_back(p[k]), texcoords.push_back(uv[k]);
        triangles.push_back({n, n + 1, n + 2, material});
    }
    // A square of side 2 in the plane z, textured once.
    void square(float z, uint material) {
        triangle({{-1, -1, z}, {1, -1, z}, {1, 1, z}}, {{0, 1}, {1, 1}, {1, 0}}, material);
        triangle({{-1, -1, z}, {1, 1, z}, {-1, 1, z}}, {{0, 1}, {1, 0}, {0, 0}}, material);
    }

    // The first half becomes a mesh that stands in three places, one of them mirrored, between what is stored in world space.
    void share(std::mt19937& random) {
        std::uniform_real_distribution<float> unit(-1, 1);
        const uint half = uint(triangles.size() / 2), rest = uint(triangles.size()) - half, quarter = rest / 2;
        const auto place = [&](uint first, uint count, float scale, vec3 at, uint flags) {
            const uint id = instances.empty() ? 0 : instances.back().first_id + instances.back().count;
            const float x = flags == instance_mirrored ? -scale : scale;
            instances.push_back({{x, 0.1f, 0}, {0, scale, 0}, {0.2f, 0, scale}, at, id, first, count, flags});
        };
        const auto anywhere = [&] { return 0.5f * vec3(unit(random), unit(random), unit(random)); };
        place(half, quarter, 1, vec3(0), instance_in_world);
        place(0, half, 0.7f, anywhere(), 0);
        place(0, half, 1.1f, anywhere(), instance_mirrored);
        place(half + quarter, rest - quarter, 1, vec3(0), instance_in_world);
        place(0, half, 0.9f, anywhere(), 0);
    }
    OpacityScene written_out() const {
        OpacityScene out;
        out.materials = materials, out.texels = texels;
        for (const Instance& i : instances)
            for (uint t = i.first_triangle; t < i.first_triangle + i.count; ++t) {
                const Corners c = instance_corners(i, world().stored(t));
                const uint n = uint(out.positions.size());
                out.positions.insert(out.positions.end(), {c.p0, c.p1, c.p2});
                uvec4 from = triangles[t];
                if (instance_swaps(i)) std::swap(from.y, from.z);
                for (int k = 0; k < 3; ++k) {
                    out.texcoords.push_back(texcoords[from[k]]), out.texcoords1.push_back(texcoords1[from[k]]);
                    out.colors.push_back(colors[from[k]]);
                }
                out.triangles.push_back({n, n + 1, n + 2, from.w});
            }
        return out;
    }

    // Every material there can be, over triangles at random.
    static OpacityScene soup(uint count, float size, std::mt19937& random) {
        std::uniform_real_distribution<float> unit(-1, 1);
        const auto point = [&] { return vec3(unit(random), unit(random), unit(random)); };
        OpacityScene s;
        s.material(Opacity::opaque());
        for (uint use = 0; use < 32; ++use) {  // both sets, all wraps
            if ((use & 3) == 3 || (use >> 2 & 3) == 3) continue;
            TextureRef t = s.texture(1 + uint(random() % 20), 1 + uint(random() % 20), random, use);
            if (use % 2) t.along_u = {unit(random), unit(random)}, t.along_v = {unit(random), unit(random)}, t.origin = {unit(random), unit(random)};
            s.material({t, 1, 0.5f});
            s.material({t, 0.9f, opacity_blended});
        }
        s.material({.alpha = 0.5f, .cutoff = 0.3f});
        s.material({.alpha = 0.3f, .cutoff = opacity_blended});
        for (uint i = 0; i < count; ++i) {
            const vec3 c = point();
            s.triangle({c + size * point(), c + size * point(), c + size * point()},
                       {3.0f * vec2(point()), 3.0f * vec2(point()), 3.0f * vec2(point())}, uint(random() % s.materials.size()));
        }
        for (size_t i = 0; i < s.positions.size(); ++i) {
            s.texcoords1.push_back(vec2(point()));
            s.colors.push_back(vec4(0.6f, 0.6f, 0.6f, random() % 4 ? 1.0f : 0.5f + 0.5f * unit(random)));
        }
        return s;
    }
};

// The same on the device, as Geometry has it in the product.
class DeviceOpacity {
public:
    DeviceOpacity(engine::Device& device, const OpacityScene& s)
        : triangles_(upload(device, s.triangles)), texcoords_(upload(device, s.texcoords)),
          texcoords1_(upload(device, s.texcoords1)), colors_(upload(device, s.colors)), materials_(upload(device, s.materials)),
          texels_(upload(device, s.texels)), instances_(upload(device, s.instances)) {
        engine::Recorder recorder(device);
        table_ = upload(device, std::vector<OpacityArrays>{table(recorder)});
    }
    DeviceOpacity(const DeviceOpacity&) = delete;

    OpacityReader reader() const {
        return [this](engine::Recorder& recorder) {
            table(recorder);
            return OpacityRef{recorder.read(table_)};
        };
    }

private:
    template <class T>
    static engine::Array<T> upload(engine::Device& device, const std::vector<T>& values) { return engine::upload(device, "test", "opacity", values); }
    OpacityArrays table(engine::Recorder& recorder) const {
        return {recorder.read(triangles_), recorder.read(texcoords_), recorder.read(texcoords1_), recorder.read(colors_),
                recorder.read(materials_), recorder.read(texels_), recorder.read(instances_), uint(instances_.count()), colors_.count() > 0};
    }

    engine::Array<uvec4> triangles_;
    engine::Array<vec2> texcoords_, texcoords1_;
    engine::Array<vec4> colors_;
    engine::Array<OpacityMaterial> materials_;
    engine::Array<uint> texels_;
    engine::Array<Instance> instances_;
    engine::Array<OpacityArrays> table_;
};

}  // namespace myriad::compute
