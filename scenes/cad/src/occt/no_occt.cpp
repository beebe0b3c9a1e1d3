// SPDX-License-Identifier: BSD-3-Clause
// Replaces the Open CASCADE reader in a build without Open CASCADE.
#include "import/readers.h"

namespace vps::scenes::import {

std::string occtVersion() {
  return "";
}

RawCad readOcct(const std::string& file, const FileFormat& format, const ImportSettings&, const Progress&) {
  throw missingLibrary(file, format.name, "Open CASCADE", "libocct-data-exchange-dev");
}

}  // namespace vps::scenes::import
