// SPDX-License-Identifier: BSD-3-Clause
// The cases of the table, each a scene with its bounds.
#pragma once

#include <vector>

#include "dynamics/world.h"
#include "table.h"

namespace vps::bench {

struct Options {
  std::vector<dynamics::Mode> modes;
  bool is_short = false;
};

struct Case {
  const char* key;  ///< for --rows
  void (*run)(const Options&, Table&);
  bool is_optional = false;  ///< runs only if --rows names it
};

const std::vector<Case>& allCases();

}  // namespace vps::bench
