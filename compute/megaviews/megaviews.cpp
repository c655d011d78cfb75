#include "compute/megaviews/megaviews.hpp"

#include "compute/kernels.hpp"

namespace myriad::compute {

using engine::compute_kernels;

namespace {

// Each step goes a level down in one of both trees.
constexpr uint32_t most_scene_levels = 29;
constexpr uint32_t most_steps = 1 + most_scene_levels + view_tree_levels + 1;
constexpr uint64_t step_words = sizeof(PairCounts) / sizeof(uint);

}  // namespace

MegaViews::MegaViews(engine::Device& device, const engine::Constants& constants)
    : arity_(bsh_arity_of(constants)), seed_(device, compute_kernels, "megaviews/seed", constants), open_(device, compute_kernels, "megaviews/open", constants),
      refs_(device, "lists", "memory of pairs", 1, engine::Location::host), counts_(device, "lists", "counts of pairs", most_steps * step_words),
      counts_report_(device, "lists", "counts of pairs report", most_steps * step_words, engine::Location::host), one_(device, "lists", "one", 1) {}

void MegaViews::record(engine::Recorder& recorder, AppendLists& lists, const MegaViewsInputs& in) {
    assert(in.tree.arity() == arity_ && in.views.capacity() + in.views.inner_capacity() <= cut_max_views);
    recorder.fill(counts_, 0);
    recorder.fill(one_, in.tree.empty() ? 0 : 1);
    uint32_t step = 0;
    const auto push = [&](const AppendRef& ref) {
        const BshRef tree = in.tree.empty() ? BshRef{} : in.tree.read(recorder);
        refs_.span()[0] = {.nodes = recorder.read(in.views.nodes()), .groups = recorder.read(in.views.groups()), .counts = {recorder.write(counts_).address},
                           .cones = tree.cones};
        return PairPush{.lists = ref, .frames = tree.frames, .spheres = tree.spheres, .memory = recorder.read(refs_), .leaves = tree.leaves,
                        .blocks = tree.blocks, .epsilon = in.epsilon, .map_size = in.map_size, .capacity = in.views.capacity(), .first = in.first,
                        .end = in.first + in.limit, .step = step};
    };
    lists.begin(recorder, seed_, one_, 0, 1);
    if (!in.tree.empty()) {
        const uint32_t steps = std::min(in.tree.levels() + view_tree_levels + 2, most_steps);
        lists.step(recorder, seed_, 1, push);
        for (step = 1; step < steps; ++step) lists.step(recorder, open_, 1, push);
    }
    lists.end(recorder);
    recorder.copy(counts_, counts_report_, counts_report_.bytes());
}

PairReport::Step& PairReport::Step::operator+=(const Step& other) {
    tested += other.tested, culled += other.culled, edge_on += other.edge_on, rendered += other.rendered, shared += other.shared;
    return *this;
}

PairReport MegaViews::report() const {
    PairReport report;
    const auto words = counts_report_.span();
    const auto number = [&](uint64_t at) { return uint64_t(words[at + 1]) << 32 | words[at]; };
    for (uint64_t at = 0; at < words.size() && number(at) > 0; at += step_words) {
        const PairReport::Step s{number(at), number(at + 2), number(at + 4), number(at + 6), number(at + 8)};
        report.steps.push_back(s);
        report.total += s;
    }
    return report;
}

}  // namespace myriad::compute
