// SPDX-License-Identifier: BSD-3-Clause
// A product of 67 solids as a STEP file, made by Open CASCADE: a gearbox with its fasteners.
#pragma once

#include <string>

namespace vps::bench {

struct ProductSize {
  int solids = 0, faces = 0;
};

/// @param is_shared  equal solids refer to one product of the file; otherwise each has faces of its own, as
/// in
///                   the files of many exporters
ProductSize writeProduct(const std::string& file, bool is_shared);

}  // namespace vps::bench
