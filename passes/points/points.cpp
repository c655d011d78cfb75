#include "passes/points/points.hpp"

#include <algorithm>

#include "compute/views/pinhole.h"
#include "engine/transfer.hpp"
#include "passes/kernels.hpp"

namespace myriad::passes {

using compute::AppendLists;
using engine::passes_kernels;

namespace {

engine::Constants with(engine::Constants constants, uint32_t id, uint32_t value) {
    constants[id] = value;
    return constants;
}

// The kernels' that walk the tree.
engine::Constants with_arity(engine::Constants constants, const compute::Bsh& tree) {
    for (const auto& [id, value] : compute::bsh_constants(tree.arity())) constants[id] = value;
    return constants;
}

bool is_set(const engine::Constants& constants, uint32_t id) {
    const auto at = constants.find(id);
    return at != constants.end() && at->second != 0;
}

}  // namespace

// A leaf around the eye may scan the whole picture. Where an invocation's loops are limited it draws one node, and every eighth row.
PointsPass::PointsPass(engine::Device& device, const PointsSettings& settings, const compute::Bsh& tree, const Geometry& geometry,
                       const compute::WorldTriangles& world, uint32_t width, uint32_t height, const engine::Constants& variant)
    : device_(device), settings_(settings), tree_(tree), geometry_(geometry), width_(width), height_(height),
      lanes_(settings.lanes ? settings.lanes : device.loop_limit() == ~0u ? 1 : 64), asks_(is_set(variant, trace_asks_constant)), instanced_(geometry.instances() != nullptr),
      manylods_(device, with_arity({{pinhole_constant, true}}, tree)), view_(device, passes_kernels, "points/view"),
      depths_(device, passes_kernels, "points/splat", with_arity(with(with(variant, 2, false), 3, lanes_), tree)),
      whats_(device, passes_kernels, "points/splat", with_arity(with(with(variant, 2, true), 3, lanes_), tree)), resolve_(device, passes_kernels, "points/resolve", with_arity(variant, tree)),
      grid_(device), views_(device, "views", "camera view", 1), count_(device, "views", "camera view count", 1),
      pixels_(device, "images", "what pixels see of points", 2 * uint64_t(width) * height + 1),
      drawn_(device, "images", "points drawn", 1, engine::Location::host) {
    if (device.loop_limit() != ~0u && uint64_t(width) * ((height + 7) / 8) > device.loop_limit() - 1024)
        throw InputError("--primary points at " + std::to_string(width) + "x" + std::to_string(height) + ": this driver limits loops, so that " +
                         "pictures have at most " + std::to_string(8 * (device.loop_limit() - 1024)) + " pixels; give a smaller --size, or --primary rays");
    if (std::max(width, height) >= 1 << 16) throw InputError("--primary points: pictures have less than 65536 pixels a side; give a smaller --size, or --primary rays");
    if (tree.empty()) return;
    samples_ = engine::download(device, tree.samples());
    rebuilds_ = tree.rebuilds();
    cells_ = points_cells(world, samples_, tree.sample_share());
    first_ = {device, "scene", "cells of leaves, by leaf", cells_.first.size()};
    cell_ = {device, "scene", "cells of leaves", cells_.cells.size()};
    upload_cells();
    engine::Recorder addresses(device);
    scene_ = engine::upload(device, "scene", "what points are made of", std::vector<PointsScene>{read_scene(addresses)});
    // A view has at most a group for each block. Guessed is what a picture of surfaces four deep needs, at nodes half as large as they may be.
    const double guess = 16.0 / (double(settings.pixels) * settings.pixels) * width * height;
    const uint64_t blocks = tree.blocks() + 1;
    make_lists(settings.capacity ? settings.capacity : std::min<uint64_t>(blocks, std::max<uint64_t>(uint64_t(std::min(guess, 1e12)), 1 << 16)));
}

void PointsPass::upload_cells() {
    engine::upload_bytes(device_, cells_.first.data(), first_, first_.bytes());
    if (cell_.count() > 0) engine::upload_bytes(device_, cells_.cells.data(), cell_, cell_.bytes());
}

void PointsPass::make_lists(uint64_t capacity) {
    lists_.reset();
    lists_.emplace(device_, settings_.append, capacity, capacity);
}

PointsScene PointsPass::read_scene(engine::Recorder& recorder) const {
    return {.samples = recorder.read(tree_.samples()),
            .triangles = recorder.read(geometry_.triangles()),
            .positions = recorder.read(geometry_.positions()),
            .instances = instanced_ ? recorder.read(*geometry_.instances()) : Instances{},
            .opacity = asks_ ? geometry_.opacity()(recorder) : OpacityRef{},
            .first = recorder.read(first_),
            .cells = recorder.read(cell_),
            .instance_count = instanced_ ? uint(geometry_.instances()->count()) : 0,
            .unused = 0};
}

void PointsPass::record(engine::Recorder& recorder, const CameraPush& camera, const engine::Array<RayHitRecord>& hits) {
    const uint64_t pixels = uint64_t(width_) * height_;
    assert(hits.count() == pixels);
    if (tree_.empty()) {
        recorder.fill(hits, ~0u);  // a miss, by its triangle
        return;
    }
    if (rebuilds_ != tree_.rebuilds()) {
        const std::vector<SurfaceSample> now = engine::download(device_, tree_.samples());
        cells_ = points_reorder(cells_, samples_, now);
        upload_cells();
        samples_ = now, rebuilds_ = tree_.rebuilds();
    }
    // Kernels find the scene's addresses in memory: they are declared all the same.
    const auto scene = [&] {
        read_scene(recorder);
        return recorder.read(scene_);
    };
    {
        auto scope = recorder.scope("points cut");
        recorder.dispatch(view_, PointsViewPush{.view = pinhole_view(camera.position, camera.right, camera.up, camera.forward, points_margin * tree_.sample_radius()),
                                                .views = recorder.write(views_), .count = recorder.write(count_)}, 1);
        manylods_.record(recorder, *lists_, {tree_, views_, count_, 0, 1, settings_.pixels, pinhole_size(width_, height_)});
    }
    {
        auto scope = recorder.scope("points splat");
        recorder.fill(pixels_, points_nothing, 0, pixels * sizeof(uint));
        recorder.fill(pixels_, ~0u, pixels * sizeof(uint), pixels * sizeof(uint));
        recorder.fill(pixels_, 0, 2 * pixels * sizeof(uint), sizeof(uint));
        for (const engine::Program* program : {&depths_, &whats_})
            grid_.dispatch(recorder, *program, lists_->state(), AppendLists::kept_word, lists_->kept_capacity(), lanes_, [&] {
                return PointsSplatPush{.camera = camera,
                                       .groups = recorder.read(lists_->kept()),
                                       .state = {recorder.read(lists_->state()).address},
                                       .scene = scene(),
                                       .pixels = recorder.write(pixels_),
                                       .tree = tree_.read(recorder),
                                       .width = width_,
                                       .height = height_};
            });
    }
    recorder.copy(pixels_, drawn_, sizeof(uint), 2 * pixels * sizeof(uint));
    auto scope = recorder.scope("points resolve");
    recorder.dispatch(resolve_,
                      PointsResolvePush{.camera = camera, .scene = scene(), .pixels = recorder.read(pixels_), .hits = recorder.write(hits),
                                        .tree = tree_.read(recorder), .width = width_, .height = height_},
                      pixels);
}

bool PointsPass::accept() {
    if (!lists_) return true;
    const compute::AppendReport report = lists_->report();
    counters_.list_peak = std::max({counters_.list_peak, report.next_needed, report.kept_needed});
    counters_.list_capacity = lists_->kept_capacity();
    if (!report.ok()) {
        ++counters_.redone;
        // An overflowed step hides what came after it; but no view has more groups, or nodes to open, than there are blocks.
        const uint64_t needed = std::max(report.next_needed, report.kept_needed);
        make_lists(std::min<uint64_t>(tree_.blocks() + 1, needed + needed / 4));
        return false;
    }
    counters_.node_views += report.processed;
    counters_.cut += report.processed - report.opened;
    counters_.groups += report.kept;
    counters_.drawn += drawn_.span()[0];
    return true;
}

}  // namespace myriad::passes
