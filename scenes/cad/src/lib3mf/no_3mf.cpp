// SPDX-License-Identifier: BSD-3-Clause
// Replaces the 3MF reader in a build without lib3mf.
#include "import/readers.h"

namespace vps::scenes::import {

RawCad read3mf(const std::string& file, const FileFormat& format, const ImportSettings&, const Progress&) {
  throw missingLibrary(file, format.name, "lib3mf", "lib3mf-dev libminizip-dev");
}

}  // namespace vps::scenes::import
