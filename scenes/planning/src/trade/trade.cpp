// SPDX-License-Identifier: BSD-3-Clause
// trade(): measures one setting after another within the time limit.
#include "vps_scenes/planning/trade.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <map>
#include <memory>
#include <new>
#include <optional>
#include <utility>
#include <vector>

#include "core/machine.h"
#include "models/scene_models.h"
#include "study/variants.h"
#include "trade/probe.h"
#include "trade/trade_plan.h"
#include "vps/errors.h"
#include "vps_scenes/run/assemble.h"
#include "vps_scenes/scene/model_options.h"
#include "vps_scenes/scene/number_words.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

namespace {

constexpr std::size_t kPoses = 16;
constexpr std::size_t kThoroughPoses = 96;
/// Stride of the judged poses; the fifty poses of a step with the deepest contacts are always judged.
constexpr std::size_t kJudgeStride = 200;

std::vector<std::string> fixedChoices() {
  return {
      "tree or exhaustive query: a run always uses the tree, whose result equals the exhaustive one bit for "
      "bit; "
      "the times of both are listed",
#ifdef VPS_BULLET_DOUBLE
      "float or double: chosen when Bullet and this program are built (cmake -DVPS_BULLET_DOUBLE=OFF); this "
      "build uses double",
#else
      "float or double: chosen when Bullet and this program are built (cmake -DVPS_BULLET_DOUBLE=ON); this "
      "build uses float",
#endif
  };
}

/// Stores the maps of one scene's parts by voxel size, and their shells by spacing.
class ModelStore {
 public:
  /// Sets the models of the scene's parts; builds the models that are not stored. Returns the build time [s].
  /// Throws as buildModels().
  double fill(Scene& scene, const ModelOptions& options);

 private:
  using Key = std::pair<std::size_t, double>;
  std::vector<std::shared_ptr<const PartModel>> models_;  ///< models of the last measured row, by part
  std::map<Key, std::shared_ptr<const VoxMap>> maps_;
  std::map<Key, std::shared_ptr<const PointShell>> shells_;
};

double ModelStore::fill(Scene& scene, const ModelOptions& options) {
  const double voxel_m = scene.fidelity.voxel_m, spacing_m = scene.fidelity.spacing_m;
  models_.resize(scene.parts.size());
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    PartModel model = models_[i] ? *models_[i] : PartModel{};  // mesh and surface are the same for every row
    model.map = maps_[{i, voxel_m}];
    model.shell = shells_[{i, spacing_m}];
    scene.parts[i].is_cropped = false;
    scene.parts[i].model = std::make_shared<const PartModel>(std::move(model));
  }
  const double begun_s = wallSeconds();
  buildModels(scene, options);
  const double wall_s = wallSeconds() - begun_s;
  for (std::size_t i = 0; i < scene.parts.size(); ++i) {
    models_[i] = scene.parts[i].model;
    maps_[{i, voxel_m}] = models_[i]->map;
    shells_[{i, spacing_m}] = models_[i]->shell;
  }
  return wall_s;
}

/// Copies the result of a run to its row.
void addRun(const AssembleResult& result, TradeRow& row) {
  row.has_run = true;
  row.run.completed = result.completed;
  row.run.to_hand_J = result.energy.to_hand_J;
  row.run.injected_J = result.energy.injected_J;
  row.run.contacts_left_out = result.contacts_left_out;
  row.run.build_wall_s = result.build_wall_s;
  row.run.physics = result.physics;
  row.run.haptic = result.haptic;
  for (const StepResult& step : result.steps) {
    row.run.deepest_m = std::max(row.run.deepest_m, step.max_penetration_m);
    row.run.final_error_m = std::max(row.run.final_error_m, step.final_error_m);
    row.run.peak_force_N = std::max(row.run.peak_force_N, step.peak_force_N);
  }
  if (!result.trace.empty()) row.run.p_W_end = result.trace.back().X_WP.p;
  row.run.bytes = result.modelled.bytes;
}

/// Thrown to end a row early; results measured so far are kept.
struct TradeStopped {};

/// One call of trade().
class Trade {
 public:
  Trade(const Scene& scene, const TradeOptions& options)
      : options_(options),
        scene_(options.is_thorough ? scene : excerptOf(scene, 0)),
        plan_(options, scene_.fidelity) {
    const SceneStep& first = scene.steps.front();
    result_.scene = scene.name;
    result_.excerpt = options.is_thorough ? "all " + counted(scene.steps.size(), "step")
                                          : "step 1 of " + std::to_string(scene.steps.size()) + ": " +
                                                scene.parts[first.part].part.name;
    result_.fixed = fixedChoices();
  }

