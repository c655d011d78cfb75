// What one command buffer holds, since it was last begun: stretches of work, each between two timestamps that the layer added.
//
// A timestamp waits for all work before it (bottom of pipe), so that stretches are disjoint or nested, and sum. Queries come in
// chunks, each a pool of its own, reset where the command buffer takes it: who submits a command buffer again resets them again.
#pragma once

#include <array>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "tools/profiler_layer/tables.hpp"
#include "tools/profiler_layer/trace.hpp"

namespace myriad::profiler {

class Device;

double now_ns();  // of the host's steady clock

struct Stretch {
    static constexpr uint32_t no_stamp = ~0u;
    Kind kind;
    std::string name;
    uint32_t begin = no_stamp, end = no_stamp;  // which timestamps
    double host_begin_ns = 0, host_ns = 0;      // its recording
};

class Recording {
public:
    // `timed`: the queue family has timestamps, and queries can be reset here.
    Recording(Device& device, bool timed, bool simultaneous);
    ~Recording();
    Recording(const Recording&) = delete;

    void open(VkCommandBuffer commands, Kind kind, std::string name);
    // Closes the innermost one of that kind, if there is one: a label may end that another command buffer began.
    void close(VkCommandBuffer commands, Kind kind);
    void close_all(VkCommandBuffer commands);

    // Inside a render pass no queries can be reset, and with `stamps` false no timestamps be written either.
    void enter_render_pass(VkCommandBuffer commands, bool stamps);
    void change_subpass(bool stamps) { stamps_inside_ = stamps; }
    void leave_render_pass() { inside_ = false; }

    // By stamp: ticks, for those that were written. To be called when the device is through with it.
    std::map<uint32_t, uint64_t> read() const;

    const std::vector<Stretch>& stretches() const { return stretches_; }
    bool simultaneous() const { return simultaneous_; }  // several submissions may be under way at a time

    std::vector<std::shared_ptr<Recording>> secondaries;  // that it executes
    uint64_t commands = 0;                                // dispatches, draws and copies
    uint64_t untimed = 0;                                 // stretches without times, for want of queries in a render pass
    bool starts_frame = false;
    bool host_told = false;                               // its recording is in the trace
    uint32_t thread = 0;                                  // the track of who recorded it

private:
    uint32_t stamp(VkCommandBuffer commands);
    void add_chunk(VkCommandBuffer commands);

    Device& device_;
    const bool timed_, simultaneous_;
    bool inside_ = false, stamps_inside_ = false;
    std::vector<Stretch> stretches_;
    std::vector<size_t> open_;  // in stretches_, innermost last
    std::vector<VkQueryPool> chunks_;
    uint32_t used_ = 0;         // of all chunks' queries
};

// A command buffer of the program. It outlives its recordings.
struct CommandBuffer {
    VkCommandBuffer handle = VK_NULL_HANDLE;
    Device* device = nullptr;
    VkCommandPool pool = VK_NULL_HANDLE;
    bool secondary = false;
    std::shared_ptr<Recording> recording;      // none: it was not begun, or frames that are traced are over
    std::array<VkPipeline, 3> pipelines = {};  // bound: graphics, compute, rays
    bool passes_timed = true;                  // the render pass that is open is a stretch
};

}  // namespace myriad::profiler
