// SPDX-License-Identifier: BSD-3-Clause
#include "import/occt/damaged_entities.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cstdint>
#include <unordered_set>
#include <utility>
#include <vector>

#include <IGESData_IGESEntity.hxx>
#include <Interface_Check.hxx>
#include <Interface_EntityIterator.hxx>
#include <Interface_Graph.hxx>
#include <Interface_ReportEntity.hxx>
#include <StepBasic_MeasureWithUnit.hxx>
#include <StepBasic_NamedUnit.hxx>
#include <StepData_UndefinedEntity.hxx>
#include <StepGeom_ConicalSurface.hxx>
#include <StepGeom_CylindricalSurface.hxx>
#include <StepGeom_Pcurve.hxx>
#include <StepGeom_SphericalSurface.hxx>
#include <StepGeom_SurfaceOfRevolution.hxx>
#include <StepGeom_ToroidalSurface.hxx>
#include <StepGeom_TrimmedCurve.hxx>
#include <StepRepr_MappedItem.hxx>
#include <StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <StepRepr_ProductDefinitionShape.hxx>
#include <StepRepr_ShapeRepresentationRelationship.hxx>
#include <StepShape_ContextDependentShapeRepresentation.hxx>
#include <StepShape_GeometricSet.hxx>
#include <StepShape_ShapeDefinitionRepresentation.hxx>
#include <StepShape_ShapeRepresentation.hxx>
#include <StepShape_ShellBasedSurfaceModel.hxx>
#include <StepShape_SolidModel.hxx>
#include <StepShape_TopologicalRepresentationItem.hxx>
#include <StepVisual_PreDefinedColour.hxx>
#include <StepVisual_PreDefinedItem.hxx>
#include <TCollection_HAsciiString.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

namespace vps::scenes::inline v0::import {
namespace {

using Entity = Handle(Standard_Transient);

template <class... Types>
bool isAny(const Entity& entity) {
  return (entity->IsKind(STANDARD_TYPE(Types)) || ...);
}

std::string joined(std::string text) {
  std::ranges::replace(text, '\n', ' ');
  return text;
}

/// The parameter that a message of Open CASCADE is about, "face_bound" of "Parameter n0.1 (face_bound) not a
/// LIST" and "name" of "(representation_item.name)"; empty where it names none.
std::string_view parameterOf(std::string_view message) {
  const std::size_t from = message.find("Parameter n0.");
  const std::size_t open = from == std::string_view::npos ? from : message.find('(', from);
  if (open == std::string_view::npos) return {};
  std::string_view name = message.substr(open + 1);
  name = name.substr(0, name.find(')'));
  return name.substr(name.rfind('.') + 1);
}

/// Calls f(number, where it is in the text, whether it is the entity's own) for each "#12" of the entities.
template <class F>
void forEachNumber(std::string_view text, F f) {
  const auto after = [&](std::size_t at, std::string_view end) {
    const std::size_t found = text.find(end, at);
    return found == std::string_view::npos ? text.size() : found + end.size();
  };
  std::size_t at = after(0, "DATA;");
  while ((at = text.find_first_of("#'/", at)) < text.size()) {
    if (text[at] == '\'') {
      at = after(at + 1, "'");
    } else if (text[at] == '/') {
      at = text.substr(at).starts_with("/*") ? after(at + 2, "*/") : at + 1;
    } else {
      std::uint64_t number = 0;
      const auto [end, error] = std::from_chars(text.data() + at + 1, text.data() + text.size(), number);
      const std::size_t from = std::exchange(at, static_cast<std::size_t>(end - text.data()));
      if (error != std::errc()) {
        at = from + 1;
        continue;
      }
      const std::size_t next = text.find_first_not_of(" \t\r\n", at);
      f(number, text.substr(from, at - from), next < text.size() && text[next] == '=');
    }
  }
}

/// The damaged entities of one file.
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
      if (const auto color = Handle(StepVisual_PreDefinedColour)::DownCast(model_->Value(i));
          !color.IsNull() && !color->GetPreDefinedItem().IsNull())
        color->GetPreDefinedItem()->SetName(new TCollection_HAsciiString(""));
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
          "its geometry is whole, but " + std::to_string(other) + (other == 1 ? " entity" : " entities") +
          " cannot be read, so that names, colours or annotations may be missing; the first: " + first_other;
    return damage;
  }

 private:
  [[nodiscard]] bool isNeeded(int i) const { return is_needed_[std::size_t(i)]; }

