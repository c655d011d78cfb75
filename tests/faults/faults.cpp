// Faults for the program under test, and for nothing else: this file is linked into `myriad_faulty`, which is the program with
// the calls below wrapped by the linker (--wrap). The product has no hook for it. A call fails as the world makes it fail:
//
//   MYRIAD_FAULT=CALL:N:ACTION    the N-th such call (from 1) of our code, libraries not counted
//     ACTION of new:       fail (that one), fail-on (that one and all later)
//            of Vulkan's:  a VkResult, which is returned in place of the call
//            of output's:  an errno, or kill-before, kill-after, interrupt-before, interrupt-after (SIGKILL, SIGINT)
//   MYRIAD_FAULT_COUNTS=FILE      writes how often each was called, "CALL COUNT" a line, at the end of the process
#include <fcntl.h>
#include <signal.h>
#include <unistd.h>

#include <atomic>
#include <cerrno>
#include <cstdarg>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <new>

#include <vulkan/vulkan.h>

namespace {

// All in static memory: operator new is among the patients.
struct Fault {
    char call[64] = "", action[64] = "";
    long at = 0;

    Fault() {
        if (const char* text = std::getenv("MYRIAD_FAULT")) std::sscanf(text, "%63[^:]:%ld:%63s", call, &at, action);
    }
};

const Fault& fault() {
    static const Fault instance;
    return instance;
}

std::atomic<bool> in_main{false};  // what static objects allocate before is not counted: nobody could catch it

struct Counter {
    explicit constexpr Counter(const char* name) : name(name) {}
    const char* name;
    std::atomic<long> count{0};

    // Whether this call is the one that fails, or comes after it.
    bool hit(bool and_later = false) {
        if (!in_main) return false;
        const long number = ++count;
        return std::strcmp(fault().call, name) == 0 && (and_later ? number >= fault().at : number == fault().at);
    }
};

Counter news("new"), allocations("vkAllocateMemory"), buffers("vkCreateBuffer"), pipelines("vkCreateComputePipelines"), submits("vkQueueSubmit2"),
    waits("vkWaitForFences"), opens("open"), writes("fwrite"), flushes("fflush"), syncs("fsync"), closes("fclose"), renames("rename");

struct Report {
    ~Report() {
        const char* path = std::getenv("MYRIAD_FAULT_COUNTS");
        FILE* out = path ? std::fopen(path, "w") : nullptr;
        if (!out) return;
        for (const Counter* c : {&news, &allocations, &buffers, &pipelines, &submits, &waits, &opens, &writes, &flushes, &syncs, &closes, &renames})
            std::fprintf(out, "%s %ld\n", c->name, c->count.load());
    }
} report;

VkResult result() { return static_cast<VkResult>(std::atoi(fault().action)); }

bool action_is(const char* name) { return std::strcmp(fault().action, name) == 0; }

// Around a call that returns `failed` and sets errno when it fails.
template <class Result, class Call>
Result output(Counter& counter, Result failed, const Call& call) {
    if (!counter.hit()) return call();
    if (action_is("kill-before")) kill(getpid(), SIGKILL);
    if (action_is("interrupt-before")) raise(SIGINT);
    if (const int error = std::atoi(fault().action)) {
        errno = error;
        return failed;
    }
    const Result result = call();
    if (action_is("kill-after")) kill(getpid(), SIGKILL);
    if (action_is("interrupt-after")) raise(SIGINT);
    return result;
}

}  // namespace

extern "C" {

#define MYRIAD_WRAP(type, name, parameters) \
    type __real_##name parameters;          \
    type __wrap_##name parameters

MYRIAD_WRAP(int, main, (int argc, char** argv)) {
    in_main = true;
    return __real_main(argc, argv);
}

MYRIAD_WRAP(void*, _Znwm, (size_t bytes)) {
    if (news.hit(action_is("fail-on"))) throw std::bad_alloc();
    return __real__Znwm(bytes);
}

MYRIAD_WRAP(VkResult, vkAllocateMemory, (VkDevice d, const VkMemoryAllocateInfo* i, const VkAllocationCallbacks* a, VkDeviceMemory* m)) {
    return allocations.hit() ? result() : __real_vkAllocateMemory(d, i, a, m);
}
MYRIAD_WRAP(VkResult, vkCreateBuffer, (VkDevice d, const VkBufferCreateInfo* i, const VkAllocationCallbacks* a, VkBuffer* b)) {
    return buffers.hit() ? result() : __real_vkCreateBuffer(d, i, a, b);
}
MYRIAD_WRAP(VkResult, vkCreateComputePipelines,
            (VkDevice d, VkPipelineCache c, uint32_t n, const VkComputePipelineCreateInfo* i, const VkAllocationCallbacks* a, VkPipeline* p)) {
    return pipelines.hit() ? result() : __real_vkCreateComputePipelines(d, c, n, i, a, p);
}
MYRIAD_WRAP(VkResult, vkQueueSubmit2, (VkQueue q, uint32_t n, const VkSubmitInfo2* s, VkFence f)) {
    return submits.hit() ? result() : __real_vkQueueSubmit2(q, n, s, f);
}
MYRIAD_WRAP(VkResult, vkWaitForFences, (VkDevice d, uint32_t n, const VkFence* f, VkBool32 all, uint64_t timeout)) {
    const VkResult real = __real_vkWaitForFences(d, n, f, all, timeout);  // first: the device must be idle when all is torn down
    return waits.hit() ? result() : real;
}

int __real_open(const char* path, int flags, ...);
int __wrap_open(const char* path, int flags, ...) {
    va_list rest;
    va_start(rest, flags);
    const mode_t mode = flags & O_CREAT ? mode_t(va_arg(rest, int)) : 0;
    va_end(rest);
    return output(opens, -1, [&] { return __real_open(path, flags, mode); });
}
MYRIAD_WRAP(size_t, fwrite, (const void* data, size_t size, size_t count, FILE* file)) {
    return output(writes, size_t(0), [&] { return __real_fwrite(data, size, count, file); });
}
MYRIAD_WRAP(int, fflush, (FILE* file)) {
    return output(flushes, EOF, [&] { return __real_fflush(file); });
}
MYRIAD_WRAP(int, fsync, (int file)) {
    return output(syncs, -1, [&] { return __real_fsync(file); });
}
MYRIAD_WRAP(int, fclose, (FILE* file)) {
    return output(closes, EOF, [&] { return __real_fclose(file); });
}
MYRIAD_WRAP(int, rename, (const char* from, const char* to)) {
    return output(renames, -1, [&] { return __real_rename(from, to); });
}
}
