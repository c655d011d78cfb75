// For tests: how a file is refused.
#pragma once

#include <string>

#include <gtest/gtest.h>

#include "engine/error.hpp"

namespace myriad::scenes {

// The message of the InputError that the action throws; it names the file first, is one line, and ends with a full stop.
template <class Action>
std::string refusal(const std::string& path, Action action) {
    try {
        action();
    } catch (const InputError& e) {
        const std::string message = e.what();
        EXPECT_EQ(message.find(path), 0u) << message;
        EXPECT_EQ(message.find('\n'), std::string::npos) << message;
        EXPECT_EQ(message.back(), '.') << message;
        return message;
    }
    return "(accepted)";
}

}  // namespace myriad::scenes
