#include "engine/recorder.hpp"

#include <algorithm>

namespace myriad::engine {

namespace {

// What a recorder's commands run in: kernels, fills and copies.
constexpr VkPipelineStageFlags2 work_stages = VK_PIPELINE_STAGE_2_COMPUTE_SHADER_BIT | VK_PIPELINE_STAGE_2_ALL_TRANSFER_BIT;

CommandSet new_command_set(const Device& device, uint32_t queries) {
    CommandSet set;
    VkCommandPoolCreateInfo pool{VK_STRUCTURE_TYPE_COMMAND_POOL_CREATE_INFO};
    pool.queueFamilyIndex = device.queue_family();
    check(vkCreateCommandPool(device.handle(), &pool, nullptr, &set.pool), "creating a command pool");
    VkCommandBufferAllocateInfo allocate{VK_STRUCTURE_TYPE_COMMAND_BUFFER_ALLOCATE_INFO};
    allocate.commandPool = set.pool;
    allocate.level = VK_COMMAND_BUFFER_LEVEL_PRIMARY;
    allocate.commandBufferCount = 1;
    check(vkAllocateCommandBuffers(device.handle(), &allocate, &set.commands), "allocating a command buffer");
    VkFenceCreateInfo fence{VK_STRUCTURE_TYPE_FENCE_CREATE_INFO};
    check(vkCreateFence(device.handle(), &fence, nullptr, &set.fence), "creating a fence");
    if (device.timestamp_period_ns() > 0) {
        VkQueryPoolCreateInfo info{VK_STRUCTURE_TYPE_QUERY_POOL_CREATE_INFO};
        info.queryType = VK_QUERY_TYPE_TIMESTAMP;
        info.queryCount = queries;
        check(vkCreateQueryPool(device.handle(), &info, nullptr, &set.queries), "creating a query pool");
        device.set_name(VK_OBJECT_TYPE_QUERY_POOL, reinterpret_cast<uint64_t>(set.queries), "pass times");
    }
    device.set_name(VK_OBJECT_TYPE_COMMAND_BUFFER, reinterpret_cast<uint64_t>(set.commands), "frame");
    return set;
}

}  // namespace

Recorder::Recorder(Device& device) : device_(device) {
    if (device.idle_commands().empty()) {
        set_ = new_command_set(device, max_queries);
    } else {
        set_ = device.idle_commands().back();
        device.idle_commands().pop_back();
    }
    begin();
}

Recorder::~Recorder() { device_.idle_commands().push_back(set_); }

void Recorder::begin() {
    check(vkResetCommandPool(device_.handle(), set_.pool, 0), "resetting a command pool");
    VkCommandBufferBeginInfo info{VK_STRUCTURE_TYPE_COMMAND_BUFFER_BEGIN_INFO};
    info.flags = VK_COMMAND_BUFFER_USAGE_ONE_TIME_SUBMIT_BIT;
    check(vkBeginCommandBuffer(set_.commands, &info), "beginning a command buffer");
    if (set_.queries) vkCmdResetQueryPool(set_.commands, set_.queries, 0, max_queries);
    next_query_ = 0;
    declared_.clear();
    pending_.clear();
}

double Recorder::now_ms() const {
    return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - epoch_).count();
}

uint64_t Recorder::use(const Buffer& buffer, bool written) {
    assert(buffer && "a buffer that was never created is used");
    declared_.push_back({buffer.handle(), written});
    return buffer.address_;
}

