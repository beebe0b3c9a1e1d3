// SPDX-License-Identifier: BSD-3-Clause
// What a check measures and reports: parts as drawn, pairs, fits, play, sections, and the verdict.
#pragma once

#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "vps/mesh.h"
#include "vps/pose.h"
#include "vps_scenes/export.h"
#include "vps_scenes/fits/verdict.h"

namespace vps::scenes {

/// A part where it belongs in the assembly.
struct DrawnPart {
  std::string name;
  Mesh mesh;
  Pose X_WP;
  /// Greatest distance of the mesh from the curved faces that it stands for, where the file format says it;
  /// empty: it is estimated from the angles between facets.
  std::optional<double> chord_m;
  bool allow_overlap = false;  ///< its overlap is reported and is no clash
  double press_fit_m = 0;      ///< see ScenePart, as are those that follow
  double youngs_modulus_Pa = 210e9;
  double poissons_ratio = 0.3;
  double friction = 0.15;
  double rounding_m = 0;  ///< see ImportedPart; counts as error of the part
  bool is_fixed = false;  ///< it is not moved to clear an overlap
};

struct CheckSettings {
  double near_m = 1e-3;  ///< pairs with more clearance are not reported
  bool has_fits = true;
  bool has_play = true;  ///< with the ways out
  bool has_sections = false;
  bool has_maps = false;
  bool has_places = false;  ///< looks for places without overlap (CheckedPlaces); needs the fits
  /// Names of parts: pairs with none of them, and the play of others, are left out. Empty: all.
  std::vector<std::string> only_parts = {};
  [[nodiscard]] bool isAsked(const std::string& part) const;
};

/// An overlap of no more than this beyond its error is contact and no clash, for `vps check` and for every
/// verdict. It is what the depths of a run are measured to (OverlapJudge::kCertain_m): parts that are drawn
/// less deep in each other cannot be told from parts that touch. A drawing means no less either: parts of
/// 50 mm in steel are longer by as much at each degree.
inline constexpr double kContactDepth_m = 0.5e-6;

enum class PairState {
  Apart,     ///< the clearance is more than its error
  Contact,   ///< the surfaces meet to within the error and kContactDepth_m; coincident faces are contact
  PressFit,  ///< the parts overlap by more than contact does, and by no more than a declared press fit
  Clash,     ///< the parts overlap by more than contact does, and by more than is declared
};
VPS_SCENES_API const char* toText(PairState state);

/// Two parts that are near each other. All errors include the distance of the meshes from the faces that
/// they stand for.
struct CheckedPair {
  std::string a, b;
  PairState state = PairState::Apart;
  double clearance_m = 0;  ///< least distance of the surfaces; 0 where the meshes overlap
  /// The greatest distance from a point of one part's surface inside the other part to the other's surface,
  /// or the diameter of the greatest ball in both parts if that is more. Of the solids: it does not depend
  /// on how faces are divided.
  double interference_depth_m = 0;
  double interference_volume_m3 = 0;
  double volume_error_m3 = 0;
  double error_m = 0;        ///< of clearance and depth, with what a search at its limit left open
  Vec3 at_W = Vec3::Zero();  ///< of the deepest overlap, or between the nearest points
  bool is_allowed = false;   ///< an overlap that the scene allows
  /// It cannot be told whether they overlap: a surface without an inside is there, see
  /// CheckedPart::no_inside. `state` is then that of the surfaces alone.
  bool is_uncertain = false;
  double press_fit_m = 0;  ///< declared interference, the greater of both parts'; 0: none
  [[nodiscard]] bool isClash() const { return state == PairState::Clash && !is_allowed; }
  /// Whether the overlap is more than contact is.
  [[nodiscard]] bool isBeyondContact() const { return interference_depth_m > error_m + kContactDepth_m; }
};

enum class FitKind {
  Shaft,   ///< a round shaft in a bore
  Key,     ///< two parallel faces between two others
  Thread,  ///< a screw in a nut
};
VPS_SCENES_API const char* toText(FitKind kind);

/// What it takes to press a shaft into a bore that is smaller, by Lame's formula for elastic thick-walled
/// cylinders: the hub is the largest ring around the bore that has only material in it, over the middle
/// half of the fit, and the shaft has the largest hole that is around its axis there.
struct CheckedPress {
  double hub_m = 0, hole_m = 0;  ///< diameters: outside of the hub, hole of the shaft
  double pressure_Pa = 0;        ///< in the joint, for the interference as drawn
  double hub_stress_Pa = 0;      ///< greatest equivalent stress (Tresca), at the bore
  double force_N = 0;            ///< to press the shaft along the fit's whole length, or out again
  double declared_force_N = 0;   ///< the same for the declared interference
  double shaft_modulus_Pa = 0, hub_modulus_Pa = 0;  ///< Young's moduli that were used
  double friction = 0;                              ///< that was used: geometric mean of both parts'
};

/// A part that fits into another: found from facets that lie on a common cylinder, plane or helix.
struct CheckedFit {
  FitKind kind = FitKind::Shaft;
  std::string shaft, bore;           ///< the inner and the outer part
  Vec3 axis_W = Vec3::UnitZ();       ///< of the cylinders; of a key across its faces. Unit
  Vec3 at_W = Vec3::Zero();          ///< on the axis, in the middle of the length
  double shaft_m = 0, bore_m = 0;    ///< diameters (of a thread the major ones), or widths, as drawn
  Vec3 along_W = Vec3::UnitZ();      ///< of a shaft the axis, of a key the overlap's longer side. Unit
  double length_m = 0;               ///< over which both are found, in this direction
  double diametral_clearance_m = 0;  ///< negative: interference
  double offset_m = 0;               ///< greatest distance of the axes over the length; 0 for a key
  double error_m = 0;                ///< of the clearance
  std::string iso_286;               ///< "H7/g6" if both sizes lie in the zones of a common fit, else empty
  /// Of a thread: its way in one turn, negative if left-hand; as the standard has it where `thread` names
  /// one.
  double lead_m = 0;
  int starts = 0;
  std::string thread;                 ///< "M16", "M16x1.5-LH" of ISO 262; else empty
  std::optional<CheckedPress> press;  ///< of a shaft with interference, if a press fit is declared
};

/// The fit in words of a standard: "H7/g6", "M16", or "lead 3.2 mm, 2 starts, left-hand" for a thread that
/// is in none; empty for other fits that are in none.
VPS_SCENES_API std::string standardOf(const CheckedFit& fit);

/// How far a part moves along or turns about an axis before it touches, the other parts held. Infinite
/// where it moves away, or turns a whole turn.
struct Play {
  std::array<double, 6> m = {};    ///< +x, -x, +y, -y, +z, -z
  std::array<double, 6> rad = {};  ///< about the same axes
  /// Errors of each, at the contact that stops it first: those of the surfaces' distance, divided by the
  /// rate at which the surfaces come nearer where they touch. Infinite: the search ended before the play
  /// did, which is more, or no bound is known. 0 where it is free.
  std::array<double, 6> error_m = {}, error_rad = {};
};

/// A way in which a part is screwed out of the others.
struct ScrewWay {
  Vec3 axis_W = Vec3::UnitZ();  ///< unit; the part leaves in this direction
  Vec3 at_W = Vec3::Zero();     ///< on the axis
  double lead_m = 0;            ///< the way in one turn; negative: left-hand
};

struct CheckedPart {
  std::string name;
  std::size_t triangles = 0;
  double chord_error_m = 0;                     ///< greatest distance of the mesh from its curved faces
  std::string mesh_faults;                      ///< in words; empty for a closed mesh
  std::string no_inside;                        ///< why it has no inside, or parts of it; empty: it has one
  std::optional<Play> play;                     ///< none for a part that clashes, and if not asked for
  Mat3 play_axes_W = Mat3::Identity();          ///< columns: the axes of `play`
  Vec3 play_center_W = Vec3::Zero();            ///< through which the axes of rotation go
  double play_error_m = 0, play_error_rad = 0;  ///< where faces stop it squarely; else see Play::error_m
  std::vector<Vec3> ways_out_W;  ///< unit directions in which it leaves the others on a straight line
  std::vector<ScrewWay> screw_ways_out;
  /// False: a shaft and its bore have the same size, or facets cross as drawn by no more than the error of
  /// the pair, or the search ended before the play did. The mesh can then stop a motion that the faces
  /// allow, or allow it for as much longer as facets cross, so `play` can be off by its error and more in
  /// truth, and ways out may be missing.
  bool is_play_certain = true;
};

/// The outlines of a part in a plane, each a closed chain of points (right, up) [m]. The inside is where an
/// odd number of chains is around a point.
struct SectionOutline {
  std::string part;
  std::vector<std::vector<std::array<double, 2>>> chains;
  bool is_open = false;  ///< the surface has holes there; their chains are closed by a straight line
};

/// A cut through the parts by a plane, at a fit or a clash.
struct CheckedSection {
  std::size_t of = 0;        ///< index of the fit, or of the pair
  bool is_fit = false;       ///< else a pair
  Vec3 at_W = Vec3::Zero();  ///< the point (0, 0) of the picture
  Vec3 right_W = Vec3::UnitX(), up_W = Vec3::UnitY();
  double half_m = 0;                  ///< the picture shows this far from the middle to each side
  std::array<double, 2> near_m{};     ///< the place to look at closely, in the picture
  double near_half_m = 0;             ///< and how far around it
  std::vector<SectionOutline> parts;  ///< those whose outlines are in the picture; the two concerned first
};

/// The distance of a part's surface from the other parts, at the corners of facets that are divided where
/// others are near.
struct ClearanceMap {
  std::string part;
  Mesh mesh_W;
  std::vector<double>
      distance_m;  ///< by vertex: to the nearest other part, at most near_m; negative inside it
};

/// A part beside the place where it is drawn.
struct MovedPart {
  std::string name;
  Vec3 by_W = Vec3::Zero();    ///< of the middle of its box [m]
  Vec3 turn_W = Vec3::Zero();  ///< about that point, as rotation vector [rad]
  double most_m = 0;           ///< how far the corner of its box that goes farthest goes
  double allowed_m = 0;        ///< the most it may: by its tightest fit, or by sight where it has none
  Pose X_WP;                   ///< where it stands then
};

/// Whether the parts can be assembled, which is another question than whether they overlap as drawn: what
/// is drawn 50 um into its neighbour is free where it moves by as much within its play. Looked for are
/// places where no parts overlap, with each part no farther from where it is drawn than its tolerance there
/// (core/fit_tolerance.h).
struct CheckedPlaces {
  /// Fits: nothing overlaps as drawn, or nothing does once the parts of `moved` are moved, by exact
  /// measure. Blocked: proven that there are none within 0.5 mm, whatever the fits. NotShown: neither of
  /// these.
  Verdict verdict = Verdict::Fits;
  std::vector<MovedPart> moved;  ///< few of them, by little; also where other overlaps remain
  std::string reason;            ///< in words: of a verdict other than Fits
};

struct CheckResult {
  std::string assembly;
  std::vector<CheckedPair> pairs;  ///< clashes first, the deepest first; then by clearance
  std::vector<CheckedFit> fits;
  std::vector<CheckedPart> parts;
  /// Parts that are nowhere near another one: nothing shows whether they fit. None of a single part.
  std::vector<std::string> alone;
  CheckedPlaces places;                  ///< NotShown where it was not asked for and parts clash
  std::vector<CheckedSection> sections;  ///< if asked for: of each fit and of each overlap
  double near_m = 0;                     ///< as the settings say
  std::vector<ClearanceMap> maps;        ///< if asked for: of the parts that are near others
  double prepare_wall_s = 0, pairs_wall_s = 0, fits_wall_s = 0, pictures_wall_s = 0, play_wall_s = 0,
         places_wall_s = 0;
  [[nodiscard]] std::size_t clashes() const;
  /// Pairs of which it cannot be told whether they overlap.
  [[nodiscard]] std::size_t uncertain() const;
  /// The deepest overlap that is not allowed; null if there is none.
  [[nodiscard]] const CheckedPair* deepestClash() const;
  /// The answer to "do the parts go together?": that of `places`, and NotShown where overlaps are uncertain
  /// or parts stand alone.
  [[nodiscard]] Verdict verdict() const;
};

}  // namespace vps::scenes
