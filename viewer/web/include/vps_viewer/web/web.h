// SPDX-License-Identifier: BSD-3-Clause
// A run in web browsers: one page, on any device that has a browser with WebGL.
#pragma once

#include <atomic>
#include <cstdint>
#include <functional>
#include <string>

#include "vps_device/recording.h"
#include "vps_scenes/network/session_network.h"
#include "vps_scenes/scene/model_options.h"
#include "vps_scenes/scene/scene.h"
#include "vps_viewer/export.h"

namespace vps::viewer {

struct WebOptions {
  std::uint16_t port = 8080;  ///< 0: one that is free
  /// Of this machine, to listen at. Other than loopback needs a token.
  std::string address = "127.0.0.1";
  std::string token;  ///< that a browser has to know; empty: none on loopback, a new one elsewhere
  /// PEM files of a certificate and its key: the page then comes by https alone. Empty: by http.
  std::string tls_certificate, tls_key;
  bool allows_hand = false;        ///< a browser may take the part in hand
  double rate_hz = 60;             ///< most snapshots a second for each browser
  std::size_t most_browsers = 32;  ///< at one time
  // Of the run.
  std::string session;  ///< as in scenes::SessionWatcher::join()
  scenes::SessionNetwork network;
  scenes::ModelOptions models;              ///< of a run in this process
  const std::atomic<bool>* stop = nullptr;  ///< set it to end
  /// Words for the user, such as the address to open. Called on the thread that serves.
  std::function<void(const std::string&)> say;
};

/// In words, what this machine lacks for the page; empty: nothing.
VPS_VIEWER_API std::string missingForWeb();

/// Serve the page until `stop` is set: a session of vps render, a run of the scene in this process, or a
/// recording. Several browsers may watch; one that is slow gets fewer pictures and disturbs nobody. Throw
/// LoadError where the address cannot be listened at, the token is too short, or the certificate cannot be
/// used.
VPS_VIEWER_API void serveSession(const WebOptions& options);
VPS_VIEWER_API void serveScene(const scenes::Scene& scene, const WebOptions& options);
VPS_VIEWER_API void serveRecording(const device::RecordedRun& run, const WebOptions& options);

}  // namespace vps::viewer
