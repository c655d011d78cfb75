// A false librenderdoc.so, preloaded: it writes down what it is asked. FALSE_RENDERDOC_FAILS makes captures fail.
#include <renderdoc_app.h>

#include <cstdio>
#include <cstdlib>

namespace {

void say(const char* what) {
    if (std::FILE* file = std::fopen(std::getenv("FALSE_RENDERDOC_LOG"), "a")) std::fprintf(file, "%s\n", what), std::fclose(file);
}

void start(RENDERDOC_DevicePointer, RENDERDOC_WindowHandle) { say("start"); }

uint32_t end(RENDERDOC_DevicePointer, RENDERDOC_WindowHandle) {
    say("end");
    return !std::getenv("FALSE_RENDERDOC_FAILS");
}

}  // namespace

extern "C" int RENDERDOC_GetAPI(RENDERDOC_Version version, void** api) {
    static RENDERDOC_API_1_0_0 functions = {};
    functions.StartFrameCapture = start, functions.EndFrameCapture = end;
    *api = &functions;
    return version == eRENDERDOC_API_Version_1_0_0;
}
