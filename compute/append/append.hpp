// Append lists in both modes behind one interface; see README.md.
#pragma once

#include <cstddef>
#include <optional>

#include "compute/append/append_io.h"
#include "compute/scan/scan.hpp"
#include "engine/recorder.hpp"

namespace myriad::compute {

enum class AppendMode { scan, atomic };

// The three specialisations of a kernel that appends (append.glsl); `constants` are the kernel's own, ids 3 and up.
class AppendKernel {
public:
    AppendKernel(engine::Device& device, const engine::KernelTable& table, const std::string& name, const engine::Constants& constants = {});
    const engine::Program& atomic() const { return atomic_; }
    const engine::Program& count() const { return count_; }
    const engine::Program& write() const { return write_; }

private:
    engine::Program atomic_, count_, write_;
};

// What the lists held and whether that fitted; read after the work that was recorded is done.
struct AppendReport {
    uint64_t kept = 0, next_needed = 0, kept_needed = 0, processed = 0, opened = 0;
    bool next_overflowed = false, kept_overflowed = false, caller_overflowed = false;
    bool ok() const { return !next_overflowed && !kept_overflowed && !caller_overflowed; }
};

// Steps over an active list, each of which fills the next active list (from empty) and adds to the kept list.
class AppendLists {
public:
    static constexpr uint64_t max_capacity = uint64_t(1) << 28;  // so that no count of a step of 8 per item wraps

    AppendLists(engine::Device& device, AppendMode mode, uint64_t next_capacity, uint64_t kept_capacity);

    // Starts with min(count[0] - first, limit) items for `kernel`. They are only indices: it makes what it reads itself. `weight`: 0 or 1,
    // the work that each of them stands for.
    void begin(engine::Recorder& recorder, const AppendKernel& kernel, const engine::Array<uint>& count, uint32_t first, uint32_t limit,
               uint32_t weight = 1);

    // One step: runs `kernel` over the active list and makes the next list the active one. `push(AppendRef)` returns the
    // kernel's push constants, and is called once a pass; all its reads and writes belong inside. `weight` is the work that
    // each item of the *next* list stands for, as AppendReport::processed counts it.
    template <class MakePush>
    void step(engine::Recorder& recorder, const AppendKernel& kernel, uint32_t weight, MakePush push) {
        assert(kernel.atomic().workgroup_size() == workgroup_size_ && "the kernels of one traversal share a workgroup size");
        auto run = [&](const engine::Program& program) {
            const AppendRef ref = reference(recorder);
            recorder.dispatch_indirect(program, push(ref), args_);
        };
        if (mode_ == AppendMode::atomic) {
            run(kernel.atomic());
        } else {
            run(kernel.count());
            scan_->record(recorder, sums_, state_words_, sums_word);
            run(kernel.write());
        }
        finish(recorder, weight);
    }

    // Copies the counters where report() finds them after the submission.
    void end(engine::Recorder& recorder);
    AppendReport report() const;

    const engine::Array<uvec2>& kept() const { return kept_; }
    // The state as words, for kernels that take the number of kept items: word `kept_word`.
    const engine::Array<uint>& state() const { return state_words_; }
    // For a kernel that keeps its own account of the kept list's places (compute/incremental).
    AppendStates write_state(engine::Recorder& recorder) const { return {recorder.write(state_words_).address}; }
    static constexpr uint64_t kept_word = offsetof(AppendState, kept) / sizeof(uint);
    static constexpr uint64_t failed_word = offsetof(AppendState, failed) / sizeof(uint);
    static constexpr uint64_t sums_word = offsetof(AppendState, sums) / sizeof(uint);

    uint64_t next_capacity() const { return next_capacity_; }
    uint64_t kept_capacity() const { return kept_capacity_; }
    AppendMode mode() const { return mode_; }
    // Device bytes that lists of these capacities take, before they are made.
    static uint64_t bytes(const engine::Device& device, AppendMode mode, uint64_t next_capacity, uint64_t kept_capacity);

private:
    AppendRef reference(engine::Recorder& recorder);
    void finish(engine::Recorder& recorder, uint32_t weight);
    AppendFinishPush finish_push(engine::Recorder& recorder);

    AppendMode mode_;
    uint64_t next_capacity_, kept_capacity_;
    engine::Program begin_, finish_;
    std::optional<Scan> scan_;
    engine::Array<uvec2> active_[2], kept_;
    engine::Array<uint> state_words_, payload_, sums_, report_;
    engine::Array<DispatchArgs> args_;
    uint32_t current_ = 0;  // which of active_ the step reads
    uint32_t workgroup_size_ = 0;
};

}  // namespace myriad::compute
