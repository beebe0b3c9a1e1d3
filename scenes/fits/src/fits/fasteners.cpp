// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/fits/fasteners.h"

#include <map>

#include "fits/fastener_shape.h"
#include "surface/on_cores.h"

namespace vps::scenes {

const char* toText(FastenerKind kind) {
  switch (kind) {
    case FastenerKind::Screw:
      return "screw";
    case FastenerKind::Stud:
      return "stud";
    case FastenerKind::Nut:
      return "nut";
    case FastenerKind::Washer:
      return "washer";
    case FastenerKind::Pin:
      return "pin";
    case FastenerKind::Key:
      return "key";
    case FastenerKind::Circlip:
      return "circlip";
  }
  return "";
}

std::vector<std::optional<FastenerShape>> fastenerShapes(const std::vector<PlacedSurface>& parts,
                                                         const Progress& progress) {
  std::map<const PartSurface*, std::size_t> number;  // of each different shape
  std::vector<const PartSurface*> surfaces;
  for (const PlacedSurface& part : parts)
    if (number.try_emplace(part.surface.get(), surfaces.size()).second)
      surfaces.push_back(part.surface.get());
  std::vector<std::optional<FastenerShape>> shapes(surfaces.size()), out;
  forEachOnCores(surfaces.size(), progress, "finding fasteners",
                 [&](std::size_t i) { shapes[i] = fastenerShape(*surfaces[i], fitFaces(*surfaces[i])); });
  for (const PlacedSurface& part : parts) out.push_back(shapes[number.at(part.surface.get())]);
  return out;
}

std::vector<Fastener> findFasteners(const std::vector<DrawnPart>& parts, const Progress& progress) {
  const std::vector<PlacedSurface> placed = placedSurfaces(parts, progress);
  const std::vector<std::optional<FastenerShape>> shapes = fastenerShapes(placed, progress);
  std::vector<Fastener> out;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (shapes[i]) out.push_back({parts[i].name, shapes[i]->kind, shapes[i]->words});
  return out;
}

}  // namespace vps::scenes
