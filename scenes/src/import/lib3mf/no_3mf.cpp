// SPDX-License-Identifier: BSD-3-Clause
// Replaces the 3MF reader in a build without lib3mf.
#include "import/readers.h"
#include "vps/load_error.h"

namespace vps::scenes::inline v0::import {

RawCad read3mf(const std::string& file, const std::string& format, const ImportSettings&, const Progress&) {
  throw LoadError(file, "",
                  format + " needs lib3mf, which this build lacks; install lib3mf-dev and build again");
}

}  // namespace vps::scenes::inline v0::import
