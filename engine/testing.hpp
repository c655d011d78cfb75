// What every device test needs. Tests only; the product never includes it.
#pragma once

#include <cstdint>
#include <random>

#include <gtest/gtest.h>

#include "engine/transfer.hpp"

namespace myriad::engine {

// A device with the validation layer on where it is installed; each test ends with the demand that it said nothing.
class DeviceTest : public ::testing::Test {
protected:
    DeviceTest() : device({.select = "", .validation = true, .memory_limit = 0}) {}
    void TearDown() override { EXPECT_EQ(device.validation_messages(), 0u) << "the validation layer complained (see above)"; }

    // Uploads under the name that memory accounting shows for tests.
    template <class T>
    Array<T> on_device(const std::vector<T>& values) {
        return upload(device, "test", "test input", values);
    }

    Device device;
    std::mt19937 random{12345};
};

// Compares element by element and shows the first that differs, and how many do.
template <class T>
::testing::AssertionResult same(const std::vector<T>& expected, const std::vector<T>& actual) {
    if (expected.size() != actual.size())
        return ::testing::AssertionFailure() << "sizes differ: " << expected.size() << " expected, " << actual.size() << " found";
    size_t wrong = 0, first = 0;
    for (size_t i = expected.size(); i-- > 0;)
        if (!(expected[i] == actual[i])) ++wrong, first = i;
    if (!wrong) return ::testing::AssertionSuccess();
    return ::testing::AssertionFailure() << wrong << " of " << expected.size() << " differ, first [" << first
                                         << "]: " << ::testing::PrintToString(expected[first]) << " expected, "
                                         << ::testing::PrintToString(actual[first]) << " found";
}

}  // namespace myriad::engine
