// A frame for RenderDoc, where the program was started by it.
#pragma once

namespace myriad::tools {

bool renderdoc_attached();

// From its making to its end(), what the device is given is captured. RenderDoc must be attached. end() throws DeviceError when
// there is no capture.
class RenderdocCapture {
public:
    RenderdocCapture();
    void end();
};

}  // namespace myriad::tools
