#include "engine/program.hpp"

#include <algorithm>
#include <cassert>
#include <cstdio>
#include <cstdlib>
#include <memory>
#include <new>
#include <semaphore>
#include <utility>
#include <vector>

#include <spirv_cross/spirv_cross_c.h>

#include "engine/parallel.hpp"

namespace myriad::engine {
namespace {

struct Interface {
    uint32_t workgroup_size = 1, push_constant_bytes = 0;
    bool size_is_constant_0 = false;
};

// Reads back from the SPIR-V what the host must agree with, so that nothing is typed twice (style, habits 1 and 8).
Interface reflect(const uint32_t* begin, const uint32_t* end) {
    // The kernels were validated when they were built, so there is one reason to fail: no memory.
    const auto check = [](spvc_result result) {
        if (result != SPVC_SUCCESS) throw std::bad_alloc();
    };
    spvc_context context = nullptr;
    spvc_parsed_ir ir = nullptr;
    spvc_compiler compiler = nullptr;
    check(spvc_context_create(&context));
    const std::unique_ptr<spvc_context_s, void (*)(spvc_context)> owner(context, spvc_context_destroy);
    check(spvc_context_parse_spirv(context, begin, size_t(end - begin), &ir));
    check(spvc_context_create_compiler(context, SPVC_BACKEND_NONE, ir, SPVC_CAPTURE_MODE_TAKE_OWNERSHIP, &compiler));

    Interface out;
    spvc_specialization_constant size[3];
    spvc_compiler_get_work_group_size_specialization_constants(compiler, &size[0], &size[1], &size[2]);
    for (unsigned axis = 0; axis < 3; ++axis)
        out.workgroup_size *= size[axis].id ? spvc_constant_get_scalar_u32(spvc_compiler_get_constant_handle(compiler, size[axis].id), 0, 0)
                                            : spvc_compiler_get_execution_mode_argument_by_index(compiler, SpvExecutionModeLocalSize, axis);
    out.size_is_constant_0 = size[0].id != 0;

    spvc_resources resources = nullptr;
    check(spvc_compiler_create_shader_resources(compiler, &resources));
    const spvc_reflected_resource* list = nullptr;
    size_t count = 0;
    check(spvc_resources_get_resource_list_for_type(resources, SPVC_RESOURCE_TYPE_PUSH_CONSTANT, &list, &count));
    if (count) {
        size_t bytes = 0;
        check(spvc_compiler_get_declared_struct_size(compiler, spvc_compiler_get_type_handle(compiler, list[0].base_type_id), &bytes));
        out.push_constant_bytes = uint32_t(bytes);
    }
    return out;
}

Pipeline make_pipeline(Device& device, const KernelTable& table, const std::string& name, Constants constants) {
    const auto kernel = std::find_if(table.begin(), table.end(), [&](auto& k) { return name == k.name; });
    if (kernel == table.end()) {
        std::fprintf(stderr, "no embedded kernel is called \"%s\"\n", name.c_str());
        std::abort();
    }
    const Interface interface = reflect(kernel->begin, kernel->end);
    Pipeline out;
    out.name = name;
    out.workgroup_size = interface.workgroup_size;
    out.push_constant_bytes = interface.push_constant_bytes;
    assert(out.push_constant_bytes <= device.info().limits.at("maxPushConstantsSize"));
    if (interface.size_is_constant_0) out.workgroup_size = constants.try_emplace(0, out.workgroup_size).first->second;
    constants.try_emplace(1, device.plain_groups() ? 1 : 0);

    std::vector<VkSpecializationMapEntry> entries;
    std::vector<uint32_t> values;
    for (auto [id, value] : constants) {
        entries.push_back({id, uint32_t(values.size() * sizeof(uint32_t)), sizeof(uint32_t)});
        values.push_back(value);
    }
    const VkSpecializationInfo specialization{uint32_t(entries.size()), entries.data(), values.size() * sizeof(uint32_t), values.data()};

    const VkPushConstantRange range{VK_SHADER_STAGE_COMPUTE_BIT, 0, (out.push_constant_bytes + 3) & ~3u};
    VkPipelineLayoutCreateInfo layout{VK_STRUCTURE_TYPE_PIPELINE_LAYOUT_CREATE_INFO};
    layout.pushConstantRangeCount = range.size ? 1 : 0;
    layout.pPushConstantRanges = &range;
    check(vkCreatePipelineLayout(device.handle(), &layout, nullptr, &out.layout), "creating a pipeline layout");

    VkShaderModuleCreateInfo code{VK_STRUCTURE_TYPE_SHADER_MODULE_CREATE_INFO};
    code.codeSize = size_t(kernel->end - kernel->begin) * sizeof(uint32_t);
    code.pCode = kernel->begin;
    VkComputePipelineCreateInfo info{VK_STRUCTURE_TYPE_COMPUTE_PIPELINE_CREATE_INFO};
    info.layout = out.layout;
    info.stage.sType = VK_STRUCTURE_TYPE_PIPELINE_SHADER_STAGE_CREATE_INFO;
    info.stage.stage = VK_SHADER_STAGE_COMPUTE_BIT;
    info.stage.pName = "main";
    info.stage.pSpecializationInfo = &specialization;
    check(vkCreateShaderModule(device.handle(), &code, nullptr, &info.stage.module), "creating a shader module");
    const VkResult result = vkCreateComputePipelines(device.handle(), VK_NULL_HANDLE, 1, &info, nullptr, &out.pipeline);
    vkDestroyShaderModule(device.handle(), info.stage.module, nullptr);
    check(result, ("compiling kernel \"" + name + "\"").c_str());
    device.set_name(VK_OBJECT_TYPE_PIPELINE, reinterpret_cast<uint64_t>(out.pipeline), name);
    device.set_name(VK_OBJECT_TYPE_PIPELINE_LAYOUT, reinterpret_cast<uint64_t>(out.layout), name);
    return out;
}

// Starts to make it on a thread of its own; where there is no thread to be had, whoever waits for it makes it.
template <class Make>
std::shared_future<Pipeline> make_beside(Make make) {
    static std::counting_semaphore<> cores(host_threads());
    return std::async(std::launch::async | std::launch::deferred, [make] {
               cores.acquire();
               struct Release {
                   ~Release() { cores.release(); }
               } release;
               return make();
           }).share();
}

}  // namespace

Program::Program(Device& device, const KernelTable& table, const std::string& name, Constants constants) {
    std::string key = name;
    for (auto [id, value] : constants) key += "|" + std::to_string(id) + "=" + std::to_string(value);
    auto found = device.pipelines().find(key);
    if (found == device.pipelines().end())
        found = device.pipelines().emplace(key, make_beside([=, &device, &table] { return make_pipeline(device, table, name, constants); })).first;
    pipeline_ = found->second;
}

}  // namespace myriad::engine
