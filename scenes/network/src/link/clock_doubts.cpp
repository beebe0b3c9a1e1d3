// SPDX-License-Identifier: BSD-3-Clause
#include "link/clock_doubts.h"

namespace vps::scenes {

namespace {

constexpr std::size_t kMostDoubtsSaid = 16;  // assumed: a flood of nodes that lie is not worth more lines

const char* nodeOf(NodeRole role) {
  switch (role) {
    case NodeRole::Render:
      return "the render node";
    case NodeRole::Device:
      return "the device's node";
    case NodeRole::Watch:
      return "a watcher";
  }
  return "a node";
}

}  // namespace

std::vector<std::string> ClockDoubts::takeNew(const Link& link) {
  std::vector<std::string> words;
  for (const PeerDoubt& doubt : link.doubts())
    if (said_.size() < kMostDoubtsSaid && said_.insert(doubt.sender).second)
      words.push_back(std::string("the times that ") + nodeOf(doubt.role) +
                      " sends contradict each other; those that cannot be are not believed");
  return words;
}

std::string ClockDoubts::summary(const Link& link) {
  std::string words;
  for (const PeerDoubt& doubt : link.doubts())
    words += (words.empty() ? "" : ", ") + std::to_string(doubt.contradictions) + " of " + nodeOf(doubt.role);
  return words.empty() ? "" : "times that cannot be and were not believed: " + words;
}

}  // namespace vps::scenes
