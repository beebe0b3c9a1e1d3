// SPDX-License-Identifier: BSD-3-Clause
// Replaces the Coin reader in a build without Coin.
#include "import/readers.h"

namespace vps::scenes::import {

RawCad readCoin(const std::string& file, const FileFormat& format, const ImportSettings&, const Progress&) {
  throw missingLibrary(file, format.name, "Coin", "libcoin-dev");
}

}  // namespace vps::scenes::import
