// The one family of errors that crosses rooms.
//
// Policy: a programmer's error asserts; the outside world (files, arguments, devices, memory) throws an Error whose
// message names the thing, the place and the cure in one sentence; an expected outcome is a return value. Only `tools/`
// catches, and turns the kind into the exit status of the program (spec, section 5).
#pragma once

#include <stdexcept>
#include <string>

namespace myriad {

class Error : public std::runtime_error {
public:
    enum class Kind {
        check_failed = 1,  // a comparison or a check that the user asked for did not hold
        bad_input = 2,     // bad usage or bad input
        device = 3,        // no usable device, a lost device, or out of memory
    };

    Error(Kind kind, const std::string& message) : std::runtime_error(message), kind_(kind) {}

    Kind kind() const { return kind_; }
    int exit_status() const { return static_cast<int>(kind_); }

private:
    Kind kind_;
};

struct InputError : Error {
    explicit InputError(const std::string& message) : Error(Kind::bad_input, message) {}
};
struct DeviceError : Error {
    explicit DeviceError(const std::string& message) : Error(Kind::device, message) {}
};
struct OutOfMemory : DeviceError {
    explicit OutOfMemory(const std::string& message) : DeviceError(message) {}
};

}  // namespace myriad
