// SPDX-License-Identifier: BSD-3-Clause
// Which parts of the finished assembly are near a part, measured on a thread of its own.
#pragma once

#include <future>
#include <string>
#include <vector>

#include "vps_scenes/fits/check_types.h"
#include "vps_scenes/scene/scene.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

class VPS_VIEWER_API Neighbours {
 public:
  /// The scene outlives it.
  explicit Neighbours(const scenes::Scene& scene) : scene_(scene) {}

  /// One line for each part within 1 mm: "housing: contact", "shaft: 12.5 µm apart". The first call begins to
  /// measure; until that is done there is the line "measuring ...".
  [[nodiscard]] std::vector<std::string> of(const std::string& part);

 private:
  const scenes::Scene& scene_;
  std::shared_future<scenes::CheckResult> checked_;
};

}  // namespace vps::viewer
