#include "tools/capture.hpp"

#include <dlfcn.h>
#include <renderdoc_app.h>

#include "engine/error.hpp"

namespace myriad::tools {
namespace {

// Asked of the library that RenderDoc put into this process; it is never loaded from here.
RENDERDOC_API_1_0_0* api() {
    static RENDERDOC_API_1_0_0* const found = [] {
        RENDERDOC_API_1_0_0* made = nullptr;
        void* library = dlopen("librenderdoc.so", RTLD_NOW | RTLD_NOLOAD);
        const auto get = library ? reinterpret_cast<pRENDERDOC_GetAPI>(dlsym(library, "RENDERDOC_GetAPI")) : nullptr;
        return get && get(eRENDERDOC_API_Version_1_0_0, reinterpret_cast<void**>(&made)) ? made : nullptr;
    }();
    return found;
}

}  // namespace

bool renderdoc_attached() { return api() != nullptr; }

// There is one device and no window, so none is named.
RenderdocCapture::RenderdocCapture() { api()->StartFrameCapture(nullptr, nullptr); }

void RenderdocCapture::end() {
    if (!api()->EndFrameCapture(nullptr, nullptr))
        throw DeviceError("--capture-frame: RenderDoc made no capture; see its log, or leave the option out");
}

}  // namespace myriad::tools
