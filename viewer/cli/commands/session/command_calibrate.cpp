// SPDX-License-Identifier: BSD-3-Clause
// vps calibrate: where the device stands in a room, and where its two arms stand to each other.
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
#include "vps_scenes/scene/toml_edit.h"

namespace vps::viewer {

namespace {

namespace fs = std::filesystem;

struct CalibrateArguments {
  std::string points, bases, parameters, display, out;
  std::string written_display, written_scene;  ///< files that the result is written into
};

/// What was found, to print, and where it goes.
struct Calibrated {
  std::string summary, toml;
  std::vector<scenes::TomlValue> for_display, for_scene;
};

std::string listOf(const Vec3& v) {
  char text[128];
  std::snprintf(text, sizeof text, "[%.9g, %.9g, %.9g]", v.x(), v.y(), v.z());
  return text;
}

/// With their unit, since a scene's may be another.
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

/// For the display file, or, with one, for the scene that it shows.
Calibrated placementOf(const std::string& file, const std::string& display_file) {
  std::vector<device::TouchedPoint> points;
  for (const scenes::NumberRow& row :
       scenes::readNumberTable(file, 6, "x, y, z read by the device and x, y, z in the room [m]")) {
    const std::vector<double>& n = row.numbers;
    points.push_back({{n[0], n[1], n[2]}, {n[3], n[4], n[5]}});
  }
  const device::Placement found = device::fitPlacement(points);
  if (found.status == Status::Truncated) throw LoadError(file, "", "has fewer than three points; touch more");
  if (found.status != Status::Ok)
    throw LoadError(file, "", "has points on one line, which leave a turn about it open; touch others");
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
      throw LoadError(file, "", "has fewer than twelve readings; move the handle about and take a hundred");
    case Status::Singular:
      throw LoadError(file, "",
                      "has readings too similar to tell all six numbers; tilt and move the handle more");
    default:
      throw LoadError(file, "",
                      "leads to no answer; is it of this device, and are its bases roughly in place?");
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

/// The file of the room that the result is for; empty: none is given. Refuses options that do not go
/// together.
std::string roomFile(const CalibrateArguments& given) {
  if (given.points.empty() && !(given.written_display + given.written_scene).empty())
    throw LoadError("", "", "--write-display and --write-scene go with --points, not with --bases");
  if (!given.display.empty() && !given.written_display.empty())
    throw LoadError("", "", "--display and --write-display both name the room; give one");
  const std::string room = given.display.empty() ? given.written_display : given.display;
  if (room.empty() && !given.written_scene.empty())
    throw LoadError("", "", "--write-scene needs the room that the scene stands in; add --display FILE");
  return room;
}

/// A rename would replace a file that is write-protected as well. Returns its name.
const std::string& requireWritable(const std::string& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (fs::exists(status) && !fs::is_regular_file(status))
    throw LoadError(file, "", "is no ordinary file, so it cannot be edited");
  constexpr fs::perms kAnyWrite = fs::perms::owner_write | fs::perms::group_write | fs::perms::others_write;
  if (fs::exists(status) && (status.permissions() & kAnyWrite) == fs::perms::none)
    throw LoadError(file, "", "is write-protected; allow writing (chmod u+w), or write a copy");
  return file;
}

/// The edited text stands complete beside the file, with the file's permissions, until commit() replaces the
/// file by it; without commit() the file is as it was.
class EditedFile {
 public:
  /// Throws LoadError when the file cannot be read, edited or replaced.
  EditedFile(const std::string& file, std::span<const scenes::TomlValue> values);
  /// Throws LoadError; the file is then as it was.
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

/// Both files are complete on the disk before the first one is replaced.
void writeInto(const CalibrateArguments& given, const Calibrated& found) {
  std::vector<std::unique_ptr<EditedFile>> files;
  if (!given.written_display.empty())
    files.push_back(std::make_unique<EditedFile>(given.written_display, found.for_display));
  if (!given.written_scene.empty()) {
    scenes::loadScene(given.written_scene);  // says what is wrong with a file that is no scene
    files.push_back(std::make_unique<EditedFile>(given.written_scene, found.for_scene));
  }
  for (const auto& file : files) file->commit();
}

int runCalibrate(const CalibrateArguments& given) {
  if (given.points.empty() == given.bases.empty())
    throw LoadError("", "", "give --points TABLE (where the device stands) or --bases TABLE (its two arms)");
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
      .add_option("--points", given->points,
                  "points that the handle touched: rows of x, y, z by the device and x, y, z in the room [m]")
      ->type_name("TABLE.csv");
  command
      .add_option(
          "--bases", given->bases,
          "readings of the dual arm with its handle moved about: left t1, t2, d3, right t1, t2, d3, q3 "
          "[rad, m]")
      ->type_name("TABLE.csv");
  command.add_option("--parameters", given->parameters, "parameters of the dual arm to start from")
      ->type_name("FILE.toml");
  command
      .add_option("--display", given->display,
                  "with --points: display file whose room it is; the result is then for the scene's own file")
      ->type_name("FILE.toml");
  command
      .add_option("--write-display", given->written_display,
                  "with --points: display file to write the result into; all else in it stays as it is")
      ->type_name("FILE.toml");
  command
      .add_option("--write-scene", given->written_scene,
                  "with --points: scene of that room, or of --display, to write the result into")
      ->type_name("FILE.toml");
  command.add_option("-o,--out", given->out, "TOML file to write")->type_name("FILE.toml");
  return [given] { return runCalibrate(*given); };
}

}  // namespace vps::viewer