  TradeResult run();

 private:
  using Clock = std::chrono::steady_clock;

  [[nodiscard]] bool isStopped() const { return options_.stop != nullptr && options_.stop->load(); }
  void report(const std::string& doing) const {
    if (options_.progress)
      options_.progress(doing, options_.is_thorough
                                   ? static_cast<double>(done_) / static_cast<double>(planned_)
                                   : plan_.spent_s() / options_.seconds);
  }

  void measure(const TradeSetting& setting);
  /// Measures the finest reference for which there is time.
  void measureReference();
  /// Fills a row. A failure with the scene's own setting ends the trade; with other settings the rest of the
  /// row stays empty.
  void fillOrLeaveOut(TradeRow& row);
  void fill(TradeRow& row);
  /// A progress callback that throws TradeStopped when the trade is stopped.
  [[nodiscard]] Progress untilStopped() const {
    return [this](std::string_view, double) {
      if (isStopped()) throw TradeStopped();
    };
  }
  void probe(const Scene& scene, TradeRow& row);
  /// Copies the probe of an earlier row with the same models; false if there is none.
  bool copyProbe(TradeRow& row) const;
  void runProcedure(const Scene& scene, TradeRow& row);
  /// Computes the exact values at contact poses of the scene's own run, and probes its models there.
  void beginProbe(const Scene& scene, const AssembleResult& result, TradeRow& row);
  void compareWithReference();

  const TradeOptions& options_;
  Scene scene_;
  TradePlan plan_;
  ModelStore store_;
  std::optional<Probe> probe_;
  std::size_t done_ = 0, planned_ = 1;
  TradeResult result_;
};

TradeResult Trade::run() {
  const std::vector<TradeSetting> design = tradeDesign(scene_);
  planned_ = design.size() + 2;
  measure(design.front());
  for (std::size_t i = 1; i < design.size() && !isStopped(); ++i) {
    measure(design[i]);
    // The reference is measured early, since all other runs are compared with it.
    if (i == 1) measureReference();
  }
  const TradeSetting suggestion = tradeSuggestion(scene_, result_.rows);
  plan_.releaseReserve();
  if (!suggestion.name.empty() && !isStopped()) measure(suggestion);
  if (isStopped())
    result_.left_out.emplace_back("stopped: the settings that are not listed were not measured");
  compareWithReference();
  markFront(result_.rows);
  return std::move(result_);
}

void Trade::measure(const TradeSetting& setting) {
  ++done_;
  const bool is_own = setting.knob == TradeKnob::Own;
  if (!is_own && !plan_.hasTimeForModels(setting)) {
    result_.left_out.push_back(setting.name + ": not measured");
    return;
  }
  report(setting.name);
  TradeRow row;
  row.setting = setting;
  fillOrLeaveOut(row);
  if (row.bytes > 0) result_.rows.push_back(std::move(row));
}

void Trade::measureReference() {
  for (const TradeSetting& reference : tradeReferences(scene_)) {
    if (isStopped()) return;
    if (!plan_.hasTimeForModels(reference)) continue;
    measure(reference);
    if (result_.rows.back().setting.name == reference.name && result_.rows.back().has_run) return;
  }
  if (!isStopped())
    result_.left_out.emplace_back(
        "reference: there was no time for even the coarsest reference run, so runs are not compared with a "
        "reference");
}

void Trade::fillOrLeaveOut(TradeRow& row) {
  const bool is_own = row.setting.knob == TradeKnob::Own;
  const auto leaveOut = [&](const std::string& why) {
    result_.left_out.push_back(row.setting.name + ": " + why);
  };
  try {
    fill(row);
  } catch (const TradeStopped&) {
    leaveOut("stopped");
  } catch (const std::bad_alloc&) {
    if (is_own) throw;
    leaveOut("needed more memory than is available");
  } catch (const std::exception& error) {
    if (is_own) throw;
    leaveOut(error.what());
  }
}

