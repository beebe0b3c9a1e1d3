// SPDX-License-Identifier: BSD-3-Clause
// Replaces the Coin reader in a build without Coin.
#include "import/readers.h"
#include "vps/load_error.h"

namespace vps::scenes::inline v0::import {

RawCad readCoin(const std::string& file, const std::string& format, const ImportSettings&, const Progress&) {
  throw LoadError(file, "",
                  format + " needs Coin, which this build lacks; install libcoin-dev and build again");
}

}  // namespace vps::scenes::inline v0::import
