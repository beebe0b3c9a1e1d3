// SPDX-License-Identifier: BSD-3-Clause
// The panels of the window, by Dear ImGui.
#include <imgui.h>

#include <algorithm>
#include <cstdio>
#include <span>
#include <vector>

#include "glfw/session.h"
#include "view/camera_motion.h"
#include "vps_device/device_kinds.h"
#include "vps_viewer/report/words.h"

namespace vps::viewer {
namespace {

constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoResize |
                                    ImGuiWindowFlags_NoCollapse | ImGuiWindowFlags_NoNav |
                                    ImGuiWindowFlags_NoSavedSettings;

void wrapped(const std::string& words) {
  ImGui::PushTextWrapPos(0);
  ImGui::TextUnformatted(words.c_str());
  ImGui::PopTextWrapPos();
}

void drawPart(Session& session) {
  if (!ImGui::CollapsingHeader("Part", ImGuiTreeNodeFlags_DefaultOpen)) return;
  if (!session.view.picked) {
    ImGui::TextDisabled("click on a part");
    return;
  }
  const std::size_t index = session.view.picked->part;
  const scenes::ScenePart& part = session.scene.parts[index];
  const Material& material = part.part.material;
  ImGui::TextUnformatted(part.part.name.c_str());
  ImGui::Text("%.0f kg/m³, friction %.3g", material.density_kg_m3, material.friction);
  ImGui::Text("stiffness %.3g N/m³, restitution %.3g", material.stiffness_N_per_m3, material.restitution);
  ImGui::Text("%zu triangles%s", part.part.mesh.triangles.size(), part.is_fixed ? ", fixed" : "");
  for (const scenes::BodySnapshot& body : session.shown.bodies) {
    if (body.part != index) continue;
    const Vec3 p_mm = 1e3 * body.X_WP.p;
    ImGui::Text("at %.3f, %.3f, %.3f mm", p_mm.x(), p_mm.y(), p_mm.z());
  }
  ImGui::TextDisabled("near this part, at the shown poses:");
  if (const std::optional<MeasuredGaps> measured = session.gaps->of(index))
    for (const std::string& line : gapLines(session.scene, *measured)) wrapped("  " + line);
  ImGui::TextDisabled("near this part, in the finished assembly:");
  for (const std::string& line : session.neighbours.of(part.part.name)) wrapped("  " + line);
}

void drawView(Session& session) {
  if (!ImGui::CollapsingHeader("View", ImGuiTreeNodeFlags_DefaultOpen)) return;
  ViewState& view = session.view;
  const auto press = [&](const char* label, Action action) {
    if (ImGui::SmallButton(label)) apply(action, view, session.shownLine(), session.box_W());
    ImGui::SameLine();
  };
  for (std::size_t i = 0; i < standardViews().size(); ++i)
    press(standardViews()[i].name.data(), static_cast<Action>(static_cast<std::size_t>(Action::View1) + i));
  ImGui::NewLine();
  ImGui::AlignTextToFramePadding();
  press("fit", Action::Fit);
  auto explode = static_cast<float>(view.explode);
  if (ImGui::SliderFloat("exploded", &explode, 0, 1.5f)) view.explode = explode;
  if (ImGui::IsItemDeactivatedAfterEdit()) view.wants_fit = true;
  bool has_cut = view.draw.cut.has_value();
  if (ImGui::Checkbox("section", &has_cut))
    apply(Action::Section, view, session.shownLine(), session.box_W());
  if (view.draw.cut) {
    ImGui::SameLine();
    press("other half", Action::FlipSection);
    ImGui::NewLine();
    ImGui::Checkbox("cuts the part in hand", &view.draw.cut->cuts_hand);
  }
  ImGui::Checkbox("target", &view.draw.show_target);
  ImGui::SameLine();
  ImGui::Checkbox("edges", &view.draw.show_edges);
  ImGui::SameLine();
  ImGui::Checkbox("floor", &view.draw.show_ground);
  ImGui::SameLine();
  if (ImGui::Checkbox("dark", &view.is_dark)) view.draw.is_dark = view.is_dark;
  if (!ImGui::BeginCombo("stereo", toText(view.stereo))) return;
  for (const StereoMode mode : stereoModes())
    if (ImGui::Selectable(toText(mode), view.stereo == mode)) view.stereo = mode;
  ImGui::EndCombo();
}

void drawSteps(Session& session) {
  if (!ImGui::CollapsingHeader("Steps", ImGuiTreeNodeFlags_DefaultOpen)) return;
  const Timeline& line = session.shownLine();
  const std::size_t now = line.chapterAt(session.view.time_s);
  for (std::size_t i = 0; i < line.chapters.size(); ++i) {
    const Chapter& chapter = line.chapters[i];
    const std::string label = chapter.name + (chapter.verdict.empty() ? "" : "  -  " + chapter.verdict) +
                              "##step" + std::to_string(i);
    if (ImGui::Selectable(label.c_str(), i == now) && !session.is_at_work)
      session.view.time_s = chapter.start_s;
    if (!chapter.reason.empty()) {
      ImGui::Indent();
      wrapped(chapter.reason);
      ImGui::Unindent();
    }
  }
}

void drawTicks(const char* name, const scenes::TickTimes& times) {
  if (times.count == 0) return;
  ImGui::Text("%s: %llu, p50 %.0f, p99 %.0f µs", name, static_cast<unsigned long long>(times.count),
              times.p50_us, times.p99_us);
  ImGui::Text("  longest %.0f µs, %llu missed", times.max_us, static_cast<unsigned long long>(times.missed));
}

/// Shows the least distance of the part in hand at the shown poses.
void drawClearance(const Session& session) {
  const scenes::BodySnapshot* body = partInHand(session.shown);
  if (body == nullptr) return;
  const std::optional<MeasuredGaps> measured = session.gaps->of(body->part);
  if (!measured) return;
  wrapped("part in hand: " + gapLines(session.scene, *measured).front());
}

/// Lists the kinds of device that can move the part in hand.
void drawHands(Session& session) {
  if (!ImGui::BeginCombo("hand", session.hand.c_str())) return;
  for (const device::DeviceKind& kind : device::deviceKinds()) {
    const bool is_chosen = session.hand == kind.name;
    if (ImGui::Selectable(kind.name.data(), is_chosen)) session.hand = kind.name;
    if (ImGui::IsItemHovered()) {
      const std::string missing = kind.missing();
      const std::string words = std::string(kind.description) +
                                (missing.empty() ? "" : "\n" + missing + "; " + std::string(kind.remedy));
      ImGui::SetTooltip("%s", words.c_str());
    }
  }
  ImGui::EndCombo();
}

/// Draws the buttons for undo, redo and free assembly.
void drawWork(Session& session) {
  ViewState& view = session.view;
  if (session.is_at_work) {
    view.wants_undo |= ImGui::Button("undo");
    ImGui::SameLine();
    view.wants_redo |= ImGui::Button("redo");
    ImGui::SameLine();
  }
  view.wants_free |= ImGui::Button(session.work.isFree() ? "end free assembly" : "free assembly");
  if (!session.work.isFree()) return;
  view.wants_take |= ImGui::Button(session.run ? "put the part down" : "take the picked part");
}

void drawGuidance(ViewState& view) {
  ImGui::Checkbox("axis snap", &view.snaps);
  ImGui::SameLine();
  ImGui::Checkbox("planned path", &view.shows_path);
}

void drawRun(Session& session) {
  if (!ImGui::CollapsingHeader("Run", ImGuiTreeNodeFlags_DefaultOpen)) return;
  if (session.is_recording) {
    ImGui::TextDisabled("a recording");
    drawClearance(session);
    return;
  }
  if (session.followed != nullptr) {
    const FollowedSession& followed = *session.followed;
    wrapped(followed.verdict()
                ? words(*followed.verdict())
                : "session '" + session.options.session + "'" + (followed.isOver() ? ": it has ended" : ""));
    if (session.shown.has_hand) ImGui::Text("force on the hand %.1f N", session.shown.F_hand_W.f.norm());
    ImGui::Text("%zu other people point at a place", followed.pointers().size());
    session.view.wants_point |=
        ImGui::Button(followed.pointing() ? "move or remove the mark" : "mark the picked place for all");
    return;
  }
  drawGuidance(session.view);
  drawWork(session);
  if (!session.run) {
    drawHands(session);
    session.view.wants_run |= ImGui::Button(session.is_at_work ? "back to the tour" : "run the procedure");
    return;
  }
  const LiveStatus& status = session.status;
  if (status.is_over) {
    wrapped(status.error.empty() ? verdictLine(status.result) : "the run failed: " + status.error);
    drawTicks("haptic ticks", status.result.haptic);
    drawTicks("physics steps", status.result.physics);
    if (status.error.empty()) ImGui::Text("energy injected %.3g mJ", 1e3 * status.result.energy.injected_J);
    session.view.wants_run |= ImGui::Button("back to the tour");
    return;
  }
  wrapped(status.doing);
  ImGui::ProgressBar(static_cast<float>(status.share), ImVec2(-1, 0));
  ImGui::Text("%.3f s, %zu physics steps", status.time_s, status.steps);
  if (session.figures.physics_steps > 0)
    for (const std::string& line :
         figureLines(session.figures, session.figures_before, session.figures_s - session.figures_before_s))
      wrapped(line);
  drawClearance(session);
  if (session.run->isByClock()) {
    ImGui::TextDisabled("in real time, with %s", session.run_hand.c_str());
  } else {
    if (ImGui::Button(session.run->isPaused() ? "go on" : "pause"))
      session.run->pause(!session.run->isPaused());
    if (session.run->isPaused()) {
      ImGui::SameLine();
      session.view.wants_one_step |= ImGui::Button("one step");
    }
    ImGui::SameLine();
  }
  session.view.wants_run |= ImGui::Button("stop");
}

void drawMessages(const Session& session) {
  if (!ImGui::CollapsingHeader("Messages", ImGuiTreeNodeFlags_DefaultOpen)) return;
  constexpr int kShown = 8;
  int left = kShown;
  for (const std::string& words : session.messages)
    if (left-- > 0) wrapped(words);
  const Timeline& line = session.shownLine();
  for (auto message = line.messages.rbegin(); message != line.messages.rend() && left > 0; ++message) {
    if (message->time_s > session.view.time_s) continue;
    char time[32];
    std::snprintf(time, sizeof time, "%.3f s  ", message->time_s);
    wrapped(time + message->words);
    --left;
  }
}

void drawTimeAxis(Session& session, const PictureSize& size, float side_px, float height_px) {
  ImGui::SetNextWindowPos({0, static_cast<float>(size.height) - height_px});
  ImGui::SetNextWindowSize({static_cast<float>(size.width) - side_px, height_px});
  ImGui::Begin("time", nullptr, kFixed | ImGuiWindowFlags_NoTitleBar | ImGuiWindowFlags_NoScrollbar);
  ViewState& view = session.view;
  const Timeline& line = session.shownLine();
  if (session.is_at_work) {
    const bool is_over = session.run && session.status.is_over;
    const bool is_live = session.run || session.followed != nullptr;
    ImGui::Text("%s %.3f s", is_over ? "ended at" : (is_live ? "running live:" : "at rest after"),
                view.time_s);
  } else {
    if (ImGui::Button(view.is_playing ? "pause" : "play"))
      apply(Action::PlayPause, view, line, session.box_W());
    ImGui::SameLine();
    ImGui::SetNextItemWidth(ImGui::GetContentRegionAvail().x * 0.7f);
    auto now = static_cast<float>(view.time_s);
    if (ImGui::SliderFloat("##time", &now, 0, static_cast<float>(line.end_s), "%.3f s")) view.time_s = now;
    ImGui::SameLine();
    ImGui::SetNextItemWidth(-1);
    auto speed = static_cast<float>(view.speed);
    if (ImGui::SliderFloat("##speed", &speed, 0.05f, 4, "%.2f x", ImGuiSliderFlags_Logarithmic))
      view.speed = speed;
  }
  char drawn[160] = "no picture yet";
  if (!session.drawn_by.empty())
    std::snprintf(drawn, sizeof drawn, "%s, last picture %.0f ms%s", session.drawn_by.c_str(),
                  session.picture_ms, session.is_draft ? " (draft)" : "");
  ImGui::TextDisabled("%s   %s   ? lists the keys", line.chapters[line.chapterAt(view.time_s)].name.c_str(),
                      drawn);
  ImGui::End();
}

void drawBinding(const KeyBinding* binding) {
  ImGui::TableNextColumn();
  if (binding != nullptr) ImGui::TextUnformatted(binding->key);
  ImGui::TableNextColumn();
  if (binding != nullptr) ImGui::TextUnformatted(binding->does);
}

void drawKeys(ViewState& view, const PictureSize& size) {
  if (!view.shows_help) return;
  ImGui::SetNextWindowPos({0.5f * static_cast<float>(size.width), 0.5f * static_cast<float>(size.height)},
                          ImGuiCond_Appearing, {0.5f, 0.5f});
  ImGui::Begin("Keys and mouse", &view.shows_help,
               ImGuiWindowFlags_AlwaysAutoResize | ImGuiWindowFlags_NoSavedSettings);
  std::vector<const KeyBinding*> all;
  for (const std::span<const KeyBinding> list : {keyBindings(), mouseBindings()})
    for (const KeyBinding& binding : list) all.push_back(&binding);
  const std::size_t rows = (all.size() + 1) / 2;  // one column would be higher than a window of 720 pixels
  if (ImGui::BeginTable("keys", 4, ImGuiTableFlags_SizingFixedFit)) {
    for (std::size_t i = 0; i < rows; ++i) {
      drawBinding(all[i]);
      drawBinding(i + rows < all.size() ? all[i + rows] : nullptr);
    }
    ImGui::EndTable();
  }
  ImGui::End();
}

}  // namespace

void drawFailure(const Session& session) {
  if (session.picture_failure.empty()) return;
  const float width_px = 0.8f * static_cast<float>(session.area.size.width);
  ImGui::SetNextWindowPos({session.area.x + 0.5f * static_cast<float>(session.area.size.width),
                           session.area.y + 0.5f * static_cast<float>(session.area.size.height)},
                          ImGuiCond_Always, {0.5f, 0.5f});
  ImGui::SetNextWindowSize({width_px, 0});
  ImGui::Begin("no picture", nullptr, kFixed | ImGuiWindowFlags_NoTitleBar);
  wrapped(session.picture_failure);
  const bool runs = session.run && !session.status.is_over;
  ImGui::TextDisabled("%s", runs ? "The run continues. Drawing is tried again." : "Drawing is tried again.");
  ImGui::End();
}

void drawPanels(Session& session, const GlfwWindow& window) {
  const PictureSize size = window.size();
  if (session.view.is_full_screen) {
    session.area = {0, 0, size};
    return drawKeys(session.view, size);
  }
  const float scale = window.scale();
  const float side_px = std::min(330 * scale, 0.45f * static_cast<float>(size.width));
  const float axis_px = std::min(64 * scale, 0.3f * static_cast<float>(size.height));
  ImGui::SetNextWindowPos({static_cast<float>(size.width) - side_px, 0});
  ImGui::SetNextWindowSize({side_px, static_cast<float>(size.height)});
  ImGui::Begin("side", nullptr, kFixed | ImGuiWindowFlags_NoTitleBar);
  ImGui::TextUnformatted(session.scene.name.c_str());
  drawView(session);
  drawPart(session);
  drawSteps(session);
  drawRun(session);
  const Timeline& line = session.shownLine();
  if (!line.curves.empty() && ImGui::CollapsingHeader("Plots", ImGuiTreeNodeFlags_DefaultOpen))
    drawPlots(line, &session.view.time_s, scale, !session.is_at_work);
  drawMessages(session);
  ImGui::End();
  drawTimeAxis(session, size, side_px, axis_px);
  drawKeys(session.view, size);
  session.area = {0, 0, {size.width - static_cast<int>(side_px), size.height - static_cast<int>(axis_px)}};
}

}  // namespace vps::viewer