void Trade::fill(TradeRow& row) {
  const TradeSetting& setting = row.setting;
  const bool is_own = setting.knob == TradeKnob::Own;
  Scene scene = scene_;
  scene.fidelity = setting.fidelity;
  ModelOptions quiet = options_;
  quiet.progress = untilStopped();
  if (!is_own) quiet.warn = nullptr;  // each warning is given once
  row.models_wall_s = store_.fill(scene, quiet);
  const ModelledCost cost = modelledCost(scene);
  row.points = cost.points;
  row.bytes = cost.bytes;
  if (is_own) plan_.ownModelsTook(row.models_wall_s);
  if (!is_own && !copyProbe(row)) probe(scene, row);
  if (is_own || plan_.hasTimeForRun(setting))
    runProcedure(scene, row);
  else
    result_.left_out.push_back(setting.name + ": its models were measured, but the procedure was not run");
}

bool Trade::copyProbe(TradeRow& row) const {
  const Fidelity& f = row.setting.fidelity;
  for (const TradeRow& other : result_.rows) {
    const Fidelity& g = other.setting.fidelity;
    if (!other.has_probe || f.voxel_m != g.voxel_m || f.spacing_m != g.spacing_m || f.sides != g.sides ||
        f.gradient != g.gradient)
      continue;
    row.probe = other.probe;
    row.points_read = other.points_read;
    row.query = other.query;
    row.all_points = other.all_points;
    row.has_probe = true;
    return true;
  }
  return false;
}

void Trade::probe(const Scene& scene, TradeRow& row) {
  if (!probe_) return;
  const auto begun = Clock::now();
  probe_->measure(scene, row);
  if (row.setting.knob == TradeKnob::Own)
    plan_.ownProbeTook(std::chrono::duration<double>(Clock::now() - begun).count());
}

void Trade::runProcedure(const Scene& scene, TradeRow& row) {
  const auto begun = Clock::now();
  const bool is_own = row.setting.knob == TradeKnob::Own;
  std::atomic<bool> is_late = false;
  AssembleOptions options;
  options.warn = is_own ? options_.warn : nullptr;
  if (!options_.is_thorough) options.judge_stride = kJudgeStride;
  options.stop = &is_late;
  options.progress = [&](std::string_view, double) {
    report(row.setting.name);
    if (isStopped() || (!is_own && plan_.left_s() < 0)) is_late = true;
  };
  Scene used = scene;  // a copy, since a run crops the models, and later rows need the whole models
  const AssembleResult result = assemble(used, options);
  row.run.wall_s = std::chrono::duration<double>(Clock::now() - begun).count();
  if (is_late) {
    result_.left_out.push_back(
        row.setting.name + (isStopped() ? ": its run was stopped" : ": its run was cut at the time limit"));
    return;
  }
  plan_.runTook(row.setting, row.run.wall_s);
  addRun(result, row);
  if (is_own) beginProbe(scene, result, row);
}

void Trade::beginProbe(const Scene& scene, const AssembleResult& result, TradeRow& row) {
  report("exact surfaces");
  const auto poses = probePoses(scene, result, options_.is_thorough ? kThoroughPoses : kPoses);
  if (poses.empty()) {
    result_.left_out.emplace_back(
        "errors of the models: the run had no contact, so there is no pose to probe");
    return;
  }
  probe_.emplace(scene, poses, untilStopped());
  result_.poses = probe_->poses();
  result_.poses_inside = probe_->posesInside();
  result_.reference_spacing_m = probe_->spacing_m();
  probe(scene, row);
}

void Trade::compareWithReference() {
  const auto reference = std::find_if(result_.rows.begin(), result_.rows.end(), [](const TradeRow& row) {
    return row.setting.knob == TradeKnob::Reference && row.has_run;
  });
  if (reference == result_.rows.end()) return;
  for (TradeRow& row : result_.rows) {
    if (!row.has_run) continue;
    row.has_reference = true;
    row.off.final_m = (row.run.p_W_end - reference->run.p_W_end).norm();
    row.off.peak_force_N = std::abs(row.run.peak_force_N - reference->run.peak_force_N);
    row.off.to_hand_J = std::abs(row.run.to_hand_J - reference->run.to_hand_J);
  }
}

}  // namespace

TradeResult trade(const Scene& scene, const TradeOptions& options) {
  if (scene.steps.empty())
    throw LoadError(
        scene.file, "",
        "has no [[step]], so there is nothing to run; add one, or use `vps query` for two meshes");
  return Trade(scene, options).run();
}

}  // namespace vps::scenes
