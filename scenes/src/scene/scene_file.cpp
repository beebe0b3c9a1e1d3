// SPDX-License-Identifier: BSD-3-Clause
// loadScene(): TOML to Scene. The format is documented in scenes/README.md; keep the two together.
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <map>
#include <sstream>

#include "scene/scene_file_keys.h"
#include "vps/load_error.h"
#include "vps_device/device_kinds.h"
#include "vps_device/dual_arm/parameters.h"
#include "vps_scenes/fidelity_choice.h"
#include "vps_scenes/import.h"
#include "vps_scenes/scene.h"

namespace vps::scenes {

namespace {

namespace fs = std::filesystem;

std::string slurp(const std::string& file) {
  std::error_code error;
  if (!fs::exists(file, error)) throw LoadError(file, "", "no such file; name a scene file (scene.toml)");
  if (fs::is_directory(file, error))
    throw LoadError(file, "", "is a folder; name the scene file in it (scene.toml)");
  std::ifstream in(file, std::ios::binary);
  std::ostringstream text;
  text << in.rdbuf();
  if (!in) throw LoadError(file, "", "cannot be read; check its permissions");
  return text.str();
}

toml::table parseToml(const std::string& text, const std::string& file) {
  try {
    return toml::parse(text, file);
  } catch (const toml::parse_error& error) {
    std::string words(error.description());
    // One line for a person, whatever the file holds.
    std::replace_if(
        words.begin(), words.end(), [](unsigned char c) { return c < 0x20; }, ' ');
    throw LoadError(file + ":" + std::to_string(error.source().begin.line), "", "not valid TOML: " + words);
  }
}

float linearFromSrgb(double s) {  // IEC 61966-2-1
  return static_cast<float>(s <= 0.04045 ? s / 12.92 : std::pow((s + 0.055) / 1.055, 2.4));
}

/// "#rrggbb" or [r, g, b] from 0 to 1, both sRGB as every colour picker shows them.
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
  for (std::size_t i = 0; i < 3; ++i) color[i] = linearFromSrgb(srgb[i]);
}

void readMaterial(const SceneKeys& keys, Material& material) {
  keys.number("density", material.density_kg_m3, kPositive);
  keys.number("friction", material.friction, kNotNegative);
  keys.number("restitution", material.restitution, {.min = 0, .max = 1});
  keys.number("stiffness", material.stiffness_N_per_m3, kPositive);
}

std::string didYouMean(const std::string& name, const std::vector<std::string>& names) {
  const std::string nearest = nearestWord(name, names);
  if (!nearest.empty()) return "; did you mean '" + nearest + "'?";
  constexpr std::size_t kShown = 12;
  std::string list;
  for (std::size_t i = 0; i < std::min(names.size(), kShown); ++i)
    list += (i ? ", " : "; there are: ") + names[i];
  return list + (names.size() > kShown ? ", ..." : "");
}

/// Index of the part a key names; the message offers the nearest name.
template <typename Parts, typename NameOf>
std::size_t partNamed(const SceneKeys& keys, std::string_view key, const std::string& name,
                      const Parts& parts, NameOf nameOf) {
  std::vector<std::string> names;
  for (const auto& part : parts) names.push_back(nameOf(part));
  const auto match = std::find(names.begin(), names.end(), name);
  if (match == names.end())
    keys.fail(key, "names '" + name + "', which is no part" + didYouMean(name, names));
  return static_cast<std::size_t>(match - names.begin());
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
  part.X_WP = imported.X_WP;
  part.file = file;
  return part;
}

/// Was the file refused because this build has no reader for its format? importCad() then names the package.
bool isMissingReader(const LoadError& error) {
  return std::string_view(error.what()).find("Open CASCADE") != std::string_view::npos;
}

/// What `fidelity = "auto"` asks for by itself: the designers' usual bound of 10 um.
const FidelityWish kAutoWish{.budget_hz = std::nullopt, .tolerance_m = 10e-6, .memory_bytes = std::nullopt};

class SceneReader {
 public:
  SceneReader(const toml::table& root, const std::string& file)
      : context_{file, std::nullopt},
        top_(root, context_, "",
             {"name", "unit", "gravity", "cad", "cad_fallback", "deflection", "material", "part", "step",
              "device", "operator", "coupling", "fidelity", "record", "release_s"}) {
    scene_.file = file;
  }

