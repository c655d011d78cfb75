// A compute program: SPIR-V, what reflection says of it, and its pipeline.
#pragma once

#include <future>
#include <map>
#include <string>

#include "engine/device.hpp"
#include "engine/kernels.hpp"

namespace myriad::engine {

// Specialisation constants by id. Ids 0 (workgroup size) and 1 (plain groups) belong to the engine; kernels use 2 and up, and what a
// scene asks of all kernels that read it starts at 16.
using Constants = std::map<uint32_t, uint32_t>;

// Programs are values: the pipeline of a name and its constants is made once a device and lives as long as the device does,
// so a pass may be made, copied and dropped freely, and warm-up happens once. Pipelines are made beside, on as many threads as there
// are cores, while the host does other things; who asks for one waits for it, and hears of an error then.
class Program {
public:
    // `name` as in the table ("scan/reduce"); a name that is not there is a programmer's error.
    Program(Device& device, const KernelTable& table, const std::string& name, Constants constants = {});

    const std::string& name() const { return pipeline_.get().name; }
    VkPipeline pipeline() const { return pipeline_.get().pipeline; }
    VkPipelineLayout layout() const { return pipeline_.get().layout; }
    uint32_t workgroup_size() const { return pipeline_.get().workgroup_size; }            // invocations
    uint32_t push_constant_bytes() const { return pipeline_.get().push_constant_bytes; }  // as the kernel declares them

private:
    std::shared_future<Pipeline> pipeline_;
};

}  // namespace myriad::engine
