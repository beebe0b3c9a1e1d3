// SPDX-License-Identifier: BSD-3-Clause
#include "import/readers.h"
#include "vps/load_error.h"

namespace vps {

ImportedCad importCad(const std::string& file, const ImportSettings& settings, const Progress& progress) {
  if (settings.unit_m && !(*settings.unit_m > 0))
    throw LoadError(file, "", "its unit is not a positive length");
  if (!(settings.deflection_m > 0) || !(settings.angle_rad > 0)) {
    throw LoadError(file, "", "deflection and angle must be positive");
  }
  ImportedCad cad;
  cad.file = file;
  cad.format = import::detectFormat(file);
  if (progress) progress("reading " + import::stem(file), 0);
  import::RawCad raw;
  if (cad.format == "STEP" || cad.format == "IGES" || cad.format == "BREP") {
    raw = import::readOcct(file, cad.format, settings, progress);
  } else if (cad.format == "Inventor" || cad.format == "VRML") {
    raw = import::readCoin(file, cad.format, settings);
  } else {
    raw = import::readAssimp(file, cad.format, settings);
  }
  import::finish(std::move(raw), cad);
  if (progress) progress("reading " + import::stem(file), 1);
  return cad;
}

}  // namespace vps
