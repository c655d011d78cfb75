// What the camera sees, drawn from its cut through the tree of samples; see README.md.
#pragma once

#include <memory>
#include <optional>

#include "compute/append/grid.hpp"
#include "compute/manylods/manylods.hpp"
#include "passes/geometry/geometry.hpp"
#include "passes/points/points_io.h"
#include "passes/points/points_cells.hpp"

namespace myriad::passes {

struct PointsSettings {
    float pixels = 1;           // c: the largest diameter of an inner node that is drawn
    compute::AppendMode append = compute::AppendMode::scan;
    uint64_t capacity = 0;      // of the lists to begin with; 0: found by the pass
    uint32_t lanes = 0;         // invocations that draw a group: 1, 8, 64 …; 0: what the device needs
};

struct PointsCounters {
    uint64_t node_views = 0;    // tested
    uint64_t cut = 0;           // of those, in the cut, culled ones included
    uint64_t drawn = 0;         // of those, not culled: points
    uint64_t groups = 0;        // that hold them
    uint64_t list_peak = 0, list_capacity = 0;
    uint32_t redone = 0;        // times that lists were too short
};

class PointsPass {
public:
    // Tree and geometry are those that are drawn, and must outlive this; `world`, the triangles, need not. `variant`: specialisation constants that
    // the scene needs of kernels. Throws InputError for pictures that the device cannot draw (a driver that limits loops).
    PointsPass(engine::Device& device, const PointsSettings& settings, const compute::Bsh& tree, const Geometry& geometry, const compute::WorldTriangles& world,
               uint32_t width, uint32_t height, const engine::Constants& variant = {});

    // The point of a triangle that each pixel sees, as "gbuffer/trace" says it: a record a pixel.
    void record(engine::Recorder& recorder, const CameraPush& camera, const engine::Array<RayHitRecord>& hits);

    // After the submission: whether the lists sufficed. If not they are longer now, and all is to be recorded again.
    bool accept();

    PointsCounters take_counters() { return std::exchange(counters_, {}); }

    // For tests: PointsSplatPush::pixels of the last record, and its cut.
    const engine::Array<uint>& pixels() const { return pixels_; }
    const compute::AppendLists& lists() const { return *lists_; }

private:
    PointsScene read_scene(engine::Recorder& recorder) const;
    void make_lists(uint64_t capacity);
    void upload_cells();

    engine::Device& device_;
    PointsSettings settings_;
    const compute::Bsh& tree_;
    const Geometry& geometry_;
    uint32_t width_, height_, lanes_;
    bool asks_, instanced_;
    compute::ManyLods manylods_;
    engine::Program view_, depths_, whats_, resolve_;
    compute::Grid grid_;
    std::optional<compute::AppendLists> lists_;
    engine::Array<View> views_;
    engine::Array<uint> count_, pixels_, drawn_, first_;
    engine::Array<uvec4> cell_;
    PointsCells cells_;
    std::vector<SurfaceSample> samples_;  // as the tree had them when `cells_` were made
    uint rebuilds_ = 0;                   // likewise
    engine::Array<PointsScene> scene_;
    PointsCounters counters_;
};

}  // namespace myriad::passes
