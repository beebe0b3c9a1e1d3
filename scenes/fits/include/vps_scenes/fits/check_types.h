// SPDX-License-Identifier: BSD-3-Clause
// What a check measures and reports: parts as drawn, pairs, fits, play, sections, and the verdict.
#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <limits>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "vps/mesh.h"
#include "vps/pose.h"
#include "vps_scenes/export.h"
#include "vps_scenes/fits/check_wishes.h"

namespace vps::scenes {

/// The answer to "do the parts go together?".
enum class Verdict {
  Fits,      ///< the part reaches its place by contact within tolerance, overlaps nothing and stays there
  Blocked,   ///< proven by geometry; of a check: for all places within 0.5 mm of the drawn ones, no others
  NotShown,  ///< the simulated hand failed, and nothing proves that the step is impossible
};

/// The verdict's name in JSON: "fits", "blocked" or "not_shown".
inline const char* toText(Verdict verdict) {
  constexpr std::array kWords{"fits", "blocked", "not_shown"};
  return kWords[static_cast<std::size_t>(verdict)];
}

/// A part at its designed pose in the assembly.
struct DrawnPart {
  std::string name;
  Mesh mesh;
  Pose X_WP;
  /// Greatest distance of the mesh from the curved faces that it approximates, where the file states this
  /// distance. If the member is empty, the distance is estimated from the angles between facets.
  std::optional<double> chord_m;
  bool allow_overlap = false;  ///< overlaps of this part are reported but do not count as clashes
  double press_fit_m = 0;      ///< this member and the next three: see ScenePart
  double youngs_modulus_Pa = 210e9;
  double poissons_ratio = 0.3;
  double friction = 0.15;
  double rounding_m = 0;  ///< see ImportedPart; added to the part's error
  bool is_fixed = false;  ///< the search for places without overlap does not move this part
  /// Names of the assemblies and of the product that contain the part, see ImportedPart::within.
  std::vector<std::string> within = {};
  /// Moves that X_WP contains already, see moveParts().
  std::vector<PartMove> moves = {};
};

/// A plane in which the assembly is drawn cut: all points p with n_W . p = offset_m.
struct SectionPlane {
  std::string name;  ///< as written by the user: "z=12mm"
  Vec3 n_W = Vec3::UnitZ();
  double offset_m = 0;
};

/// What a check measures.
struct CheckSettings {
  double near_m = 1e-3;  ///< pairs with a greater clearance are not reported
  bool has_fits = true;
  bool has_play = true;  ///< measures play, and the directions in which each part can be removed
  bool has_sections = false;
  std::vector<SectionPlane> planes = {};  ///< planes of CheckResult::plane_sections
  bool has_maps = false;
  bool has_places = false;  ///< searches for places without overlap (CheckedPlaces); needs has_fits
  /// Names of the parts to check. Pairs that contain no named part, and the play of parts that are not named,
  /// are left out. If the list is empty, all parts are checked.
  std::vector<std::string> only_parts = {};
  [[nodiscard]] bool isAsked(const std::string& part) const;
  /// Pairs to measure; if the list is empty, all pairs are measured. Pairs that match `ignored` are left out
  /// in any case. A pair that is left out may overlap: it is no clash, and the search for places without
  /// overlap does not look at it. Play is not measured for a part that is in a pair that is left out.
  std::vector<PairPattern> between = {}, ignored = {};
  /// Rules that the result judges. Pairs of a rule with a clearance are measured up to that clearance.
  std::vector<CheckRule> rules = {};
  /// How overlaps are judged that a drawing may have on purpose: threads, seals, inserts.
  OverlapWishes overlaps = {};
};

/// An overlap that exceeds its error by no more than this depth counts as contact and not as a clash, for
/// `vps check` and for every verdict. Depths in a run are measured with this precision
/// (OverlapJudge::kCertain_m), so parts that overlap by less cannot be distinguished from parts that touch. A
/// smaller depth has no meaning in a drawing either: a steel part of 50 mm grows by about 0.5 um per kelvin.
inline constexpr double kContactDepth_m = 0.5e-6;

enum class PairState {
  Apart,     ///< the clearance is more than its error
  Contact,   ///< the surfaces meet to within the error and kContactDepth_m; coincident faces are contact
  PressFit,  ///< the parts overlap by more than contact allows, and by no more than a declared press fit
  Thread,    ///< a screw in its nut or hole: drawn as cylinders, out of phase, or self-tapping
  Seal,      ///< a seal that is drawn undeformed in its groove
  Insert,    ///< an insert that is pressed or melted into a smaller hole
  Clash,     ///< the parts overlap by more than contact allows, and nothing declared or known explains it
};
VPS_SCENES_API const char* toText(PairState state);

/// Two parts that are near each other. All errors include the distance of the meshes from the faces that they
/// approximate.
struct CheckedPair {
  std::string a, b;
  PairState state = PairState::Apart;
  double clearance_m = 0;  ///< least distance of the surfaces; 0 where the meshes overlap
  /// The greatest distance from a point of one part's surface inside the other part to the other part's
  /// surface, or the diameter of the greatest ball that lies in both parts, whichever is greater. This depth
  /// is a property of the solids: it does not depend on how their faces are divided into facets.
  double interference_depth_m = 0;
  double interference_volume_m3 = 0;
  double volume_error_m3 = 0;
  /// Bound of the error of clearance and depth; larger where a search ended at its limit of work.
  double error_m = 0;
  Vec3 at_W = Vec3::Zero();  ///< the deepest point of the overlap, or the middle between the nearest points
  bool is_allowed = false;   ///< the scene allows the overlap
  /// True where the check cannot decide whether the parts overlap, because one of them has a surface without
  /// an inside (CheckedPart::no_inside). `state` of an uncertain pair describes the surfaces alone.
  bool is_uncertain = false;
  double press_fit_m = 0;  ///< declared interference, the greater of both parts'; 0: none
  /// What was assumed about a thread, a seal or an insert; or, of a clash, why it is none. Empty: nothing is
  /// known.
  std::string explanation = {};
  std::string fastener = {};  ///< the screw, seal or insert of the pair; empty for other pairs
  std::string nominal = {};   ///< nominal size of a thread, "M8"; else empty
  double squash = 0;          ///< of a seal: its greatest squash, divided by the width of its section
  [[nodiscard]] bool isClash() const { return state == PairState::Clash && !is_allowed; }
  /// Whether the overlap is a thread, a seal or an insert.
  [[nodiscard]] bool isKnown() const { return state > PairState::PressFit && state < PairState::Clash; }
  /// Whether the depth of the overlap exceeds its error by more than kContactDepth_m.
  [[nodiscard]] bool isBeyondContact() const { return interference_depth_m > error_m + kContactDepth_m; }
};

/// The state in words: "apart", "clash (allowed)", or "not known" for an uncertain pair.
VPS_SCENES_API std::string stateWords(const CheckedPair& pair);

/// The volume that two parts share, in cubic millimetres: "7.9840"; "<= 12.3" if the error is as large as the
/// volume; "not known" if no piece of the volume's surface was found.
VPS_SCENES_API std::string volumeWords(const CheckedPair& pair);

enum class FitKind {
  Shaft,   ///< a round shaft in a bore
  Key,     ///< two parallel faces of one part between two parallel faces of another part
  Thread,  ///< a screw in a nut
};
VPS_SCENES_API const char* toText(FitKind kind);

/// Pressure and force of pressing a shaft into a smaller bore, by Lame's formula for elastic thick-walled
/// cylinders. The hub is the largest ring around the bore that consists of material only, over the middle
/// half of the fit's length. The shaft's hole is the largest hole around the shaft's axis over the middle
/// half.
struct CheckedPress {
  double hub_m = 0, hole_m = 0;  ///< diameters: outside of the hub, hole of the shaft
  double pressure_Pa = 0;        ///< pressure in the joint, for the interference as drawn
  double hub_stress_Pa = 0;      ///< greatest equivalent stress (Tresca), at the bore
  double force_N = 0;            ///< force to press the shaft in or out along the fit's whole length
  double declared_force_N = 0;   ///< force to press the shaft in for the declared interference
  double shaft_modulus_Pa = 0, hub_modulus_Pa = 0;  ///< Young's moduli that were used
  double friction = 0;  ///< friction coefficient that was used: geometric mean of both parts' coefficients
};

/// A part that fits into another one. Fits are found from facets that lie on a common cylinder, plane or
/// helix.
struct CheckedFit {
  FitKind kind = FitKind::Shaft;
  std::string shaft, bore;         ///< the inner and the outer part
  Vec3 axis_W = Vec3::UnitZ();     ///< axis of the cylinders, or normal of a key's faces; unit
  Vec3 at_W = Vec3::Zero();        ///< point on the axis, in the middle of the fit's length
  double shaft_m = 0, bore_m = 0;  ///< diameters (major diameters of a thread) or widths, as drawn
  /// Direction of the length: a shaft's axis, or the longer side of the area in which a key's faces cover
  /// each other; unit.
  Vec3 along_W = Vec3::UnitZ();
  double length_m = 0;               ///< length of the fit along `along_W`
  double diametral_clearance_m = 0;  ///< negative: interference
  double offset_m = 0;               ///< greatest distance between the two axes along the fit; 0 for a key
  double error_m = 0;                ///< bound of the clearance's error
  std::string iso_286;               ///< "H7/g6" if both sizes lie in the zones of a common fit, else empty
  /// Lead of a thread: axial advance in one turn, negative for a left-hand thread. Where `thread` names a
  /// standard thread, the lead is the standard's.
  double lead_m = 0;
  int starts = 0;
  std::string thread;                 ///< name in ISO 262, "M16" or "M16x1.5-LH"; else empty
  std::optional<CheckedPress> press;  ///< set for a shaft with interference, if a press fit is declared
  /// Whether the axes of shaft and bore are farther apart than the clearance lets them be, by more than the
  /// contact of faces: the parts overlap as drawn, although their sizes fit.
  [[nodiscard]] bool isEccentric() const {
    const double room_m = 0.5 * std::max(0.0, diametral_clearance_m);
    return kind == FitKind::Shaft && offset_m > room_m + error_m + kContactDepth_m;
  }
};

/// Describes the fit as a standard does: "H7/g6" or "M16". Where a shaft is drawn beside its bore
/// (isEccentric()), the text says so: "sizes of H7/g6, but axes 70.00 um apart". A thread that is in no
/// standard is described by its lead, as "lead 3.2 mm, 2 starts, left-hand"; for any other fit that is in no
/// standard the text is empty.
VPS_SCENES_API std::string standardOf(const CheckedFit& fit);

/// How far a part can move along an axis or turn about it before it touches another part; the other parts do
/// not move. Infinite where nothing stops the part, or where it can turn by a whole turn.
struct Play {
  std::array<double, 6> m = {};    ///< +x, -x, +y, -y, +z, -z
  std::array<double, 6> rad = {};  ///< rotations about the axes of `m`, in the order of `m`
  /// Bounds of the errors of `m` and `rad`: the error of the surfaces' distance, divided by the rate at which
  /// the surfaces approach each other at the contact that stops the part first. Infinite where the search
  /// ended before a contact was found (the play is then greater than stated), or where no bound is known. 0
  /// where nothing stops the part.
  std::array<double, 6> error_m = {}, error_rad = {};
};

/// A screw motion by which a part can be removed from the other parts.
struct ScrewWay {
  Vec3 axis_W = Vec3::UnitZ();  ///< unit direction in which the part leaves
  Vec3 at_W = Vec3::Zero();     ///< point on the axis
  double lead_m = 0;            ///< axial advance in one turn; negative: left-hand
};

/// What the check found about one part.
struct CheckedPart {
  std::string name;
  std::size_t triangles = 0;
  double chord_error_m = 0;  ///< greatest distance of the mesh from its curved faces
  std::string mesh_faults;   ///< in words; empty for a closed mesh
  std::string no_inside;     ///< why the surface, or a part of it, encloses no volume; else empty
  /// How faces of few flat sides that may be meant as round were read, in words; empty: there are none, or
  /// the file states which of its faces are curved.
  std::string read_as;
  /// Empty without has_play, and for a part that clashes, is pressed in, or is in a pair that was left out.
  std::optional<Play> play;
  Mat3 play_axes_W = Mat3::Identity();  ///< columns: the axes of `play`
  Vec3 play_center_W = Vec3::Zero();    ///< point through which the axes of rotation pass
  /// Bounds of the play's error for contacts at right angles to the motion; Play::error_m bounds the error
  /// for other contacts.
  double play_error_m = 0, play_error_rad = 0;
  std::vector<Vec3> ways_out_W;  ///< unit directions in which the part can be removed in a straight line
  std::vector<ScrewWay> screw_ways_out;  ///< screw motions by which the part can be removed
  /// False where a shaft and its bore have the same size, where facets cross as drawn by no more than the
  /// error of the pair, or where the search ended before it found a contact. The mesh can then stop a motion
  /// that the true faces allow, or allow a longer motion than the true faces; `play` may deviate by more than
  /// its error, and ways out may be missing.
  bool is_play_certain = true;
  std::vector<std::string> within;  ///< as in DrawnPart
};

/// The outlines of a part in a plane, each a closed chain of points (right, up) [m]. A point is inside the
/// part where an odd number of chains encloses it.
struct SectionOutline {
  std::string part;
  std::vector<std::vector<std::array<double, 2>>> chains;
  bool is_open = false;  ///< the surface has holes in the plane; a straight line closes each open chain
};

/// A cut through the parts by a plane, at a fit or a clash.
struct CheckedSection {
  std::size_t of = 0;        ///< index of the fit or of the pair that the section shows
  bool is_fit = false;       ///< true: `of` counts fits; false: `of` counts pairs
  Vec3 at_W = Vec3::Zero();  ///< the point (0, 0) of the picture
  Vec3 right_W = Vec3::UnitX(), up_W = Vec3::UnitY();
  double half_m = 0;                  ///< half the width and height of the picture
  std::array<double, 2> near_m{};     ///< middle of the detail view, in the picture
  double near_half_m = 0;             ///< half the width and height of the detail view
  std::vector<SectionOutline> parts;  ///< parts in the picture; the two parts of the fit or pair come first
};

/// A cut through all parts by a plane that the user chose. The picture shows all outlines. It is seen from
/// the side of +z or +x, or of -y for a plane across y, so that x points to the right wherever the plane
/// contains it.
struct PlaneSection {
  SectionPlane plane;
  Vec3 at_W = Vec3::Zero();  ///< the point (0, 0) of the picture, the middle of the outlines
  Vec3 right_W = Vec3::UnitX(), up_W = Vec3::UnitY();
  std::array<double, 2> half_m{};     ///< half the width and the height of the outlines
  std::vector<SectionOutline> parts;  ///< the parts that the plane cuts, in their order
};

/// The distance of a part's surface from the other parts, at the vertices of a mesh that is refined near
/// other parts.
struct ClearanceMap {
  std::string part;
  Mesh mesh_W;
  /// For each vertex: distance to the nearest other part, at most near_m; negative inside the nearest part,
  /// but 0 where the depth counts as contact (CheckedPair::isBeyondContact()).
  std::vector<double> distance_m;
};

/// A part that is moved from the place where it is drawn.
struct MovedPart {
  std::string name;
  Vec3 by_W = Vec3::Zero();    ///< displacement of the middle of the part's box [m]
  Vec3 turn_W = Vec3::Zero();  ///< rotation vector about the middle of the box [rad]
  double most_m = 0;           ///< greatest displacement of a corner of the part's box
  /// Limit of most_m: placement by eye (0.5 mm). In a fit, the part may move less far: across the axis of a
  /// shaft, or across the faces of a key, by the tolerance of that fit.
  double allowed_m = 0;
  Pose X_WP;  ///< pose after the motion
};

/// Parts that overlaps connect, and whether they can be freed from each other.
struct CheckedGroup {
  std::vector<std::string> parts;   ///< sorted
  Verdict verdict = Verdict::Fits;  ///< as CheckedPlaces::verdict, for these parts
  std::string reason;               ///< reason for a verdict other than Fits, in words
};

/// Whether the parts can be assembled. The question differs from whether the parts overlap as drawn: a part
/// that is drawn 50 um inside its neighbour is free if its play lets it move away by 50 um. The search looks
/// for places at which no parts overlap and no part is farther from its drawn place than its tolerance: 0.5
/// mm, and in each fit the tolerance that the fit gives (fits/fits.h), in the directions which it guides.
struct CheckedPlaces {
  /// Fits: no parts overlap as drawn, or no parts overlap, by exact measure, after the parts of `moved` are
  /// moved. Blocked: it is proven that no places without overlap exist within 0.5 mm of the drawn places,
  /// whatever the fits. NotShown: neither places without overlap nor a proof were found.
  Verdict verdict = Verdict::Fits;
  std::vector<MovedPart> moved;  ///< the parts that were moved; filled also where other overlaps remain
  std::string reason;            ///< reason for a verdict other than Fits, in words
  /// Every part that clashes as drawn is in one group at least. Once a group is proven blocked, the remaining
  /// groups are only asked for the proofs that take no search.
  std::vector<CheckedGroup> groups;
};

/// The result of a check.
struct CheckResult {
  std::string assembly;
  std::string title;  ///< heading of a page: the assembly's name without folders; empty: `assembly`
  std::vector<CheckedPair> pairs;  ///< sorted: clashes first, deep overlaps first, small clearances first
  std::vector<CheckedFit> fits;
  std::vector<CheckedPart> parts;
  /// Names of parts that are near no other part, so that nothing shows whether they fit. Empty if the
  /// assembly has one part only.
  std::vector<std::string> alone;
  CheckedPlaces places;  ///< NotShown if parts clash and places were not searched for
  /// With has_sections: one section for each fit and each overlap, up to 60.
  std::vector<CheckedSection> sections;
  std::vector<PlaneSection> plane_sections;  ///< one for each of CheckSettings::planes
  double near_m = 0;                         ///< as in CheckSettings
  /// The patterns of CheckSettings.
  std::vector<PairPattern> between, ignored;
  /// Pairs that `between` and `ignored` left out, of those whose boxes are at most near_m apart.
  std::vector<LeftOutPair> left_out;
  std::vector<RuleOutcome> rules;      ///< the broken ones first, then those that are not decided
  std::vector<RuleCount> rule_counts;  ///< one for each of CheckSettings::rules
  std::vector<PartMove> moves;         ///< moves that moveParts() made before the check
  /// With has_maps: one map for each part that is near another one, up to 24.
  std::vector<ClearanceMap> maps;
  double prepare_wall_s = 0, pairs_wall_s = 0, fits_wall_s = 0, pictures_wall_s = 0, play_wall_s = 0,
         places_wall_s = 0;
  [[nodiscard]] std::size_t clashes() const;
  /// Whether the verdict is about some of the pairs only.
  [[nodiscard]] bool isAboutChosenPairs() const { return !between.empty() || !left_out.empty(); }
  /// Whether pairs were ignored and none was measured, so that the check says nothing.
  [[nodiscard]] bool isAllIgnored() const;
  /// Number of pairs for which the check cannot decide whether the parts overlap.
  [[nodiscard]] std::size_t uncertain() const;
  /// The deepest overlap that is not allowed; null if there is none.
  [[nodiscard]] const CheckedPair* deepestClash() const;
  /// The answer to "do the parts go together?": the verdict of `places`, or NotShown where overlaps are
  /// uncertain, parts are near no other part, or all pairs are ignored. The rules do not count.
  [[nodiscard]] Verdict verdict() const;
};

/// Clips a closed chain of points to a square: returns the part of the chain that lies within half_m of the
/// middle along both axes. O(n). Source: Sutherland and Hodgman 1974.
inline std::vector<std::array<double, 2>> clippedToSquare(std::vector<std::array<double, 2>> chain,
                                                          const std::array<double, 2>& middle_m,
                                                          double half_m) {
  for (const std::size_t axis : {0U, 1U})
    for (const double sign : {1.0, -1.0}) {
      std::vector<std::array<double, 2>> kept;
      for (std::size_t k = 0; k < chain.size(); ++k) {
        const auto &a = chain[k], &b = chain[(k + 1) % chain.size()];
        const double in_a = half_m - sign * (a[axis] - middle_m[axis]),
                     in_b = half_m - sign * (b[axis] - middle_m[axis]);
        if (in_a >= 0) kept.push_back(a);
        if ((in_a >= 0) == (in_b >= 0)) continue;
        const double share = in_a / (in_a - in_b);
        kept.push_back({a[0] + share * (b[0] - a[0]), a[1] + share * (b[1] - a[1])});
      }
      chain = std::move(kept);
    }
  return chain;
}

}  // namespace vps::scenes
