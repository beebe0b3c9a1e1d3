// SPDX-License-Identifier: BSD-3-Clause
// A session's name that no other test of this machine uses at the same time.
#pragma once

#include <gtest/gtest.h>
#include <unistd.h>

#include <functional>
#include <string>

namespace vps::scenes {

inline std::string sessionName(const std::string& topic) {
  const auto* info = testing::UnitTest::GetInstance()->current_test_info();
  const std::size_t test = std::hash<std::string>{}(info->name()) % 100000;
  return topic + "-" + std::to_string(getpid()) + "-" + std::to_string(test);
}

}  // namespace vps::scenes
