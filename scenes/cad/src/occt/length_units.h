// SPDX-License-Identifier: BSD-3-Clause
// The units of length of a STEP or IGES file, as far as Open CASCADE 7.6.3 does not tell of them: it takes
// millimetres where there is none, and a factor that is negative.
#pragma once

#include <string>

#include <Interface_InterfaceModel.hxx>

namespace vps::scenes::import {

struct LengthUnits {
  bool is_stated = true;  ///< at least one shape has a unit
  std::string remark;     ///< on shapes without a unit beside others with one; empty: there are none
  std::string fault;      ///< a unit that is no length, in words; empty: there is none
};

/// O(entities).
LengthUnits lengthUnits(const Handle(Interface_InterfaceModel) & model);

}  // namespace vps::scenes::import
