// SPDX-License-Identifier: BSD-3-Clause
#include "vps_scenes/fits/fasteners.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdio>
#include <limits>
#include <map>
#include <numbers>

#include "fits/fastener_shape.h"
#include "fits/iso_sizes.h"
#include "surface/placed_surface.h"
#include "vps/stoppable.h"

namespace vps::scenes {

namespace {

constexpr double kPi = std::numbers::pi;
constexpr double kSameRadius = 2e-3;  // relative difference of equal radii
constexpr double kSameLine = 1e-2;  // greatest distance between axes of one turned part, divided by a radius
// assumed: proportions that catalogues of standard parts keep (ISO 4014, 4032, 7089, 2338, DIN 471)
constexpr double kMostHead = 4, kLeastHead = 1.2;  // a head's radius divided by its shank's radius
constexpr double kMostHeadHeight = 3;              // a head's height divided by the shank's radius
constexpr double kMostNut = 2.5, kLeastNut = 1.3;  // radius of a nut's corners divided by its hole's radius
constexpr double kMostWasher = 4, kLeastWasher = 1.3;
constexpr double kFlat = 0.5;                          // a washer's height divided by its hole's radius
constexpr double kLeastPin = 1, kMostPin = 12;         // a pin's length divided by its diameter
constexpr double kLeastOpen = 0.55, kMostOpen = 0.97;  // share of a turn that a circlip covers

std::string millimetres(double m) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", 1e3 * m);
  return text;
}

/// A part in cylindrical coordinates around an axis.
class Turned {
 public:
  Turned(const PartSurface& surface, const FitFaces& faces, const Vec3& axis, const Vec3& p)
      : surface_(surface), faces_(faces), axis_(axis), p_(p), u_(axis.unitOrthogonal()), v_(axis.cross(u_)) {
    for (const Vec3& x : surface.mesh().vertices) {
      low_m_ = std::min(low_m_, along(x));
      high_m_ = std::max(high_m_, along(x));
      radius_m_ = std::max(radius_m_, radiusOf(x));
    }
  }

  [[nodiscard]] double along(const Vec3& x) const { return axis_.dot(x - p_); }
  [[nodiscard]] double radiusOf(const Vec3& x) const { return std::hypot(u_.dot(x - p_), v_.dot(x - p_)); }
  [[nodiscard]] double low_m() const { return low_m_; }
  [[nodiscard]] double high_m() const { return high_m_; }
  [[nodiscard]] double length_m() const { return high_m_ - low_m_; }
  [[nodiscard]] double radius_m() const { return radius_m_; }

  template <class Face>
  [[nodiscard]] bool isAround(const Face& face, double radius_m) const {
    const Vec3 off = face.p - p_;
    return std::abs(face.axis.dot(axis_)) > 0.999 &&
           (off - axis_.dot(off) * axis_).norm() < kSameLine * radius_m;
  }
  /// The ends of a face along the axis.
  template <class Face>
  [[nodiscard]] std::array<double, 2> rangeOf(const Face& face) const {
    const double sign = face.axis.dot(axis_) > 0 ? 1 : -1, at_m = axis_.dot(face.p - p_);
    const double a = at_m + sign * face.from_m, b = at_m + sign * face.to_m;
    return {std::min(a, b), std::max(a, b)};
  }

  /// The share of a turn around the axis that facets cover.
  [[nodiscard]] double turnOf(const std::vector<std::uint32_t>& facets) const {
    constexpr int kBins = 180;
    std::array<bool, kBins> is_covered{};
    for (const std::uint32_t i : facets) {
      const Triangle t = surface_.triangle(i);
      double least = 0, most = 0;  // angles relative to the first corner
      const double first = angleOf(t[0]);
      for (const Vec3& x : t) {
        const double turn = std::remainder(angleOf(x) - first, 2 * kPi);
        least = std::min(least, turn);
        most = std::max(most, turn);
      }
      const double bin = 2 * kPi / kBins;
      for (double a = first + least + 0.5 * bin; a < first + most + 0.5 * bin; a += bin) {
        const double turned = a - 2 * kPi * std::floor(a / (2 * kPi));
        is_covered[static_cast<std::size_t>(turned / bin) % kBins] = true;
      }
    }
    return static_cast<double>(std::ranges::count(is_covered, true)) / kBins;
  }

