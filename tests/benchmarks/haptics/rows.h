// SPDX-License-Identifier: BSD-3-Clause
// The rows of the table; each is one function.
#pragma once

#include <vector>

#include "table.h"

namespace vps::bench {

struct HapticOptions {
  bool is_short = false;  ///< each row takes a few seconds, with the same bounds
};

struct HapticCase {
  const char* key;  ///< for --rows
  void (*run)(const HapticOptions&, Table&);
};

// Rows of the arm alone.
void kinematicsRow(const HapticOptions&, Table&);
void staticsRow(const HapticOptions&, Table&);
// Rows of a sampled wall in one direction.
void passivityRow(const HapticOptions&, Table&);
void ringingRow(const HapticOptions&, Table&);
void stiffestWallRow(const HapticOptions&, Table&);
// Rows of the arm with the haptic loop and Bullet with VPS contact.
void pressRow(const HapticOptions&, Table&);
void slideRow(const HapticOptions&, Table&);
void freeMotionRow(const HapticOptions&, Table&);
// Row of shipped scenes that the virtual operator assembles over a connection with delay and loss.
// This row needs the library vps::scenes.
void injectedRow(const HapticOptions&, Table&);
// Rows in real time.
void tickRow(const HapticOptions&, Table&);
void pointsRow(const HapticOptions&, Table&);

}  // namespace vps::bench
