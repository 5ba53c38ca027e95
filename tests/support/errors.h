// SPDX-License-Identifier: Apache-2.0
// What an action says when it refuses its input.
#pragma once

#include <gtest/gtest.h>

#include <string>

#include "base/error.h"

namespace obscura::test {

// The message of the InputError that action throws; a test failure and "" if it throws none.
template <typename Action>
std::string input_error(Action&& action) {
    try {
        action();
    } catch (const InputError& error) {
        return error.what();
    }
    ADD_FAILURE() << "no InputError was thrown";
    return "";
}

}  // namespace obscura::test

// The action throws an InputError whose message contains text.
#define EXPECT_INPUT_ERROR(action, text)                                                  \
    do {                                                                                  \
        const std::string message_ = ::obscura::test::input_error([&] { action; });       \
        EXPECT_NE(message_.find(text), std::string::npos) << "the message: " << message_; \
    } while (false)
