// SPDX-License-Identifier: BSD-3-Clause
// The facts of a render node's run, and the state of its recordings.
#include "requests/request_handler.h"

#include <filesystem>
#include <mutex>
#include <utility>

#include "record/scene_archive.h"

namespace vps::scenes {

std::string unusedFile(const std::string& wanted) {
  namespace fs = std::filesystem;
  const fs::path path(wanted);
  std::error_code error;
  std::string file = wanted;
  for (int number = 2; fs::exists(file, error); ++number)
    file = (path.parent_path() /
            (path.stem().string() + "-" + std::to_string(number) + path.extension().string()))
               .string();
  return file;
}

void ServedRun::begin(const Scene& scene, std::string scene_bytes, const Link& link,
                      const std::string& recording) {
  const std::lock_guard lock(mutex_);
  const std::uint64_t number = facts_.number + 1;
  facts_ = {};
  facts_.number = number;
  facts_.name = scene.name;
  facts_.hash = contentHash(scene_bytes);
  facts_.bytes = std::move(scene_bytes);
  for (const SceneStep& step : scene.steps) facts_.parts.push_back(scene.parts[step.part].part.name);
  facts_.recording = recording;
  if (!recording.empty())
    recorded_[recording] = Recorded::Growing;  // from now on other programs may request the recording
  facts_.is_running = true;
  link_ = &link;
}

void ServedRun::beginRecording(const std::string& file) {
  const std::lock_guard lock(mutex_);
  facts_.has_begun = true;
  facts_.recording = file;
  if (!file.empty()) recorded_[file] = Recorded::Growing;
}

void ServedRun::finishRecording() {
  const std::lock_guard lock(mutex_);
  if (!facts_.recording.empty()) recorded_[facts_.recording] = Recorded::Whole;
}

ServedRun::Recorded ServedRun::stateOf(const std::string& file) const {
  const std::lock_guard lock(mutex_);
  const auto found = recorded_.find(file);
  return found != recorded_.end() ? found->second : Recorded::Failed;
}

void ServedRun::end() {
  const std::lock_guard lock(mutex_);
  if (const auto found = recorded_.find(facts_.recording);
      found != recorded_.end() && found->second == Recorded::Growing)
    found->second = Recorded::Failed;
  link_ = nullptr;
  facts_.is_running = false;
}

void ServedRun::setDevice(const std::string& name, bool may_rearm, const CouplingGains& gains,
                          const CouplingGains& most) {
  const std::lock_guard lock(mutex_);
  facts_.device = name;
  facts_.may_rearm = may_rearm;
  facts_.gains = gains;
  facts_.most = most;
}

ServedRun::Facts ServedRun::facts(bool with_bytes) const {
  const std::lock_guard lock(mutex_);
  Facts facts = facts_;
  if (!with_bytes) facts.bytes.clear();
  facts.has_device = link_ != nullptr && link_->isAlive(NodeRole::Device);
  facts.watchers = link_ != nullptr ? link_->watchers() : 0;
  return facts;
}

}  // namespace vps::scenes
