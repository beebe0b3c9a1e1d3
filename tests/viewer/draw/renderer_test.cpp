// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/draw/renderer.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <optional>

#include "mesh/shading_mesh.h"

namespace vps::viewer {
namespace {

std::array<int, 3> pixel(const Image& image, double x, double y) {
  const std::uint8_t* p = image.at(static_cast<int>(x), static_cast<int>(y));
  return {p[0], p[1], p[2]};
}

scenes::BodySnapshot mounted(std::size_t part, const Vec3& p_W) {
  return {part, Pose::translation(p_W), scenes::BodyRole::Mounted};
}

/// Options that draw surfaces only, so that no lines, shadows or text cover the measured pixels.
DrawOptions plain() {
  DrawOptions options;
  options.width = 320;
  options.height = 240;
  options.supersampling = 1;
  options.show_edges = options.show_ground = options.show_legend = false;
  return options;
}

Camera fromAbove() {
  Camera camera;
  camera.eye_W = Vec3(0, 0, 0.5);
  camera.up_W = Vec3::UnitY();
  return camera;
}

TEST(RendererTest, ARedBoxIsRedInTheMiddleAndAsLargeAsItsProjection) {
  const Mesh box = makeBox(Vec3(0.08, 0.05, 0.02));
  Renderer renderer({{&box, {0.8f, 0.05f, 0.05f}}});
  const Camera camera = fromAbove();
  scenes::Snapshot snapshot;
  const Image empty = renderer.render(snapshot, camera, plain());
  snapshot.bodies = {mounted(0, Vec3::Zero())};
  const Image image = renderer.render(snapshot, camera, plain());

  const auto [r, g, b] = pixel(image, 160, 120);
  EXPECT_GT(r, 150);
  EXPECT_LT(g, r / 2);
  EXPECT_LT(b, r / 2);

  int left = 320, right = -1, top = 240, bottom = -1;
  for (int y = 0; y < 240; ++y)
    for (int x = 0; x < 320; ++x)
      if (pixel(image, x, y) != pixel(empty, x, y)) {
        left = std::min(left, x);
        right = std::max(right, x);
        top = std::min(top, y);
        bottom = std::max(bottom, y);
      }
  // Seen from above, the upper face is the outline. A pixel belongs to the face if any of its samples does,
  // so sizes agree within 1.
  const auto [x0, y0] = camera.project(Vec3(-0.04, 0.025, 0.01), 320, 240);
  const auto [x1, y1] = camera.project(Vec3(0.04, -0.025, 0.01), 320, 240);
  EXPECT_NEAR(left, x0, 1);
  EXPECT_NEAR(right + 1, x1, 1);
  EXPECT_NEAR(top, y0, 1);
  EXPECT_NEAR(bottom + 1, y1, 1);
  // Check of the formula: at distance 1 the 240 px of the picture are 2 tan(fov / 2) high.
  EXPECT_NEAR(x1 - x0, 0.08 / 0.49 * 240 / (2 * std::tan(0.25)), 1e-9);
}

TEST(RendererTest, TheSameInputGivesTheSameBitsFromTwoRenderers) {
  const Mesh tube = makeTube(0.03, 0.02, 0.04, 48);
  scenes::Snapshot snapshot;
  snapshot.bodies = {mounted(0, Vec3::Zero())};
  snapshot.contacts = {{Vec3(0.03, 0, 0), Vec3::UnitX(), 5e-6}};
  DrawOptions options;
  options.width = 320;
  options.height = 240;
  options.title = "twice";
  const RenderScene scene = {{&tube, {0.5f, 0.5f, 0.5f}}};
  const Camera camera = frameScene(bounds(tube), Vec3(1, -1, 1));
  Renderer a(scene), b(scene);
  const Image first = a.render(snapshot, camera, options);
  EXPECT_EQ(first.rgb, a.render(snapshot, camera, options).rgb);
  EXPECT_EQ(first.rgb, b.render(snapshot, camera, options).rgb);
}

TEST(RendererTest, TheTargetIsHiddenBehindPartsAndTintsWhatIsBehindIt) {
  const Mesh plate = makeBox(Vec3(0.1, 0.1, 0.002));
  Renderer renderer({{&plate, {0.6f, 0.5f, 0.1f}}, {&plate, {0.5f, 0.5f, 0.5f}}});
  const auto renderWithTarget = [&](std::optional<double> z) {
    scenes::Snapshot snapshot;
    snapshot.bodies = {mounted(0, Vec3::Zero())};
    snapshot.has_target = z.has_value();
    snapshot.target_part = 1;
    snapshot.X_WP_target = Pose::translation(Vec3(0, 0, z.value_or(0)));
    return pixel(renderer.render(snapshot, fromAbove(), plain()), 160, 120);
  };
  const auto without = renderWithTarget({}), before = renderWithTarget(0.05),
             behind = renderWithTarget(-0.05);
  // Behind the plate the target is hidden; the light may change by rounding, because the shadow map covers
  // more. In front of the plate, the plate's yellow becomes bluer, but not as blue as the target.
  for (int k = 0; k < 3; ++k) EXPECT_NEAR(behind[k], without[k], 3) << k;
  EXPECT_GT(before[2], without[2] + 15);
  EXPECT_GT(before[0], 60);
}

TEST(RendererTest, ASectionShowsHatchedCutFacesAndASmoothBore) {
  const Mesh tube = makeTube(0.03, 0.015, 0.06, 64);
  Renderer renderer({{&tube, {0.7f, 0.1f, 0.1f}}});
  scenes::Snapshot snapshot;
  snapshot.bodies = {mounted(0, Vec3::Zero())};
  Camera camera;
  camera.eye_W = Vec3(0, -0.2, 0);
  DrawOptions options = plain();
  options.width = 640;
  options.height = 480;
  const Image whole = renderer.render(snapshot, camera, options);
  options.cut = CutPlane{Vec3::Zero(), -Vec3::UnitY()};
  const Image cut = renderer.render(snapshot, camera, options);
  options.cut->n_W = Vec3::UnitY();  // the section keeps the half on the side of the eye, so the front half
                                     // of the tube looks the same
  const Image from_behind = renderer.render(snapshot, camera, options);

  // Contrast along 24 pixels, which is more than two hatch lines. Only a hatched face has such contrast;
  // mantle and bore are straight along z and change little.
  const auto contrast = [&](const Image& image, double x_m) {
    int least = 255, greatest = 0;
    const auto [x, y] = camera.project(Vec3(x_m, 0, 0), 640, 480);
    for (int dy = -12; dy < 12; ++dy) {
      least = std::min(least, pixel(image, x, y + dy)[0]);
      greatest = std::max(greatest, pixel(image, x, y + dy)[0]);
    }
    return greatest - least;
  };
  for (const double wall_m : {-0.0225, 0.0225}) {
    EXPECT_GT(contrast(cut, wall_m), 30);
    EXPECT_LT(contrast(whole, wall_m), 15);
    EXPECT_LT(contrast(from_behind, wall_m), 15);
  }
  EXPECT_LT(contrast(cut, 0), 15);
}

TEST(RendererTest, ASectionCutsThePartInHandOnlyWithCutsHand) {
  const Mesh bar = makeBox(Vec3(0.02, 0.1, 0.02));
  Renderer renderer({{&bar, {0.5f, 0.5f, 0.5f}}});
  scenes::Snapshot snapshot;
  snapshot.bodies = {{0, Pose(), scenes::BodyRole::InHand}};
  const Camera camera = fromAbove();
  DrawOptions options = plain();
  options.cut = CutPlane{Vec3::Zero(), Vec3::UnitY()};
  const auto [x, y] = camera.project(Vec3(0, 0.03, 0), 320, 240);
  const auto blueness = [x = x, y = y](const Image& image) {
    return pixel(image, x, y)[2] - pixel(image, x, y)[0];
  };
  EXPECT_GT(blueness(renderer.render(snapshot, camera, options)), 60);
  options.cut->cuts_hand = true;
  EXPECT_LT(blueness(renderer.render(snapshot, camera, options)), 20);
}

TEST(RendererTest, ADarkBackgroundChangesNoPixelOfAPart) {
  const Mesh box = makeBox(Vec3(0.1, 0.1, 0.1));
  Renderer renderer({{&box}});
  scenes::Snapshot shot;
  shot.bodies = {{0, Pose(), scenes::BodyRole::Mounted}};
  DrawOptions options;
  options.width = 320;
  options.height = 240;
  options.show_ground = options.show_legend = false;
  const Camera camera = frameScene({Vec3(-0.05, -0.05, -0.05), Vec3(0.05, 0.05, 0.05)}, Vec3(0, -1, 0));
  const Image light = renderer.render(shot, camera, options);
  options.is_dark = true;
  const Image dark = renderer.render(shot, camera, options);
  // The part's face covers at least the middle half of the picture.
  for (const int x : {120, 160, 200})
    for (int k = 0; k < 3; ++k) EXPECT_EQ(dark.at(x, 120)[k], light.at(x, 120)[k]);
  for (const int y : {2, 120, 237})
    for (int k = 0; k < 3; ++k) {
      EXPECT_GT(light.at(3, y)[k], 200);
      EXPECT_LT(dark.at(3, y)[k], 80);  // dark enough for the white text of the panels
    }
}

TEST(RendererTest, AnEmptySnapshotIsABackgroundAndInvalidBodiesAreLeftOut) {
  const Mesh box = makeBox(Vec3(0.1, 0.1, 0.1));
  Renderer renderer({{&box, {0.5f, 0.5f, 0.5f}}});
  scenes::Snapshot snapshot;
  const Image empty = renderer.render(snapshot, fromAbove(), plain());
  snapshot.bodies = {mounted(0, Vec3(NAN, 0, 0)), mounted(7, Vec3::Zero())};
  EXPECT_EQ(renderer.render(snapshot, fromAbove(), plain()).rgb, empty.rgb);
}

/// A peg in hand before a tube on a plate, with its target, contacts and a force.
struct PegBeforeTube {
  Mesh plate = makeBox(Vec3(0.2, 0.2, 0.02)), tube = makeTube(0.03, 0.02, 0.04, 48),
       peg = makeBox(Vec3(0.02, 0.02, 0.06));
  RenderScene drawn = {{&plate}, {&tube}, {&peg, {0.8f, 0.1f, 0.1f}}};
  scenes::Snapshot snapshot;
  Camera camera = frameScene({Vec3(-0.1, -0.1, -0.03), Vec3(0.1, 0.1, 0.1)}, Vec3(1, -1, 1));
  DrawOptions options = plain();

