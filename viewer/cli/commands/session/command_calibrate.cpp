// SPDX-License-Identifier: BSD-3-Clause
// vps calibrate: computes where the device stands in a room, and where its two arms stand relative to each
// other.
#include <cstdio>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "output/command.h"
#include "output/output.h"
#include "vps/errors.h"
#include "vps_device/calibration.h"
#include "vps_device/dual_arm/parameters.h"
#include "vps_scenes/scene/display.h"
#include "vps_scenes/scene/number_table.h"
#include "vps_scenes/scene/scene.h"
#include "vps_scenes/scene/scene_text.h"

namespace vps::viewer {

namespace {

namespace fs = std::filesystem;

struct CalibrateArguments {
  std::string points, bases, parameters, display, out;
  std::string written_display, written_scene;  ///< files that the result is written into
};

/// The result: text to print, and the values for each file.
struct Calibrated {
  std::string summary, toml;
  std::vector<scenes::TomlValue> for_display, for_scene;
};

std::string listOf(const Vec3& v) {
  char text[128];
  std::snprintf(text, sizeof text, "[%.9g, %.9g, %.9g]", v.x(), v.y(), v.z());
  return text;
}

/// Coordinates with a unit, because the scene may use another unit.
std::string metres(const Vec3& v) {
  char text[128];
  std::snprintf(text, sizeof text, "[\"%.9gm\", \"%.9gm\", \"%.9gm\"]", v.x(), v.y(), v.z());
  return text;
}

scenes::TomlValue placementValue(const Pose& X) {
  const Quat q = X.quaternion();
  char rotation[160];
  std::snprintf(rotation, sizeof rotation, "[%.12g, %.12g, %.12g, %.12g]", q.x(), q.y(), q.z(), q.w());
  return {"device", "placement", "{position = " + metres(X.p) + ", rotation_xyzw = " + rotation + "}"};
}

scenes::TomlValue scaleValue(double scale) {
  char text[40];
  std::snprintf(text, sizeof text, "%.12g", scale);
  return {"device", "scale", text};
}

std::string tableText(const std::string& comment, const std::vector<scenes::TomlValue>& values) {
  std::string text = "# " + comment + "\n[" + values[0].table + "]\n";
  for (const scenes::TomlValue& value : values) text += value.key + " = " + value.value + "\n";
  return text;
}

/// Computes where the device stands: in the room, for the display file, or, if a display file is given, in
/// the scene that this display shows.
Calibrated placementOf(const std::string& file, const std::string& display_file) {
  std::vector<device::TouchedPoint> points;
  for (const scenes::NumberRow& row :
       scenes::readNumberTable(file, 6, "x, y, z read by the device and x, y, z in the room [m]")) {
    const std::vector<double>& n = row.numbers;
    points.push_back({{n[0], n[1], n[2]}, {n[3], n[4], n[5]}});
  }
  const device::Placement found = device::fitPlacement(points);
  if (found.status == Status::Truncated)
    throw LoadError(file, "", "has fewer than three points; touch more points");
  if (found.status != Status::Ok)
    throw LoadError(file, "",
                    "has all points on one line, so that the rotation about this line is undetermined; touch "
                    "other points");
  char residual[160];
  std::snprintf(residual, sizeof residual,
                "%zu points: residual %.3g mm rms, greatest %.3g mm at point %zu\n", points.size(),
                1e3 * found.rms_m, 1e3 * found.greatest_m, found.worst + 1);
  Calibrated result{residual, "", {placementValue(found.X_SD)}, {}};
  if (display_file.empty()) {
    result.toml = tableText("Where the device stands in the room, for the display file.", result.for_display);
    return result;
  }
  scenes::Display display = scenes::loadDisplay(display_file);
  display.X_SD = found.X_SD;
  scenes::DeviceSettings device;
  display.placeDevice(device);
  result.for_scene = {scaleValue(device.scale), placementValue(*device.placement)};
  result.toml = tableText("Where the device stands in the scene, for the scene file.", result.for_scene);
  return result;
}

Calibrated basesOf(const std::string& file, const std::string& parameters) {
  std::vector<device::DualArmJoints> readings;
  for (const scenes::NumberRow& row :
       scenes::readNumberTable(file, 7, "left t1, t2 [rad], d3 [m], right t1, t2, d3, handle motor q3"))
    readings.push_back(device::fromVector(Eigen::Map<const device::JointVector>(row.numbers.data())));
  const device::DualArmFile start =
      parameters.empty() ? device::builtInDualArm() : device::loadDualArm(parameters);
  const device::BaseCalibration found = device::calibrateBases(start.parameters, readings);
  switch (found.status) {
    case Status::Ok:
      break;
    case Status::Truncated:
      throw LoadError(file, "", "has fewer than twelve readings; move the handle and take about a hundred");
    case Status::Singular:
      throw LoadError(
          file, "",
          "has readings that are too similar to determine all six parameters; tilt and move the handle more");
    default:
      throw LoadError(file, "",
                      "gives no solution; check that the readings are of this device and that its bases are "
                      "roughly in place");
  }
  char summary[200];
  std::snprintf(summary, sizeof summary,
                "%zu readings: residual %.3g um rms; the right base is known to %.3g um and %.3g mrad\n",
                readings.size(), 1e6 * found.rms_m, 1e6 * found.sigma_m, 1e3 * found.sigma_rad);
  return {summary,
          tableText("Calibrated from " + std::to_string(readings.size()) + " readings.",
                    {{"bases", "right_shift_m", listOf(found.parameters.right_shift_m)},
                     {"bases", "right_turn_rad", listOf(found.parameters.right_turn_rad)}}),
          {},
          {}};
}

/// The display file that describes the room; empty if none is given. Throws LoadError for options that
/// exclude each other.
std::string roomFile(const CalibrateArguments& given) {
  if (given.points.empty() && !(given.written_display + given.written_scene).empty())
    throw LoadError("", "", "--write-display and --write-scene need --points, and do not work with --bases");
  if (!given.display.empty() && !given.written_display.empty())
    throw LoadError("", "",
                    "--display and --write-display both name the room; give only one of the two options");
  const std::string room = given.display.empty() ? given.written_display : given.display;
  if (room.empty() && !given.written_scene.empty())
    throw LoadError("", "", "--write-scene needs the display file of the room; add --display FILE");
  return room;
}

/// Throws LoadError unless the file may be written, because a rename would also replace a write-protected
/// file. Returns the file name.
const std::string& requireWritable(const std::string& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw LoadError(file, "", "is not a regular file, so it cannot be edited");
  constexpr fs::perms kAnyWrite = fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
  if (fs::exists(status) && (status.permissions() & kAnyWrite) == fs::perms::none)
    throw LoadError(file, "", "is write-protected; allow writing (chmod u+w), or write a copy");
  return file;
}

/// A user's TOML file in which a command changes single values. The edited text is written to a temporary
/// file with the same permissions; commit() replaces the user's file by the temporary file. Without commit()
/// the file is not changed.
class EditedFile {
 public:
  /// Throws LoadError when the file cannot be read, edited or replaced.
  EditedFile(const std::string& file, std::span<const scenes::TomlValue> values);
  /// Replaces the file. Throws LoadError, and then leaves the file unchanged.
  void commit() { out_.commit(); }