  /// Number of sides of a square or hexagon around the axis (0: the part is neither), and its width across
  /// flats.
  struct Sides {
    int count = 0;
    double across_m = 0;
  };
  [[nodiscard]] Sides sides() const {
    constexpr double kAcross = 0.02, kSameOffset = 0.01, kSameAngle = 0.02;
    std::vector<double> angles;
    double offset_m = 0;
    for (const FlatFace& flat : faces_.flat) {
      if (std::abs(flat.n.dot(axis_)) > kAcross) continue;
      const double off_m = flat.offset_m - flat.n.dot(p_);
      if (off_m < 0.5 * radius_m_ || (offset_m > 0 && std::abs(off_m - offset_m) > kSameOffset * offset_m))
        continue;
      offset_m = std::max(offset_m, off_m);
      const double angle = std::atan2(v_.dot(flat.n), u_.dot(flat.n));
      const bool is_new = std::ranges::none_of(angles, [&](double other) {
        return std::abs(std::remainder(angle - other, 2 * kPi)) < kSameAngle;
      });
      if (is_new) angles.push_back(angle);
    }
    const auto count = static_cast<int>(angles.size());
    if (count != 4 && count != 6) return {};
    // The corners of the polygon are the part's farthest points from the axis.
    if (std::abs(offset_m / std::cos(kPi / count) - radius_m_) >= 0.1 * radius_m_) return {};
    return {count, 2 * offset_m};
  }

  /// Whether a flat face lies along the axis between two positions along it: a side or a slot for a wrench or
  /// a key.
  [[nodiscard]] bool hasFlatAlong(double from_m, double to_m) const {
    constexpr double kAcross = 0.02;
    return std::ranges::any_of(faces_.flat, [&](const FlatFace& flat) {
      if (std::abs(flat.n.dot(axis_)) > kAcross || flat.facets.empty()) return false;
      const Triangle t = surface_.triangle(flat.facets.front());
      const double at_m = along((t[0] + t[1] + t[2]) / 3);
      return at_m >= from_m && at_m <= to_m;
    });
  }

  [[nodiscard]] double volume_m3() const { return std::abs(massProperties(surface_.mesh()).volume_m3); }

  /// Greatest distance from the axis of the vertices between two positions along the axis.
  [[nodiscard]] double greatestBeyond(double from_m, double to_m) const {
    double most_m = 0;
    for (const Vec3& x : surface_.mesh().vertices)
      if (along(x) >= from_m && along(x) <= to_m) most_m = std::max(most_m, radiusOf(x));
    return most_m;
  }

 private:
  [[nodiscard]] double angleOf(const Vec3& x) const { return std::atan2(v_.dot(x - p_), u_.dot(x - p_)); }

