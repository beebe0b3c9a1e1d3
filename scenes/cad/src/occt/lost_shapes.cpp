// SPDX-License-Identifier: BSD-3-Clause
#include "occt/file_faults.h"

#include <algorithm>
#include <map>
#include <set>
#include <string_view>
#include <vector>

#include <Interface_Check.hxx>
#include <Interface_InterfaceModel.hxx>
#include <StepBasic_ProductDefinition.hxx>
#include <StepRepr_CharacterizedDefinition.hxx>
#include <StepRepr_NextAssemblyUsageOccurrence.hxx>
#include <StepRepr_ProductDefinitionShape.hxx>
#include <StepRepr_RepresentedDefinition.hxx>
#include <StepRepr_ShapeRepresentationRelationshipWithTransformation.hxx>
#include <StepShape_ContextDependentShapeRepresentation.hxx>
#include <StepShape_ShapeDefinitionRepresentation.hxx>
#include <TCollection_HAsciiString.hxx>
#include <Transfer_Binder.hxx>
#include <Transfer_TransientProcess.hxx>
#include <XSControl_TransferReader.hxx>
#include <XSControl_WorkSession.hxx>

#include "occt/step_kinds.h"

namespace vps::scenes::import {
namespace {

/// Finds products with a shape, and their instances without a placement.
class Placements {
 public:
  explicit Placements(const Handle(Interface_InterfaceModel) & model) : model_(model) {
    for (int i = 1; i <= model->NbEntities(); ++i) add(model->Value(i));
  }

  [[nodiscard]] std::string unplaced() {
    std::string first;
    int count = 0;
    for (const auto& [assembly, instances] : instances_of_)
      for (const Handle(StepRepr_NextAssemblyUsageOccurrence) & instance : instances) {
        std::set<Entity> seen;
        // A mapped item in the assembly's shape is also a placement.
        if (placed_.contains(instance) || anyItemOf(assembly, isAny<StepRepr_MappedItem>) ||
            !hasShape(instance->RelatedProductDefinition(), seen))
          continue;
        if (count++ == 0) {
          const Handle(TCollection_HAsciiString) name = instance->Name();
          first = model_->StringLabel(instance)->ToCString();
          if (!name.IsNull() && !name->IsEmpty()) first.append(" '").append(name->ToCString()).append("'");
        }
      }
    if (count == 0) return "";
    return std::to_string(count) + (count == 1 ? " instance of a part has" : " instances of parts have") +
           " no placement; the first: " + first;
  }

 private:
  void add(const Entity& entity) {
    if (const auto instance = Handle(StepRepr_NextAssemblyUsageOccurrence)::DownCast(entity);
        !instance.IsNull()) {
      instances_of_[instance->RelatingProductDefinition()].push_back(instance);
    } else if (const auto placement = Handle(StepShape_ContextDependentShapeRepresentation)::DownCast(entity);
               !placement.IsNull()) {
      if (!placement->RepresentationRelation().IsNull() && !placement->RepresentedProductRelation().IsNull())
        placed_.insert(placement->RepresentedProductRelation()->Definition().Value());
    } else if (const auto shape = Handle(StepShape_ShapeDefinitionRepresentation)::DownCast(entity);
               !shape.IsNull()) {
      if (const auto of = Handle(StepRepr_PropertyDefinition)::DownCast(shape->Definition().Value());
          !of.IsNull())
        shapes_of_[of->Definition().Value()].push_back(shape->UsedRepresentation());
    } else if (const auto relation = Handle(StepRepr_ShapeRepresentationRelationship)::DownCast(entity);
               !relation.IsNull() &&
               !isAny<StepRepr_ShapeRepresentationRelationshipWithTransformation>(entity)) {
      same_shape_[relation->Rep1()].push_back(relation->Rep2());
      same_shape_[relation->Rep2()].push_back(relation->Rep1());
    }
  }

  /// Whether f(item) is true for any item of a product's shape.
  template <class F>
  [[nodiscard]] bool anyItemOf(const Entity& product, F f) const {
    const auto own = shapes_of_.find(product);
    return own != shapes_of_.end() && std::ranges::any_of(own->second, [&](const Entity& shape) {
             const auto same = same_shape_.find(shape);
             return anyItem(shape, f) ||
                    (same != same_shape_.end() && std::ranges::any_of(same->second, [&](const Entity& other) {
                       return anyItem(other, f);
                     }));
           });
  }
  /// Whether a product or one of its parts has a shape. `seen` ends the search in products that contain
  /// themselves.
  [[nodiscard]] bool hasShape(const Entity& product, std::set<Entity>& seen) const {
    if (product.IsNull() || !seen.insert(product).second) return false;
    if (anyItemOf(product, isShape)) return true;
    const auto parts = instances_of_.find(product);
    return parts != instances_of_.end() && std::ranges::any_of(parts->second, [&](const auto& part) {
             return hasShape(part->RelatedProductDefinition(), seen);
           });
  }

  Handle(Interface_InterfaceModel) model_;
  std::map<Entity, std::vector<Handle(StepRepr_NextAssemblyUsageOccurrence)>> instances_of_;
  std::map<Entity, std::vector<Entity>> shapes_of_, same_shape_;
  std::set<Entity> placed_;
};

/// The number of solids that were not translated, with the reason for the first, in words; empty if there are
/// none.
std::string leftOut(const Handle(Interface_InterfaceModel) & model,
                    const Transfer_TransientProcess& process) {
  std::string first;
  int count = 0;
  const auto look = [&](const Entity& solid) {
    if (process.IsBound(solid) || count++ > 0) return;
    std::string_view kind = solid->DynamicType()->Name();
    kind.remove_prefix(kind.find('_') + 1);
    first = std::string(model->StringLabel(solid)->ToCString()).append(" (").append(kind).append(") ");
    const Handle(Transfer_Binder) tried = process.Find(solid);
    if (isPrimitive(solid))
      first += "is of a kind that is not read";
    else if (!tried.IsNull() && tried->Check()->NbFails() > 0)
      first += std::string("cannot be translated: ") + tried->Check()->CFail(1);
    else
      first += tried.IsNull() ? "belongs to no product that is placed" : "cannot be translated";
  };
  for (int i = 1; i <= model->NbEntities(); ++i) {
    const Entity entity = model->Value(i);
    if (isAny<StepShape_SolidModel, StepShape_ShellBasedSurfaceModel>(entity)) look(entity);
    // A primitive inside a solid that consists of several is not examined.
    anyItem(entity, [&](const Entity& item) {
      if (isPrimitive(item)) look(item);
      return false;
    });
  }
  if (count == 0) return "";
  std::ranges::replace(first, '\n', ' ');
  return std::to_string(count) + (count == 1 ? " solid is" : " solids are") +
         " left out; the first: " + first;
}

}  // namespace

LostShapes lostShapes(const XSControl_Reader& reader) {
  return {Placements(reader.Model()).unplaced(),
          leftOut(reader.Model(), *reader.WS()->TransferReader()->TransientProcess())};
}

}  // namespace vps::scenes::import