  PegBeforeTube() {
    snapshot.bodies = {mounted(0, Vec3(0, 0, -0.03)),
                       mounted(1, Vec3::Zero()),
                       {2, Pose::translation(Vec3(0.005, 0, 0.05)), scenes::BodyRole::InHand}};
    snapshot.has_target = snapshot.has_hand = true;
    snapshot.target_part = 2;
    snapshot.X_WP_target = Pose::translation(Vec3(0, 0, 0.02));
    snapshot.X_W_Proxy = snapshot.bodies[2].X_WP;
    options.is_draft = options.show_edges = true;
  }
  void move(const Vec3& by_W, double force_N) {
    snapshot.bodies[2].X_WP.p += by_W;
    snapshot.X_W_Proxy.p += by_W;
    snapshot.F_hand_W.f = Vec3(0, 0, force_N);
    snapshot.contacts.clear();
    if (force_N > 0)
      snapshot.contacts.push_back({snapshot.bodies[2].X_WP * Vec3(0, 0, -0.03), Vec3::UnitZ(), 1e-5});
  }
  /// Draws the same picture with a renderer that has drawn nothing before.
  [[nodiscard]] Image afresh() const { return Renderer(drawn).render(snapshot, camera, options); }
};

class Drafts : public testing::TestWithParam<bool> {};
INSTANTIATE_TEST_SUITE_P(WithAndWithoutASection, Drafts, testing::Bool());

TEST_P(Drafts, WhereAPartMovedHaveTheBitsOfDraftsThatAreDrawnAsAWhole) {
  PegBeforeTube shown;
  if (GetParam()) shown.options.cut = CutPlane{Vec3::Zero(), Vec3(1, -1, 0).normalized(), false};
  shown.options.show_flash = true;
  Renderer renderer(shown.drawn);
  Image last = renderer.render(shown.snapshot, shown.camera, shown.options);
  EXPECT_TRUE(renderer.drewWhole());
  EXPECT_EQ(last.rgb, shown.afresh().rgb);
  // The peg moves, touches, slides on, and loses contact.
  for (const double force_N : {0.0, 5.0, 8.0, 0.0}) {
    shown.move(Vec3(8e-3, -4e-3, -3e-3), force_N);  // farther than the margin around moved parts
    const Image image = renderer.render(shown.snapshot, shown.camera, shown.options);
    EXPECT_FALSE(renderer.drewWhole());
    EXPECT_NE(image.rgb, last.rgb);
    EXPECT_EQ(image.rgb, shown.afresh().rgb) << "at " << force_N << " N";
    last = image;
  }
  EXPECT_EQ(renderer.render(shown.snapshot, shown.camera, shown.options).rgb, last.rgb) << "nothing moved";
}

TEST(DraftsOfAnotherView, AreDrawnAsAWhole) {
  PegBeforeTube shown;
  Renderer renderer(shown.drawn);
  static_cast<void>(renderer.render(shown.snapshot, shown.camera, shown.options));
  shown.camera.eye_W.x() += 1e-3;
  const Image turned = renderer.render(shown.snapshot, shown.camera, shown.options);
  EXPECT_TRUE(renderer.drewWhole());
  EXPECT_EQ(turned.rgb, shown.afresh().rgb);
  shown.options.is_draft = false;
  static_cast<void>(renderer.render(shown.snapshot, shown.camera, shown.options));
  EXPECT_TRUE(renderer.drewWhole());
  shown.options.is_draft = true;
  shown.snapshot.bodies.pop_back();  // a part disappears, after a picture in full
  EXPECT_EQ(renderer.render(shown.snapshot, shown.camera, shown.options).rgb, shown.afresh().rgb);
}

TEST(Camera, FrameSceneShowsTheWholeBoxAndTouchesTheMargin) {
  const Box box = {Vec3(-0.1, 0.2, 0), Vec3(0.3, 0.25, 0.9)};
  const Camera camera = frameScene(box, Vec3(1, -2, 0.7), 0.5, 4.0 / 3, 0.1);
  double reach = 0;  // greatest distance of a corner from the middle, as a share of half the picture
  for (int i = 0; i < 8; ++i) {
    const Vec3 p((i & 1) ? box.max.x() : box.min.x(), (i & 2) ? box.max.y() : box.min.y(),
                 (i & 4) ? box.max.z() : box.min.z());
    const auto [x, y] = camera.project(p, 800, 600);
    reach = std::max({reach, std::abs(x - 400) / 400, std::abs(y - 300) / 300});
  }
  EXPECT_NEAR(reach, 0.9, 1e-9);
}

TEST(RendererTest, FacesHaveTheirColorsUnlessThePartIsInHand) {
  const Mesh box = makeBox(Vec3(0.08, 0.08, 0.02));
  scenes::FaceColors colors{{{0.8f, 0.05f, 0.05f}, {0.05f, 0.8f, 0.05f}}, {}};
  for (const auto& t : box.triangles) {
    const Vec3 n = (box.vertices[t[1]] - box.vertices[t[0]]).cross(box.vertices[t[2]] - box.vertices[t[0]]);
    colors.of_triangle.push_back(n.z() > 0 ? 1 : 0);  // faces that point upwards are green, all others red
  }
  RenderScene scene = {{&box, {0.5f, 0.5f, 0.5f}}};
  scene[0].face_colors = &colors;
  Renderer renderer(scene);
  Camera below = fromAbove();
  below.eye_W.z() *= -1;
  scenes::Snapshot snapshot;
  snapshot.bodies = {mounted(0, Vec3::Zero())};
  const auto above = pixel(renderer.render(snapshot, fromAbove(), plain()), 160, 120);
  EXPECT_GT(above[1], 2 * above[0]);
  const auto under = pixel(renderer.render(snapshot, below, plain()), 160, 120);
  EXPECT_GT(under[0], 2 * under[1]);
  snapshot.bodies[0].role = scenes::BodyRole::InHand;
  const auto held = pixel(renderer.render(snapshot, fromAbove(), plain()), 160, 120);
  EXPECT_GT(held[2], held[0] + 40);
  EXPECT_GT(held[2], held[1] + 20);
}

TEST(SectionAlong, ContainsTheMotionAndFacesTheViewer) {
  for (const Vec3& d : {Vec3(0, 0, -1), Vec3(1, 0, 0), Vec3(0, 1, 0), Vec3(1, 1, 0.3)}) {
    const Vec3 viewer(0.7, -1.2, 0.8);
    const CutPlane cut = sectionAlong(Vec3::Zero(), d, viewer);
    EXPECT_NEAR(cut.n_W.dot(d.normalized()), 0, 1e-12);
    EXPECT_GT(cut.n_W.dot(viewer), 0);
    EXPECT_NEAR(cut.n_W.norm(), 1, 1e-12);
  }
}

TEST(ShadingMesh, ABoxHasTwelveSharpEdgesAndFlatFaces) {
  const ShadingMesh mesh = buildShadingMesh(makeBox(Vec3(1, 2, 3)));
  EXPECT_EQ(mesh.sharp_edges.size(), 12u);
  EXPECT_TRUE(mesh.smooth_edges.empty());
  EXPECT_EQ(mesh.vertices.size(), 24u);  // each corner occurs once for each of its three faces
}

TEST(ShadingMesh, ACylinderIsRoundWithTwoSharpCircles) {
  constexpr int kSegments = 32;
  const ShadingMesh mesh = buildShadingMesh(makeCylinder(0.5, 1, kSegments));
  EXPECT_EQ(mesh.sharp_edges.size(), 2u * kSegments);
  for (const ShadingVertex& v : mesh.vertices) {
    if (std::abs(v.n[2]) > 0.5f) continue;
    // On the mantle the normal is radial to single precision, as the mean of symmetric facets.
    EXPECT_NEAR(v.n[0] * v.p[1] - v.n[1] * v.p[0], 0, 1e-6);
  }
}

TEST(ShadingMesh, SectionOfABoxIsItsRectangle) {
  const ShadingMesh mesh = buildShadingMesh(makeBox(Vec3(2, 4, 6)));
  double length = 0;
  for (const ShadingEdge& e : sectionSegments(mesh, Vec3::UnitX(), 0.25)) {
    const Vec3 a(e.a[0], e.a[1], e.a[2]), b(e.b[0], e.b[1], e.b[2]);
    EXPECT_NEAR(a.x(), 0.25, 1e-6);
    length += (b - a).norm();
  }
  EXPECT_NEAR(length, 2 * (4 + 6), 1e-5);
}

}  // namespace
}  // namespace vps::viewer
