// SPDX-License-Identifier: BSD-3-Clause
// One list of fields serves both directions. It takes each struct apart into as many names as it has members,
// so a member that is added and forgotten here does not compile.
#include "record/scene_archive.h"

#define XXH_INLINE_ALL
#include <xxhash.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <utility>

#include "vps/load_error.h"
#include "vps_device/detail/bytes.h"

namespace vps::scenes {

namespace {

// What came with each: the scene; Scene::contact; DeviceSettings::has_indexing.
constexpr std::array<std::string_view, 3> kMagics = {"vps-scene-1\n", "vps-scene-2\n", "vps-scene-3\n"};

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
    is_good_ = is_good_ && value <= 1;  // all enums of a scene have two values
    x = static_cast<T>(value & 1);
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
    // Grows as bytes come, not by the count they claim.
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

template <typename Archive, Either<Material> T>
void fields(Archive& archive, T& x) {
  auto& [density, friction, restitution, stiffness] = x;
  archive(density, friction, restitution, stiffness);
}
template <typename Archive, Either<Mesh> T>
void fields(Archive& archive, T& x) {
  auto& [vertices, triangles] = x;
  archive(vertices, triangles);
}
template <typename Archive, Either<Part> T>
void fields(Archive& archive, T& x) {
  auto& [name, mesh, material, color] = x;
  archive(name, mesh, material, color);
}
template <typename Archive, Either<ScenePart> T>
void fields(Archive& archive, T& x) {
  [[maybe_unused]] auto& [part, X_WP, is_fixed, allow_overlap, file, model, is_cropped] =
      x;  // the model is built again
  archive(part, X_WP, is_fixed, allow_overlap, file);
}
template <typename Archive, Either<SceneStep> T>
void fields(Archive& archive, T& x) {
  auto& [part, start, target, way_points, tolerance_m, tolerance_rad, clearance_m, timeout_s] = x;
  archive(part, start, target, way_points, tolerance_m, tolerance_rad, clearance_m, timeout_s);
}
template <typename Archive, Either<Fidelity> T>
void fields(Archive& archive, T& x) {
  auto& [voxel, spacing, sides, gradient, contact_limit, haptic, physics, iterations] = x;
  archive(voxel, spacing, sides, gradient, contact_limit, haptic, physics, iterations);
}
template <typename Archive, Either<CouplingWishes> T>
void fields(Archive& archive, T& x) {
  auto& [k, b, k_turn, b_turn, force, torque] = x;
  archive(k, b, k_turn, b_turn, force, torque);
}
template <typename Archive, Either<DeviceSettings> T>
void fields(Archive& archive, T& x) {
  auto& [kind, data, scale, is_quantised, has_indexing] = x;  // the last: since vps-scene-3
  archive(kind, data, scale, is_quantised);
}
template <typename Archive, Either<OperatorSettings> T>
void fields(Archive& archive, T& x) {
  auto& [seed, aim_m, aim_rad, speed, press, limit] = x;
  archive(seed, aim_m, aim_rad, speed, press, limit);
}
template <typename Archive, Either<RecordSettings> T>
void fields(Archive& archive, T& x) {
  auto& [csv_rate_hz] = x;
  archive(csv_rate_hz);
}
template <typename Archive, Either<Scene> T>
void fields(Archive& archive, T& x) {
  auto& [file, name, warnings, parts, steps, gravity, fidelity, contact, choice, coupling, device, hand,
         record, release_s] = x;
  archive(file, name, parts, steps, gravity, fidelity, coupling, device, hand, record, release_s);
}

std::string lastPiece(const std::string& file) {
  return std::filesystem::path(file).filename().string();
}

/// What would crash or never end further on, were it true.
const char* impossible(const Scene& scene) {
  for (const ScenePart& part : scene.parts) {
    for (const auto& triangle : part.part.mesh.triangles)
      for (const std::uint32_t corner : triangle)
        if (corner >= part.part.mesh.vertices.size()) return "a triangle whose corner is not there";
    if (!part.X_WP.isFinite()) return "a pose that is no number";
  }
  for (const SceneStep& step : scene.steps)
    if (step.part >= scene.parts.size()) return "a step whose part is not there";
  const Fidelity& f = scene.fidelity;
  const auto isPositive = [](double x) { return x > 0 && std::isfinite(x); };
  if (!isPositive(f.haptic_rate_hz) || !isPositive(f.physics_rate_hz) || !isPositive(f.voxel_m) ||
      !isPositive(f.spacing_m) || !isPositive(scene.device.scale) || !isPositive(scene.record.csv_rate_hz))
    return "a rate, step or scale that is not positive";
  if (!(scene.release_s >= 0 && scene.release_s < 1e6)) return "a release time out of range";
  return nullptr;
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
  std::string out(kMagics.back());
  Writer writer(out);
  fields(writer, std::as_const(plain));
  writer(plain.contact, plain.device.has_indexing);
  return out;
}

Scene sceneFromBytes(std::string_view bytes, const std::string& file) {
  Scene scene;
  const auto* const form = std::find_if(kMagics.begin(), kMagics.end(),
                                        [&](std::string_view magic) { return bytes.starts_with(magic); });
  if (form == kMagics.end())
    throw LoadError(file, "", "holds a scene in a form that this version does not know");
  Reader reader(bytes.substr(form->size()));
  fields(reader, scene);
  if (form > kMagics.data()) reader(scene.contact);
  if (form > kMagics.data() + 1) reader(scene.device.has_indexing);
  if (!reader.isAllRead()) throw LoadError(file, "", "holds a scene that is not whole");
  if (const char* what = impossible(scene))
    throw LoadError(file, "", std::string("holds a scene with ") + what);
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
