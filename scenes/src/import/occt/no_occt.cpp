// SPDX-License-Identifier: BSD-3-Clause
// Stands in for Open CASCADE where the build has not found it.
#include "import/readers.h"
#include "vps/load_error.h"

namespace vps::scenes::import {

RawCad readOcct(const std::string& file, const std::string& format, const ImportSettings&, const Progress&) {
  throw LoadError(file, "",
                  format +
                      " needs Open CASCADE, which this build has not; install "
                      "libocct-data-exchange-dev and build again");
}

}  // namespace vps::scenes::import