  const PartSurface& surface_;
  const FitFaces& faces_;
  Vec3 axis_, p_, u_, v_;
  double low_m_ = std::numeric_limits<double>::max(), high_m_ = std::numeric_limits<double>::lowest();
  double radius_m_ = 0;
};

bool isNear(double a, double b, double share) {
  return std::abs(a - b) <= share * std::max(std::abs(a), std::abs(b));
}

FastenerShape shapeOf(FastenerKind kind, const std::string& words, const Vec3& axis, const Vec3& p,
                      double radius_m, const std::array<double, 2>& range) {
  return {kind, words, axis, p, radius_m, range[0], range[1]};
}

/// Name of a thread or shank of this diameter: "M8", or the diameter in millimetres.
std::string sizeOf(double diameter_m) {
  const std::string name = metricSize(diameter_m);
  return name.empty() ? millimetres(diameter_m) + " mm" : name;
}

/// Name of the thread of a nut whose hole is drawn plain. A hole can be the major diameter of one thread and
/// the drill of the next one: 5 mm are M5 and M6. The width across flats then decides.
std::string sizeOfHole(double diameter_m, const Turned::Sides& sides) {
  if (sides.count == 6)
    if (const std::string name = metricNut(diameter_m, sides.across_m); !name.empty()) return name;
  const std::string name = metricHole(diameter_m);
  return name.empty() ? sizeOf(diameter_m) : name;
}

/// A screw or a headed pin: a shank with a head at one of its ends.
std::optional<FastenerShape> screwWith(const Turned& part, const Vec3& axis, const Vec3& p, double radius_m,
                                       const std::array<double, 2>& shank, const std::string& size,
                                       bool is_threaded) {
  const double slack_m = 0.05 * radius_m;
  const double above_m = part.high_m() - shank[1], below_m = shank[0] - part.low_m();
  const double over_m = part.greatestBeyond(shank[1] + slack_m, part.high_m()),
               under_m = part.greatestBeyond(part.low_m(), shank[0] - slack_m);
  const bool is_above = over_m > kLeastHead * radius_m, is_below = under_m > kLeastHead * radius_m;
  if (is_above == is_below || part.radius_m() > kMostHead * radius_m) return std::nullopt;
  const double height_m = is_above ? above_m : below_m;
  if (height_m > kMostHeadHeight * radius_m) return std::nullopt;
  const double length_m = part.length_m() - height_m;
  if (length_m < radius_m) return std::nullopt;
  const int sides = part.sides().count;
  const double head_from_m = is_above ? shank[1] : part.low_m(),
               head_to_m = is_above ? part.high_m() : shank[0];
  const bool has_drive = sides > 0 || part.hasFlatAlong(head_from_m - slack_m, head_to_m + slack_m);
  if (!is_threaded && !has_drive) {
    // Without thread and drive only the proportions of a headed pin are left. A stepped shaft or a probe has
    // them by chance, but seldom one metric size up to its end.
    constexpr double kWhole =
        0.8;  // share of the shank's length that has one diameter; the rest are chamfers
    const std::string metric = metricSize(2 * radius_m);
    if (metric.empty() || shank[1] - shank[0] < kWhole * length_m) return std::nullopt;
    const std::string words = "headed pin " + millimetres(2 * radius_m) + " x " + millimetres(length_m) +
                              " mm (if threaded, " + metric + ")";
    return shapeOf(FastenerKind::HeadedPin, words, axis, p, radius_m, shank);
  }
  const std::string head = sides == 6 ? ", hexagon head" : sides == 4 ? ", square head" : "";
  return shapeOf(FastenerKind::Screw, "screw " + size + " x " + millimetres(length_m) + head, axis, p,
                 radius_m, shank);
}

std::optional<FastenerShape> threaded(const PartSurface& surface, const FitFaces& faces,
                                      const ThreadFace& thread) {
  const Turned part(surface, faces, thread.axis, thread.p);
  const std::array<double, 2> range = part.rangeOf(thread);
  const MetricThread metric =
      thread.starts == 1 ? metricThread(2 * thread.greatest_m, thread.lead_m) : MetricThread();
  const std::string size = metric.name.empty() ? sizeOf(2 * thread.greatest_m) : metric.name;
  if (thread.is_inside) {
    const double corners = part.radius_m() / thread.greatest_m;
    if (corners > kMostNut || corners < 1.1 || part.length_m() > 4 * thread.greatest_m) return std::nullopt;
    return shapeOf(FastenerKind::Nut, "nut " + size, thread.axis, thread.p, thread.greatest_m, range);
  }
  if (part.radius_m() < 1.05 * thread.greatest_m)
    return shapeOf(FastenerKind::Stud, "stud " + size + " x " + millimetres(part.length_m()), thread.axis,
                   thread.p, thread.greatest_m, range);
  // A plain cylinder between the thread and the head belongs to the shank. The cylinder's radius is at most
  // that of a fit bolt.
  std::array<double, 2> shank = range;
  for (const RoundFace& round : faces.round)
    if (!round.is_bore && part.isAround(round, thread.greatest_m) &&
        round.radius_m < 1.1 * thread.greatest_m) {
      shank[0] = std::min(shank[0], part.rangeOf(round)[0]);
      shank[1] = std::max(shank[1], part.rangeOf(round)[1]);
    }
  return screwWith(part, thread.axis, thread.p, thread.greatest_m, shank, size, true);
}

/// A washer, nut or circlip: a ring or polygon around a hole that passes through the whole part.
std::optional<FastenerShape> holed(const Turned& part, const RoundFace& bore, const FitFaces& faces) {
  constexpr double kThrough = 0.6, kVolume = 0.1;
  const double r = bore.radius_m, R = part.radius_m(), h = part.length_m();
  const std::array<double, 2> range = part.rangeOf(bore);
  if (range[1] - range[0] < kThrough * h) return std::nullopt;
  const double turn = part.turnOf(bore.facets);
  const bool has_rim = std::ranges::any_of(faces.round, [&](const RoundFace& round) {
    return !round.is_bore && part.isAround(round, r) && isNear(round.radius_m, R, 0.02) &&
           part.rangeOf(round)[1] - part.rangeOf(round)[0] > kThrough * h;
  });
  const double ring_m3 = kPi * (R * R - r * r) * h;
  if (turn > kMostOpen) {
    if (has_rim && h < kFlat * r && R > kLeastWasher * r && R < kMostWasher * r &&
        isNear(part.volume_m3(), ring_m3, kVolume))
      return shapeOf(
          FastenerKind::Washer,
          "washer " + millimetres(2 * r) + " x " + millimetres(2 * R) + " x " + millimetres(h) + " mm",
          bore.axis, bore.p, r, range);
    const auto [sides, across_m] = part.sides();
    const bool is_standard = sides == 6 && !metricNut(2 * r, across_m).empty();  // M3 and less are wider
    if (sides == 0 || (R > kMostNut * r && !is_standard) || R < kLeastNut * r || h < kFlat * r || h > 4 * r)
      return std::nullopt;
    const double polygon_m2 = 0.5 * sides * R * R * std::sin(2 * kPi / sides);
    if (!isNear(part.volume_m3(), (polygon_m2 - kPi * r * r) * h, 2 * kVolume)) return std::nullopt;
    // The hole of a nut is drawn with the major or the minor diameter of its thread.
    return shapeOf(FastenerKind::Nut, "nut for " + sizeOfHole(2 * r, {sides, across_m}), bore.axis, bore.p, r,
                   range);
  }
  if (turn > kLeastOpen && has_rim && R - r < 0.4 * R && h < 0.4 * R &&
      isNear(part.volume_m3(), turn * ring_m3, 0.3))
    return shapeOf(
        FastenerKind::Circlip,
        "circlip " + millimetres(2 * r) + " x " + millimetres(2 * R) + " x " + millimetres(h) + " mm",
        bore.axis, bore.p, r, range);
  return std::nullopt;
}

/// A pin or an unthreaded screw: a plain cylinder without or with a head.
std::optional<FastenerShape> shanked(const Turned& part, const RoundFace& shank) {
  const double r = shank.radius_m, length_m = part.length_m();
  const std::array<double, 2> range = part.rangeOf(shank);
  if (part.turnOf(shank.facets) < kMostOpen) return std::nullopt;
  if (part.radius_m() < (1 + kSameRadius) * r) {
    const bool is_whole = isNear(part.volume_m3(), kPi * r * r * length_m, 0.05);
    if (!is_whole || length_m < kLeastPin * 2 * r || length_m > kMostPin * 2 * r) return std::nullopt;
    return shapeOf(FastenerKind::Pin, "pin " + millimetres(2 * r) + " x " + millimetres(length_m) + " mm",
                   shank.axis, shank.p, r, range);
  }
  return screwWith(part, shank.axis, shank.p, r, range, sizeOf(2 * r), false);
}

}  // namespace