  Scene read() {
    readTop();
    readCad();
    for (const toml::table* table : top_.tables("part")) readPart(*table);
    if (scene_.parts.empty()) top_.failWhole(R"(has no part; name one in [[part]] with file = "part.stl")");
    for (const toml::table* table : top_.tables("step")) readStep(*table);
    readDevice();
    readOperator();
    readCoupling();
    readFidelity();
    readRecord();
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
    top_.number("release_s", scene_.release_s, kNotNegative);
    import_.unit_m = context_.unit_m;
    top_.length("deflection", import_.deflection_m, kPositive);
    if (const toml::table* table = top_.table("material"))
      readMaterial(
          SceneKeys(*table, context_, "[material]", {"density", "friction", "restitution", "stiffness"}),
          material_);
  }

  /// The file a key names, from the scene file's folder.
  [[nodiscard]] std::string path(const std::string& file) const {
    return (fs::path(context_.file).parent_path() / file).lexically_normal().string();
  }

  /// Reads a CAD file once, however many parts come out of it.
  const ImportedCad& cad(const SceneKeys& keys, std::string_view key, const std::string& file) {
    const auto known = cads_.find(file);
    if (known != cads_.end()) return known->second;
    try {
      const ImportedCad& cad = cads_.emplace(file, importCad(path(file), import_)).first->second;
      for (const std::string& warning : cad.warnings) scene_.warnings.push_back(file + ": " + warning);
      return cad;
    } catch (const LoadError& error) {
      keys.fail(key, std::string("cannot be used: ") + error.what());
    }
  }

