// SPDX-License-Identifier: BSD-3-Clause
#include "vps/fidelity.h"

#include <string>

#include "vps/errors.h"

namespace vps {

// All values are assumed; the paper gives none of them. The grid step is half the point spacing, so that the
// area of a point covers a few cells. `vps trade` measures the settings that a scene needs.
Fidelity fidelityPreset(std::string_view name) {
  Fidelity f;  // "normal": fits of tens of micrometres on parts of a few centimetres
  if (name == "normal") return f;
  if (name == "fast") {  // for previews: a quarter of the points, and of each pair only the points of
                         // the smaller part are queried
    f.voxel_m = 0.5e-3;
    f.spacing_m = 1e-3;
    f.sides = Sides::One;
    f.contact_limit = 24;
    f.solver_iterations = 50;
    return f;
  }
  if (name == "fine") {  // tight fits: a cell small against the curvature of a 10 mm bore (error h^2 / 8r)
    f.voxel_m = 0.125e-3;
    f.spacing_m = 0.25e-3;
    f.contact_limit = 256;
    f.solver_iterations = 200;
    return f;
  }
  throw LoadError("", "", "fidelity '" + std::string(name) + "' is not known; use fast, normal or fine");
}

}  // namespace vps
