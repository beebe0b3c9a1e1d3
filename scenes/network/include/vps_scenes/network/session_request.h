// SPDX-License-Identifier: BSD-3-Clause
// Asks the render node of a session for something.
#pragma once

#include <functional>
#include <string>

#include "vps_scenes/export.h"
#include "vps_scenes/network/session_network.h"
#include "vps_scenes/scene/scene.h"

namespace vps::scenes {

/// Whether a text has the form of a scene's hash: 32 hexadecimal digits, in small letters.
VPS_SCENES_API bool isSceneHash(const std::string& text);

struct SessionAnswer {
  bool is_done = false;
  std::string words;  ///< what is so, or why it was not done
};

/// All functions wait for the answer, and throw LoadError where there is no such session, it is of another
/// version, or nothing answers within 5 s.
class VPS_SCENES_API SessionRequest {
 public:
  explicit SessionRequest(std::string session, SessionNetwork network = {});

  [[nodiscard]] SessionAnswer who() const;
  /// The next part of the procedure. @param part  its name; empty: whichever it is
  [[nodiscard]] SessionAnswer take(const std::string& part = "") const;
  /// The part in hand, where it is.
  [[nodiscard]] SessionAnswer release() const;
  [[nodiscard]] SessionAnswer rearm() const;
  /// From the next part on. @param k_Nm_per_rad  0: as it is
  [[nodiscard]] SessionAnswer setGains(double k_N_per_m, double k_Nm_per_rad = 0) const;
  /// Another scene in place of the one that runs. It is sent only where the render node does not know it.
  /// @param progress  gets the share that was sent; may be empty
  [[nodiscard]] SessionAnswer load(const Scene& scene,
                                   const std::function<void(double)>& progress = nullptr) const;
  /// One that the render node knows. See isSceneHash().
  [[nodiscard]] SessionAnswer load(const std::string& hash) const;
  [[nodiscard]] SessionAnswer again() const;
  /// The runs that begin from now on. @param name  of a file, without a folder; empty: no more
  [[nodiscard]] SessionAnswer record(const std::string& name) const;

 private:
  std::string session_;
  SessionNetwork network_;
};

}  // namespace vps::scenes
