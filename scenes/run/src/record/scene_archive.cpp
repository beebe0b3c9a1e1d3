// SPDX-License-Identifier: BSD-3-Clause
// Version n of the format contains the fields that version 1 introduced, then those of version 2, and so on
// to n, each in the order of the field tables (FieldTraits::since). A new setting is therefore one row of a
// table, and every older recording stays readable. Structs without a table are decomposed into as many names
// as they have members, so that the program does not compile if a new member is forgotten here.
#include "record/scene_archive.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <utility>

#include "vps/errors.h"
#include "vps_device/detail/bytes.h"
#include "vps_scenes/scene/settings_fields.h"

namespace vps::scenes {

namespace {

std::string magicOf(int version) {
  return "vps-scene-" + std::to_string(version) + "\n";
}

/// The greatest `since` of all settings, and of the fields without a table (laterFields()).
constexpr int latestVersion() {
  int latest = 7;
  const auto look = [&](const auto& row) {
    if constexpr (requires { row.traits.since; }) latest = std::max(latest, row.traits.since);
  };
  forEachRow(std::tuple_cat(kMaterialFields, kStepKeys, kFidelityFields, kCouplingFields, kDeviceKeys,
                            kOperatorFields, kRecordFields),
             look);
  return latest;
}
constexpr int kLatestVersion = latestVersion();

class Writer {
 public:
  explicit Writer(std::string& out) : bytes_(out) {}
  template <typename... T>
  void operator()(const T&... fields) {
    (put(fields), ...);
  }

 private:
  void put(bool x) { bytes_.put(static_cast<std::uint8_t>(x)); }
  template <typename T>
  requires std::is_enum_v<T>
  void put(T x) { bytes_.put(static_cast<std::uint8_t>(x)); }
  void put(int x) { bytes_.put(static_cast<std::int32_t>(x)); }
  template <std::unsigned_integral T>
  void put(T x) {
    bytes_.put(static_cast<std::uint64_t>(x));
  }
  void put(double x) { bytes_.put(x); }
  void put(float x) { bytes_.put(x); }
  void put(const std::string& x) { bytes_.text(x); }
  void put(const Vec3& x) { (*this)(x[0], x[1], x[2]); }
  void put(const Pose& x) {
    for (int i = 0; i < 9; ++i) put(x.R(i / 3, i % 3));
    put(x.p);
  }
  void put(const std::array<std::uint32_t, 3>& x) {
    for (const std::uint32_t corner : x) bytes_.put(corner);
  }
  void put(const std::array<float, 3>& x) { (*this)(x[0], x[1], x[2]); }
  void put(const std::optional<double>& x) {
    put(x.has_value());
    put(x.value_or(0));
  }
  template <typename T>
  void put(const std::vector<T>& list) {
    bytes_.put(static_cast<std::uint64_t>(list.size()));
    for (const T& x : list) put(x);
  }
  template <typename T>
  requires requires(Writer& w, const T& x) { fields(w, x); }
  void put(const T& x) { fields(*this, x); }

  device::ByteWriter bytes_;
};

class Reader {
 public:
  explicit Reader(std::string_view bytes) : bytes_(bytes) {}
  template <typename... T>
  void operator()(T&... fields) {
    (get(fields), ...);
  }
  [[nodiscard]] bool isAllRead() const { return is_good_ && bytes_.isGood() && bytes_.left() == 0; }

 private:
  void get(bool& x) { x = bytes_.get<std::uint8_t>() != 0; }
  template <typename T>
  requires std::is_enum_v<T>
  void get(T& x) {
    const auto value = bytes_.get<std::uint8_t>();
    is_good_ = is_good_ && value < kValueCount<T>;
    x = static_cast<T>(is_good_ ? value : 0);
  }
  void get(int& x) { x = bytes_.getInt(); }
  template <std::unsigned_integral T>
  void get(T& x) {
    x = static_cast<T>(bytes_.get<std::uint64_t>());
  }
  void get(double& x) { x = bytes_.getDouble(); }
  void get(float& x) { x = bytes_.getFloat(); }
  void get(std::string& x) { x = bytes_.text(); }
  void get(Vec3& x) { (*this)(x[0], x[1], x[2]); }
  void get(Pose& x) {
    for (int i = 0; i < 9; ++i) get(x.R(i / 3, i % 3));
    get(x.p);
  }
  void get(std::array<std::uint32_t, 3>& x) {
    for (std::uint32_t& corner : x) corner = bytes_.get<std::uint32_t>();
  }
  void get(std::array<float, 3>& x) { (*this)(x[0], x[1], x[2]); }
  void get(std::optional<double>& x) {
    bool has_value = false;
    double value = 0;
    (*this)(has_value, value);
    if (has_value) x = value;
  }
  template <typename T>
  void get(std::vector<T>& list) {
    // The list grows with the bytes that were read, not by the count that the bytes claim.
    const auto count = bytes_.get<std::uint64_t>();
    for (std::uint64_t i = 0; i < count && bytes_.isGood(); ++i) get(list.emplace_back());
  }
  template <typename T>
  requires requires(Reader& r, T& x) { fields(r, x); }
  void get(T& x) { fields(*this, x); }

