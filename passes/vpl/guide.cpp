#include "passes/vpl/guide.hpp"

#include <algorithm>
#include <bit>

#include "engine/transfer.hpp"
#include "passes/kernels.hpp"

namespace myriad::passes {
namespace {

// 32 paths a cell while there are few lights, so that a cell knows its share to about a tenth; fewer from 16 lights on.
uint32_t samples_a_cell(uint32_t punctual) { return std::bit_floor(std::clamp(512 / std::max(punctual, 1u), 1u, 32u)); }

// Appends where each strip ends. Samples are multiples of 2^-24; with ends that are too, a strip's width is exactly the
// probability that a sample falls in it.
void append_ends(std::vector<float>& ends, std::span<const double> weights) {
    double total = 0, sum = 0;
    for (double weight : weights) total += weight;
    for (double weight : weights) ends.push_back(float(std::round((sum += weight) / total * 0x1p24) * 0x1p-24));
    ends.back() = 1;
}

std::vector<PilotTally> run_pilot(engine::Recorder& recorder, const Geometry& geometry, const compute::Bvh& bvh, const LightTable& lights,
                                  uint32_t seed, const engine::Constants& variant) {
    engine::Device& device = recorder.device();
    const uint32_t guided = lights.data().guided(), cells = guided * guide_cells, samples = samples_a_cell(guided);
    const engine::Array<PilotTally> tallies(device, "vpls", "pilot tallies", cells);
    if (cells > 0) {
        const engine::Program pilot(device, engine::passes_kernels, "vpl/pilot", variant);
        auto scope = recorder.scope("vpl pilot");
        recorder.fill(tallies, 0);
        recorder.dispatch(pilot,
                          VplPilotPush{.geometry = geometry.read(recorder), .bvh = bvh.read(recorder), .lights = lights.read(recorder),
                                       .tallies = recorder.write(tallies), .samples = samples, .paths = cells * samples, .seed = seed},
                          cells * samples);
    }
    recorder.submit_and_wait();
    return engine::download(device, tallies);
}

std::vector<float> shares_of(const std::vector<Light>& lights) {
    std::vector<float> shares;
    for (const Light& light : lights) shares.push_back(light.cdf);
    return shares;
}

std::vector<double> weights(const LightData& lights, const GuideData& guide) {
    std::vector<double> weights = lights.powers;
    for (size_t i = 0; i < weights.size(); ++i) weights[i] *= guide.worth[i];
    return weights;
}

}  // namespace

GuideData guide_data(const LightData& lights, std::span<const PilotTally> tallies, uint32_t samples) {
    GuideData guide{lights.lights, {}, std::vector<double>(lights.lights.size(), 1.0)};
    std::vector<double> cells(guide_cells);
    for (uint32_t light = 0; light < lights.guided(); ++light) {
        const std::span<const PilotTally> own = tallies.subspan(size_t(light) * guide_cells, guide_cells);
        double mean = 0;
        for (const PilotTally& t : own) mean += double(t.second) / samples / guide_cells;
        // A cell counts with one path of the mean besides its own, since few paths may all have been lucky, or unlucky.
        double sum = 0;
        for (uint32_t i = 0; i < guide_cells; ++i) sum += cells[i] = std::lerp(guide_floor, 1.0, (own[i].second + mean) / (samples + 1.0));
        guide.worth[light] = sum / guide_cells;

        std::vector<double> columns(guide_side);
        for (uint32_t i = 0; i < guide_cells; ++i) columns[i / guide_side] += cells[i];
        append_ends(guide.cells, columns);
        for (uint32_t c = 0; c < guide_side; ++c) append_ends(guide.cells, std::span(cells).subspan(c * guide_side, guide_side));
    }
    share_out(guide.lights, weights(lights, guide));
    return guide;
}

EmissionGuide::EmissionGuide(engine::Recorder& recorder, const Geometry& geometry, const compute::Bvh& bvh, const LightTable& lights,
                             uint32_t seed, const engine::Constants& variant)
    : device_(recorder.device()), data_(guide_data(lights.data(), run_pilot(recorder, geometry, bvh, lights, seed, variant), samples_a_cell(lights.data().guided()))),
      moves_(lights.moves()), shares_(engine::upload(recorder.device(), "vpls", "guided shares", shares_of(data_.lights))),
      cells_(engine::upload(recorder.device(), "vpls", "guide", data_.cells)) {}

void EmissionGuide::follow(const LightTable& lights) {
    if (lights.moves() == moves_) return;
    moves_ = lights.moves();
    move_lights(data_.lights, std::span(lights.data().lights).first(lights.punctual()), weights(lights.data(), data_));
    engine::upload_bytes(device_, shares_of(data_.lights).data(), shares_, shares_.bytes());
}

}  // namespace myriad::passes
