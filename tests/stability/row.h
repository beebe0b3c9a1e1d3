// SPDX-License-Identifier: BSD-3-Clause
// One row of the stability table: a scene with one quantity that goes to its extreme.
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
  bool is_thorough = false;  ///< hours where the short form takes seconds
};

struct Row {
  std::string key;
  std::string extreme;  ///< what goes to its extreme, with its unit
  std::string judged;   ///< by what, beside what every run is judged by (watch.h)
  /// From harmless towards the extreme. The first `asked` are what this suite promises to try, each is run;
  /// those beyond only until one breaks.
  std::vector<double> ladder;
  std::size_t asked = 0;
  std::function<Judgement(const Run&)> run;
  /// How many of those asked hold by constraint and by penalty; fewer are a known edge, and the page says
  /// why.
  std::size_t holds[2] = {99, 99};
  /// Values are cases: what a value stands for. Else they are numbers, and the edge is narrowed between them.
  std::function<std::string(double)> label = nullptr;
};

}  // namespace vps::stability