  device::ByteReader bytes_;
  bool is_good_ = true;
};

// --- The fields, for a const struct and a Writer or a struct and a Reader

template <typename T, typename U>
concept Either = std::is_same_v<std::remove_const_t<T>, U>;

/// The settings of a table that the given version introduced.
template <typename Archive, typename T, typename Rows>
void settings(Archive& archive, T& x, const Rows& rows, int version = 1) {
  forEachRow(rows, [&](const auto& row) {
    if constexpr (requires { row.traits.since; })
      if (row.traits.since == version) archive(std::invoke(row.get, x));
  });
}

template <typename Archive, Either<Mesh> T>
void fields(Archive& archive, T& x) {
  auto& [vertices, triangles] = x;
  archive(vertices, triangles);
}
template <typename Archive, Either<Part> T>
void fields(Archive& archive, T& x) {
  [[maybe_unused]] auto& [name, mesh, material, color, face_colors] = x;
  archive(name, mesh);
  settings(archive, material, kMaterialFields);
  archive(color);
}
template <typename Archive, Either<ScenePart> T>
void fields(Archive& archive, T& x) {
  // A part's model is not archived but built again; velocities, tolerances and own resolutions are for
  // simulate() and study(), whose runs are not recorded.
  [[maybe_unused]] auto& [part, X_WP, V_WP_W, is_fixed, allow_overlap, is_scenery, press_fit_m,
                          youngs_modulus_Pa, poissons_ratio, tolerance, file, members, within, fastener,
                          deflection_m, rounding_m, voxel_m, spacing_m, model, is_cropped] = x;
  archive(part, X_WP, is_fixed, allow_overlap, file);
}
template <typename Archive, Either<SceneStep> T>
void fields(Archive& archive, T& x) {
  archive(x.part, x.X_WP_start, x.X_WP_target, x.way_points);
  settings(archive, x, kStepKeys);
}
template <typename Archive, Either<DeviceSettings> T>
void fields(Archive& archive, T& x) {
  forEachRow(kDeviceKeys, [&](const auto& row) {
    if constexpr (std::is_same_v<std::remove_cvref_t<decltype(row)>, Key>) {
      if (row.key == "parameters") archive(x.data);
    } else if (row.traits.since == 1)
      archive(std::invoke(row.get, x));
  });
}
/// A wish is not archived, since a recorded scene has its fidelity; nor are warnings and `missing`, which the
/// command that records has printed.
template <typename Archive, Either<Scene> T>
void fields(Archive& archive, T& x) {
  [[maybe_unused]] auto& [file, name, warnings, missing, parts, steps, gravity, fidelity, wish, choice,
                          chooses_voxel, chooses_spacing, resolution, coupling, device, hand, record,
                          release_s] = x;
  archive(file, name, parts, steps, gravity);
  settings(archive, fidelity, kFidelityFields);
  settings(archive, coupling, kCouplingFields);
  archive(device);
  settings(archive, hand, kOperatorFields);
  settings(archive, record, kRecordFields);
  archive(release_s);
}

/// Fields of a part that version 4 introduced and that have no table.
template <typename Archive, Either<ScenePart> T>
void partFields4(Archive& archive, T& part) {
  archive(part.is_scenery, part.press_fit_m, part.deflection_m);
}

/// Fields of a part that version 5 introduced for the force of a press fit.
template <typename Archive, Either<ScenePart> T>
void partFields5(Archive& archive, T& part) {
  archive(part.youngs_modulus_Pa, part.poissons_ratio);
}

/// Fields of a part that version 7 introduced and that have no table.
template <typename Archive, Either<ScenePart> T>
void partFields7(Archive& archive, T& part) {
  archive(part.part.face_colors.palette, part.part.face_colors.of_triangle);
}

/// Fields of a step that version 6 introduced and that have no table.
template <typename Archive, Either<SceneStep> T>
void stepFields6(Archive& archive, T& step) {
  archive(step.takes_off);
}

/// Field of the device that version 6 introduced and that has no row in a table.
template <typename Archive, Either<DeviceSettings> T>
void devicePlacement(Archive& archive, T& device) {
  bool has_placement = device.placement.has_value();
  Pose placement = device.placement.value_or(Pose{});
  archive(has_placement, placement);
  if constexpr (!std::is_const_v<T>)
    if (has_placement) device.placement = placement;
}

/// All fields that a version after the first introduced.
template <typename Archive, Either<Scene> T>
void laterFields(Archive& archive, T& x, int version) {
  for (auto& part : x.parts) settings(archive, part.part.material, kMaterialFields, version);
  if (version == 4)
    for (auto& part : x.parts) partFields4(archive, part);
  if (version == 5)
    for (auto& part : x.parts) partFields5(archive, part);
  if (version == 7)
    for (auto& part : x.parts) partFields7(archive, part);
  for (auto& step : x.steps) settings(archive, step, kStepKeys, version);
  if (version == 6)
    for (auto& step : x.steps) stepFields6(archive, step);
  settings(archive, x.fidelity, kFidelityFields, version);
  settings(archive, x.coupling, kCouplingFields, version);
  settings(archive, x.device, kDeviceKeys, version);
  if (version == 6) devicePlacement(archive, x.device);
  settings(archive, x.hand, kOperatorFields, version);
  settings(archive, x.record, kRecordFields, version);
}

std::string lastPiece(const std::string& file) {
  return std::filesystem::path(file).filename().string();
}

/// The key of a setting that is out of its range; empty if there is none.
template <typename T, typename Rows>
std::string outOfRange(const T& x, const Rows& rows) {
  std::string found;
  const auto check = [&](const auto& row, double value) {
    if (!row.traits.range.contains(value)) found = row.key;
  };
  forEachRow(rows, [&](const auto& row) {
    if constexpr (requires { row.traits; }) {
      const auto& value = std::invoke(row.get, x);
      if constexpr (std::is_same_v<std::remove_cvref_t<decltype(value)>, std::optional<double>>) {
        if (value) check(row, *value);
      } else if constexpr (std::is_arithmetic_v<std::remove_cvref_t<decltype(value)>>) {
        check(row, static_cast<double>(value));
      }
    }
  });
  return found;
}

/// A reason why a run of the scene would crash or not end; empty if there is none.
std::string impossible(const Scene& scene) {
  for (const ScenePart& part : scene.parts) {
    for (const auto& triangle : part.part.mesh.triangles)
      for (const std::uint32_t corner : triangle)
        if (corner >= part.part.mesh.vertices.size()) return "a triangle whose corner does not exist";
    if (!part.X_WP.isFinite()) return "a pose that is not finite";
    const FaceColors& colors = part.part.face_colors;
    if (!colors.isNone() && colors.of_triangle.size() != part.part.mesh.triangles.size())
      return "another number of colours than of triangles";
    for (const std::uint32_t color : colors.of_triangle)
      if (color >= colors.palette.size()) return "a triangle whose colour does not exist";
  }
  if (scene.device.placement && !scene.device.placement->isFinite()) return "a pose that is not finite";
  std::string key;
  for (const ScenePart& part : scene.parts)
    if (key.empty()) key = outOfRange(part.part.material, kMaterialFields);
  for (const SceneStep& step : scene.steps) {
    if (step.part >= scene.parts.size()) return "a step whose part does not exist";
    if (key.empty()) key = outOfRange(step, kStepKeys);
  }
  if (key.empty()) key = outOfRange(scene.fidelity, kFidelityFields);
  if (key.empty()) key = outOfRange(scene.coupling, kCouplingFields);
  if (key.empty()) key = outOfRange(scene.hand, kOperatorFields);
  if (key.empty()) key = outOfRange(scene.device, kDeviceKeys);
  if (key.empty()) key = outOfRange(scene.record, kRecordFields);
  if (!key.empty()) return "a setting '" + key + "' out of its range";
  if (!(scene.release_s >= 0 && scene.release_s < 1e6)) return "a release time out of range";
  return {};
}

std::string hex(XXH128_hash_t hash) {
  char text[33];
  std::snprintf(text, sizeof text, "%016llx%016llx", static_cast<unsigned long long>(hash.high64),
                static_cast<unsigned long long>(hash.low64));
  return text;
}

}  // namespace

std::string sceneToBytes(const Scene& scene) {
  Scene plain = scene;
  plain.file = lastPiece(scene.file);
  for (ScenePart& part : plain.parts) part.file = lastPiece(part.file);
  plain.device.data = lastPiece(scene.device.data);
  std::string out = magicOf(kLatestVersion);
  Writer writer(out);
  fields(writer, std::as_const(plain));
  for (int version = 2; version <= kLatestVersion; ++version)
    laterFields(writer, std::as_const(plain), version);
  return out;
}

Scene sceneFromBytes(std::string_view bytes, const std::string& file) {
  Scene scene;
  int form = 1;
  while (form <= kLatestVersion && !bytes.starts_with(magicOf(form))) ++form;
  if (form > kLatestVersion)
    throw LoadError(
        file, "",
        "holds a scene in a format that this version does not know; replay it with the version that made it");
  Reader reader(bytes.substr(magicOf(form).size()));
  fields(reader, scene);
  for (int version = 2; version <= form; ++version) laterFields(reader, scene, version);
  if (!reader.isAllRead()) throw LoadError(file, "", "holds a scene that is cut or damaged");
  if (const std::string what = impossible(scene); !what.empty())
    throw LoadError(file, "", "holds a scene with " + what);
  return scene;
}

std::string contentHash(std::string_view bytes) {
  return hex(XXH3_128bits(bytes.data(), bytes.size()));
}

std::string contentHash(const Mesh& mesh) {
  std::string bytes;
  Writer writer(bytes);
  fields(writer, mesh);
  return contentHash(bytes);
}

}  // namespace vps::scenes
