// SPDX-License-Identifier: BSD-3-Clause
// Pictures for two eyes: cameras with off-axis frusta, and the modes that show both pictures on a screen.
#pragma once

#include <string>
#include <vector>

#include "vps_scenes/scene/display.h"
#include "vps_viewer/draw/camera.h"
#include "vps_viewer/draw/renderer.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

enum class StereoMode {
  Mono,         ///< one picture, from the middle between the eyes
  SideBySide,   ///< left eye in the left half, each picture squeezed to half its width
  TopBottom,    ///< left eye in the upper half, each picture squeezed to half its height
  Interleaved,  ///< alternating rows, the uppermost for the left eye: line-polarised screens
  Anaglyph,     ///< for red-cyan glasses: left red, right green and blue
  /// Two pictures, for two projectors with interference filters: each eye has its own three narrow bands of
  /// red, green and blue, to whose colours the pictures are converted (Tripicchio et al.'s glasses).
  Spectral,
};

/// The name of a mode: "mono", "side_by_side", "top_bottom", "interleaved", "anaglyph", "spectral".
VPS_VIEWER_API const char* toText(StereoMode mode);
VPS_VIEWER_API const std::vector<StereoMode>& stereoModes();
/// The mode with the given name; Mono if no mode has it.
VPS_VIEWER_API StereoMode stereoModeOf(const std::string& name);

/// Distance between the eyes as a share of the distance to the target: the common 1/30 rule of stereo
/// photography, which is comfortable for most people.
inline constexpr double kEyeShare = 1.0 / 30;

/// Place of an interleaved picture on the screen. Each row of the picture must be one row of the screen,
/// since only even rows of the screen reach the left eye.
struct ScreenRows {
  /// Size to which both pictures are stretched before their rows are taken; 0: their own size.
  int width = 0, height = 0;
  int first = 0;  ///< row of the screen that shows the picture's uppermost row

  bool operator==(const ScreenRows&) const = default;
};

struct EyePair {
  Camera left, right;
};

/// The eyes to the left and right of a camera. The screen goes through the camera's target, so a point at the
/// target has no parallax.
/// @param picture_aspect  width over height of the picture that both eyes see
VPS_VIEWER_API EyePair eyesOf(const Camera& camera, double eye_distance_m, double picture_aspect);

/// The camera of an eye in front of a screen, in the scene's frame. Throws LoadError for an eye that is not
/// in front of the screen.
VPS_VIEWER_API Camera cameraFor(const scenes::Display& display, const scenes::DisplayScreen& screen,
                                const Vec3& eye_S);

/// The eyes of a viewer in front of a screen. Throws as cameraFor().
VPS_VIEWER_API EyePair eyesOf(const scenes::Display& display, const scenes::DisplayScreen& screen,
                              const scenes::DisplayViewer& viewer);

/// The camera midway between both eyes, whose frustum ends at the same screen.
VPS_VIEWER_API Camera middleEye(const EyePair& eyes);

/// One picture of the size in `options`, or two for Spectral (left, right). Legend and title are left out,
/// since they have no depth.
/// @param rows  for Interleaved: the picture gets the size in `rows`
VPS_VIEWER_API std::vector<Image> renderStereo(Renderer& renderer, const scenes::Snapshot& snapshot,
                                               const EyePair& eyes, const DrawOptions& options,
                                               StereoMode mode, const ScreenRows& rows = {});

/// One of the two pictures of Spectral: for the left eye, or for the right eye.
VPS_VIEWER_API Image renderSpectralEye(Renderer& renderer, const scenes::Snapshot& snapshot,
                                       const EyePair& eyes, const DrawOptions& options, bool is_left);

/// Copies a picture into another one, with its upper left pixel at (x, y), both >= 0. Pixels outside `whole`
/// are dropped.
VPS_VIEWER_API void paste(const Image& part, int x, int y, Image& whole);

/// The picture of a screen for a viewer.
struct ScreenPicture {
  std::string name;  ///< "front_anna", "front_anna_left"
  Image image;
};
/// Pictures of all screens for all viewers of a display. With a single viewer, the names leave out the
/// viewer. The stereo mode works as in renderStereo().
VPS_VIEWER_API std::vector<ScreenPicture> renderDisplay(Renderer& renderer, const scenes::Snapshot& snapshot,
                                                        const scenes::Display& display,
                                                        const DrawOptions& options, StereoMode mode);

}  // namespace vps::viewer
