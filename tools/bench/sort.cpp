// `myriad bench sort`: the device's radix sort (compute/sort) in the shapes that it can have, against the host's radix sort and the library's
// stable sort. Random keys; every row's result is compared with the library's before it is timed. A `copy` row moves as many bytes as a pass of the
// device's sort must: the counter `times_copy` is the sort's time over that of as many copies as it has passes.
#include <algorithm>
#include <chrono>
#include <random>

#include "compute/bsh/copy_io.h"
#include "compute/common/radix_sort.hpp"
#include "compute/kernels.hpp"
#include "compute/sort/sort.hpp"
#include "engine/transfer.hpp"
#include "tools/bench/bench.hpp"

namespace myriad::tools {
namespace {

struct Item {
    uint64_t key;
    uint32_t payload;
    bool operator==(const Item&) const = default;
};

double ms_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count();
}

template <class Key>
Key key_of(uint64_t bits) {
    if constexpr (sizeof(Key) == 4) return uint(bits);
    else return {uint(bits), uint(bits >> 32)};
}

template <class Key>
struct Experiment {
    engine::Device& device;
    const BenchOptions& options;
    const RowSink& sink;
    std::vector<Item> items, sorted;
    double copy_ms = 0;
    static constexpr uint32_t key_bits = 8 * sizeof(Key);
    static constexpr uint32_t pass_words = 2 * (key_bits / 32) + 1 + key_bits / 32 + 1;  // keys to count; keys and payload, read and written

    BenchRow row(const char* technique) const {
        BenchRow r;
        r.bench = "sort";
        r.scene = "random keys";
        r.technique = technique;
        r.settings = {{"items", items.size()}, {"bits", key_bits}};
        r.bytes = {{"pairs", 0}, {"atlas", 0}};
        return r;
    }

    // `run` sorts a copy of the items, and is asked for it afterwards.
    template <class Run>
    void host(const char* technique, Run run) {
        BenchRow r = row(technique);
        for (uint32_t i = 0; i <= options.repeats; ++i) {
            std::vector<Item> mine = items;
            const auto start = std::chrono::steady_clock::now();
            run(mine);
            if (i > 0) r.ms.ms.push_back(ms_since(start));
            if (sorted.empty()) sorted = mine;
            if (mine != sorted) throw Error(Error::Kind::check_failed, std::string("the ") + technique + " differs from the stable sort");
        }
        r.counters = {{"Mitems/s", double(items.size()) / r.ms.median() / 1000}};
        sink(r);
    }

    void copy() {
        BenchRow r = row("copy");
        const engine::Program program(device, engine::compute_kernels, "bsh/copy");
        const uint64_t quads = (items.size() * pass_words / 2 + 3) / 4;
        const engine::Array<uvec4> from(device, "bench", "copied from", quads), to(device, "bench", "copied to", quads);
        engine::Recorder recorder(device);
        recorder.fill(from, 7);
        for (uint32_t run = 0; run <= options.repeats; ++run) {
            {
                auto scope = recorder.scope("copy");
                recorder.dispatch(program, BshCopyPush{recorder.read(from), recorder.write(to), uint(quads)}, quads);
            }
            recorder.submit_and_wait();
            const double ms = recorder.take_times().at(0).gpu_ms;
            if (run > 0) r.ms.ms.push_back(ms);
        }
        copy_ms = r.ms.median();
        r.counters = {{"GB/s", 2 * double(quads) * 16 / copy_ms / 1e6}};
        sink(r);
    }

    void on_device(const compute::SortShape& shape) {
        BenchRow r = row("device");
        r.settings["groups"] = shape.lone_lanes ? "lanes" : "subgroups";
        r.settings["digit_bits"] = shape.digit_bits;
        r.settings["tile"] = shape.tile;
        const uint64_t n = items.size();
        std::vector<Key> keys(n);
        std::vector<uint> payload(n);
        for (size_t i = 0; i < n; ++i) keys[i] = key_of<Key>(items[i].key), payload[i] = items[i].payload;
        const auto key_source = engine::upload(device, "bench", "bench keys", keys);
        const auto payload_source = engine::upload(device, "bench", "bench payload", payload);
        const auto count = engine::upload(device, "bench", "bench count", std::vector<uint>{uint(n)});
        const engine::Array<Key> key_array(device, "bench", "sorted keys", n);
        const engine::Array<uint> payload_array(device, "bench", "sorted payload", n);
        compute::Sort sort(device, n, key_bits, shape);
        engine::Recorder recorder(device);
        for (uint32_t run = 0; run <= options.repeats; ++run) {
            recorder.copy(key_source, key_array, n * sizeof(Key));
            recorder.copy(payload_source, payload_array, n * sizeof(uint));
            const auto result = [&] {
                auto scope = recorder.scope("sort");
                return sort.record(recorder, key_array, payload_array, count, 0, key_bits);
            }();
            recorder.submit_and_wait();
            const double ms = recorder.take_times().at(0).gpu_ms;
            if (run > 0) r.ms.ms.push_back(ms);
            else verify(engine::download(device, result.keys, n), engine::download(device, result.payload, n));
        }
        const uint32_t passes = compute::Sort::passes(key_bits, shape);
        r.counters = {{"Mitems/s", double(n) / r.ms.median() / 1000}, {"passes", passes}, {"times_copy", r.ms.median() / (passes * copy_ms)}};
        r.bytes["sort"] = sort.bytes();
        sink(r);
    }

    void verify(const std::vector<Key>& keys, const std::vector<uint>& payload) const {
        for (size_t i = 0; i < sorted.size(); ++i)
            if (keys[i] != key_of<Key>(sorted[i].key) || payload[i] != sorted[i].payload)
                throw Error(Error::Kind::check_failed, "the device's order differs from the stable sort's at item " + std::to_string(i));
    }

    void run(uint32_t count, bool all_shapes) {
        std::mt19937_64 random(options.seed);
        for (uint32_t i = 0; i < count; ++i) items.push_back({random() >> (64 - key_bits), i});
        host("native-stable-sort", [](auto& mine) { std::ranges::stable_sort(mine, {}, &Item::key); });
        host("native-radix", [](auto& mine) { compute::radix_sort(mine, [](const Item& i) { return i.key; }, 0, key_bits); });
        copy();
        const compute::SortShape usual = compute::SortShape::of(device);
        on_device(usual);
        if (!all_shapes) return;
        for (const compute::SortShape& shape : compute::SortShape::all(device))
            if (shape != usual) on_device(shape);
    }
};

}  // namespace

void bench_sort(engine::Device& device, const BenchOptions& options, const RowSink& sink) {
    const std::vector<uint32_t> counts = options.items.empty() ? std::vector<uint32_t>{1 << 16, 1 << 20, 1 << 22} : options.items;
    for (const uint32_t count : counts) {
        const bool all_shapes = count == 1 << 20;
        Experiment<uint>{device, options, sink, {}, {}}.run(count, all_shapes);
        Experiment<uvec2>{device, options, sink, {}, {}}.run(count, all_shapes);
    }
}

}  // namespace myriad::tools
