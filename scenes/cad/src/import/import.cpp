// SPDX-License-Identifier: BSD-3-Clause
// importCad(): detects the format, runs its reader, and finishes the parts.
#include <algorithm>
#include <cstdint>
#include <iterator>
#include <map>
#include <optional>
#include <set>

#include "core/machine.h"
#include "import/child_processes.h"
#include "import/part_bytes.h"
#include "import/readers.h"
#include "vps/errors.h"
#include "vps/stoppable.h"
#include "vps_scenes/cad/time_limit.h"

namespace vps::scenes {
namespace {

using import::FileFormat;

/// Renames assemblies and products whose names another file has as well.
void nameTreeApart(ImportedCad& one, const ImportedCad& others) {
  std::set<std::string> taken, own;
  for (const ImportedPart& part : others.parts) taken.insert(part.within.begin(), part.within.end());
  for (const ImportedPart& part : one.parts) own.insert(part.within.begin(), part.within.end());
  std::map<std::string, std::string> renamed;
  for (ImportedPart& part : one.parts)
    for (std::string& name : part.within) {
      const auto [known, is_new] = renamed.try_emplace(name, name);
      if (is_new && taken.contains(name)) {
        for (int n = 2; taken.contains(known->second) || own.contains(known->second); ++n)
          known->second = name + "_" + std::to_string(n);
        own.insert(known->second);
      }
      name = known->second;
    }
}

/// Reads a file by its format's reader; the parts keep the file's axes.
void readAnew(const std::string& file, const FileFormat& format, const ImportSettings& settings,
              StoppableWork& work, ImportedCad& cad) {
  const import::FormatRow& row = format.row();
  const Progress progress = [&work](std::string_view doing, double share) { work.report(doing, share); };
  const auto read = [&](const Progress& inner) { return row.read(file, format, settings, inner); };
  std::optional<import::RawCad> raw;
  if (row.read_here != nullptr) raw = row.read_here(file, settings);
  if (!raw) raw = import::inOwnProcess(file, row.library, settings, progress, read);
  cad.states_unit = raw->states_unit;
  cad.missing = raw->missing;
  if (settings.part_per == PartPer::Object) raw->open_shapes = import::Shapes::AreParts;
  import::finish(std::move(*raw), cad, work);
  for (ImportedPart& part : cad.parts) {
    if (row.has_exact_faces)
      part.deflection_m = std::max(part.deflection_m.value_or(0), settings.deflection_m);
    else
      part.deflection_m.reset();
  }
}

/// All parts of the file as one part, in the frame of the file.
ImportedPart wholeFile(const ImportedCad& cad) {
  ImportedPart whole;
  whole.name = import::stem(cad.file);
  double largest_m2 = 0;
  for (const ImportedPart& part : cad.parts) {
    append(whole.mesh, transformed(part.mesh, part.X_WP));
    append(whole.face_colors, part.mesh.triangles.size(), part.face_colors, part.color);
    if (const double own_m2 = area(part.mesh); own_m2 > largest_m2) {
      largest_m2 = own_m2;
      whole.color = part.color;
    }
    if (part.deflection_m) whole.deflection_m = std::max(*part.deflection_m, whole.deflection_m.value_or(0));
    whole.rounding_m = std::max(whole.rounding_m, part.rounding_m);
    if (whole.note.empty()) whole.note = part.note;
  }
  simplify(whole.face_colors, whole.color);
  return whole;
}

/// A file's parts in the file's axes.
struct CadInFileAxes {
  ImportedCad cad;
  bool is_up_open = false;  ///< see FormatRow
};

/// Checks what shows at once: the settings, and the file's existence, size, kind, end and unit.
FileFormat readable(const std::string& file, const ImportSettings& settings) {
  if (settings.unit_m && !(*settings.unit_m > 0))
    throw LoadError(file, "", "is given a unit that is not a positive length; give metres per file unit");
  if (!(settings.deflection_m > 0) || !(settings.angle_rad > 0)) {
    throw LoadError(file, "", "needs a deflection and an angle of more than 0");
  }
  FileFormat format = import::detectFormat(file);
  if (format.row().has_no_unit) static_cast<void>(import::unitOf(file, format, settings));
  return format;
}

CadInFileAxes withFileAxes(const std::string& file, ImportSettings settings, const Progress& progress) {
  const FileFormat format = readable(file, settings);
  if (settings.most_memory_bytes == 0)
    settings.most_memory_bytes = static_cast<std::uint64_t>(0.5 * machineMemoryBytes());
  ImportedCad cad;
  cad.file = file;
  cad.format = format.name;
  const std::string doing = "reading " + import::stem(file);
  StoppableWork work(progress, doing);
  work.report(doing, 0);
  const std::string made_from = settings.cache != nullptr ? import::madeFrom(file, format, settings) : "";
  std::optional<std::string> kept;
  if (!made_from.empty()) kept = settings.cache->find(made_from);
  if (!kept || !import::readKeptBytes(*kept, cad)) {
    readAnew(file, format, settings, work, cad);
    if (!made_from.empty()) settings.cache->keep(made_from, import::keptBytes(cad));
  }
  if (settings.part_per == PartPer::File) cad.parts = {wholeFile(cad)};
  work.report(doing, 1);
  return {std::move(cad), format.row().is_up_open};
}

void setUp(ImportedCad& cad, bool is_open, const ImportSettings& settings) {
  if (settings.up) return import::turnUp(cad, *settings.up);
  if (is_open && settings.guesses_up) import::guessUp(cad);
}

}  // namespace

ImportedCad importCad(const std::string& file, const ImportSettings& settings, const Progress& progress) {
  CadInFileAxes one = withFileAxes(file, settings, withTimeLimit(progress, {settings.most_s}, file));
  setUp(one.cad, one.is_up_open, settings);
  return std::move(one.cad);
}

ImportedCad importCad(const std::vector<std::string>& files, const ImportSettings& settings,
                      const Progress& progress) {
  ImportedCad all;
  all.states_unit = !files.empty();
  bool is_up_open = true;
  std::vector<std::size_t> ends;
  // A file that is missing, empty or of no known kind is told before the others are read, which may take
  // minutes.
  for (const std::string& file : files) static_cast<void>(readable(file, settings));
  const TimeLimit limit{settings.most_s};
  for (const std::string& file : files) {
    auto [one, is_open] = withFileAxes(file, settings, withTimeLimit(progress, limit, file));
    if (all.file.empty()) all.file = file;
    is_up_open = is_up_open && is_open;
    all.states_unit = all.states_unit && one.states_unit;
    if (all.format.find(one.format) == std::string::npos)
      all.format += (all.format.empty() ? "" : ", ") + one.format;
    nameTreeApart(one, all);
    std::ranges::move(one.parts, std::back_inserter(all.parts));
    ends.push_back(all.parts.size());
    if (!one.missing.empty())
      all.missing.append(all.missing.empty() ? "" : "; ")
          .append(files.size() > 1 ? file + ": " : "")
          .append(one.missing);
    for (const std::string& warning : one.warnings)
      all.warnings.push_back(files.size() > 1 ? file + ": " + warning : warning);
  }
  import::nameUniquely(all.parts, "part");
  if (const std::string warning = import::ownFramesWarning(all.parts, ends); !warning.empty())
    all.warnings.push_back(warning);
  setUp(all, is_up_open, settings);
  return all;
}

}  // namespace vps::scenes
