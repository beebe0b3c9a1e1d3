// SPDX-License-Identifier: BSD-3-Clause
// Kinds of entities in Open CASCADE's models of STEP files.
#pragma once

#include <algorithm>

#include <StepRepr_HArray1OfRepresentationItem.hxx>
#include <StepRepr_MappedItem.hxx>
#include <StepRepr_Representation.hxx>
#include <StepShape_Block.hxx>
#include <StepShape_BooleanResult.hxx>
#include <StepShape_FaceBasedSurfaceModel.hxx>
#include <StepShape_GeometricSet.hxx>
#include <StepShape_HalfSpaceSolid.hxx>
#include <StepShape_RightAngularWedge.hxx>
#include <StepShape_RightCircularCone.hxx>
#include <StepShape_RightCircularCylinder.hxx>
#include <StepShape_ShellBasedSurfaceModel.hxx>
#include <StepShape_SolidModel.hxx>
#include <StepShape_Sphere.hxx>
#include <StepShape_Torus.hxx>

namespace vps::scenes::import {

using Entity = Handle(Standard_Transient);

template <class... Types>
bool isAny(const Entity& entity) {
  return !entity.IsNull() && (entity->IsKind(STANDARD_TYPE(Types)) || ...);
}

/// Whether the entity is a primitive or an operation of constructive solid geometry.
inline bool isPrimitive(const Entity& entity) {
  return isAny<StepShape_Block, StepShape_RightAngularWedge, StepShape_RightCircularCone,
               StepShape_RightCircularCylinder, StepShape_Sphere, StepShape_Torus, StepShape_BooleanResult,
               StepShape_HalfSpaceSolid>(entity);
}

/// Whether the entity is a shape when it is an item of a representation.
inline bool isShape(const Entity& entity) {
  return isPrimitive(entity) ||
         isAny<StepShape_SolidModel, StepShape_ShellBasedSurfaceModel, StepShape_FaceBasedSurfaceModel,
               StepShape_GeometricSet, StepRepr_MappedItem>(entity);
}

/// Whether f(item) is true for any item of a representation.
template <class F>
bool anyItem(const Entity& representation, F f) {
  const auto of = Handle(StepRepr_Representation)::DownCast(representation);
  if (of.IsNull() || of->Items().IsNull()) return false;
  return std::any_of(of->Items()->begin(), of->Items()->end(), f);
}

}  // namespace vps::scenes::import
