// SPDX-License-Identifier: BSD-3-Clause
// importCad(): detects the format, runs its reader, and finishes the parts.
#include <algorithm>
#include <iterator>
#include <optional>

#include "import/own_process.h"
#include "import/readers.h"
#include "vps/load_error.h"

namespace vps::scenes::inline v0 {
namespace {

struct Reader {
  const char* library;
  import::RawCad (*read)(const std::string& file, const std::string& format, const ImportSettings& settings,
                         const Progress& progress);
};

bool hasExactFaces(const std::string& format) {
  return format == "STEP" || format == "IGES" || format == "BREP";
}

Reader readerOf(const std::string& format) {
  if (hasExactFaces(format)) return {"Open CASCADE", import::readOcct};
  if (format == "Inventor" || format == "VRML") return {"Coin", import::readCoin};
  return {"assimp", import::readAssimp};
}

}  // namespace

ImportedCad importCad(const std::string& file, const ImportSettings& settings, const Progress& progress) {
  if (settings.unit_m && !(*settings.unit_m > 0))
    throw LoadError(file, "", "is given a unit that is not a positive length; give metres per file unit");
  if (!(settings.deflection_m > 0) || !(settings.angle_rad > 0)) {
    throw LoadError(file, "", "needs a deflection and an angle of more than 0");
  }
  ImportedCad cad;
  cad.file = file;
  cad.format = import::detectFormat(file);
  if (progress) progress("reading " + import::stem(file), 0);
  const Reader reader = readerOf(cad.format);
  const auto read = [&](const Progress& inner) { return reader.read(file, cad.format, settings, inner); };
  std::optional<import::RawCad> raw;
  if (cad.format == "STL") raw = import::readBinaryStl(file, settings);
  if (!raw)
    raw =
        settings.in_own_process ? import::inOwnProcess(file, reader.library, progress, read) : read(progress);
  import::finish(std::move(*raw), cad);
  for (ImportedPart& part : cad.parts) {
    if (hasExactFaces(cad.format))
      part.deflection_m = std::max(part.deflection_m.value_or(0), settings.deflection_m);
    else
      part.deflection_m.reset();
  }
  if (settings.up) import::turnUp(cad, *settings.up);
  if (progress) progress("reading " + import::stem(file), 1);
  return cad;
}

ImportedCad importCad(const std::vector<std::string>& files, const ImportSettings& settings,
                      const Progress& progress) {
  ImportedCad all;
  for (const std::string& file : files) {
    ImportedCad one = importCad(file, settings, progress);
    if (all.file.empty()) all.file = file;
    if (all.format.find(one.format) == std::string::npos)
      all.format += (all.format.empty() ? "" : ", ") + one.format;
    std::ranges::move(one.parts, std::back_inserter(all.parts));
    for (const std::string& warning : one.warnings)
      all.warnings.push_back(files.size() > 1 ? file + ": " + warning : warning);
  }
  import::nameUniquely(all.parts, "part");
  return all;
}

}  // namespace vps::scenes::inline v0
