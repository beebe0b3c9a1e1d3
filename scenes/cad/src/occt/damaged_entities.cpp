// SPDX-License-Identifier: BSD-3-Clause
#include "occt/file_faults.h"

#include <algorithm>
#include <array>
#include <optional>
#include <string_view>
#include <vector>

#include <IGESData_IGESEntity.hxx>
#include <Interface_Check.hxx>
#include <Interface_EntityIterator.hxx>
#include <Interface_Graph.hxx>
#include <Interface_ReportEntity.hxx>
#include <StepBasic_MeasureWithUnit.hxx>
#include <StepBasic_NamedUnit.hxx>
#include <StepBasic_UncertaintyMeasureWithUnit.hxx>
#include <StepData_UndefinedEntity.hxx>
#include <StepGeom_ConicalSurface.hxx>
#include <StepGeom_CylindricalSurface.hxx>
#include <StepGeom_Pcurve.hxx>
#include <StepGeom_RectangularTrimmedSurface.hxx>
#include <StepGeom_SphericalSurface.hxx>
#include <StepGeom_SurfaceOfRevolution.hxx>
#include <StepGeom_ToroidalSurface.hxx>
#include <StepGeom_TrimmedCurve.hxx>
#include <StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <StepRepr_ProductDefinitionShape.hxx>
#include <StepRepr_ShapeRepresentationRelationshipWithTransformation.hxx>
#include <StepShape_ContextDependentShapeRepresentation.hxx>
#include <StepShape_RevolvedAreaSolid.hxx>
#include <StepShape_RevolvedFaceSolid.hxx>
#include <StepShape_ShapeDefinitionRepresentation.hxx>
#include <StepVisual_ColourRgb.hxx>
#include <StepVisual_PreDefinedColour.hxx>
#include <StepVisual_PreDefinedItem.hxx>
#include <TCollection_HAsciiString.hxx>

#include "occt/step_kinds.h"

