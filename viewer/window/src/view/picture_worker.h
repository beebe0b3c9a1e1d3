// SPDX-License-Identifier: BSD-3-Clause
// A thread that draws the pictures that the window requests, so that the window responds during a slow
// picture.
#pragma once

#include <condition_variable>
#include <functional>
#include <mutex>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "view/display_tiles.h"
#include "vps_viewer/draw/renderer.h"
#include "vps_viewer/draw/stereo.h"

namespace vps::viewer {

struct PictureRequest {
  scenes::Snapshot snapshot;
  Camera camera;
  DrawOptions options;
  StereoMode stereo = StereoMode::Mono;
  /// Used in place of `camera`; without stereo the picture is seen from the middle between the eyes.
  std::optional<EyePair> eyes;
  ScreenRows rows;  ///< rows of an interleaved picture
  /// Drawn on black in place of `camera` and `eyes`; empty: one whole picture.
  std::vector<PictureTile> tiles;
};
/// Whether both requests give the same picture.
[[nodiscard]] VPS_VIEWER_API bool isSame(const PictureRequest& a, const PictureRequest& b);

/// Draws the picture in full quality and size.
[[nodiscard]] VPS_VIEWER_API Image drawInFull(Renderer& renderer, const PictureRequest& asked);
/// Draws the same view as a draft, with width and height divided by `shrink`. An interleaved draft keeps all
/// rows.
/// @param shrink  >= 1
[[nodiscard]] VPS_VIEWER_API Image drawDraft(Renderer& renderer, const PictureRequest& asked, int shrink);

struct DrawnPicture {
  Image image;
  bool is_draft = false;
  double wall_s = 0;   ///< duration of drawing
  double clock_s = 0;  ///< end of drawing, by device::monotonicSeconds()
};

/// Draws the newest request first as a draft, and in full if no newer request follows. Older requests are
/// skipped, and a request for the same picture draws nothing. If the renderer fails (no OpenGL, out of
/// memory, the graphics card was reset), the worker makes a new renderer after a while and draws the newest
/// request again.
class VPS_VIEWER_API PictureWorker {
 public:
  /// @param scene    its meshes must outlive the worker
  /// @param on_done  called on the worker's thread after each picture, and after a failure
  /// @param wait_s   time from the first failure to the next attempt; doubled after each further failure,
  ///                 up to kLongestWait_s
  explicit PictureWorker(RenderScene scene, std::function<void()> on_done, double wait_s = 1);
  ~PictureWorker();
  PictureWorker(const PictureWorker&) = delete;
  PictureWorker& operator=(const PictureWorker&) = delete;

  void request(const PictureRequest& wanted);
  static constexpr double kLongestWait_s = 30;
  /// The newest picture; empty if it was taken already.
  [[nodiscard]] std::optional<DrawnPicture> take();
  /// Why the newest request has no picture, with a remedy; empty: nothing has failed since the last picture.
  [[nodiscard]] std::string failure() const;
  /// Number of pictures drawn so far.
  [[nodiscard]] std::size_t count() const;
  /// Name of the OpenGL renderer; empty before the first picture.
  [[nodiscard]] std::string description() const;

 private:
  void run(const RenderScene& scene, double wait_s);
  void drawAll(Renderer& renderer);

  std::function<void()> on_done_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<PictureRequest> wanted_;  ///< request that is not drawn in full yet
  std::optional<PictureRequest> last_;    ///< the newest request
  std::optional<DrawnPicture> done_;
  std::string failure_, description_;
  std::size_t count_ = 0;
  bool is_ending_ = false;
  std::thread thread_;  // declared last, since the thread uses the other members
};

}  // namespace vps::viewer
