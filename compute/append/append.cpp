#include "compute/append/append.hpp"

#include <algorithm>

#include "compute/kernels.hpp"

namespace myriad::compute {

using engine::compute_kernels;

namespace {

constexpr uint64_t state_words = sizeof(AppendState) / sizeof(uint);

engine::Constants with_pass(engine::Constants constants, uint32_t pass) {
    constants[2] = pass;
    return constants;
}

uint64_t sums_for(const engine::Device& device, uint64_t items) {
    return 2 * ((items + device.group_size() - 1) / device.group_size());
}

}  // namespace

AppendKernel::AppendKernel(engine::Device& device, const engine::KernelTable& table, const std::string& name,
                           const engine::Constants& constants)
    : atomic_(device, table, name, with_pass(constants, 0)), count_(device, table, name, with_pass(constants, 1)),
      write_(device, table, name, with_pass(constants, 2)) {}

AppendLists::AppendLists(engine::Device& device, AppendMode mode, uint64_t next_capacity, uint64_t kept_capacity)
    : mode_(mode), next_capacity_(next_capacity), kept_capacity_(kept_capacity), begin_(device, compute_kernels, "append/begin"),
      finish_(device, compute_kernels, "append/finish"), kept_(device, "lists", "kept list", kept_capacity),
      state_words_(device, "lists", "append state", state_words),
      report_(device, "lists", "append report", state_words, engine::Location::host), args_(device, "lists", "append grid", 1) {
    assert(next_capacity <= max_capacity && kept_capacity <= max_capacity);
    active_[0] = {device, "lists", "active list 0", next_capacity};
    active_[1] = {device, "lists", "active list 1", next_capacity};
    if (mode == AppendMode::scan) {
        const uint64_t sums = sums_for(device, next_capacity);
        scan_.emplace(device, sums);
        sums_ = {device, "lists", "append sums", sums + 1};
        payload_ = {device, "lists", "append payload", next_capacity};
    }
}

uint64_t AppendLists::bytes(const engine::Device& device, AppendMode mode, uint64_t next_capacity, uint64_t kept_capacity) {
    uint64_t bytes = (2 * next_capacity + kept_capacity) * sizeof(uvec2);
    if (mode == AppendMode::scan) bytes += (sums_for(device, next_capacity) + next_capacity) * sizeof(uint);
    return bytes;
}

AppendFinishPush AppendLists::finish_push(engine::Recorder& recorder) {
    return {.state = {recorder.write(state_words_).address},
            .args = recorder.write(args_),
            .sums = scan_ ? recorder.read(sums_) : Uints{},
            .source = {},
            .next_capacity = uint(next_capacity_),
            .kept_capacity = uint(kept_capacity_),
            .group_size = recorder.device().group_size(),
            .workgroup_size = workgroup_size_,
            .scan = mode_ == AppendMode::scan,
            .first = 0,
            .limit = 0,
            .weight = 1};
}

void AppendLists::begin(engine::Recorder& recorder, const AppendKernel& kernel, const engine::Array<uint>& count, uint32_t first,
                        uint32_t limit, uint32_t weight) {
    assert(limit <= next_capacity_ && "the first list is an active list too");
    current_ = 0;
    workgroup_size_ = kernel.atomic().workgroup_size();
    AppendFinishPush push = finish_push(recorder);
    push.source = recorder.read(count);
    push.first = first;
    push.limit = limit;
    push.weight = weight;
    recorder.dispatch(begin_, push, 1);
}

AppendRef AppendLists::reference(engine::Recorder& recorder) {
    const bool scan = mode_ == AppendMode::scan;
    return {.items = recorder.read(active_[current_]),
            .next = recorder.write(active_[current_ ^ 1]),
            .kept = recorder.write(kept_),
            .state = {recorder.write(state_words_).address},
            .payload = scan ? recorder.write(payload_) : Uints{},
            .sums = scan ? recorder.write(sums_) : Uints{},
            .next_capacity = uint(next_capacity_),
            .kept_capacity = uint(kept_capacity_)};
}

void AppendLists::finish(engine::Recorder& recorder, uint32_t weight) {
    AppendFinishPush push = finish_push(recorder);
    push.weight = weight;
    recorder.dispatch(finish_, push, 1);
    current_ ^= 1;
}

void AppendLists::end(engine::Recorder& recorder) { recorder.copy(state_words_, report_, report_.bytes()); }

AppendReport AppendLists::report() const {
    AppendState s;
    std::memcpy(&s, report_.span().data(), sizeof s);
    AppendReport report;
    report.kept = s.kept;
    report.next_needed = s.next_needed;
    report.kept_needed = s.kept_needed;
    report.processed = uint64_t(s.processed[1]) << 32 | s.processed[0];
    report.opened = uint64_t(s.opened[1]) << 32 | s.opened[0];
    report.next_overflowed = s.failed & append_next_overflow;
    report.kept_overflowed = s.failed & append_kept_overflow;
    report.caller_overflowed = s.failed & append_caller_overflow;
    return report;
}

}  // namespace myriad::compute
