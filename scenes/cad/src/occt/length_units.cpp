// SPDX-License-Identifier: BSD-3-Clause
#include "occt/file_faults.h"

#include <array>
#include <cctype>
#include <cmath>
#include <string>
#include <string_view>
#include <utility>

#include <IGESData_BasicEditor.hxx>
#include <IGESData_IGESModel.hxx>
#include <StepBasic_ConversionBasedUnitAndLengthUnit.hxx>
#include <StepBasic_HArray1OfNamedUnit.hxx>
#include <StepBasic_LengthUnit.hxx>
#include <StepBasic_MeasureValueMember.hxx>
#include <StepBasic_MeasureWithUnit.hxx>
#include <StepBasic_SiUnitAndLengthUnit.hxx>
#include <StepBasic_Unit.hxx>
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

constexpr int kNamedUnit = 3;  ///< flag of a unit that has a name alone

void mendUnitOfIges(IGESData_GlobalSection& global) {
  if (global.UnitFlag() != kNamedUnit || global.UnitName().IsNull() ||
      IGESData_BasicEditor::UnitNameFlag(global.UnitName()->ToCString()) > 0)
    return;
  std::string name;
  for (const char* c = global.UnitName()->ToCString(); *c != 0; ++c)
    if (*c != ' ') name += static_cast<char>(std::toupper(static_cast<unsigned char>(*c)));
  if (name.size() > 3 && name.ends_with('S')) name.pop_back();  // MILLIMETERS
  if (name.ends_with("ETRE")) name.replace(name.size() - 2, 2, "ER");
  // Names and flags of IGES 5.3, section 2.2.4.3.14.
  constexpr std::array<std::pair<std::string_view, int>, 19> kFlags = {{{"INCHE", 1},
                                                                        {"INCH", 1},
                                                                        {"IN", 1},
                                                                        {"MM", 2},
                                                                        {"MILLIMETER", 2},
                                                                        {"FT", 4},
                                                                        {"FOOT", 4},
                                                                        {"FEET", 4},
                                                                        {"MI", 5},
                                                                        {"M", 6},
                                                                        {"METER", 6},
                                                                        {"KM", 7},
                                                                        {"KILOMETER", 7},
                                                                        {"MIL", 8},
                                                                        {"UM", 9},
                                                                        {"MICRON", 9},
                                                                        {"CM", 10},
                                                                        {"CENTIMETER", 10},
                                                                        {"UIN", 11}}};
  for (const auto& [known, flag] : kFlags)
    if (name == known) global.SetUnitFlag(flag);
}

bool hasValue(const Handle(StepBasic_MeasureWithUnit) & measure) {
  return !measure.IsNull() && !measure->ValueComponentMember().IsNull();
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

void mendUnits(const Handle(Interface_InterfaceModel) & model) {
  if (const auto iges = Handle(IGESData_IGESModel)::DownCast(model); !iges.IsNull())
    return mendUnitOfIges(iges->ChangeGlobalSection());
  constexpr int kMost = 8;  // units may be based on each other in a circle
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const auto unit = Handle(StepBasic_ConversionBasedUnit)::DownCast(model->Value(i));
    if (unit.IsNull()) continue;
    for (int k = 0; k < kMost; ++k) {
      const Handle(StepBasic_MeasureWithUnit) factor = unit->ConversionFactor();
      if (!hasValue(factor)) break;
      const auto base = Handle(StepBasic_ConversionBasedUnit)::DownCast(factor->UnitComponent().Value());
      if (base.IsNull() || base == unit || !hasValue(base->ConversionFactor())) break;
      factor->SetValueComponent(factor->ValueComponent() * base->ConversionFactor()->ValueComponent());
      factor->SetUnitComponent(base->ConversionFactor()->UnitComponent());
    }
  }
}

LengthUnits lengthUnits(const Handle(Interface_InterfaceModel) & model) {
  const auto iges = Handle(IGESData_IGESModel)::DownCast(model);
  if (iges.IsNull()) return unitsOfStep(*model);
  const IGESData_GlobalSection& global = iges->GlobalSection();
  LengthUnits found;
  found.is_stated = global.UnitFlag() == kNamedUnit
                        ? !global.UnitName().IsNull() &&
                              IGESData_BasicEditor::UnitNameFlag(global.UnitName()->ToCString()) > 0
                        : IGESData_BasicEditor::UnitFlagValue(global.UnitFlag()) > 0;
  return found;
}

}  // namespace vps::scenes::import
