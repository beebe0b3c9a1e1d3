// SPDX-License-Identifier: BSD-3-Clause
#include "view/picture_worker.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "vps_device/metronome.h"

namespace vps::viewer {
namespace {

bool isSamePose(const Pose& a, const Pose& b) {
  return a.R == b.R && a.p == b.p;
}

bool isSameSnapshot(const scenes::Snapshot& a, const scenes::Snapshot& b) {
  const auto same_body = [](const scenes::BodySnapshot& x, const scenes::BodySnapshot& y) {
    return x.part == y.part && x.role == y.role && isSamePose(x.X_WP, y.X_WP);
  };
  const auto same_mark = [](const scenes::ContactMark& x, const scenes::ContactMark& y) {
    return x.p_W == y.p_W && x.n_W == y.n_W && x.depth_m == y.depth_m;
  };
  return std::equal(a.bodies.begin(), a.bodies.end(), b.bodies.begin(), b.bodies.end(), same_body) &&
         std::equal(a.contacts.begin(), a.contacts.end(), b.contacts.begin(), b.contacts.end(), same_mark) &&
         a.has_target == b.has_target && a.target_part == b.target_part &&
         isSamePose(a.X_WP_target, b.X_WP_target) && a.has_hand == b.has_hand &&
         isSamePose(a.X_W_Proxy, b.X_W_Proxy) && a.F_hand_W.f == b.F_hand_W.f &&
         a.F_hand_W.tau == b.F_hand_W.tau;
}

bool isSameEyes(const std::optional<EyePair>& a, const std::optional<EyePair>& b) {
  if (!a || !b) return a.has_value() == b.has_value();
  return a->left == b->left && a->right == b->right;
}

bool isSameTiles(const std::vector<PictureTile>& a, const std::vector<PictureTile>& b) {
  return std::equal(a.begin(), a.end(), b.begin(), b.end(), [](const PictureTile& x, const PictureTile& y) {
    return isSameEyes(x.eyes, y.eyes) && x.place == y.place && x.eye == y.eye;
  });
}

/// Whether the requests differ in nothing but their snapshots.
bool isSameView(const PictureRequest& a, const PictureRequest& b) {
  return a.camera == b.camera && a.options == b.options && a.stereo == b.stereo &&
         isSameEyes(a.eyes, b.eyes) && a.rows == b.rows && isSameTiles(a.tiles, b.tiles);
}

/// Draws all tiles on black.
/// @param options  options of a draft may have fewer pixels than the request
Image drawTiles(Renderer& renderer, const PictureRequest& asked, const DrawOptions& options) {
  const bool has_rows = asked.stereo == StereoMode::Interleaved;  // a draft keeps the rows of the screen
  const int whole_w = has_rows && asked.rows.width > 0 ? asked.rows.width : options.width;
  const int whole_h = has_rows && asked.rows.height > 0 ? asked.rows.height : options.height;
  const auto scaled = [](int px, int from, int to) {
    return static_cast<int>(std::lround(double(px) * to / std::max(1, from)));
  };
  Image whole(whole_w, whole_h);
  for (const PictureTile& tile : asked.tiles) {
    const TilePlace& place = tile.place;
    DrawOptions own = options;
    own.width = pictureLength_px(scaled(place.width, asked.options.width, options.width));
    own.height = pictureLength_px(scaled(place.height, asked.options.height, options.height));
    const int x = scaled(place.x, asked.options.width, whole_w);
    const int y = scaled(place.y, asked.options.height, whole_h);
    if (tile.eye != 0) {
      paste(renderSpectralEye(renderer, asked.snapshot, tile.eyes, own, tile.eye < 0), x, y, whole);
      continue;
    }
    ScreenRows rows;
    if (has_rows)
      rows = {scaled(place.width, asked.options.width, whole_w),
              scaled(place.height, asked.options.height, whole_h), asked.rows.first + y};
    paste(renderStereo(renderer, asked.snapshot, tile.eyes, own, asked.stereo, rows).front(), x, y, whole);
  }
  return whole;
}

Image draw(Renderer& renderer, const PictureRequest& asked, const Camera& camera,
           const DrawOptions& options) {
  if (!asked.tiles.empty()) return drawTiles(renderer, asked, options);
  if (!asked.eyes) return renderer.render(asked.snapshot, camera, options);
  ScreenRows rows = asked.rows;
  if (rows.width <= 0) rows.width = asked.options.width;
  if (rows.height <= 0) rows.height = asked.options.height;
  return std::move(renderStereo(renderer, asked.snapshot, *asked.eyes, options, asked.stereo, rows).front());
}

}  // namespace

bool isSame(const PictureRequest& a, const PictureRequest& b) {
  return isSameView(a, b) && isSameSnapshot(a.snapshot, b.snapshot);
}

Image drawInFull(Renderer& renderer, const PictureRequest& asked) {
  return draw(renderer, asked, asked.camera, asked.options);
}

Image drawDraft(Renderer& renderer, const PictureRequest& asked, int shrink) {
  DrawOptions options = asked.options;
  options.is_draft = true;
  options.supersampling = 1;
  Camera camera = asked.camera;
  if (shrink > 1) {
    camera.aspect =
        double(options.width) / options.height;  // rounding the draft's size must not change the view
    options.width = pictureLength_px(options.width / shrink);
    options.height = pictureLength_px(options.height / shrink);
  }
  return draw(renderer, asked, camera, options);
}

PictureWorker::PictureWorker(RenderScene scene, std::function<void()> on_done, double wait_s)
    : on_done_(std::move(on_done)),
      thread_([this, drawn = std::move(scene), wait_s] { run(drawn, wait_s); }) {}

PictureWorker::~PictureWorker() {
  {
    const std::lock_guard lock(mutex_);
    is_ending_ = true;
  }
  wake_.notify_one();
  thread_.join();
}

void PictureWorker::request(const PictureRequest& wanted) {
  {
    const std::lock_guard lock(mutex_);
    if (last_ && isSame(*last_, wanted)) return;
    wanted_ = last_ = wanted;
  }
  wake_.notify_one();
}

std::optional<DrawnPicture> PictureWorker::take() {
  const std::lock_guard lock(mutex_);
  return std::exchange(done_, std::nullopt);
}

std::string PictureWorker::failure() const {
  const std::lock_guard lock(mutex_);
  return failure_;
}

std::size_t PictureWorker::count() const {
  const std::lock_guard lock(mutex_);
  return count_;
}

std::string PictureWorker::description() const {
  const std::lock_guard lock(mutex_);
  return description_;
}

void PictureWorker::run(const RenderScene& scene, double wait_s) {
  double next_s = wait_s;
  for (;;) {
    const std::size_t drawn = count();
    try {
      Renderer renderer(scene);
      {
        const std::lock_guard lock(mutex_);
        description_ = renderer.description();
      }
      drawAll(renderer);
      return;
    } catch (const std::exception& error) {
      const std::lock_guard lock(mutex_);
      failure_ = error.what();
      wanted_ = last_;
    }
    on_done_();
    if (count() > drawn) next_s = wait_s;
    std::unique_lock lock(mutex_);
    if (wake_.wait_for(lock, std::chrono::duration<double>(next_s), [this] { return is_ending_; })) return;
    next_s = std::min(2 * next_s, kLongestWait_s);
  }
}

void PictureWorker::drawAll(Renderer& renderer) {
  // While a full picture is drawn, which may take a second, there are no drafts. A full picture is therefore
  // drawn only when the view is at rest.
  constexpr auto kRest = std::chrono::milliseconds(150);
  // A draft that takes longer than kSlowDraft_s (20 pictures a second) gets fewer pixels, down to a third of
  // the width and height; a draft faster than kFastDraft_s gets more. assumed: a third of the width and
  // height still shows where parts move.
  constexpr double kSlowDraft_s = 0.05, kFastDraft_s = 0.015;
  constexpr int kMostShrink = 3;
  // In a view at rest only the region that changed is drawn. A contact must be visible within 24 ms, the
  // bound between picture, sound and force. A contact may begin while a draft is drawn and then appears in
  // the next draft, so two such drafts must fit into the bound.
  constexpr double kSlowPart_s = 0.006, kFastPart_s = 0.002;
  int shrink = 1;
  PictureRequest asked;
  bool has_draft = false;  // `asked` was drawn as a draft, but not in full
  for (;;) {
    bool is_draft = true, is_still = false;
    {
      std::unique_lock lock(mutex_);
      const auto is_new = [&] { return is_ending_ || (wanted_ && !(has_draft && isSame(asked, *wanted_))); };
      if (has_draft)
        is_draft = wake_.wait_for(lock, kRest, is_new);
      else
        wake_.wait(lock, is_new);
      if (is_ending_) return;
      is_still = isSameView(asked, *wanted_);
      asked = *wanted_;
      if (!is_draft) wanted_.reset();
    }
    const double begun_s = device::monotonicSeconds();
    Image image = is_draft ? drawDraft(renderer, asked, shrink) : drawInFull(renderer, asked);
    const double done_s = device::monotonicSeconds(), wall_s = done_s - begun_s;
    const bool is_part = !renderer.drewWhole();
    if (is_draft && (is_part || !is_still)) {
      if (wall_s > (is_part ? kSlowPart_s : kSlowDraft_s) && shrink < kMostShrink) ++shrink;
      if (wall_s < (is_part ? kFastPart_s : kFastDraft_s) && shrink > 1) --shrink;
    }
    {
      const std::lock_guard lock(mutex_);
      done_ = DrawnPicture{std::move(image), is_draft, wall_s, done_s};
      ++count_;
      failure_.clear();
    }
    has_draft = is_draft;
    on_done_();
  }
}

}  // namespace vps::viewer
