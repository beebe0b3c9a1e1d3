// SPDX-License-Identifier: BSD-3-Clause
#include "occt/pieces.h"

#include <algorithm>
#include <cmath>

#include <BRepBndLib.hxx>
#include <BRepBuilderAPI_Sewing.hxx>
#include <Bnd_Box.hxx>
#include <TopExp_Explorer.hxx>

namespace vps::scenes::import {
std::vector<TopoDS_Shape> pieces(const TopoDS_Shape& shape) {
  std::vector<TopoDS_Shape> found;
  for (TopExp_Explorer it(shape, TopAbs_SOLID); it.More(); it.Next()) found.push_back(it.Current());
  // 1 um [mm], which suffices for most IGES edges; far less where the file states that the part is tiny.
  Bnd_Box box;
  BRepBndLib::Add(shape, box);
  const double tolerance = box.IsVoid() ? 1e-3 : std::min(1e-3, 1e-5 * std::sqrt(box.SquareExtent()));
  BRepBuilderAPI_Sewing sewing(tolerance);
  int loose = 0;
  for (TopExp_Explorer it(shape, TopAbs_FACE, TopAbs_SOLID); it.More(); it.Next(), ++loose)
    sewing.Add(it.Current());
  if (loose > 0) {
    sewing.Perform();
    if (!sewing.SewedShape().IsNull()) found.push_back(sewing.SewedShape());
  }
  return found;
}

}  // namespace vps::scenes::import
