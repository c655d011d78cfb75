// Dispatches, draws and copies: counted, and at the finest granularity timed each by itself. One template is all of them.
#include "tools/profiler_layer/intercepts.hpp"

namespace myriad::profiler {
namespace {

// A name as a template's argument.
template <size_t length>
struct Literal {
    char text[length];
    constexpr Literal(const char (&literal)[length]) { std::copy_n(literal, length, text); }
};

enum Bound { graphics, compute, rays, nothing };  // the pipeline that does it; as in CommandBuffer::pipelines

// "vkCmdDispatch: NAME", with the name of the pipeline where the program gave one.
std::string name_of_work(const CommandBuffer& buffer, const char* command, Bound bound) {
    if (bound == nothing || !buffer.pipelines[bound]) return command;
    const std::string name = buffer.device->name_of(reinterpret_cast<uint64_t>(buffer.pipelines[bound]));
    return name.empty() ? command : command + (": " + name);
}

template <Literal name, Bound bound, auto member, class Function>
struct Work;

template <Literal name, Bound bound, auto member, class... Arguments>
struct Work<name, bound, member, void(VKAPI_PTR* DeviceTable::*)(VkCommandBuffer, Arguments...)> {
    static VKAPI_ATTR void VKAPI_CALL call(VkCommandBuffer commands, Arguments... arguments) {
        CommandBuffer& buffer = commands_of(commands);
        Recording* recording = buffer.recording.get();
        const bool timed = recording && buffer.device->profiler().settings.granularity == Granularity::dispatch;
        if (recording) ++recording->commands;
        if (timed) recording->open(commands, Kind::command, name_of_work(buffer, name.text, bound));
        (buffer.device->next.*member)(commands, arguments...);
        if (timed) recording->close(commands, Kind::command);
    }
};

// "vkFoo" and "vkFooKHR" for one entry of the table; a name that no device has is never asked for.
#define WORK_AS(suffix, name, bound)                                                                                    \
    {"vk" #name suffix, reinterpret_cast<PFN_vkVoidFunction>(                                                           \
                            &Work<"vk" #name, bound, &DeviceTable::name, decltype(&DeviceTable::name)>::call)}
#define WORK(name, bound) WORK_AS("", name, bound)
#define WORK_KHR(name, bound) WORK_AS("", name, bound), WORK_AS("KHR", name, bound)

constexpr auto list = [] {
    return std::to_array<Intercept>({
        WORK(CmdDispatch, compute), WORK(CmdDispatchIndirect, compute), WORK_KHR(CmdDispatchBase, compute),
        WORK(CmdTraceRaysKHR, rays), WORK(CmdBuildAccelerationStructuresKHR, nothing),
        WORK(CmdDraw, graphics), WORK(CmdDrawIndexed, graphics), WORK(CmdDrawIndirect, graphics), WORK(CmdDrawIndexedIndirect, graphics),
        WORK_KHR(CmdDrawIndirectCount, graphics), WORK_KHR(CmdDrawIndexedIndirectCount, graphics),
        WORK(CmdDrawMeshTasksEXT, graphics), WORK(CmdDrawMeshTasksIndirectEXT, graphics),
        WORK(CmdCopyBuffer, nothing), WORK_KHR(CmdCopyBuffer2, nothing), WORK(CmdFillBuffer, nothing), WORK(CmdUpdateBuffer, nothing),
        WORK(CmdCopyImage, nothing), WORK_KHR(CmdCopyImage2, nothing), WORK(CmdBlitImage, nothing), WORK_KHR(CmdBlitImage2, nothing),
        WORK(CmdCopyBufferToImage, nothing), WORK_KHR(CmdCopyBufferToImage2, nothing),
        WORK(CmdCopyImageToBuffer, nothing), WORK_KHR(CmdCopyImageToBuffer2, nothing),
        WORK(CmdResolveImage, nothing), WORK_KHR(CmdResolveImage2, nothing),
        WORK(CmdClearColorImage, nothing), WORK(CmdClearDepthStencilImage, nothing),
    });
};

}  // namespace

std::span<const Intercept> work_intercepts() {
    static const auto all = list();
    return all;
}

}  // namespace myriad::profiler
