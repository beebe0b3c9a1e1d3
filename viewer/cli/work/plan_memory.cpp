// SPDX-License-Identifier: BSD-3-Clause
#include "work/plan_memory.h"

#include <nlohmann/json.hpp>

#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>

#include "vps/errors.h"
#include "vps_scenes/fits/check.h"

namespace vps::viewer {

namespace {

using nlohmann::json;

/// FNV-1a of 64 bits.
class Key {
 public:
  void add(const void* data, std::size_t size) {
    for (std::size_t i = 0; i < size; ++i)
      key_ = (key_ ^ static_cast<const unsigned char*>(data)[i]) * 0x100000001b3ULL;
  }
  void add(const std::string& text) { add(text.c_str(), text.size() + 1); }
  void add(double x) { add(&x, sizeof x); }
  [[nodiscard]] std::string text() const { return std::to_string(key_); }

 private:
  std::uint64_t key_ = 0xcbf29ce484222325ULL;
};

std::optional<json> jsonOf(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) return std::nullopt;
  return json::parse(in, nullptr, false);
}

}  // namespace

std::string planKey(const scenes::Scene& scene, const scenes::PlanSettings& settings) {
  constexpr int kForm = 1;  // of what PlanFindings::motions mean
  Key key;
  key.add(kForm);
  for (const scenes::DrawnPart& part : drawnParts(scene)) {
    key.add(part.name);
    key.add(part.mesh.vertices.data(), part.mesh.vertices.size() * sizeof part.mesh.vertices[0]);
    key.add(part.mesh.triangles.data(), part.mesh.triangles.size() * sizeof part.mesh.triangles[0]);
    for (const double x : {part.X_WP.p.x(), part.X_WP.p.y(), part.X_WP.p.z()}) key.add(x);
    for (int i = 0; i < 9; ++i) key.add(part.X_WP.R(i / 3, i % 3));
    for (const double x : {part.chord_m.value_or(-1), part.press_fit_m, part.rounding_m}) key.add(x);
    key.add(part.allow_overlap ? 1.0 : 0.0);
  }
  for (const scenes::ScenePart& part : scene.parts) key.add(part.is_scenery ? 1.0 : 0.0);
  for (int axis = 0; axis < 3; ++axis) key.add(scene.gravity_W[axis]);
  for (const std::string& name : settings.fixed) key.add(name);
  return key.text();
}

std::string findingsText(const std::string& key, const scenes::PlanFindings& found) {
  return json{{"parts", key}, {"taken_off", found.taken_off}, {"motions", found.motions}}.dump() + "\n";
}

std::optional<scenes::PlanFindings> readFindings(const std::string& file, const std::string& key) {
  const std::optional<json> all = jsonOf(file);
  if (!all) return std::nullopt;
  try {
    if (all->at("parts").get<std::string>() != key)
      throw LoadError(file, "", "is of other parts or another base; delete it, or leave out --resume");
    return scenes::PlanFindings{all->at("motions").get<std::vector<std::uint64_t>>(),
                                all->at("taken_off").get<std::vector<std::string>>()};
  } catch (const json::exception&) {
    throw LoadError(file, "", "is damaged; delete it, or leave out --resume");
  }
}

std::map<std::string, double> plannedClearances(const std::string& scene_file) {
  const std::filesystem::path path(scene_file);
  const std::optional<json> plan = jsonOf((path.parent_path() / "plan.json").string());
  std::map<std::string, double> out;
  if (!plan || plan->is_discarded()) return out;
  try {
    const json& assemblies = plan->at("assemblies");
    const bool is_product = path.filename() == "scene.toml";
    for (std::size_t i = 0; i < assemblies.size(); ++i) {
      const json& assembly = assemblies[i];
      if (is_product ? i != 0 : assembly.at("name").get<std::string>() != path.stem().string()) continue;
      for (const json& step : assembly.at("steps")) {
        const json& clearance = step.at("clearance_m");
        out[step.at("name").get<std::string>()] =
            clearance.is_null() ? scenes::kNearWay_m : clearance.get<double>();
      }
    }
  } catch (const json::exception&) {
    return {};  // of another program
  }
  return out;
}

}  // namespace vps::viewer
