// SPDX-License-Identifier: BSD-3-Clause
#include "occt/file_faults.h"

#include <cmath>

#include <IGESData_BasicEditor.hxx>
#include <IGESData_IGESModel.hxx>
#include <StepBasic_ConversionBasedUnitAndLengthUnit.hxx>
#include <StepBasic_HArray1OfNamedUnit.hxx>
#include <StepBasic_LengthUnit.hxx>
#include <StepBasic_MeasureWithUnit.hxx>
#include <StepBasic_SiUnitAndLengthUnit.hxx>
#include <StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx.hxx>
#include <StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext.hxx>
#include <StepRepr_GlobalUnitAssignedContext.hxx>
#include <StepRepr_RepresentationContext.hxx>
#include <StepShape_ShapeRepresentation.hxx>
#include <TCollection_HAsciiString.hxx>

#include "occt/step_kinds.h"

namespace vps::scenes::import {
namespace {

using Units = Handle(StepBasic_HArray1OfNamedUnit);

/// The units of a context; null if it has none.
template <class Context>
Units unitsOf(const Entity& context) {
  const auto of = Handle(Context)::DownCast(context);
  return of.IsNull() ? Units() : of->Units();
}

/// The unit of length in a context; null if it has none.
Entity lengthUnitIn(const Entity& context) {
  for (const Units& units :
       {unitsOf<StepGeom_GeomRepContextAndGlobUnitAssCtxAndGlobUncertaintyAssCtx>(context),
        unitsOf<StepGeom_GeometricRepresentationContextAndGlobalUnitAssignedContext>(context),
        unitsOf<StepRepr_GlobalUnitAssignedContext>(context)})
    for (int i = 1; !units.IsNull() && i <= units->Length(); ++i)
      if (const Entity unit(units->Value(i));
          isAny<StepBasic_SiUnitAndLengthUnit, StepBasic_ConversionBasedUnitAndLengthUnit,
                StepBasic_LengthUnit>(unit))
        return unit;
  return {};
}

LengthUnits unitsOfStep(const Interface_InterfaceModel& model) {
  LengthUnits found;
  int with_unit = 0, without_unit = 0;
  std::string first;
  for (int i = 1; i <= model.NbEntities(); ++i) {
    const auto shape = Handle(StepShape_ShapeRepresentation)::DownCast(model.Value(i));
    if (shape.IsNull() || !anyItem(shape, isShape)) continue;
    const Entity unit = lengthUnitIn(shape->ContextOfItems());
    if (unit.IsNull()) {
      if (without_unit++ == 0) first = model.StringLabel(shape)->ToCString();
      continue;
    }
    ++with_unit;
    const auto converted = Handle(StepBasic_ConversionBasedUnit)::DownCast(unit);
    if (converted.IsNull() || converted->ConversionFactor().IsNull()) continue;
    const double factor = converted->ConversionFactor()->ValueComponent();
    if (found.fault.empty() && !(factor > 0 && std::isfinite(factor)))
      found.fault = std::string("the conversion factor of its unit of length ") +
                    model.StringLabel(unit)->ToCString() + " is not a positive number";
  }
  found.is_stated = with_unit > 0 || without_unit == 0;
  if (with_unit > 0 && without_unit > 0)
    found.remark = std::to_string(without_unit) +
                   (without_unit == 1 ? " shape states no unit of length, and is"
                                      : " shapes state no unit of length, and are") +
                   " read in millimetres; the first: " + first;
  return found;
}

}  // namespace

LengthUnits lengthUnits(const Handle(Interface_InterfaceModel) & model) {
  const auto iges = Handle(IGESData_IGESModel)::DownCast(model);
  if (iges.IsNull()) return unitsOfStep(*model);
  constexpr int kNamedUnit = 3;
  const IGESData_GlobalSection& global = iges->GlobalSection();
  LengthUnits found;
  found.is_stated = global.UnitFlag() == kNamedUnit
                        ? !global.UnitName().IsNull() &&
                              IGESData_BasicEditor::UnitNameFlag(global.UnitName()->ToCString()) > 0
                        : IGESData_BasicEditor::UnitFlagValue(global.UnitFlag()) > 0;
  return found;
}

}  // namespace vps::scenes::import
