// SPDX-License-Identifier: BSD-3-Clause
// Results as JSON.
#include "output/json_out.h"

#include <algorithm>

#include "output/json_fields.h"
#include "output/reports.h"
#include "vps_device/dual_arm/character.h"
#include "vps_scenes/fits/check_fields.h"
#include "vps_scenes/fits/revision_fields.h"
#include "vps_scenes/planning/fidelity_choice.h"
#include "vps_scenes/planning/plan_fields.h"
#include "vps_scenes/planning/study_fields.h"
#include "vps_scenes/planning/trade_fields.h"
#include "vps_scenes/run/result_fields.h"
#include "vps_scenes/uses/compare.h"
#include "vps_scenes/uses/ergonomics.h"
#include "vps_viewer/window/latency.h"

namespace vps::viewer {

namespace {

/// Names come from files and need not be UTF-8; an invalid byte becomes U+FFFD and causes no error.
std::string text(const Json& json) {
  return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Json shortTimes(const scenes::TickTimes& times) {
  return toObject(times, scenes::kShortTimes);
}

Json modelled(const scenes::ModelledCost& cost) {
  return toObject(cost, scenes::kModelledFields);
}

Json pairOverlap(const scenes::PairOverlap& pair) {
  return {{"a", pair.a},
          {"b", pair.b},
          {"depth_m", pair.depth_m},
          {"at_m", toValue(pair.at_W)},
          {"time_s", pair.time_s}};
}

Json exactDepth(const scenes::JudgedDepth& judged) {
  const bool has_any = judged.deepest.depth_m > 0;
  return {{"deepest", has_any ? pairOverlap(judged.deepest) : Json(nullptr)},
          {"bound_m", judged.bound_m},
          {"measures", judged.measures}};
}

Json overlap(const scenes::JudgedOverlap& judged) {
  Json starts = Json::array();
  for (const scenes::OverlappingStart& start : judged.at_start) {
    starts.push_back(pairOverlap(start.start));
    starts.back()["apart_s"] = toValue(start.apart_s);
    starts.back()["end_depth_m"] = start.end_depth_m;
  }
  const bool has_any = judged.deepest.depth_m > 0;
  return {{"max_depth_m", judged.deepest.depth_m},
          {"limit_m", judged.limit_m},
          {"is_within_limit", judged.isWithinLimit()},
          {"poses_judged", judged.poses_judged},
          {"deepest", has_any ? pairOverlap(judged.deepest) : Json(nullptr)},
          {"at_start", starts}};
}

}  // namespace

std::string toJson(const scenes::AssembleResult& result) {
  Json json = {{"wall", toObject(result, scenes::kAssembleWallFields)}};
  addFields(json, result, scenes::kAssembleFields);
  return text(json);
}

std::string toJson(const std::string& scene, double seconds, const scenes::SimulateResult& result) {
  Json bodies = Json::array();
  for (const scenes::BodyState& body : result.bodies)
    bodies.push_back({{"name", body.name},
                      {"position_m", toValue(body.X_WP.p)},
                      {"rotation_xyzw", toValue(body.X_WP.quaternion())},
                      {"velocity_m_s", toValue(body.V_WP_W.v)},
                      {"angular_velocity_rad_s", toValue(body.V_WP_W.w)}});
  Json wall = {{"build_s", result.build_wall_s},
               {"step_us", shortTimes(result.step)},
               {"contact_step_us", shortTimes(result.contact_step)}};
  if (const auto& kept = result.real_time)
    wall["physics"] = {{"missed_periods", kept->missed},
                       {"run_s", kept->run_wall_s},
                       {"has_priority", kept->has_priority},
                       {"has_locked_memory", kept->has_locked_memory},
                       {"warnings", kept->warnings}};
  Json json = {{"wall", wall},
               {"scene", scene},
               {"seconds", seconds},
               {"steps", result.step.count},
               {"contact_steps", result.contact_step.count},
               {"bodies", bodies},
               {"max_penetration_m", result.max_penetration_m},
               {"max_penetration_by", "exact_distance"},
               {"contact_depth_m", result.contact_depth_m},
               {"kinetic_energy_J", result.kinetic_energy_J},
               {"shortened_steps", result.shortened_steps},
               {"modelled", modelled(result.modelled)}};
  addFields(json, result,
            std::make_tuple(
                scenes::list("fast_turns", &scenes::SimulateResult::fast_turns, scenes::kFastTurnFields)));
  json["most_substeps"] = result.most_substeps;
  json["exact"] = exactDepth(result.exact);
  if (result.overlap) json["overlap"] = overlap(*result.overlap);
  return text(json);
}

std::string toJson(const QueryAnswer& answer) {
  Json poses = Json::array();
  for (const PoseAnswer& pose : answer.poses) {
    Json entry = {{"position_m", toValue(pose.X_AB.p)},
                  {"rotation_xyzw", toValue(pose.X_AB.quaternion())},
                  {"min_distance_m", pose.is_beyond ? Json(nullptr) : Json(pose.min_distance_m)},
                  {"max_depth_m", pose.is_beyond ? 0 : pose.maxDepth_m()},
                  {"is_depth_saturated", pose.is_saturated},
                  {"contact_count", pose.contact_count},
                  {"points_total", answer.points_total},
                  {"points_tested", pose.points_tested},
                  {"force_N", toValue(pose.F_Bo_A.f)},
                  {"torque_Nm", toValue(pose.F_Bo_A.tau)}};
    if (pose.is_beyond) entry["beyond_m"] = pose.min_distance_m;
    poses.push_back(std::move(entry));
  }
  Json all = {{"wall", {{"build_s", answer.build_wall_s}, {"time_us", shortTimes(answer.time)}}},
              {"mesh_a", answer.mesh_a},
              {"mesh_b", answer.mesh_b},
              {"voxel_m", answer.voxel_m},
              {"point_spacing_m", answer.point_spacing_m},
              {"memory_bytes", answer.memory_bytes},
              {"poses", poses}};
  if (answer.voxel_b_m > 0 && answer.voxel_b_m != answer.voxel_m) all["voxel_b_m"] = answer.voxel_b_m;
  return text(all);
}

std::string toJson(const ImportAnswer& answer) {
  Json parts = Json::array();
  for (const ImportedPartAnswer& part : answer.parts)
    parts.push_back({{"name", part.name},
                     {"file", part.file},
                     {"triangles", part.triangles},
                     {"closed", part.is_closed},
                     {"size_m", toValue(part.size_m)}});
  Json groups = Json::array();
  for (const scenes::PartGroup& group : answer.groups)
    groups.push_back({{"name", group.name}, {"parts", group.parts}, {"reason", group.reason}});
  Json fasteners = Json::array();
  for (const scenes::Fastener& one : answer.fasteners)
    fasteners.push_back(toObject(one, scenes::kFastenerFields));
  return text({{"cad", answer.cad},
               {"format", answer.format},
               {"parts", parts},
               {"groups", groups},
               {"fasteners", fasteners},
               {"warnings", answer.warnings}});
}

std::string toJson(const ExportAnswer& answer) {
  Json files = Json::array();
  for (const ExportedFileAnswer& row : answer.files) {
    Json file = {{"file", row.file}, {"model", row.model}};
    if (row.model == "voxmap") {
      file["voxel_m"] = row.voxel_m;
      file["bricks"] = row.bricks;
    } else if (row.model == "pointshell") {
      file["points"] = row.points;
      file["point_spacing_m"] = row.point_spacing_m;
    } else {
      file["triangles"] = row.triangles;
    }
    files.push_back(std::move(file));
  }
  return text({{"source", answer.source}, {"part", answer.part}, {"files", files}});
}

std::string toJson(const SnapshotAnswer& answer) {
  Json json = {{"scene", answer.scene}, {"width", answer.width}, {"height", answer.height}};
  if (answer.is_compared)
    json["compared"] = {{"same_size", answer.is_same_size},
                        {"tolerance", answer.tolerance},
                        {"share_beyond", answer.share_beyond},
                        {"greatest_difference", answer.greatest_difference},
                        {"mean_difference", answer.mean_difference}};
  return text(json);
}

namespace {

Json percentiles(const std::vector<double>& values_s) {
  return {{"seen", std::ranges::count_if(values_s, [](double value) { return value >= 0; })},
          {"p50_s", percentile(values_s, 0.5)},
          {"p99_s", percentile(values_s, 0.99)},
          {"max_s", percentile(values_s, 1)}};
}

}  // namespace

std::string toJson(const LatencyResult& result) {
  Json stages = Json::object();
  for (const LatencyStage& stage : latencyStages()) {
    std::vector<double> values_s;
    for (const ContactTimes& times : result.contacts) values_s.push_back(times.*stage.time_s);
    stages[stage.key] = percentiles(values_s);
  }
  return text({{"scene", result.scene},
               {"part", result.part},
               {"width", result.width},
               {"height", result.height},
               {"has_sound", result.hasSound()},
               {"bound_s", kApart_s},
               {"wall",
                {{"contacts", result.contacts.size()},
                 {"is_good", result.isGood()},
                 {"apart", percentiles(result.apart_s())},
                 {"since_read", stages},
                 {"late_samples", result.late_samples},
                 {"late_mixes", result.late_mixes},
                 {"picture_s", result.picture_wall_s},
                 {"drawn_by", result.drawn_by}}}});
}

namespace {

Json names(const scenes::Scene& scene, const std::vector<std::size_t>& parts) {
  Json out = Json::array();
  for (const std::size_t i : parts) out.push_back(scene.parts[i].part.name);
  return out;
}

Json plannedPart(const scenes::Scene& scene, const scenes::ExplainedModels& explained, std::size_t i) {
  const scenes::PartModelPlan& part = explained.plan.parts[i];
  const scenes::PartCost& cost = explained.cost.parts[i];
  Json kept = Json::array();
  for (const Box& box : part.kept_P) kept.push_back(toValue(box));
  return {{"part", scene.parts[i].part.name},
          {"map", part.has_map},
          {"shell", part.has_shell},
          {"same_as", part.same_as ? Json(scene.parts[*part.same_as].part.name) : Json(nullptr)},
          {"kept_m", kept},
          {"map_bytes", cost.map_bytes},
          {"shell_bytes", cost.shell_bytes},
          {"points", cost.points},
          {"why", part.why}};
}

Json plannedStep(const scenes::Scene& scene, const scenes::ExplainedModels& explained, std::size_t s) {
  const scenes::FieldPlan& step = explained.plan.steps[s];
  const scenes::StepCost& cost = explained.cost.steps[s];
  return {{"moves", step.part ? Json(scene.parts[*step.part].part.name) : Json(nullptr)},
          {"region_m", step.region_W ? toValue(*step.region_W) : Json(nullptr)},
          {"cooked", names(scene, step.cooked)},
          {"left_out", names(scene, step.left_out)},
          {"is_cooked_anew", cost.is_cooked},
          {"field_bytes", cost.bytes},
          {"field_points", cost.points}};
}

Json explainWall(const scenes::ModelPlanCost& cost) {
  Json parts = Json::array(), steps = Json::array();
  for (const scenes::PartCost& part : cost.parts)
    parts.push_back({{"map_s", part.map_wall_s}, {"shell_s", part.shell_wall_s}});
  for (const scenes::StepCost& step : cost.steps) steps.push_back(step.cook_wall_s);
  return {{"build_s", cost.build_wall_s}, {"cook_s", cost.cook_wall_s}, {"parts", parts}, {"steps", steps}};
}

}  // namespace

std::string toJson(const ExplainAnswer& answer) {
  const scenes::Scene& scene = answer.scene;
  const scenes::ModelPlan& plan = answer.chosen.plan;
  Json parts = Json::array(), steps = Json::array();
  for (std::size_t i = 0; i < plan.parts.size(); ++i) parts.push_back(plannedPart(scene, answer.chosen, i));
  for (std::size_t s = 0; s < plan.steps.size(); ++s) steps.push_back(plannedStep(scene, answer.chosen, s));
  Json json = {{"wall", explainWall(answer.chosen.cost)},
               {"scene", scene.name},
               {"for", plan.purpose == scenes::ModelPurpose::Assemble ? "assemble" : "simulate"},
               {"models_everything", plan.models_everything},
               {"estimated", answer.chosen.cost.is_estimated},
               {"voxel_m", scene.fidelity.voxel_m},
               {"point_spacing_m", scene.fidelity.spacing_m},
               {"sides", toText(scene.fidelity.sides)},
               {"parts", parts},
               {"steps", steps},
               {"modelled", modelled(answer.chosen.cost.most)}};
  if (!answer.everything) return text(json);
  json["everything"] = modelled(answer.everything->cost.most);
  json["wall"]["everything"] = {{"build_s", answer.everything->cost.build_wall_s},
                                {"cook_s", answer.everything->cost.cook_wall_s}};
  return text(json);
}

std::string toJson(const std::string& scene, const scenes::FidelityChoice& choice) {
  Json json = {{"scene", scene}};
  addFields(json, choice, scenes::kChoiceFields);
  return text(json);
}

namespace {

Json wayFaults(const std::vector<scenes::WayFault>& faults) {
  Json list = Json::array();
  for (const scenes::WayFault& fault : faults) list.push_back(toObject(fault, scenes::kWayFaultFields));
  return list;
}

}  // namespace

std::string toJson(const scenes::SessionAnswer& answer) {
  return text({{"done", answer.is_done}, {"answer", answer.words}});
}

std::string toJson(const scenes::PlanResult& plan, const std::vector<scenes::WayFault>& faults) {
  Json json = {{"wall", toObject(plan, scenes::kPlanWallFields)}};
  json["verdict"] = scenes::toText(verdictOf(plan, faults));
  addFields(json, plan, scenes::kPlanFields);
  json["way_faults"] = wayFaults(faults);
  return text(json);
}

std::string toJson(const std::string& scene, const std::vector<scenes::WayFault>& faults) {
  return text(
      {{"scene", scene}, {"verdict", scenes::toText(verdictOf(faults))}, {"way_faults", wayFaults(faults)}});
}

std::string toJson(const scenes::CheckResult& result, const scenes::RevisionChanges* against) {
  Json parts = Json::array();
  for (const scenes::CheckedPart& part : result.parts) {
    Json& json = parts.emplace_back(toObject(part, scenes::kCheckedPartFields));
    if (!part.play) continue;
    json["play_axes"] = Json::array();
    for (int axis = 0; axis < 3; ++axis)
      json["play_axes"].push_back(toValue(Vec3(part.play_axes_W.col(axis))));
    json["ways_out"] = Json::array();
    for (const Vec3& way : part.ways_out_W) json["ways_out"].push_back(toValue(way));
    json["screw_ways_out"] = Json::array();
    for (const scenes::ScrewWay& way : part.screw_ways_out)
      json["screw_ways_out"].push_back(
          {{"axis", toValue(way.axis_W)}, {"at_m", toValue(way.at_W)}, {"lead_m", way.lead_m}});
  }
  Json pairs = Json::array(), fits = Json::array();
  for (const scenes::CheckedPair& pair : result.pairs)
    pairs.push_back(toObject(pair, scenes::kCheckedPairFields));
  for (const scenes::CheckedFit& fit : result.fits) fits.push_back(toObject(fit, scenes::kCheckedFitFields));
  Json places = toObject(result.places, scenes::kCheckedPlacesFields);
  places["moved"] = Json::array();
  for (const scenes::MovedPart& part : result.places.moved)
    places["moved"].push_back(toObject(part, scenes::kMovedPartFields));
  places["groups"] = Json::array();
  for (const scenes::CheckedGroup& group : result.places.groups)
    places["groups"].push_back(toObject(group, scenes::kCheckedGroupFields));
  const auto names = [](const std::vector<scenes::PairPattern>& patterns) {
    Json out = Json::array();
    for (const scenes::PairPattern& pattern : patterns) out.push_back({pattern.a, pattern.b});
    return out;
  };
  const auto objects = [](const auto& list, const auto& rows) {
    Json out = Json::array();
    for (const auto& of : list) out.push_back(toObject(of, rows));
    return out;
  };
  Json json = {{"wall", toObject(result, scenes::kCheckWallFields)},
               {"assembly", result.assembly},
               {"verdict", scenes::toText(result.verdict())},
               {"clashes", result.clashes()},
               {"uncertain", result.uncertain()},
               {"alone", result.alone},
               {"between", names(result.between)},
               {"ignore", names(result.ignored)},
               {"left_out", objects(result.left_out, scenes::kLeftOutPairFields)},
               {"moves", objects(result.moves, scenes::kPartMoveFields)},
               {"rules", objects(result.rules, scenes::kRuleOutcomeFields)},
               {"rule_counts", objects(result.rule_counts, scenes::kRuleCountFields)},
               {"places", places},
               {"pairs", pairs},
               {"fits", fits},
               {"parts", parts}};
  if (against != nullptr) json["against"] = toObject(*against, scenes::kRevisionFields);
  return text(json);
}

std::string toJson(const scenes::MarginResult& result) {
  Json steps = Json::array();
  for (const scenes::StepMargin& step : result.steps)
    steps.push_back(toObject(step, scenes::kStepMarginFields));
  return text({{"scene", result.scene},
               {"resolution_m", result.resolution_m},
               {"by_contact", result.has_contact},
               {"verdict", scenes::toText(result.verdict())},
               {"steps", steps}});
}

std::string toJson(const scenes::Ergonomics& result) {
  Json steps = Json::array();
  for (const scenes::StepErgonomics& step : result.steps)
    steps.push_back(toObject(step, scenes::kStepErgonomicsFields));
  return text({{"steps", steps}});
}

std::string toJson(const scenes::RunComparison& result) {
  Json json = Json::object();
  addFields(json, result, scenes::kComparisonFields);
  return text(json);
}

std::string toJson(const scenes::StudyResult& result) {
  Json json = Json::object();
  addFields(json, result, scenes::kStudyFields);
  return text(json);
}

std::string toJson(const scenes::TradeResult& result) {
  Json rows = Json::array(), wall = Json::array();
  for (const scenes::TradeRow& row : result.rows) {
    rows.push_back(toObject(row, scenes::kTradeRowFields));
    wall.push_back({{"name", row.setting.name}});
    addFields(wall.back(), row, scenes::kTradeRowWallFields);
  }
  return text({{"wall",
                {{"rows", wall},
                 {"answers", scenes::tradeAnswers(result)},
                 {"knobs", scenes::tradeKnobs(result)},
                 {"left_out", result.left_out}}},
               {"scene", result.scene},
               {"excerpt", result.excerpt},
               {"poses", result.poses},
               {"poses_inside", result.poses_inside},
               {"reference_spacing_m", result.reference_spacing_m},
               {"cannot_choose", result.fixed},
               {"rows", rows}});
}

namespace {

Json extent(const device::Extent& e) {
  return {{"least", e.least}, {"median", e.median}, {"greatest", e.greatest}};
}

Json duty(const device::Duty& d) {
  return {{"continuous", extent(d.continuous)}, {"peak", extent(d.peak)}};
}

Json coupling(const device::DeviceLimits& limits, const CouplingGains& gains) {
  return {{"k_N_per_m", gains.k_N_per_m},
          {"b_Ns_per_m", gains.b_Ns_per_m},
          {"k_Nm_per_rad", gains.k_Nm_per_rad},
          {"b_Nms_per_rad", gains.b_Nms_per_rad},
          {"device_damping_Ns_per_m", limits.damping_Ns_per_m},
          {"device_damping_Nms_per_rad", limits.damping_Nms_per_rad},
          {"device_coulomb_N", limits.coulomb_N},
          {"device_coulomb_Nm", limits.coulomb_Nm},
          {"device_delay_s", limits.delay_s}};
}

Json parameters(const device::DualArmFile& file) {
  Json out = Json::object();
  for (const device::ParameterNote& note : file.notes) {
    const Json value = note.value.size() == 1 ? Json(note.value[0]) : Json(note.value);
    const char* origin = note.words.empty() ? "given" : note.is_sourced ? "sourced" : "assumed";
    out[note.section][note.key] = {{"value", value}, {origin, note.words}};
  }
  return out;
}

}  // namespace

std::string toJson(const device::DualArmCharacter& c, const device::DualArmFile& file) {
  Json json;
  json["device"] = "dual_arm";
  json["workspace"] = {{"size_m", toValue(c.workspace_m)},
                       {"straight_scale", c.straight_scale},
                       {"tilted_scale", c.tilted_scale},
                       {"gimbal_sr", c.gimbal_sr},
                       {"centre_solid_angle_sr", c.centre_solid_angle_sr},
                       {"solid_angle_sr", extent(c.solid_angle_sr)}};
  json["limit"] = {{"force_N", {c.limits_1kHz.continuous_force_N, c.limits_1kHz.peak_force_N}},
                   {"torque_Nm", {c.limits_1kHz.continuous_torque_Nm, c.limits_1kHz.peak_torque_Nm}}};
  json["force_N"] = {{"worst_direction_straight", duty(c.straight_force_N)},
                     {"worst_direction", duty(c.force_N)},
                     {"any_direction", duty(c.any_force_N)},
                     {"up_left", duty(c.left_up_N)},
                     {"up_right", duty(c.right_up_N)},
                     {"up_both", duty(c.up_N)},
                     {"up_both_with_couple", duty(c.sum_up_N)}};
  json["torque_Nm"] = {{"worst_direction_straight", duty(c.straight_torque_Nm)},
                       {"worst_direction", duty(c.torque_Nm)},
                       {"any_direction", duty(c.any_torque_Nm)}};
  json["stiffness_N_per_m"] = {{"held", extent(c.held_stiffness_N_per_m)},
                               {"free", extent(c.free_stiffness_N_per_m)}};
  json["resolution"] = {{"to_45_deg_m", extent(c.resolution_m)},
                        {"to_45_deg_rad", extent(c.resolution_rad)},
                        {"all_directions_m", extent(c.far_resolution_m)},
                        {"all_directions_rad", extent(c.far_resolution_rad)}};
  json["friction_N"] = extent(c.friction_N);
  json["force_over_friction"] = {{"continuous", c.force_ratio}, {"peak", c.peak_force_ratio}};
  json["isotropy"] = {{"plate_torque_over_places_arm", c.arm_isotropy},
                      {"plate_torque_over_places_pair", c.pair_isotropy},
                      {"directions_arm", extent(c.arm_ellipsoid_isotropy)},
                      {"directions_pair", extent(c.ellipsoid_isotropy)}};
  json["manipulability_arm_m2"] = extent(c.arm_manipulability_m2);
  json["mean_force_pair_N"] = extent(c.pair_force_mean_N);
  json["reflected"] = {{"mass_kg", extent(c.mass_kg)}, {"inertia_kgm2", extent(c.inertia_kgm2)}};
  json["clearance_m"] = {{"straight", c.straight_clearance_m},
                         {"to_45_deg", c.tilted_clearance_m},
                         {"all_directions", c.far_clearance_m}};
  json["coupling"] = {{"at_1kHz", coupling(c.limits_1kHz, c.gains_1kHz)},
                      {"at_4kHz", coupling(c.limits_4kHz, c.gains_4kHz)}};
  json["parameters"] = parameters(file);
  return text(json);
}

}  // namespace vps::viewer
