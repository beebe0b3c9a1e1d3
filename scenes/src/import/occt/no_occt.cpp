// SPDX-License-Identifier: BSD-3-Clause
// Replaces the Open CASCADE reader in a build without Open CASCADE.
#include "import/readers.h"
#include "vps/load_error.h"

namespace vps::scenes::inline v0::import {

std::string occtVersion() {
  return "";
}

RawCad readOcct(const std::string& file, const std::string& format, const ImportSettings&, const Progress&) {
  throw LoadError(file, "",
                  format +
                      " needs Open CASCADE, which this build lacks; install "
                      "libocct-data-exchange-dev and build again");
}

}  // namespace vps::scenes::inline v0::import
