// SPDX-License-Identifier: BSD-3-Clause
// The rows of the table, one function each.
#pragma once

#include <vector>

#include "table.h"

namespace vps::bench {

struct HapticOptions {
  bool is_short = false;  ///< a few seconds of work for each row, with the same bounds
};

struct HapticCase {
  const char* key;  ///< for --rows
  void (*run)(const HapticOptions&, Table&);
};

// The arm alone.
void kinematicsRow(const HapticOptions&, Table&);
void staticsRow(const HapticOptions&, Table&);
// A sampled wall of one direction.
void passivityRow(const HapticOptions&, Table&);
void ringingRow(const HapticOptions&, Table&);
void stiffestWallRow(const HapticOptions&, Table&);
// The arm, the haptic loop, and Bullet with VPS contact.
void pressRow(const HapticOptions&, Table&);
void slideRow(const HapticOptions&, Table&);
void freeMotionRow(const HapticOptions&, Table&);
// Shipped scenes with their operator. Needs vps::scenes.
void injectedRow(const HapticOptions&, Table&);
// In real time.
void tickRow(const HapticOptions&, Table&);
void pointsRow(const HapticOptions&, Table&);

}  // namespace vps::bench