  void readCad() {
    std::string file, fallback;
    if (top_.text("cad_fallback", fallback) && !top_.has("cad"))
      top_.fail("cad_fallback", "stands without 'cad', which it would replace");
    if (!top_.text("cad", file)) return;
    if (fallback.empty()) return addCad("cad", file);
    try {
      return addCad("cad", file);
    } catch (const LoadError& error) {
      if (!isMissingReader(error)) throw;
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
    const SceneKeys keys(table, context_, "[[part]]",
                         {"name", "file", "node", "pose", "fixed", "density", "friction", "restitution",
                          "stiffness", "color", "allow_overlap"});
    ScenePart& part = keys.has("file") ? addPart(keys) : cadPart(keys);
    for (const ScenePart& other : scene_.parts)
      if (&other != &part && other.part.name == part.part.name)
        keys.failWhole("is the second part named '" + part.part.name + "'; give it another 'name'");
    keys.pose("pose", part.X_WP);
    keys.flag("fixed", part.is_fixed);
    keys.flag("allow_overlap", part.allow_overlap);
    readMaterial(keys, part.part.material);
    readColor(keys, part.part.color);
  }

  /// A part with a file of its own.
  ScenePart& addPart(const SceneKeys& keys) {
    std::string file, node, name;
    keys.text("file", file);
    const ImportedCad& found = cad(keys, "file", file);
    std::size_t index = 0;
    if (keys.text("node", node)) {
      index = partNamed(keys, "node", node, found.parts, nameOfImported);
      name = node;
    } else {
      std::vector<std::string> names;
      for (const ImportedPart& part : found.parts) names.push_back(part.name);
      if (found.parts.size() != 1)
        keys.fail("file", "has " + std::to_string(found.parts.size()) + " parts; say which with 'node'" +
                              didYouMean("", names));
      name = fs::path(file).stem().string();
    }
    keys.text("name", name);
    scene_.parts.push_back(placedPart(found.parts[index], path(file), material_));
    scene_.parts.back().part.name = name;
    return scene_.parts.back();
  }

  /// A part of the scene's CAD file, of which something is said.
  ScenePart& cadPart(const SceneKeys& keys) {
    std::string name, node;
    if (!keys.text("name", name) && !keys.has("node"))
      keys.failWhole("has neither 'name' nor 'file'; give one");
    if (cad_count_ == 0) keys.failWhole("has no 'file'; name the mesh it is made of");
    const bool has_node = keys.text("node", node);
    const std::vector<ScenePart> of_cad(scene_.parts.begin(),
                                        scene_.parts.begin() + static_cast<std::ptrdiff_t>(cad_count_));
    const std::size_t index =
        partNamed(keys, has_node ? "node" : "name", has_node ? node : name, of_cad, nameOf);
    if (is_described_[index])
      keys.failWhole("describes '" + of_cad[index].part.name + "' for the second time");
    is_described_[index] = true;
    if (!name.empty()) scene_.parts[index].part.name = name;
    return scene_.parts[index];
  }

  void readStep(const toml::table& table) {
    const SceneKeys keys(table, context_, "[[step]]",
                         {"part", "target", "start", "approach", "way_points", "tolerance", "tolerance_deg",
                          "clearance", "timeout_s"});
    SceneStep step;
    std::string name;
    if (!keys.text("part", name)) keys.failWhole("has no 'part'; name the part it mounts");
    step.part = partNamed(keys, "part", name, scene_.parts, nameOf);
    const ScenePart& part = scene_.parts[step.part];
    if (part.is_fixed) keys.fail("part", "names '" + name + "', which is fixed; a step moves its part");
    for (const SceneStep& earlier : scene_.steps)
      if (earlier.part == step.part) keys.fail("part", "names '" + name + "', which an earlier step mounts");

    step.X_WP_target = part.X_WP;
    keys.pose("target", step.X_WP_target);
    step.X_WP_start = step.X_WP_target;
    if (Vec3 offset_W; keys.position("approach", offset_W)) {
      if (keys.has("start")) keys.fail("approach", "stands beside 'start'; give one of them");
      step.X_WP_start.p += offset_W;
    } else if (!keys.pose("start", step.X_WP_start)) {
      step.X_WP_start.p.z() += liftToClear(step);
    }
    keys.poses("way_points", step.X_WP_target, step.way_points);
    keys.length("tolerance", step.tolerance_m, kPositive);
    keys.angle("tolerance_deg", step.tolerance_rad, kPositive);
    keys.length("clearance", step.clearance_m, kNotNegative);
    keys.number("timeout_s", step.timeout_s, kPositive);
    scene_.steps.push_back(std::move(step));
  }

  /// How far along +z a part goes from its target until half its own height lies between it and all that is
  /// in place by then (fixed parts, and those of earlier steps) [m].
  [[nodiscard]] double liftToClear(const SceneStep& step) const {
    const Box moved = boundsAt(scene_.parts[step.part].part.mesh, step.X_WP_target);
    double top_m = moved.min.z();
    for (const ScenePart& part : scene_.parts)
      if (part.is_fixed) top_m = std::max(top_m, boundsAt(part.part.mesh, part.X_WP).max.z());
    for (const SceneStep& earlier : scene_.steps)
      top_m = std::max(top_m, boundsAt(scene_.parts[earlier.part].part.mesh, earlier.X_WP_target).max.z());
    return top_m - moved.min.z() + 0.5 * moved.size().z();
  }

  static Box boundsAt(const Mesh& mesh, const Pose& X_WP) {
    Box box;
    for (const Vec3& p_P : mesh.vertices) box.add(X_WP * p_P);
    return box;
  }

  void readDevice() {
    const toml::table* table = top_.table("device");
    if (!table) return;
    const SceneKeys keys(*table, context_, "[device]",
                         {"kind", "parameters", "scale", "quantised_encoders", "indexing"});
    if (keys.text("kind", scene_.device.kind) && device::findDeviceKind(scene_.device.kind) == nullptr)
      keys.fail("kind", "is '" + scene_.device.kind + "'; known are " + device::deviceKindNames());
    if (std::string file; keys.text("parameters", file)) readDeviceFile(keys, file);
    keys.number("scale", scene_.device.scale, kPositive);
    keys.flag("quantised_encoders", scene_.device.has_quantised_encoders);
    keys.flag("indexing", scene_.device.has_indexing);
  }

  /// Used later, when the device is made; checked here, so that a message can name line and key.
  void readDeviceFile(const SceneKeys& keys, const std::string& file) {
    if (!device::findDeviceKind(scene_.device.kind)->isSimulated())
      keys.fail("parameters", "are those of a dual_arm or an ideal_dual_arm");
    try {
      device::loadDualArm(path(file));
    } catch (const LoadError& error) {
      keys.fail("parameters", std::string("cannot be used: ") + error.what());
    }
    scene_.device.data = path(file);
  }

  void readOperator() {
    const toml::table* table = top_.table("operator");
    if (!table) return;
    const SceneKeys keys(*table, context_, "[operator]",
                         {"seed", "aim_error", "aim_error_deg", "speed_m_s", "press_N", "force_limit_N"});
    OperatorSettings& hand = scene_.hand;
    if (std::int64_t seed = 0; keys.integer("seed", seed, kNotNegative))
      hand.seed = static_cast<std::uint64_t>(seed);
    keys.length("aim_error", hand.aim_error_m, kNotNegative);
    keys.angle("aim_error_deg", hand.aim_error_rad, kNotNegative);
    keys.number("speed_m_s", hand.speed_m_s, kPositive);
    keys.number("press_N", hand.press_N, kNotNegative);
    keys.number("force_limit_N", hand.force_limit_N, kPositive);
  }

  void readCoupling() {
    const toml::table* table = top_.table("coupling");
    if (!table) return;
    const SceneKeys keys(
        *table, context_, "[coupling]",
        {"k_N_per_m", "b_Ns_per_m", "k_Nm_per_rad", "b_Nms_per_rad", "max_force_N", "max_torque_Nm"});
    const auto wish = [&](const char* key, std::optional<double>& wished, Range range) {
      if (!keys.has(key)) return;
      keys.number(key, wished.emplace(), range);
    };
    CouplingWishes& gains = scene_.coupling;
    wish("k_N_per_m", gains.k_N_per_m, kNotNegative);
    wish("b_Ns_per_m", gains.b_Ns_per_m, kNotNegative);
    wish("k_Nm_per_rad", gains.k_Nm_per_rad, kNotNegative);
    wish("b_Nms_per_rad", gains.b_Nms_per_rad, kNotNegative);
    wish("max_force_N", gains.max_force_N, kPositive);
    wish("max_torque_Nm", gains.max_torque_Nm, kPositive);
  }

  /// A preset's name, or a table of single knobs over a preset.
  void readFidelity() {
    scene_.fidelity = fidelityPreset("normal");
    if (!top_.has("fidelity")) return;
    if (top_.isText("fidelity")) return readNamedFidelity();
    const SceneKeys keys(
        *top_.table("fidelity"), context_, "[fidelity]",
        {"preset", "auto", "budget_hz", "tolerance", "memory_MB", "voxel", "spacing", "sides", "gradient",
         "contact", "contact_limit", "haptic_rate_hz", "physics_rate_hz", "solver_iterations"});
    const std::vector<std::string> presets = {"fast", "normal", "fine"};
    std::size_t index = 1;
    if (keys.word("preset", presets, index)) scene_.fidelity = fidelityPreset(presets[index]);
    Fidelity& fidelity = scene_.fidelity;
    keys.length("voxel", fidelity.voxel_m, kPositive);
    keys.length("spacing", fidelity.spacing_m, kPositive);
    if (keys.word("sides", {"one", "both"}, index)) fidelity.sides = index == 0 ? Sides::One : Sides::Both;
    if (keys.word("gradient", {"continuous", "trilinear"}, index))
      fidelity.gradient = index == 0 ? Gradient::Continuous : Gradient::Trilinear;
    if (keys.word("contact", {"constraint", "penalty"}, index))
      scene_.contact = index == 0 ? ContactMethod::Constraint : ContactMethod::Penalty;
    constexpr Range kCount{.min = 1, .max = 1e6};
    std::int64_t count = 0;
    if (keys.integer("contact_limit", count, kCount)) fidelity.contact_limit = static_cast<int>(count);
    if (keys.integer("solver_iterations", count, kCount))
      fidelity.solver_iterations = static_cast<int>(count);
    constexpr Range kRate{.min = 1, .max = 1e6};
    keys.number("haptic_rate_hz", fidelity.haptic_rate_hz, kRate);
    keys.number("physics_rate_hz", fidelity.physics_rate_hz, kRate);
    readFidelityWish(keys);
  }

  void readNamedFidelity() {
    const std::vector<std::string> names = {"fast", "normal", "fine", "auto"};
    std::size_t index = 1;
    top_.word("fidelity", names, index);
    if (names[index] == "auto") return choose(kAutoWish);
    scene_.fidelity = fidelityPreset(names[index]);
  }

  void readFidelityWish(const SceneKeys& keys) {
    FidelityWish wish;
    bool is_auto = false;
    keys.flag("auto", is_auto);
    const auto wished = [&](const char* key, std::optional<double>& out) {
      if (!keys.has(key)) return false;
      if (!is_auto) keys.fail(key, "stands without 'auto = true', which would heed it");
      out = 0;
      return true;
    };
    constexpr Range kRate{.min = 1, .max = 1e6};
    if (wished("budget_hz", wish.budget_hz)) keys.number("budget_hz", *wish.budget_hz, kRate);
    if (wished("tolerance", wish.tolerance_m)) keys.length("tolerance", *wish.tolerance_m, kPositive);
    if (wished("memory_MB", wish.memory_bytes)) {
      keys.number("memory_MB", *wish.memory_bytes, kPositive);
      *wish.memory_bytes *= 1e6;
    }
    if (!is_auto) return;
    for (const char* key : {"voxel", "spacing"})
      if (keys.has(key)) keys.fail(key, "stands beside 'auto = true', which chooses it");
    const bool has_wish = wish.budget_hz || wish.tolerance_m || wish.memory_bytes;
    choose(has_wish ? wish : kAutoWish);
  }

  /// Chooses by counts, so that the same file gives the same scene everywhere.
  void choose(const FidelityWish& wish) {
    const FidelityChoice choice = chooseFidelity(scene_, wish);
    if (!choice.is_met) top_.fail("fidelity", "is auto and cannot be met: " + choice.failure_reason);
    scene_.fidelity = choice.fidelity;
    scene_.fidelity_choice = describe(choice);
  }

  void readRecord() {
    const toml::table* table = top_.table("record");
    if (!table) return;
    const SceneKeys keys(*table, context_, "[record]", {"csv_rate_hz"});
    keys.number("csv_rate_hz", scene_.record.csv_rate_hz, kPositive);
  }

  SceneFileContext context_;
  SceneKeys top_;
  Scene scene_;
  ImportSettings import_;
  Material material_;  ///< [material]: what parts are made of unless they say
  std::map<std::string, ImportedCad> cads_;
  std::size_t cad_count_ = 0;       ///< the first parts of the scene are those of its 'cad'
  std::vector<bool> is_described_;  ///< of those: has a [[part]] of its own
};

}  // namespace

Scene loadScene(const std::string& file) {
  const toml::table root = parseToml(slurp(file), file);
  return SceneReader(root, file).read();
}

}  // namespace vps::scenes