// A hazard is any pair of accesses to one buffer of which one writes. One global barrier covers all that is pending:
// drivers turn buffer barriers into global ones anyway, and buffers here are as coarse as the passes.
void Recorder::synchronise() {
    const bool hazard = std::any_of(declared_.begin(), declared_.end(), [&](const Access& now) {
        return std::any_of(pending_.begin(), pending_.end(), [&](const Access& earlier) {
            return earlier.buffer == now.buffer && (earlier.written || now.written);
        });
    });
    if (hazard) {
        VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
        barrier.srcStageMask = work_stages | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT;
        barrier.srcAccessMask = VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT;
        barrier.dstStageMask = work_stages | VK_PIPELINE_STAGE_2_DRAW_INDIRECT_BIT;
        barrier.dstAccessMask = VK_ACCESS_2_SHADER_READ_BIT | VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_TRANSFER_READ_BIT |
                                VK_ACCESS_2_TRANSFER_WRITE_BIT | VK_ACCESS_2_INDIRECT_COMMAND_READ_BIT;
        VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
        dependency.memoryBarrierCount = 1;
        dependency.pMemoryBarriers = &barrier;
        vkCmdPipelineBarrier2(set_.commands, &dependency);
        pending_.clear();
    }
    pending_.insert(pending_.end(), declared_.begin(), declared_.end());
    declared_.clear();
}

void Recorder::record(const Program& program, const void* push, size_t bytes, size_t alignment, uint64_t threads, const Buffer* args,
                      uint64_t index) {
    // GLSL declares no padding at the end of a block; C++ does.
    [[maybe_unused]] const size_t declared = (program.push_constant_bytes() + alignment - 1) / alignment * alignment;
    assert(bytes == declared && "push constants differ between C++ and GLSL");
    if (args) declared_.push_back({args->handle(), false});
    if (!args && threads == 0) {
        declared_.clear();
        return;
    }
    synchronise();
    device_.begin_label(set_.commands, program.name().c_str());
    vkCmdBindPipeline(set_.commands, VK_PIPELINE_BIND_POINT_COMPUTE, program.pipeline());
    vkCmdPushConstants(set_.commands, program.layout(), VK_SHADER_STAGE_COMPUTE_BIT, 0, (program.push_constant_bytes() + 3) & ~3u, push);
    if (args) {
        vkCmdDispatchIndirect(set_.commands, args->handle(), index * sizeof(DispatchArgs));
    } else {
        const uint64_t groups = (threads + program.workgroup_size() - 1) / program.workgroup_size();
        assert(groups < uint64_t(65535) * 65535);
        const DispatchArgs grid = grid_of(uint32_t(groups));
        vkCmdDispatch(set_.commands, grid.x, grid.y, grid.z);
    }
    device_.end_label(set_.commands);
}

void Recorder::fill(const Buffer& buffer, uint32_t value, uint64_t offset, uint64_t bytes) {
    if (bytes == 0) return;
    use(buffer, true);
    synchronise();
    vkCmdFillBuffer(set_.commands, buffer.handle(), offset, bytes, value);
}

void Recorder::copy(const Buffer& from, const Buffer& to, uint64_t bytes, uint64_t from_offset, uint64_t to_offset) {
    if (bytes == 0) return;
    use(from, false);
    use(to, true);
    synchronise();
    const VkBufferCopy region{from_offset, to_offset, bytes};
    vkCmdCopyBuffer(set_.commands, from.handle(), to.handle(), 1, &region);
}

Recorder::Scope::Scope(Recorder& recorder, std::string name) : recorder_(recorder), index_(recorder.times_.size()) {
    PassTime time;
    time.name = std::move(name);
    time.cpu_begin_ms = recorder.now_ms();
    recorder.device_.begin_label(recorder.set_.commands, time.name.c_str());
    recorder.times_.push_back(std::move(time));
    // Later scopes go untimed rather than unrecorded when the pool of one submission is used up.
    const bool queried = recorder.set_.queries && recorder.next_query_ + 2 <= max_queries;
    recorder.scopes_.push_back({index_, recorder.next_query_, queried});
    if (queried) {
        vkCmdWriteTimestamp2(recorder.set_.commands, VK_PIPELINE_STAGE_2_BOTTOM_OF_PIPE_BIT, recorder.set_.queries, recorder.next_query_);
        recorder.next_query_ += 2;
    }
}

Recorder::Scope::~Scope() {
    PassTime& time = recorder_.times_[index_];
    time.cpu_ms = recorder_.now_ms() - time.cpu_begin_ms;
    for (const OpenScope& open : recorder_.scopes_)
        if (open.time == index_ && open.queried)
            vkCmdWriteTimestamp2(recorder_.set_.commands, VK_PIPELINE_STAGE_2_BOTTOM_OF_PIPE_BIT, recorder_.set_.queries, open.first_query + 1);
    recorder_.device_.end_label(recorder_.set_.commands);
}

