// SPDX-License-Identifier: BSD-3-Clause
// Reads arbitrary bytes as the scene of a recording.
#include "record/scene_archive.h"

#include "fuzz.h"
#include "vps/errors.h"

int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  try {
    const vps::scenes::Scene scene =
        vps::scenes::sceneFromBytes({reinterpret_cast<const char*>(data), size}, "fuzz");
    for (const vps::scenes::ScenePart& part : scene.parts)
      for (const auto& triangle : part.part.mesh.triangles)
        for (const std::uint32_t corner : triangle)
          vps::fuzz::require(corner < part.part.mesh.vertices.size(), "all corners exist");
    for (const vps::scenes::SceneStep& step : scene.steps)
      vps::fuzz::require(step.part < scene.parts.size(), "the part of a step exists");
    const std::string again = vps::scenes::sceneToBytes(scene);
    vps::fuzz::require(vps::scenes::sceneToBytes(vps::scenes::sceneFromBytes(again, "fuzz")) == again,
                       "a scene is read back unchanged");
  } catch (const vps::LoadError&) {
  }
  return 0;
}

std::vector<std::string> vps::fuzz::seeds() {
  scenes::Scene scene;
  scene.name = "scene";
  scene.parts.resize(2);
  scene.parts[0].part.mesh = makeBox({1, 1, 1});
  scene.parts[0].part.name = "box";
  scene.steps.resize(1);
  scene.steps[0].way_points.resize(2);
  scene.coupling.k_N_per_m = 1000;
  return {scenes::sceneToBytes(scene)};
}
