// SPDX-License-Identifier: BSD-3-Clause
// One row of the stability table: a scene in which one quantity is increased or decreased to its extreme.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "dynamics/engine.h"
#include "judgement.h"

namespace vps::stability {

using dynamics::Mode;

struct Run {
  Mode mode = Mode::Constraint;
  double value = 0;          ///< of the row's quantity
  bool is_thorough = false;  ///< hours instead of seconds
};

struct Row {
  std::string key;
  std::string extreme;  ///< the quantity, with its unit
  std::string judged;   ///< criteria in addition to those of every run (watch.h)
  /// Values from harmless to extreme. The first `promised` are always run, the others until one fails.
  std::vector<double> ladder;
  std::size_t promised = 0;
  std::function<Judgement(const Run&)> run;
  /// How many promised values must hold with constraint and with penalty contact. Fewer than promised is a
  /// known limit, explained in README.md.
  std::size_t holds[2] = {99, 99};
  /// Name of a value, if values are cases. Otherwise they are numbers, and the limit is narrowed between
  /// them.
  std::function<std::string(double)> label = nullptr;
};

}  // namespace vps::stability
