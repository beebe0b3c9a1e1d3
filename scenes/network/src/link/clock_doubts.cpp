// SPDX-License-Identifier: BSD-3-Clause
#include "link/link.h"

namespace vps::scenes {

namespace {

constexpr std::size_t kMostDoubtsSaid =
    16;  // limits the number of messages if many nodes send inconsistent times

const char* nodeOf(NodeRole role) {
  switch (role) {
    case NodeRole::Render:
      return "the render node";
    case NodeRole::Device:
      return "the device node";
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
      words.push_back(std::string("the clock of ") + nodeOf(doubt.role) +
                      " is inconsistent; its contradictory times are ignored");
  return words;
}

std::string ClockDoubts::summary(const Link& link) {
  std::string words;
  for (const PeerDoubt& doubt : link.doubts())
    words +=
        (words.empty() ? "" : ", ") + std::to_string(doubt.contradictions) + " from " + nodeOf(doubt.role);
  return words.empty() ? "" : "contradictory times that were ignored: " + words;
}

}  // namespace vps::scenes
