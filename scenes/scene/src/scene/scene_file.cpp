// SPDX-License-Identifier: BSD-3-Clause
// loadScene(): TOML to Scene. The keys are listed in vps_scenes/scene/settings_fields.h.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <limits>
#include <map>
#include <span>
#include <sstream>

#include "import/readers.h"
#include "scene/read_fields.h"
#include "scene/scene_file_tables.h"
#include "vps/errors.h"
#include "vps_device/device_kinds.h"
#include "vps_device/dual_arm/parameters.h"
#include "vps_scenes/cad/colors.h"
#include "vps_scenes/cad/import.h"
#include "vps_scenes/scene/scene_parts.h"
#include "vps_scenes/scene/settings_fields.h"

namespace vps::scenes {

namespace {

namespace fs = std::filesystem;

/// Reads "#rrggbb" or [r, g, b] from 0 to 1, both in sRGB.
void readColor(const SceneKeys& keys, std::array<float, 3>& color) {
  double srgb[3];
  if (std::string text; keys.isText("color") && keys.text("color", text)) {
    if (text.size() != 7 || text[0] != '#' ||
        text.find_first_not_of("0123456789abcdefABCDEF", 1) != std::string::npos)
      keys.fail("color", "is '" + text + R"('; expected "#rrggbb" or [r, g, b], each 0 to 1)");
    for (std::size_t i = 0; i < 3; ++i) srgb[i] = std::stoi(text.substr(1 + 2 * i, 2), nullptr, 16) / 255.0;
  } else if (!keys.numbers("color", 3, srgb, {.min = 0, .max = 1})) {
    return;
  }
  for (std::size_t i = 0; i < 3; ++i) color[i] = static_cast<float>(linearFromSrgb(srgb[i]));
}

/// Index of the part that a key names; the message for an unknown name offers the nearest known name.
template <typename Parts, typename NameOf>
std::size_t partNamed(const SceneKeys& keys, std::string_view key, const std::string& name,
                      const Parts& parts, NameOf nameOf) {
  const auto match = std::ranges::find(parts, name, nameOf);
  if (match != parts.end()) return static_cast<std::size_t>(match - parts.begin());
  std::vector<std::string> names;
  for (const auto& part : parts) names.push_back(nameOf(part));
  keys.fail(key, "names '" + name + "', which is not the name of a part" + didYouMean(name, names));
}

const std::string& nameOf(const ScenePart& part) {
  return part.part.name;
}
const std::string& nameOfImported(const ImportedPart& part) {
  return part.name;
}

ScenePart placedPart(const ImportedPart& imported, const std::string& file, const Material& material) {
  ScenePart part;
  part.part.name = imported.name;
  part.part.mesh = imported.mesh;
  part.part.material = material;
  part.part.color = imported.color;
  part.part.face_colors = imported.face_colors;
  part.X_WP = imported.X_WP;
  part.file = file;
  part.deflection_m = imported.deflection_m;
  part.rounding_m = imported.rounding_m;
  part.within = imported.within;
  return part;
}

class SceneReader {
 public:
  SceneReader(const toml::table& root, const std::string& file, const Progress& progress,
              const ByteCache* cache)
      : context_{file, std::nullopt}, top_(root, context_, "", keysOf(kSceneKeys)), progress_(progress) {
    scene_.file = file;
    import_.cache = cache;
  }

  Scene read() {
    readTop();
    readCad();
    for (const toml::table* table : top_.tables("part")) readPart(*table);
    if (scene_.parts.empty()) top_.failWhole(R"(has no part; name one in [[part]] with file = "part.stl")");
    for (const toml::table* table : top_.tables("group")) readGroup(*table);
    uniteGroups(scene_, groups_);
    for (const toml::table* table : top_.tables("step")) readStep(*table);
    requireNearOrigin();
    readDevice();
    readTable("operator", scene_.hand, kOperatorFields);
    readTable("coupling", scene_.coupling, kCouplingFields);
    readFidelity(top_, context_, scene_);
    readTable("record", scene_.record, kRecordFields);
    return std::move(scene_);
  }

 private:
  void readTop() {
    scene_.name = fs::absolute(context_.file).parent_path().filename().string();
    top_.text("name", scene_.name);
    if (std::string unit; top_.text("unit", unit)) {
      context_.unit_m = unitFromText(unit);
      if (!context_.unit_m) top_.fail("unit", "is '" + unit + "'; expected one of: mm, cm, m, um, inch");
    }
    top_.numbers("gravity", 3, scene_.gravity_W.data());
    readFields(top_, scene_, kSceneKeys);
    if (top_.text("missing", scene_.missing) && !scene_.missing.empty())
      scene_.warnings.push_back("lacks geometry of its CAD file: " + scene_.missing);
    import_.unit_m = context_.unit_m;
    top_.length("deflection", import_.deflection_m, kPositive);
    readTable("material", material_, kMaterialFields);
  }

  /// Reads a table whose keys are all in its field table.
  template <typename Struct, typename Rows>
  void readTable(const std::string& name, Struct& out, const Rows& rows) {
    if (const toml::table* table = top_.table(name))
      readFields(SceneKeys(*table, context_, "[" + name + "]", keysOf(rows)), out, rows);
  }

  /// The path of a file whose name is relative to the scene file's folder.
  [[nodiscard]] std::string path(const std::string& file) const {
    return (fs::path(context_.file).parent_path() / file).lexically_normal().string();
  }

  /// Reads each CAD file once, even if several parts come from it.
  const ImportedCad& cad(const SceneKeys& keys, std::string_view key, const std::string& file,
                         PartPer part_per = PartPer::Body) {
    const auto known = cads_.find({file, part_per});
    if (known != cads_.end()) return known->second;
    try {
      import_.part_per = part_per;
      const ImportedCad& cad =
          cads_.emplace(std::pair(file, part_per), importCad(path(file), import_, progress_)).first->second;
      for (const std::string& warning : cad.warnings)  // each warning once, even if a file is read twice
        if (const std::string line = file + ": " + warning;
            std::ranges::find(scene_.warnings, line) == scene_.warnings.end())
          scene_.warnings.push_back(line);
      if (const std::string words = file + ": " + cad.missing;
          !cad.missing.empty() && scene_.missing.find(words) == std::string::npos)
        scene_.missing.append(scene_.missing.empty() ? "" : "; ").append(words);
      return cad;
    } catch (const LoadError& error) {
      keys.fail(key, std::string("cannot be used: ") + error.what());
    }
  }

  void readCad() {
    std::string file, fallback;
    if (top_.text("cad_fallback", fallback) && !top_.has("cad"))
      top_.fail("cad_fallback",
                "replaces a 'cad' whose library is missing, but the file has no 'cad'; add the key 'cad'");
    if (!top_.text("cad", file)) return;
    if (fallback.empty()) return addCad("cad", file);
    try {
      return addCad("cad", file);
    } catch (const LoadError& error) {
      if (!import::isMissingLibrary(error)) throw;
      std::fprintf(stderr, "%s; using %s\n", error.what(), fallback.c_str());
    }
    addCad("cad_fallback", fallback);
  }

  void addCad(std::string_view key, const std::string& file) {
    for (const ImportedPart& imported : cad(top_, key, file).parts)
      scene_.parts.push_back(placedPart(imported, path(file), material_));
    cad_count_ = scene_.parts.size();
    is_described_.assign(cad_count_, false);
  }

  void readPart(const toml::table& table) {
    const SceneKeys keys(table, context_, "[[part]]", keysOf(kPartKeys));
    ScenePart& part = keys.has("file") ? addPart(keys) : cadPart(keys);
    for (const ScenePart& other : scene_.parts)
      if (&other != &part && other.part.name == part.part.name)
        keys.failWhole("is the second part named '" + part.part.name + "'; give it another 'name'");
    keys.pose("pose", part.X_WP);
    keys.numbers("velocity_m_s", 3, part.V_WP_W.v.data());
    keys.numbers("angular_velocity_rad_s", 3, part.V_WP_W.w.data());
    readFields(keys, part, kPartKeys);
    for (const char* key : {"velocity_m_s", "angular_velocity_rad_s"})
      if (part.is_fixed && keys.has(key))
        keys.fail(key, "has no effect on a fixed part; leave out the key or 'fixed'");
    if (keys.has("color")) part.part.face_colors = {};  // the file sets one colour for the whole part
    readColor(keys, part.part.color);
  }

  /// Adds a part with a file of its own.
  ScenePart& addPart(const SceneKeys& keys) {
    std::string file, node, name;
    keys.text("file", file);
    const bool is_whole = keys.text("node", node) && node == "*";
    const ImportedCad& found = cad(keys, "file", file, is_whole ? PartPer::File : PartPer::Body);
    std::size_t index = 0;
    if (!node.empty() && !is_whole) {
      index = partNamed(keys, "node", node, found.parts, nameOfImported);
      name = node;
    } else {
      std::vector<std::string> names;
      for (const ImportedPart& part : found.parts) names.push_back(part.name);
      if (found.parts.size() != 1)
        keys.fail(
            "file",
            "has " + std::to_string(found.parts.size()) +
                " parts; name one of them with 'node', or write node = \"*\" for the whole file as one part" +
                didYouMean("", names));
      name = fs::path(file).stem().string();
    }
    keys.text("name", name);
    scene_.parts.push_back(placedPart(found.parts[index], path(file), material_));
    scene_.parts.back().part.name = name;
    return scene_.parts.back();
  }

  /// The part of the scene's CAD file to which a [[part]] without a file belongs.
  ScenePart& cadPart(const SceneKeys& keys) {
    std::string name, node;
    if (!keys.text("name", name) && !keys.has("node"))
      keys.failWhole("has neither 'name' nor 'file'; give one of the two keys");
    if (cad_count_ == 0) keys.failWhole("has no 'file'; name the part's mesh file");
    const bool has_node = keys.text("node", node);
    const auto of_cad = std::span(scene_.parts).first(cad_count_);
    const std::size_t index =
        partNamed(keys, has_node ? "node" : "name", has_node ? node : name, of_cad, nameOf);
    if (is_described_[index])
      keys.failWhole("describes '" + of_cad[index].part.name +
                     "' for the second time; describe each part in one [[part]]");
    is_described_[index] = true;
    if (!name.empty()) scene_.parts[index].part.name = name;
    return scene_.parts[index];
  }

  void readGroup(const toml::table& table) {
    const SceneKeys keys(table, context_, "[[group]]", keysOf(kGroupKeys));
    PartGroup group;
    if (!keys.text("name", group.name) || group.name.empty())
      keys.failWhole("has no 'name'; give the body a name");
    if (!keys.texts("parts", group.parts)) keys.failWhole("has no 'parts'; list the names of its parts");
    if (group.parts.size() < 2) keys.fail("parts", "names fewer than two parts; a group has two or more");
    const ScenePart* first = nullptr;
    for (const std::string& name : group.parts) {
      const ScenePart& part = scene_.parts[partNamed(keys, "parts", name, scene_.parts, nameOf)];
      if (const auto in = group_of_.find(name); in != group_of_.end())
        keys.fail("parts", "names '" + name + "', which is in the group '" + in->second + "' already");
      group_of_[name] = group.name;
      if (first == nullptr) first = &part;
      if (part.is_scenery != first->is_scenery)
        keys.fail("parts",
                  "names '" + first->part.name + "' and '" + name +
                      "', of which only one is scenery; either all parts of a group are scenery or none");
    }
    for (const PartGroup& other : groups_)
      if (other.name == group.name)
        keys.fail("name",
                  "is '" + group.name + "', which is also the name of another group; give it another name");
    for (const ScenePart& part : scene_.parts)
      if (part.part.name == group.name && std::ranges::find(group.parts, group.name) == group.parts.end())
        keys.fail("name",
                  "is '" + group.name +
                      "', which is also the name of a part outside of the group; give it another name");
    groups_.push_back(std::move(group));
  }

  void readStep(const toml::table& table) {
    const SceneKeys keys(table, context_, "[[step]]", keysOf(kStepKeys));
    SceneStep step;
    std::string name;
    if (!keys.text("part", name)) keys.failWhole("has no 'part'; name the part that the step mounts");
    if (const auto in = group_of_.find(name);
        in != group_of_.end() && in->second != name &&
        std::ranges::find(scene_.parts, name, nameOf) == scene_.parts.end())
      keys.fail("part", "names '" + name + "', which is part of the group '" + in->second +
                            "'; name the group, which moves as one");
    step.part = partNamed(keys, "part", name, scene_.parts, nameOf);
    const ScenePart& part = scene_.parts[step.part];
    if (part.is_fixed)
      keys.fail("part", "names '" + name + "', which is fixed; a step mounts a part that is not fixed");
    for (const SceneStep& earlier : scene_.steps)
      if (earlier.part == step.part) keys.fail("part", "names '" + name + "', which an earlier step mounts");

    step.X_WP_target = part.X_WP;
    keys.pose("target", step.X_WP_target);
    step.X_WP_start = step.X_WP_target;
    if (Vec3 offset_W; keys.position("approach", offset_W)) {
      if (keys.has("start"))
        keys.fail("approach", "cannot be combined with 'start'; give one of the two keys");
      step.X_WP_start.p += offset_W;
    } else if (!keys.pose("start", step.X_WP_start)) {
      step.X_WP_start.p.z() += liftToClear(step);
    }
    keys.poses("way_points", step.X_WP_target, step.way_points);
    readFields(keys, step, kStepKeys);
    completeScrew(keys, part.part.mesh, step);
    scene_.steps.push_back(std::move(step));
  }

  /// The distance [m] along +z from a part's target at which the part is above all fixed parts and all parts
  /// of earlier steps, with a gap of half the part's height.
  [[nodiscard]] double liftToClear(const SceneStep& step) {
    const auto include = [this](std::size_t part, const Pose& X_WP) {
      top_m_ = std::max(top_m_, boundsAt(scene_.parts[part].part.mesh, X_WP).max.z());
    };
    // All parts are read before the first step.
    for (; topped_parts_ < scene_.parts.size(); ++topped_parts_)
      if (const ScenePart& part = scene_.parts[topped_parts_]; part.is_fixed)
        include(topped_parts_, part.X_WP);
    for (; topped_steps_ < scene_.steps.size(); ++topped_steps_)
      include(scene_.steps[topped_steps_].part, scene_.steps[topped_steps_].X_WP_target);
    const Box moved = boundsAt(scene_.parts[step.part].part.mesh, step.X_WP_target);
    return std::max(top_m_, moved.min.z()) - moved.min.z() + 0.5 * moved.size().z();
  }

  static Box boundsAt(const Mesh& mesh, const Pose& X_WP) {
    Box box;
    for (const Vec3& p_P : mesh.vertices) box.add(X_WP * p_P);
    return box;
  }

  /// Refuses coordinates above 1000 km, where rounding is 1e-10 m, still far below every tolerance.
  void requireNearOrigin() const {
    constexpr double kFarthest_m = 1e6;
    const auto require = [&](const ScenePart& part, const Pose& X_WP) {
      const Box box = boundsAt(part.part.mesh, X_WP);
      if (box.min.cwiseAbs().cwiseMax(box.max.cwiseAbs()).maxCoeff() <= kFarthest_m) return;
      throw LoadError(
          scene_.file, part.part.name,
          "is more than 1000 km from the origin; check its unit, its pose and the poses of its steps");
    };
    for (const ScenePart& part : scene_.parts) require(part, part.X_WP);
    for (const SceneStep& step : scene_.steps)
      for (const Pose& X_WP : {step.X_WP_start, step.X_WP_target}) require(scene_.parts[step.part], X_WP);
  }

  void readDevice() {
    const toml::table* table = top_.table("device");
    if (!table) return;
    const SceneKeys keys(*table, context_, "[device]", keysOf(kDeviceKeys));
    readFields(keys, scene_.device, kDeviceKeys);
    if (keys.has("kind") && device::findDeviceKind(scene_.device.kind) == nullptr)
      keys.fail("kind", "is '" + scene_.device.kind + "'; known are " + device::deviceKindNames());
    if (std::string file; keys.text("parameters", file)) readDeviceFile(keys, file);
    if (keys.has("placement")) keys.pose("placement", scene_.device.placement.emplace());
  }

  /// Checks the device file, which the run reads again, so that an error is reported with line and key.
  void readDeviceFile(const SceneKeys& keys, const std::string& file) {
    if (!device::findDeviceKind(scene_.device.kind)->isSimulated())
      keys.fail("parameters", "applies to a dual_arm or an ideal_dual_arm only; leave the key out");
    try {
      device::loadDualArm(path(file));
    } catch (const LoadError& error) {
      keys.fail("parameters", std::string("cannot be used: ") + error.what());
    }
    scene_.device.data = path(file);
  }

  SceneFileContext context_;
  SceneKeys top_;
  const Progress& progress_;
  Scene scene_;
  ImportSettings import_;
  Material material_;  ///< [material]: for parts that do not state their own material
  std::map<std::pair<std::string, PartPer>, ImportedCad> cads_;
  std::vector<PartGroup> groups_;
  std::map<std::string, std::string> group_of_;  ///< name of the group of each part
  std::size_t cad_count_ = 0;       ///< number of parts from 'cad', which are the first parts of the scene
  std::vector<bool> is_described_;  ///< for each part from 'cad': the file has a [[part]] for the part
  /// The highest point of the fixed parts and of the parts of earlier steps, among the first topped_parts_
  /// and topped_steps_.
  double top_m_ = -std::numeric_limits<double>::infinity();
  std::size_t topped_parts_ = 0, topped_steps_ = 0;
};

}  // namespace

Scene loadScene(const std::string& file, const Progress& progress, const ByteCache* cache) {
  const toml::table root = parseToml(readTomlText(file, "scene file", "scene.toml"), file);
  return SceneReader(root, file, progress, cache).read();
}

}  // namespace vps::scenes