namespace vps::scenes::import {
namespace {

std::string joined(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

/// The parameter that a message of Open CASCADE names: "face_bound" for "Parameter n0.1 (face_bound) not a
/// LIST", and "name" for "(representation_item.name)". Empty if the message names no parameter.
std::string_view parameterOf(std::string_view message) {
  const std::size_t from = message.find("Parameter n0.");
  const std::size_t open = from == std::string_view::npos ? from : message.find('(', from);
  if (open == std::string_view::npos) return {};
  std::string_view name = message.substr(open + 1);
  name = name.substr(0, name.find(')'));
  return name.substr(name.rfind('.') + 1);
}

/// Whether the name of an unknown kind of entity contains a word that marks kinds without geometry.
bool isNoShape(std::string_view kind) {
  constexpr std::array<std::string_view, 12> kWords = {"ANNOTATION", "DRAUGHTING", "CALLOUT", "TEXT",
                                                       "LEADER",     "DIMENSION",  "SYMBOL",  "CAMERA",
                                                       "PLACEMENT",  "AXIS2",      "AXIS1",   "PLACEHOLDER"};
  while (!kind.empty()) {
    const std::size_t end = std::min(kind.find('_'), kind.size());
    if (std::ranges::find(kWords, kind.substr(0, end)) != kWords.end()) return true;
    kind.remove_prefix(std::min(end + 1, kind.size()));
  }
  return false;
}

/// Finds the damaged entities of one file.
class Finder {
 public:
  explicit Finder(const Handle(Interface_InterfaceModel) & model)
      : model_(model), graph_(model, false), is_needed_(std::size_t(model->NbEntities()) + 1) {}

  Damage find() {
    findNeeded();
    std::string first_lost, first_other;
    int lost = 0, other = 0;
    for (int i = 1; i <= model_->NbEntities(); ++i) {
      if (!model_->IsErrorEntity(i)) continue;
      const std::string loss = isNeeded(i) ? lossOf(i) : "";
      if (loss.empty() ? other++ == 0 : lost++ == 0)
        (loss.empty() ? first_other : first_lost) =
            wordsOn(i, loss.empty() ? model_->Check(i, true)->CFail(1) : loss.c_str());
    }
    Damage damage;
    if (lost > 0)
      damage.lost_geometry = std::to_string(lost) + (lost == 1 ? " entity" : " entities") +
                             " of its geometry cannot be read; the first: " + first_lost;
    else if (const std::string global = globalLoss(); !global.empty())
      damage.lost_geometry = global;
    if (other > 0)
      damage.remark =
          std::to_string(other) + (other == 1 ? " entity" : " entities") +
          " cannot be read, so that names, colours or annotations may be missing; the first: " + first_other;
    return damage;
  }

 private:
  [[nodiscard]] bool isNeeded(int i) const { return is_needed_[std::size_t(i)]; }

  /// Marks the entities to which shapes of products refer, at any depth, and in IGES the entities whose type
  /// number is that of geometry.
  void findNeeded() {
    std::vector<int> left;
    const auto need = [&](int i) {
      if (i <= 0 || isNeeded(i)) return;
      is_needed_[std::size_t(i)] = true;
      left.push_back(i);
    };
    for (int i = 1; i <= model_->NbEntities(); ++i) {
      const Entity entity = model_->Value(i);
      const Handle(IGESData_IGESEntity) iges = Handle(IGESData_IGESEntity)::DownCast(entity);
      const int number = iges.IsNull() ? 0 : iges->TypeNumber();
      constexpr int kSubfigure = 308, kSingularInstance = 408, kSolidInstance = 430;
      const bool is_curve_or_surface = number >= 100 && number < 200;
      const bool is_topology = number >= 500 && number < 600;  // lists of vertices and edges, loops, faces
      if (is_curve_or_surface || is_topology || number == kSubfigure || number == kSingularInstance ||
          number == kSolidInstance ||
          isAny<StepShape_ShapeDefinitionRepresentation, StepShape_ContextDependentShapeRepresentation,
                StepRepr_ShapeRepresentationRelationship, StepRepr_NextAssemblyUsageOccurrence>(entity))
        need(i);
    }
    bool has_pcurve = false, is_round = false;
    while (!left.empty()) {
      const Entity entity = model_->Value(left.back());
      left.pop_back();
      has_pcurve = has_pcurve || isAny<StepGeom_Pcurve>(entity);
      is_round = is_round || isAny<StepGeom_CylindricalSurface, StepGeom_SphericalSurface,
                                   StepGeom_ToroidalSurface, StepGeom_SurfaceOfRevolution>(entity);
      has_angles_ = has_angles_ || (has_pcurve && is_round) ||
                    isAny<StepGeom_ConicalSurface, StepGeom_TrimmedCurve, StepGeom_RectangularTrimmedSurface,
                          StepShape_RevolvedAreaSolid, StepShape_RevolvedFaceSolid>(entity);
      if (isAny<IGESData_IGESEntity>(entity)) continue;  // all geometry of IGES is found by its type number
      for (Interface_EntityIterator it = graph_.Shareds(entity); it.More(); it.Next())
        if (!isNoGeometry(it.Value())) need(model_->Number(it.Value()));
    }
  }

  /// Whether the entity is an annotation, a style, a tolerance, an uncertainty or an unknown entity. An
  /// entity that needs such an entity is reported as damaged itself.
  static bool isNoGeometry(const Entity& entity) {
    const std::string_view type = entity->DynamicType()->Name();
    return type.starts_with("StepVisual_") || type.starts_with("StepDimTol_") ||
           isAny<StepBasic_UncertaintyMeasureWithUnit, StepData_UndefinedEntity>(entity);
  }

  /// The first message about lost geometry of a needed entity; empty if its geometry is complete.
  [[nodiscard]] std::string lossOf(int i) const {
    // Parameters with accuracy, names or identifiers have no geometry. Open CASCADE computes missing pcurves,
    // and identifies units by kind and factor, not by exponents.
    constexpr std::array<std::string_view, 10> kNoGeometry = {"name",
                                                              "id",
                                                              "reference_designator",
                                                              "description",
                                                              "identifier",
                                                              "dimensions",
                                                              "context_type",
                                                              "context_identifier",
                                                              "uncertainty_measure_with_unit",
                                                              "associated_geometry"};
    const Entity entity = model_->Value(i);
    const std::string_view type = entity->DynamicType()->Name();
    // StepBasic entities other than units have no geometry: products, their contexts and categories, dates,
    // persons.
    if (type.starts_with("StepBasic_") && !isAny<StepBasic_NamedUnit, StepBasic_MeasureWithUnit>(entity))
      return "";
    if (type.ends_with("SolidAngleUnit") || (type.ends_with("PlaneAngleUnit") && !has_angles_)) return "";
    const Handle(Interface_Check) check = model_->Check(i, true);
    std::string without_parameter;
    bool has_parameter = false;
    std::optional<std::string> lost_item;
    for (int k = 1; k <= check->NbFails(); ++k) {
      const std::string message = check->CFail(k);
      const std::string_view parameter = parameterOf(message);
      if (parameter.empty()) {
        // The message "A reference to another entity is unresolved" accompanies another message that names
        // the parameter.
        if (message.find("unresolved") == std::string::npos || without_parameter.empty())
          without_parameter = message;
        continue;
      }
      has_parameter = true;
      if (std::ranges::find(kNoGeometry, parameter) != kNoGeometry.end()) continue;
      if (parameter == "representation_item") {
        if (!lost_item) lost_item = lostItem(entity);
        if (lost_item->empty()) continue;
        return *lost_item;
      }
      if ((parameter == "rep_1" || parameter == "rep_2") && isBesideUnknown(entity)) continue;
      return message;
    }
    const bool is_repeated = has_parameter && without_parameter.find("unresolved") != std::string::npos;
    return is_repeated ? "" : without_parameter;
  }

  /// The loss among the items of a representation, in words. Empty if the representation has a shape and all
  /// items that were not read are of unknown kinds whose names mark them as no shapes.
  [[nodiscard]] std::string lostItem(const Entity& representation) const {
    bool has_shape = false;
    std::size_t unknown = 0, lost = 0;
    for (Interface_EntityIterator it = graph_.Shareds(representation); it.More(); it.Next()) {
      const Entity& item = it.Value();
      has_shape = has_shape || isShape(item);
      const auto other = Handle(StepData_UndefinedEntity)::DownCast(item);
      if (other.IsNull()) continue;
      ++unknown;
      const std::string kind = other->StepType() != nullptr ? other->StepType() : "";
      if (!isNoShape(kind))
        return std::string("its item ") + model_->StringLabel(item)->ToCString() + " " + kind +
               " is of a kind that is not read";
    }
    const Handle(Interface_Check) check = model_->Check(model_->Number(representation), true);
    for (int k = 1; k <= check->NbFails(); ++k)
      if (parameterOf(check->CFail(k)) == "representation_item") ++lost;
    // If the number of lost items exceeds the number of unknown kinds, an item is missing from the file, and
    // it may be a shape.
    return has_shape && lost <= unknown ? "" : check->CFail(1);
  }

  /// Whether a relationship joins a representation with a shape to a representation of an unknown kind, such
  /// as a tessellation of the exact shape.
  [[nodiscard]] bool isBesideUnknown(const Entity& relationship) const {
    bool has_shape = false, has_unknown = false;
    for (Interface_EntityIterator it = graph_.Shareds(relationship); it.More(); it.Next()) {
      has_shape = has_shape || anyItem(it.Value(), isShape);
      has_unknown = has_unknown || isAny<StepData_UndefinedEntity>(it.Value());
    }
    return has_shape && has_unknown &&
           !isAny<StepRepr_ShapeRepresentationRelationshipWithTransformation>(relationship);
  }

  /// The first error of the file as a whole. Unresolved references are skipped, since they are also errors of
  /// their entities.
  [[nodiscard]] std::string globalLoss() const {
    const Handle(Interface_Check) global = model_->GlobalCheck(true);
    for (int k = 1; k <= global->NbFails(); ++k)
      if (const std::string message = global->CFail(k); !message.starts_with("Unresolved Reference"))
        return joined(message);
    return "";
  }

  [[nodiscard]] std::string wordsOn(int i, const std::string& message) const {
    const Entity entity = model_->Value(i);
    std::string words = model_->StringLabel(entity)->ToCString();
    const Handle(Interface_ReportEntity) report = model_->ReportEntity(i);
    if (!report.IsNull() && report->HasContent())
      if (const auto content = Handle(StepData_UndefinedEntity)::DownCast(report->Content());
          !content.IsNull() && content->StepType() != nullptr)
        words.append(" ").append(content->StepType());
    return joined(words + ": " + message);
  }

  Handle(Interface_InterfaceModel) model_;
  Interface_Graph graph_;
  std::vector<bool> is_needed_;  // indexed by the number of an entity, from 1
  /// The geometry depends on the unit of angles, through a cone's half angle, a parameter at the end of a
  /// conic or of a surface, the angle of a revolution, or pcurves on round surfaces.
  bool has_angles_ = false;
};

}  // namespace

Damage damageOf(const Handle(Interface_InterfaceModel) & model) {
  return Finder(model).find();
}

void mendColors(const Handle(Interface_InterfaceModel) & model) {
  // Rounding in single precision, and what a dark colour may lack.
  constexpr double kBeside = 0.01;
  const auto rounded = [](double share) {
    if (share < 0) return 0.0;
    return share > 1 && share < 1 + kBeside ? 1.0 : std::min(share, 255.0);
  };
  for (int i = 1; i <= model->NbEntities(); ++i) {
    if (const auto rgb = Handle(StepVisual_ColourRgb)::DownCast(model->Value(i)); !rgb.IsNull()) {
      rgb->SetRed(rounded(rgb->Red()));
      rgb->SetGreen(rounded(rgb->Green()));
      rgb->SetBlue(rounded(rgb->Blue()));
    }
    const auto color = Handle(StepVisual_PreDefinedColour)::DownCast(model->Value(i));
    if (color.IsNull() || color->GetPreDefinedItem().IsNull()) continue;
    if (model->IsErrorEntity(i))
      color->GetPreDefinedItem()->SetName(new TCollection_HAsciiString(""));
    else if (!color->GetPreDefinedItem()->Name().IsNull())
      color->GetPreDefinedItem()->Name()->LowerCase();
  }
}

}  // namespace vps::scenes::import
