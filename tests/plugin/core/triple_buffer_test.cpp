// SPDX-License-Identifier: BSD-3-Clause
#include "vps/triple_buffer.h"

#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <array>
#include <cstdint>
#include <cstdlib>
#include <memory>
#include <thread>

#include "support/no_alloc.h"

namespace vps {
namespace {

TEST(TripleBuffer, TheReaderGetsTheInitialValueThenOnlyTheLatest) {
  TripleBuffer<int> buffer(7);
  EXPECT_EQ(buffer.read(), 7);
  buffer.write(1);
  buffer.write(2);
  EXPECT_EQ(buffer.read(), 2);
  EXPECT_EQ(buffer.read(), 2);  // nothing new: the same value
}

TEST(TripleBuffer, WritingDoesNotChangeTheValueBeingRead) {
  TripleBuffer<int> buffer(0);
  buffer.write(1);
  const int& held = buffer.read();
  for (int value = 2; value < 10; ++value) buffer.write(value);
  EXPECT_EQ(held, 1);
  EXPECT_EQ(buffer.read(), 9);
}

// A value wider than any atomic store; torn if its words differ.
struct Wide {
  std::array<std::uint64_t, 16> words{};
};

TEST(TripleBuffer, ThreadsNeverSeeATornOrOlderValue) {
  constexpr std::uint64_t kLast = 200000;
  TripleBuffer<Wide> buffer;
  std::thread writer([&buffer] {
    Wide value;
    for (std::uint64_t i = 1; i <= kLast; ++i) {
      value.words.fill(i);
      buffer.write(value);
    }
  });
  std::uint64_t newest = 0, torn = 0, backwards = 0;
  while (newest < kLast) {
    const Wide& value = buffer.read();
    const std::uint64_t first = value.words.front();
    for (const std::uint64_t word : value.words) torn += word != first;
    backwards += first < newest;
    newest = first;
  }
  writer.join();
  EXPECT_EQ(torn, 0u);
  EXPECT_EQ(backwards, 0u);
}

TEST(TripleBuffer, NeitherSideAllocates) {
  TripleBuffer<Wide> buffer;
  const vps_test::NoAllocScope guard;
  buffer.write(Wide{});
  EXPECT_EQ(buffer.read().words[0], 0u);
}

TEST(NoAllocScope, FailsATestThatAllocates) {
  EXPECT_NONFATAL_FAILURE(
      {
        const vps_test::NoAllocScope guard;
        // Allocates by a direct call of the function, because a compiler may remove a new whose block nobody
        // else uses.
        ::operator delete(::operator new(1));
      },
      "heap calls in a scope that must have none");
}

TEST(NoAllocScope, CountsNestedScopesAndForgetsWhatWasBefore) {
  const auto before = std::make_unique<int>(1);  // made before and released after the scopes, so not counted
  const vps_test::NoAllocScope outer;
  {
    const vps_test::NoAllocScope inner;
    EXPECT_EQ(inner.count(), 0u);
  }
  EXPECT_EQ(outer.count(), 0u);
}

}  // namespace
}  // namespace vps
