#include "compute/incremental/incremental.hpp"

#include <algorithm>

#include "compute/kernels.hpp"

namespace myriad::compute {

using engine::compute_kernels;

namespace {

constexpr uint64_t carried_words = sizeof(CarriedState) / sizeof(uint);

}  // namespace

BoundsTravel::BoundsTravel(engine::Device& device, uint arity)
    : device_(device), shift_(device, compute_kernels, "incremental/shift", bsh_constants(arity)) {}

void BoundsTravel::record(engine::Recorder& recorder, const Bsh& tree) {
    if (tree.empty() || tree.bounds_version() == seen_) return;
    const bool all = since_ == 0 || tree.all_bounds_version() > seen_;
    const uint32_t blocks = tree.blocks() + 1;  // with the one over the root
    const uint32_t visited = all ? blocks : tree.moving_blocks();
    if (since_ == 0) {
        since_ = tree.bounds_version();
        if (ways_.count() != blocks) {
            frames_ = {device_, "lists", "frames before", blocks};
            spheres_ = {device_, "lists", "spheres before", tree.slots()};
            ways_ = {device_, "lists", "ways of blocks", blocks};
        }
    }
    seen_ = tree.bounds_version();
    const BshRef now = tree.read(recorder);
    recorder.dispatch(shift_,
                      ShiftPush{.listed = all ? Uints{} : recorder.read(tree.moving()), .frames = now.frames, .spheres = now.spheres,
                                .frames_before = recorder.write(frames_), .spheres_before = recorder.write(spheres_),
                                .ways = recorder.write(ways_), .count = visited, .all = all ? 1u : 0u,
                                .first = seen_ == since_ ? 1u : 0u, .version = uint(seen_)},
                      visited);
}

CarriedCut::CarriedCut(engine::Device& device, AppendMode mode, uint64_t capacity, uint32_t first_view, uint32_t views,
                       const engine::Constants& constants)
    : arity_(bsh_arity_of(constants)), first_view_(first_view), views_(views), lists_(device, mode, capacity, capacity), restart_(device, compute_kernels, "incremental/restart"),
      travel_(device, compute_kernels, "incremental/travel"), place_(device, compute_kernels, "incremental/place"),
      due_kernel_(device, compute_kernels, "incremental/due", constants), update_(device, compute_kernels, "incremental/update", constants),
      open_(device, compute_kernels, "incremental/open", constants), dues_(device, "lists", "dues", capacity),
      found_(device, "lists", "dues found", mode == AppendMode::scan ? capacity : 0), free_(device, "lists", "holes", capacity),
      state_words_(device, "lists", "carried state", carried_words),
      report_(device, "lists", "carried report", carried_words, engine::Location::host), travels_(device, "lists", "travels", views),
      before_(device, "lists", "views before", views), changed_(device, "lists", "views changed", views),
      changed_report_(device, "lists", "views changed report", views, engine::Location::host), refs_(device, "lists", "carried memory", 1, engine::Location::host) {
    assert(capacity >= views);
}

uint64_t CarriedCut::bytes(const engine::Device& device, AppendMode mode, uint64_t capacity, uint32_t views) {
    return AppendLists::bytes(device, mode, capacity, capacity) + capacity * ((mode == AppendMode::scan ? 2 : 1) * sizeof(Due) + sizeof(uint)) +
           views * (sizeof(Travel) + sizeof(View) + 2 * sizeof(uint)) + sizeof(CarriedRefs) + 2 * sizeof(CarriedState);
}

// All of it is written, as far as barriers go: the frame's steps follow one another anyway.
Ref<CarriedRefs> CarriedCut::memory(engine::Recorder& recorder, const BoundsTravel* bounds) {
    refs_.span()[0] = {.codes = recorder.write(lists_.kept()),
                       .dues = recorder.write(dues_),
                       .free = recorder.write(free_),
                       .found = recorder.write(found_),
                       .travels = recorder.write(travels_),
                       .before = recorder.write(before_),
                       .state = {recorder.write(state_words_).address},
                       .changed = recorder.write(changed_),
                       .ways = bounds ? recorder.read(bounds->ways()) : Ways{},
                       .bounds_now = bounds_now_};
    return recorder.read(refs_);
}

void CarriedCut::record(engine::Recorder& recorder, const ManyLodsInputs& in, const CarrySettings& settings, const BoundsTravel* bounds) {
    assert(in.first_view == first_view_ && in.limit == views_ && first_view_ + views_ <= cut_max_views && in.tree.blocks() < cut_max_blocks &&
           in.tree.arity() == arity_);
    if (in.tree.empty()) {
        lists_.begin(recorder, due_kernel_, in.view_count, 0, 0);
        lists_.end(recorder);
        recorder.fill(report_, 0);
        recorder.fill(changed_, 1);
        recorder.fill(changed_report_, 1);
        return;
    }
    assert(!bounds || bounds->since() > 0);
    const bool from_roots = !started_;
    const bool moved = in.tree.bounds_version() != bounds_version_;
    const bool known = bounds && bounds->since() <= bounds_version_;  // how far they moved since the last frame
    uint flags = (settings.everything || from_roots || (moved && !known) ? carry_all : 0u) | (bounds ? carry_ways : 0u);
    bounds_version_ = in.tree.bounds_version();
    bounds_now_ = bounds && moved ? uint(bounds_version_) : 0u;
    const auto travel = [&] {
        return TravelPush{.views = recorder.read(in.views), .count = recorder.read(in.view_count), .memory = memory(recorder, bounds),
                          .first_view = first_view_, .limit = views_, .over_root = in.tree.blocks(), .flags = flags};
    };
    if (from_roots) recorder.dispatch(restart_, travel(), views_);
    started_ = true;
    recorder.dispatch(travel_, travel(), views_);

    const auto push = [&](const AppendRef& ref) {
        const BshRef tree = in.tree.read(recorder);
        return CarryPush{.lists = ref, .frames = tree.frames, .spheres = tree.spheres, .views = recorder.read(in.views),
                         .memory = memory(recorder, bounds), .leaves = tree.leaves, .blocks = tree.blocks, .epsilon = in.epsilon,
                         .map_size = in.map_size, .first_view = first_view_, .flags = flags};
    };
    const auto place = [&](uint close) {
        recorder.dispatch(place_, PlacePush{.lists = lists_.write_state(recorder), .memory = memory(recorder, bounds),
                                            .capacity = uint(lists_.kept_capacity()), .close = close}, 1);
    };
    lists_.begin(recorder, due_kernel_, state_words_, 0, uint32_t(lists_.kept_capacity()), 0);
    lists_.step(recorder, due_kernel_, arity_ + 1, push);
    lists_.step(recorder, update_, arity_ + 1, push);
    place(0);
    const uint32_t levels = in.tree.levels();
    const uint32_t steps = settings.edges > 0 && !from_roots ? std::min(settings.edges, levels) : levels;
    for (uint32_t step = 1; step <= steps; ++step) {
        if (step == steps && steps < levels) flags |= carry_last;
        lists_.step(recorder, open_, arity_ + 1, push);
    }
    place(1);
    lists_.end(recorder);
    recorder.copy(state_words_, report_, report_.bytes());
    recorder.copy(changed_, changed_report_, changed_.bytes());
}

CarryReport CarriedCut::report() const {
    CarriedState s;
    std::memcpy(&s, report_.span().data(), sizeof s);
    CarryReport report;
    report.lists = lists_.report();
    report.cut = s.cut, report.dropped = s.dropped, report.made = s.made, report.holes = s.holes, report.invalid = s.invalid;
    report.changed = uint64_t(std::ranges::count(changed_report_.span(), 1u));
    report.due = report.lists.opened - report.made;  // what the two kinds of steps evaluated
    return report;
}

}  // namespace myriad::compute
