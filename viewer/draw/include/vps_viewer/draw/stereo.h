// SPDX-License-Identifier: BSD-3-Clause
// Pictures for two eyes: cameras with off-axis frusta, and the ways to bring both pictures to a screen.
#pragma once

#include <string>
#include <vector>

#include "vps_scenes/scene/display.h"
#include "vps_viewer/draw/camera.h"
#include "vps_viewer/draw/renderer.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

enum class StereoMode {
  Mono,         ///< from the middle between the eyes
  SideBySide,   ///< left eye in the left half, each squeezed to half its width
  TopBottom,    ///< left eye in the upper half, each squeezed to half its height
  Interleaved,  ///< rows by turns, the uppermost for the left eye: line-polarised screens
  Anaglyph,     ///< for red-cyan glasses: left red, right green and blue
  /// Two pictures, for two projectors with interference filters: each eye has its own three narrow bands of
  /// red, green and blue, to whose colours the pictures are converted (the paper's glasses).
  Spectral,
};

/// "mono", "side_by_side", "top_bottom", "interleaved", "anaglyph", "spectral".
VPS_VIEWER_API const char* toText(StereoMode mode);
VPS_VIEWER_API const std::vector<StereoMode>& stereoModes();
/// The mode of that name; Mono where there is none.
VPS_VIEWER_API StereoMode stereoModeOf(const std::string& name);

/// Distance of the eyes for the distance to what is looked at: a common rule of stereo photographers, with
/// which most people have no trouble.
inline constexpr double kEyeShare = 1.0 / 30;

/// Where an interleaved picture is shown: each of its rows must be one row of the screen, of which only the
/// even ones reach the left eye.
struct ScreenRows {
  int width = 0,
      height = 0;  ///< both pictures are stretched to this before their rows are taken; 0: their own
  int first = 0;   ///< row of the screen that shows the uppermost row

  bool operator==(const ScreenRows&) const = default;
};

struct EyePair {
  Camera left, right;
};

/// The eyes of a camera: to its left and right, with the screen through its target, so that what is there
/// has no parallax.
/// @param picture_aspect  width over height of the picture that both see
VPS_VIEWER_API EyePair eyesOf(const Camera& camera, double eye_distance_m, double picture_aspect);

/// The camera of an eye in front of a screen, in the scene. Throws LoadError for an eye that is not in front.
VPS_VIEWER_API Camera cameraFor(const scenes::Display& display, const scenes::DisplayScreen& screen,
                                const Vec3& eye_S);

/// Those of a viewer in front of a screen. Throws as cameraFor().
VPS_VIEWER_API EyePair eyesOf(const scenes::Display& display, const scenes::DisplayScreen& screen,
                              const scenes::DisplayViewer& viewer);

/// The eye between both, whose frustum ends at the same screen.
VPS_VIEWER_API Camera middleEye(const EyePair& eyes);

/// One picture of options' size, or two for Spectral: left, right. Without legend and title, which would have
/// no place in depth.
/// @param rows  of Interleaved, whose picture has the size that they state
VPS_VIEWER_API std::vector<Image> renderStereo(Renderer& renderer, const scenes::Snapshot& snapshot,
                                               const EyePair& eyes, const DrawOptions& options,
                                               StereoMode mode, const ScreenRows& rows = {});

/// One of the pictures of Spectral: that of the left eye, or of the right one.
VPS_VIEWER_API Image renderSpectralEye(Renderer& renderer, const scenes::Snapshot& snapshot,
                                       const EyePair& eyes, const DrawOptions& options, bool is_left);

/// Copies what fits of a picture into another one, its upper left pixel to (x, y), neither of them negative.
VPS_VIEWER_API void paste(const Image& part, int x, int y, Image& whole);

/// What a screen shows to a viewer.
struct ScreenPicture {
  std::string name;  ///< "front_anna", "front_anna_left"
  Image image;
};
/// All screens for all viewers of a display; with one viewer its name is left out. Anaglyph and the like as
/// in renderStereo().
VPS_VIEWER_API std::vector<ScreenPicture> renderDisplay(Renderer& renderer, const scenes::Snapshot& snapshot,
                                                        const scenes::Display& display,
                                                        const DrawOptions& options, StereoMode mode);

}  // namespace vps::viewer
