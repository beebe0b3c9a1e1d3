// SPDX-License-Identifier: BSD-3-Clause
// The rigid pieces of an Open CASCADE shape.
#pragma once

#include <vector>

#include <TopoDS_Shape.hxx>

namespace vps::scenes::import {

/// The rigid pieces of a shape: each solid, and the faces outside of solids, sewn together where they meet.
std::vector<TopoDS_Shape> pieces(const TopoDS_Shape& shape);

}  // namespace vps::scenes::import
