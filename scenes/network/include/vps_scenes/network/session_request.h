// SPDX-License-Identifier: BSD-3-Clause
// Sends requests to the render node of a session.
#pragma once

#include <functional>
#include <string>

#include "vps_scenes/export.h"
#include "vps_scenes/network/session_network.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Whether a text has the form of a scene's hash: 32 lower-case hexadecimal digits.
VPS_SCENES_API bool isSceneHash(const std::string& text);

struct SessionAnswer {
  bool is_done = false;
  std::string words;  ///< the reply: the resulting state, or the reason of a refusal
};

/// All functions wait for the answer. The functions throw LoadError if there is no such session, if it has
/// another version, or if no answer comes within 5 s.
class VPS_SCENES_API SessionRequest {
 public:
  explicit SessionRequest(std::string session, SessionNetwork network = {});

  [[nodiscard]] SessionAnswer who() const;
  /// Takes the next part of the procedure. @param part  name of the part; empty: any part
  [[nodiscard]] SessionAnswer take(const std::string& part = "") const;
  /// Releases the part in hand where it is.
  [[nodiscard]] SessionAnswer release() const;
  [[nodiscard]] SessionAnswer rearm() const;
  /// Sets the coupling gains from the next part on. @param k_Nm_per_rad  0: unchanged
  [[nodiscard]] SessionAnswer setGains(double k_N_per_m, double k_Nm_per_rad = 0) const;
  /// Runs another scene instead of the current one. The scene is sent only if the render node does not have
  /// it.
  /// @param progress  called with the share that was sent; may be empty
  [[nodiscard]] SessionAnswer load(const Scene& scene,
                                   const std::function<void(double)>& progress = nullptr) const;
  /// Runs a scene that the render node already has, by its hash; see isSceneHash().
  [[nodiscard]] SessionAnswer load(const std::string& hash) const;
  [[nodiscard]] SessionAnswer again() const;
  /// Records all runs that begin from now on. @param name  file name without a folder; empty: stop recording
  [[nodiscard]] SessionAnswer record(const std::string& name) const;

 private:
  std::string session_;
  SessionNetwork network_;
};

}  // namespace vps::scenes