double Recorder::warm_up() {
    const Array<DispatchArgs> nothing(device_, "frame", "warm-up grid", 1);
    const std::vector<char> zeros(device_.info().limits.at("maxPushConstantsSize"));
    submit_and_wait();
    const double start = now_ms();
    fill(nothing, 0);
    use(nothing, false);
    synchronise();
    for (const auto& [key, made] : device_.pipelines()) {
        const Pipeline& pipeline = made.get();
        vkCmdBindPipeline(set_.commands, VK_PIPELINE_BIND_POINT_COMPUTE, pipeline.pipeline);
        if (pipeline.push_constant_bytes)
            vkCmdPushConstants(set_.commands, pipeline.layout, VK_SHADER_STAGE_COMPUTE_BIT, 0, (pipeline.push_constant_bytes + 3) & ~3u, zeros.data());
        vkCmdDispatchIndirect(set_.commands, nothing.handle(), 0);
    }
    submit_and_wait();
    return now_ms() - start;
}

void Recorder::submit_and_wait() {
    // What the device wrote becomes visible to the host, through mapped buffers.
    VkMemoryBarrier2 barrier{VK_STRUCTURE_TYPE_MEMORY_BARRIER_2};
    barrier.srcStageMask = work_stages;
    barrier.srcAccessMask = VK_ACCESS_2_SHADER_WRITE_BIT | VK_ACCESS_2_TRANSFER_WRITE_BIT;
    barrier.dstStageMask = VK_PIPELINE_STAGE_2_HOST_BIT;
    barrier.dstAccessMask = VK_ACCESS_2_HOST_READ_BIT;
    VkDependencyInfo dependency{VK_STRUCTURE_TYPE_DEPENDENCY_INFO};
    dependency.memoryBarrierCount = 1;
    dependency.pMemoryBarriers = &barrier;
    vkCmdPipelineBarrier2(set_.commands, &dependency);
    check(vkEndCommandBuffer(set_.commands), "ending a command buffer");

    VkCommandBufferSubmitInfo commands{VK_STRUCTURE_TYPE_COMMAND_BUFFER_SUBMIT_INFO};
    commands.commandBuffer = set_.commands;
    VkSubmitInfo2 submit{VK_STRUCTURE_TYPE_SUBMIT_INFO_2};
    submit.commandBufferInfoCount = 1;
    submit.pCommandBufferInfos = &commands;
    check(vkQueueSubmit2(device_.queue(), 1, &submit, set_.fence), "submitting work");
    check(vkWaitForFences(device_.handle(), 1, &set_.fence, VK_TRUE, UINT64_MAX), "waiting for the device");
    check(vkResetFences(device_.handle(), 1, &set_.fence), "resetting a fence");

    if (next_query_) {
        std::vector<uint64_t> ticks(next_query_);
        check(vkGetQueryPoolResults(device_.handle(), set_.queries, 0, next_query_, ticks.size() * sizeof(uint64_t), ticks.data(),
                                    sizeof(uint64_t), VK_QUERY_RESULT_64_BIT | VK_QUERY_RESULT_WAIT_BIT),
              "reading timestamps");
        const double ms = device_.timestamp_period_ns() * 1e-6;
        if (const auto moment = device_.now()) {  // read anew each time: clocks drift
            const std::chrono::duration<double, std::milli> since = moment->host - epoch_;
            gpu_epoch_ = moment->ticks - uint64_t(int64_t(since.count() / ms));
        } else if (!gpu_epoch_) {
            gpu_epoch_ = ticks[0];
        }
        for (const OpenScope& scope : scopes_) {
            if (!scope.queried) continue;
            times_[scope.time].gpu_begin_ms = double(int64_t(ticks[scope.first_query] - gpu_epoch_)) * ms;
            times_[scope.time].gpu_ms = double(ticks[scope.first_query + 1] - ticks[scope.first_query]) * ms;
        }
    }
    scopes_.clear();
    begin();
}

}  // namespace myriad::engine