  /// Marks what the shapes of products refer to at any depth, and in IGES what is geometry by its number.
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
    while (!left.empty()) {
      const Entity entity = model_->Value(left.back());
      left.pop_back();
      for (Interface_EntityIterator it = graph_.Shareds(entity); it.More(); it.Next())
        need(model_->Number(it.Value()));
    }
  }

  /// The first message on what of a needed entity is lost; empty if its geometry is whole.
  [[nodiscard]] std::string lossOf(int i) const {
    // What says how exact, of which name, or where in an interface the geometry is. Open CASCADE computes
    // pcurves that are missing, and takes units by their kind and factor, not by their exponents.
    constexpr std::array<std::string_view, 9> kNoGeometry = {"name",
                                                             "id",
                                                             "description",
                                                             "identifier",
                                                             "dimensions",
                                                             "context_type",
                                                             "context_identifier",
                                                             "uncertainty_measure_with_unit",
                                                             "associated_geometry"};
    const Entity entity = model_->Value(i);
    const std::string_view type = entity->DynamicType()->Name();
    // Products, their contexts and categories, dates, persons: all that is not a unit.
    if (type.starts_with("StepBasic_") && !isAny<StepBasic_NamedUnit, StepBasic_MeasureWithUnit>(entity))
      return "";
    if (type.ends_with("SolidAngleUnit") || (type.ends_with("PlaneAngleUnit") && !hasAngles())) return "";
    const Handle(Interface_Check) check = model_->Check(i, true);
    std::string without_parameter;
    bool has_parameter = false;
    std::optional<bool> is_whole;  // but for items that are no shapes
    for (int k = 1; k <= check->NbFails(); ++k) {
      const std::string message = check->CFail(k);
      const std::string_view parameter = parameterOf(message);
      if (parameter.empty()) {
        // "A reference to another entity is unresolved" comes beside a message with the parameter.
        if (message.find("unresolved") == std::string::npos || without_parameter.empty())
          without_parameter = message;
        continue;
      }
      has_parameter = true;
      if (std::ranges::find(kNoGeometry, parameter) != kNoGeometry.end()) continue;
      if (parameter == "representation_item") {
        if (!is_whole) is_whole = hasShapeBesideUnknown(entity);
        if (*is_whole) continue;
      }
      return message;
    }
    const bool is_repeated = has_parameter && without_parameter.find("unresolved") != std::string::npos;
    return is_repeated ? "" : without_parameter;
  }

  /// Whether the geometry depends on the unit of angles: by a cone's half angle, by a parameter at the end of
  /// a conic, or by pcurves on round surfaces.
  [[nodiscard]] bool hasAngles() const {
    bool has_pcurve = false, is_round = false;
    for (int i = 1; i <= model_->NbEntities(); ++i) {
      if (!isNeeded(i)) continue;
      const Entity entity = model_->Value(i);
      if (isAny<StepGeom_ConicalSurface, StepGeom_TrimmedCurve>(entity)) return true;
      has_pcurve = has_pcurve || isAny<StepGeom_Pcurve>(entity);
      is_round = is_round || isAny<StepGeom_CylindricalSurface, StepGeom_SphericalSurface,
                                   StepGeom_ToroidalSurface, StepGeom_SurfaceOfRevolution>(entity);
    }
    return has_pcurve && is_round;
  }

  /// Whether a representation has a shape, and what could not be read of its items are entities of unknown
  /// kinds to which no topology belongs, such as annotations.
  [[nodiscard]] bool hasShapeBesideUnknown(const Entity& representation) const {
    if (!isAny<StepShape_ShapeRepresentation>(representation)) return false;
    bool has_shape = false;
    std::vector<Entity> unknown;
    for (Interface_EntityIterator it = graph_.Shareds(representation); it.More(); it.Next()) {
      const Entity& item = it.Value();
      has_shape = has_shape || isAny<StepShape_SolidModel, StepShape_ShellBasedSurfaceModel,
                                     StepShape_GeometricSet, StepRepr_MappedItem>(item);
      if (isAny<StepData_UndefinedEntity>(item)) unknown.push_back(item);
    }
    const Handle(Interface_Check) check = model_->Check(model_->Number(representation), true);
    std::size_t lost = 0;
    for (int k = 1; k <= check->NbFails(); ++k)
      if (parameterOf(check->CFail(k)) == "representation_item") ++lost;
    // More are lost than are unknown where one is missing from the file, whatever it was.
    return has_shape && lost <= unknown.size() && !referToTopology(std::move(unknown));
  }

  /// Whether one of the entities does, at any depth.
  [[nodiscard]] bool referToTopology(std::vector<Entity> left) const {
    std::vector<bool> is_seen(is_needed_.size());
    while (!left.empty()) {
      const Entity next = left.back();
      left.pop_back();
      if (isAny<StepShape_TopologicalRepresentationItem>(next)) return true;
      for (Interface_EntityIterator it = graph_.Shareds(next); it.More(); it.Next()) {
        const int number = model_->Number(it.Value());
        if (number <= 0 || is_seen[std::size_t(number)]) continue;
        is_seen[std::size_t(number)] = true;
        left.push_back(it.Value());
      }
    }
    return false;
  }

  /// Errors of the whole file; that references lead nowhere is said by their entities as well.
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
  std::vector<bool> is_needed_;  // by the entities' numbers, which begin with 1
};

}  // namespace

Damage damageOf(const Handle(Interface_InterfaceModel) & model) {
  return Finder(model).find();
}

std::string unplacedShapes(const XSControl_Reader& reader) {
  const Handle(Interface_InterfaceModel) model = reader.Model();
  const Handle(Transfer_TransientProcess) process = reader.WS()->TransferReader()->TransientProcess();
  std::string first;
  int count = 0;
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Entity entity = model->Value(i);
    if (!isAny<StepShape_SolidModel, StepShape_ShellBasedSurfaceModel>(entity) || process->IsBound(entity))
      continue;
    if (count++ == 0) first = model->StringLabel(entity)->ToCString();
  }
  if (count == 0) return "";
  return std::to_string(count) + (count == 1 ? " solid is" : " solids are") +
         " of no product, or of one that is placed nowhere, and left out; the first: " + first;
}

std::optional<std::string> withPlainlyLostReferences(std::string_view text) {
  std::unordered_set<std::uint64_t> own;
  forEachNumber(text, [&](std::uint64_t number, std::string_view, bool is_own) {
    if (is_own) own.insert(number);
  });
  std::string out;
  std::size_t copied = 0;
  forEachNumber(text, [&](std::uint64_t number, std::string_view where, bool is_own) {
    if (is_own || own.contains(number)) return;
    const auto from = static_cast<std::size_t>(where.data() - text.data());
    out.append(text.substr(copied, from - copied)).append("#2000000000");
    copied = from + where.size();
  });
  if (copied == 0) return std::nullopt;
  return out.append(text.substr(copied));
}

}  // namespace vps::scenes::inline v0::import
