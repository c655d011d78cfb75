// A compute program: SPIR-V, what reflection says of it, and its pipeline.
#pragma once

#include <map>
#include <string>

#include "engine/device.hpp"
#include "engine/kernels.hpp"

namespace myriad::engine {

// Specialisation constants by id. Ids 0 (workgroup size) and 1 (plain groups) belong to the engine; kernels use 2 and up.
using Constants = std::map<uint32_t, uint32_t>;

class Program {
public:
    // `name` as in the table ("scan/reduce"); a name that is not there is a programmer's error.
    Program(Device& device, const KernelTable& table, const std::string& name, Constants constants = {});
    ~Program();
    Program(Program&& other) noexcept;
    Program& operator=(Program&&) = delete;

    const std::string& name() const { return name_; }
    VkPipeline pipeline() const { return pipeline_; }
    VkPipelineLayout layout() const { return layout_; }
    uint32_t workgroup_size() const { return workgroup_size_; }       // invocations
    uint32_t push_constant_bytes() const { return push_constant_bytes_; }  // as the kernel declares them

private:
    Device* device_;
    std::string name_;
    VkPipelineLayout layout_ = VK_NULL_HANDLE;
    VkPipeline pipeline_ = VK_NULL_HANDLE;
    uint32_t workgroup_size_ = 0, push_constant_bytes_ = 0;
};

}  // namespace myriad::engine
