// Records work, derives its barriers, submits it, and times it.
//
// A kernel reaches memory only through addresses in its push constants, and an address is had only by saying what for:
//
//     auto scope = recorder.scope("splat");
//     recorder.dispatch(splat, SplatPush{.records = recorder.read(records), .atlas = recorder.write(atlas)}, records.count());
//
// read() and write() note the access for the next dispatch, so the barrier between two dispatches follows from what
// they declared; nobody writes access masks, and a forgotten declaration cannot be, short of reusing an old address.
#pragma once

#include <cassert>
#include <chrono>
#include <string>
#include <vector>

#include "engine/buffer.hpp"
#include "engine/program.hpp"

namespace myriad::engine {

// One timed region. Times are milliseconds; begins are relative to the recorder's creation. Where the device shares no clock with the host
// (DeviceInfo::common_clock), gpu_begin_ms is relative to the first region's begin on the device.
struct PassTime {
    std::string name;
    double gpu_ms = 0, cpu_ms = 0;          // gpu_ms is 0 where the queue has no timestamps; cpu_ms is the recording
    double gpu_begin_ms = 0, cpu_begin_ms = 0;
};

class Recorder {
public:
    explicit Recorder(Device& device);
    ~Recorder();
    Recorder(const Recorder&) = delete;

    // The address of an array, for a kernel that only reads, or may also write it. Counts for the next dispatch.
    template <class T> Ref<T> read(const Array<T>& array) { return {use(array, false)}; }
    template <class T> Ref<T> write(const Array<T>& array) { return {use(array, true)}; }
    // A part of an array that starts at an element.
    template <class T> Ref<T> read(const Array<T>& array, uint64_t first) { return {use(array, false) + first * sizeof(T)}; }
    template <class T> Ref<T> write(const Array<T>& array, uint64_t first) { return {use(array, true) + first * sizeof(T)}; }

    // Runs a kernel over at least `threads` invocations (rounded up to workgroups; 0 records nothing).
    template <class Push>
    void dispatch(const Program& program, const Push& push, uint64_t threads) {
        record(program, &push, sizeof(Push), alignof(Push), threads, nullptr, 0);
    }
    // The same over as many workgroups as args[index] holds when the device gets there.
    template <class Push>
    void dispatch_indirect(const Program& program, const Push& push, const Array<DispatchArgs>& args, uint64_t index = 0) {
        record(program, &push, sizeof(Push), alignof(Push), 0, &args, index);
    }

    void fill(const Buffer& buffer, uint32_t value, uint64_t offset = 0, uint64_t bytes = VK_WHOLE_SIZE);  // multiples of 4
    void copy(const Buffer& from, const Buffer& to, uint64_t bytes, uint64_t from_offset = 0, uint64_t to_offset = 0);

    // Names and times everything recorded until it is destroyed. Scopes nest; only name those worth a timestamp (about
    // 50 us each on lavapipe): dispatches inside are labelled anyway.
    class Scope {
    public:
        Scope(Recorder& recorder, std::string name);
        ~Scope();
        Scope(const Scope&) = delete;

    private:
        Recorder& recorder_;
        size_t index_;
    };
    [[nodiscard]] Scope scope(std::string name) { return Scope(*this, std::move(name)); }

    // Runs what was recorded, returns when it is done and the host may read mapped memory, and starts anew.
    void submit_and_wait();

    // Dispatches no workgroups of every pipeline that exists, after what was recorded, and waits. Drivers that compile at the first
    // dispatch (lavapipe: 20 to 700 ms a kernel) do it here, not inside the first frame. Milliseconds.
    double warm_up();

    // Times of the scopes of all submissions so far, in order of their beginning; taking them forgets them.
    std::vector<PassTime> take_times() { return std::exchange(times_, {}); }

    Device& device() { return device_; }

private:
    struct Access {
        VkBuffer buffer;
        bool written;
    };
    uint64_t use(const Buffer& buffer, bool written);
    void record(const Program& program, const void* push, size_t bytes, size_t alignment, uint64_t threads, const Buffer* args,
                uint64_t index);
    void synchronise();  // a barrier, if anything declared since the last dispatch needs one
    void begin();
    double now_ms() const;

    struct OpenScope {
        size_t time;         // in times_
        uint32_t first_query;
        bool queried;
    };
    static constexpr uint32_t max_queries = 2048;

    Device& device_;
    CommandSet set_;
    uint32_t next_query_ = 0;
    std::vector<Access> declared_;  // for the next command
    std::vector<Access> pending_;   // since the last barrier
    std::vector<OpenScope> scopes_;
    std::vector<PassTime> times_;
    std::chrono::steady_clock::time_point epoch_ = std::chrono::steady_clock::now();
    uint64_t gpu_epoch_ = 0;
};

}  // namespace myriad::engine