std::optional<FastenerShape> fastenerShape(const PartSurface& surface, const FitFaces& faces) {
  if (!surface.solid().report().isClosed()) return std::nullopt;
  for (const ThreadFace& thread : faces.threads)
    if (std::optional<FastenerShape> found = threaded(surface, faces, thread)) return found;
  // The longest face comes first, so that a shank is tried before its head.
  std::vector<const RoundFace*> round;
  for (const RoundFace& face : faces.round) round.push_back(&face);
  std::ranges::stable_sort(round, [](const RoundFace* a, const RoundFace* b) {
    return a->to_m - a->from_m > b->to_m - b->from_m;
  });
  for (const RoundFace* face : round) {
    const Turned part(surface, faces, face->axis, face->p);
    // Only turned parts count: all round faces must have the same axis.
    const bool is_alone = std::ranges::all_of(
        faces.round, [&](const RoundFace& other) { return part.isAround(other, face->radius_m); });
    if (!is_alone) return std::nullopt;
    std::optional<FastenerShape> found = face->is_bore ? holed(part, *face, faces) : shanked(part, *face);
    if (found) return found;
  }
  return std::nullopt;
}

const char* toText(FastenerKind kind) {
  switch (kind) {
    case FastenerKind::Screw:
      return "screw";
    case FastenerKind::Stud:
      return "stud";
    case FastenerKind::Nut:
      return "nut";
    case FastenerKind::Washer:
      return "washer";
    case FastenerKind::Pin:
      return "pin";
    case FastenerKind::Key:
      return "key";
    case FastenerKind::Circlip:
      return "circlip";
    case FastenerKind::HeadedPin:
      return "headed pin";
  }
  return "";
}

std::vector<std::optional<FastenerShape>> fastenerShapes(const std::vector<PlacedSurface>& parts,
                                                         const Progress& progress) {
  std::map<const PartSurface*, std::size_t> number;  // index of each distinct surface
  std::vector<const PartSurface*> surfaces;
  for (const PlacedSurface& part : parts)
    if (number.try_emplace(part.surface.get(), surfaces.size()).second)
      surfaces.push_back(part.surface.get());
  std::vector<std::optional<FastenerShape>> shapes(surfaces.size()), out;
  forEachOnCores(surfaces.size(), progress, "finding fasteners",
                 [&](std::size_t i) { shapes[i] = fastenerShape(*surfaces[i], fitFaces(*surfaces[i])); });
  for (const PlacedSurface& part : parts) out.push_back(shapes[number.at(part.surface.get())]);
  return out;
}

std::vector<Fastener> findFasteners(const std::vector<DrawnPart>& parts, const Progress& progress) {
  const StoppableWork stoppable(progress, "preparing the parts");
  const std::vector<PlacedSurface> placed = placedSurfaces(parts, progress);
  const std::vector<std::optional<FastenerShape>> shapes = fastenerShapes(placed, progress);
  std::vector<Fastener> out;
  for (std::size_t i = 0; i < parts.size(); ++i)
    if (shapes[i]) out.push_back({parts[i].name, shapes[i]->kind, shapes[i]->words});
  return out;
}

}  // namespace vps::scenes
