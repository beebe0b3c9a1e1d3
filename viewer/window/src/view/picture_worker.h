// SPDX-License-Identifier: BSD-3-Clause
// A thread that draws what the window asks for, so that the window answers while a slow picture is drawn.
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

/// What a part of the picture shows.
struct PictureTile {
  EyePair eyes;
  TilePlace place;  ///< in a picture of the options' size
  int eye = 0;      ///< of Spectral, see DisplayOutput
};

struct PictureRequest {
  scenes::Snapshot snapshot;
  Camera camera;
  DrawOptions options;
  StereoMode stereo = StereoMode::Mono;
  std::optional<EyePair>
      eyes;         ///< of a picture for two eyes, or for the middle between them; none: `camera`'s
  ScreenRows rows;  ///< of an interleaved picture
  std::vector<PictureTile> tiles;  ///< on black, in place of `camera` and `eyes`; empty: the picture is whole
};
/// Whether both give the same picture.
[[nodiscard]] VPS_VIEWER_API bool isSame(const PictureRequest& a, const PictureRequest& b);

/// In full.
[[nodiscard]] VPS_VIEWER_API Image drawInFull(Renderer& renderer, const PictureRequest& asked);
/// The same view as a draft with that share of the pixels across. An interleaved one has all of its rows.
/// @param shrink  >= 1
[[nodiscard]] VPS_VIEWER_API Image drawDraft(Renderer& renderer, const PictureRequest& asked, int shrink);

struct DrawnPicture {
  Image image;
  bool is_draft = false;
  double wall_s = 0;   ///< time that drawing took
  double clock_s = 0;  ///< when it was done, by device::monotonicSeconds()
};

/// Draws the newest request first as a draft, and in full once nothing newer is wanted. Requests in between
/// are skipped, and one that asks for the same again draws nothing. Where the renderer fails (no OpenGL, out
/// of memory, the graphics card was reset), it makes a new one after a while and draws the newest request
/// again.
class VPS_VIEWER_API PictureWorker {
 public:
  /// @param scene    its meshes outlive the worker
  /// @param on_done  called on the worker's thread after each picture, and after a failure
  /// @param wait_s   from a first failure to the next attempt; twice as long after each further one, up to
  ///                 kLongestWait_s
  explicit PictureWorker(RenderScene scene, std::function<void()> on_done, double wait_s = 1);
  ~PictureWorker();
  PictureWorker(const PictureWorker&) = delete;
  PictureWorker& operator=(const PictureWorker&) = delete;

  void request(const PictureRequest& wanted);
  static constexpr double kLongestWait_s = 30;
  /// The newest picture, once.
  [[nodiscard]] std::optional<DrawnPicture> take();
  /// Why there is no picture of the newest request, in words with a remedy; empty: nothing has failed since
  /// the last picture.
  [[nodiscard]] std::string failure() const;
  /// Pictures drawn so far.
  [[nodiscard]] std::size_t count() const;
  /// What draws, in words; empty before the first picture.
  [[nodiscard]] std::string description() const;

 private:
  void run(const RenderScene& scene, double wait_s);
  void drawAll(Renderer& renderer);

  std::function<void()> on_done_;
  mutable std::mutex mutex_;
  std::condition_variable wake_;
  std::optional<PictureRequest> wanted_;  ///< not drawn in full yet
  std::optional<PictureRequest> last_;    ///< the newest request
  std::optional<DrawnPicture> done_;
  std::string failure_, description_;
  std::size_t count_ = 0;
  bool is_ending_ = false;
  std::thread thread_;  // last, since it uses the others
};

}  // namespace vps::viewer