 private:
  OutputFile out_;
};

EditedFile::EditedFile(const std::string& file, std::span<const scenes::TomlValue> values)
    : out_(requireWritable(file), {}) {
  out_.stage(scenes::editedToml(file, values));
  std::error_code error;
  fs::permissions(out_.partial(), fs::status(file, error).permissions(), error);
  if (error) throw LoadError(file, "", "cannot be written: " + error.message() + "; choose another place");
}

/// Writes both files completely under temporary names before it replaces the first one.
void writeInto(const CalibrateArguments& given, const Calibrated& found) {
  std::vector<std::unique_ptr<EditedFile>> files;
  if (!given.written_display.empty())
    files.push_back(std::make_unique<EditedFile>(given.written_display, found.for_display));
  if (!given.written_scene.empty()) {
    scenes::loadScene(given.written_scene);  // throws LoadError if the file is not a scene
    files.push_back(std::make_unique<EditedFile>(given.written_scene, found.for_scene));
  }
  for (const auto& file : files) file->commit();
}

int runCalibrate(const CalibrateArguments& given) {
  if (given.points.empty() == given.bases.empty())
    throw LoadError(
        "", "",
        "give --points TABLE to find where the device stands, or --bases TABLE to calibrate its two arms");
  const std::string room = roomFile(given);
  OutputFile out(given.out, {given.points, given.bases, given.parameters, room, given.written_scene});
  const Calibrated found =
      given.points.empty() ? basesOf(given.bases, given.parameters) : placementOf(given.points, room);
  writeInto(given, found);
  std::fputs(found.summary.c_str(), stdout);
  for (const std::string& file : {given.written_display, given.written_scene})
    if (!file.empty()) std::printf("written into %s\n", file.c_str());
  if (given.written_display.empty() && given.written_scene.empty()) std::fputs(found.toml.c_str(), stdout);
  out.write(found.toml);
  return kGood;
}

}  // namespace

std::function<int()> addCalibrate(CLI::App& command) {
  const auto given = std::make_shared<CalibrateArguments>();
  command
      .add_option(
          "--points", given->points,
          "points that the handle touched: rows of x, y, z as read by the device and x, y, z in the room [m]")
      ->type_name("TABLE.csv");
  command
      .add_option(
          "--bases", given->bases,
          "readings of the dual arm at many poses of its handle: left t1, t2, d3, right t1, t2, d3, q3 "
          "[rad, m]")
      ->type_name("TABLE.csv");
  command.add_option("--parameters", given->parameters, "parameters of the dual arm to start from")
      ->type_name("FILE.toml");
  command
      .add_option("--display", given->display,
                  "with --points: display file of the room; the result is then for the scene file")
      ->type_name("FILE.toml");
  command
      .add_option("--write-display", given->written_display,
                  "with --points: display file to write the result into; nothing else in it is changed")
      ->type_name("FILE.toml");
  command
      .add_option("--write-scene", given->written_scene,
                  "with --points: scene file to write the result into; its room is that of --write-display "
                  "or --display")
      ->type_name("FILE.toml");
  command.add_option("-o,--out", given->out, "TOML file to write")->type_name("FILE.toml");
  return [given] { return runCalibrate(*given); };
}

}  // namespace vps::viewer
