// Which lights paths start from, and where on them: by what a pilot found that their light can do; see README.md.
#pragma once

#include <span>

#include "compute/raytrace/bvh.hpp"
#include "passes/geometry/geometry.hpp"
#include "passes/geometry/lights.hpp"
#include "passes/vpl/vpl_io.h"

namespace myriad::passes {

// What a cell gets that lights nothing, of what one gets all of whose paths meet a second surface. Its inverse bounds how many
// times brighter than the others a VPL can be that the pilot did not foresee.
inline constexpr double guide_floor = 0.05;

struct GuideData {
    std::vector<Light> lights;  // as in the table, but for `cdf`, which is the guided choice; only that goes to the device
    std::vector<float> cells;   // guide_floats a light that is guided (LightData::guided)
    std::vector<double> worth;  // a light: what its power was multiplied by, the mean of its cells
};
// `tallies`: guide_cells a guided light, each of `samples` paths.
GuideData guide_data(const LightData& lights, std::span<const PilotTally> tallies, uint32_t samples);

class EmissionGuide {
public:
    // Runs the pilot, which submits what is recorded. The same scene and seed give the same guide.
    EmissionGuide(engine::Recorder& recorder, const Geometry& geometry, const compute::Bvh& bvh, const LightTable& lights, uint32_t seed,
                  const engine::Constants& variant = {});

    // Lights of the table have moved. They are guided as before: what the pilot found is a little out of date, but the pattern stays.
    void follow(const LightTable& lights);

    // By light: its share and those of all before it.
    Ref<float> shares(engine::Recorder& recorder) const { return recorder.read(shares_); }
    Ref<float> cells(engine::Recorder& recorder) const { return recorder.read(cells_); }
    const GuideData& data() const { return data_; }

private:
    engine::Device& device_;
    GuideData data_;
    uint32_t moves_;  // of the table, that it has followed
    engine::Array<float> shares_, cells_;
};

}  // namespace myriad::passes
