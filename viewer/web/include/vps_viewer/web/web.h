// SPDX-License-Identifier: BSD-3-Clause
// A run in web browsers: one page for any device that has a browser with WebGL.
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
  std::uint16_t port = 8080;  ///< 0: any free port
  /// Address of this machine to listen at. Any address other than loopback needs a token.
  std::string address = "127.0.0.1";
  std::string token;  ///< secret of the page's address; empty: none on loopback, else a new one
  /// PEM files of a certificate and its key; the page is then served by https only. Empty: the page is served
  /// by http.
  std::string tls_certificate, tls_key;
  bool allows_hand = false;        ///< a browser may take the part in hand
  double rate_hz = 60;             ///< greatest number of snapshots per second for each browser
  std::size_t most_browsers = 32;  ///< greatest number of browsers at one time
  // Settings of the run.
  std::string session;  ///< name of the session, as in scenes::SessionWatcher::join()
  scenes::SessionNetwork network;
  scenes::ModelOptions models;              ///< contact models of a run in this process
  const std::atomic<bool>* stop = nullptr;  ///< set it to stop the server
  /// Shows a message to the user, such as the address to open. Called on the server's thread.
  std::function<void(const std::string&)> say;
};

/// Reason why this machine cannot serve the page, with a remedy; empty: it can.
VPS_VIEWER_API std::string missingForWeb();

/// Serves a page that shows a session of vps render, until `stop` is set. Several browsers may watch; a slow
/// browser gets fewer snapshots and does not slow down others. Throws LoadError if the server cannot listen
/// at the address, the token is too short, or the certificate cannot be used.
VPS_VIEWER_API void serveSession(const WebOptions& options);
/// Serves a page as serveSession() does, for runs of the scene in this process.
VPS_VIEWER_API void serveScene(const scenes::Scene& scene, const WebOptions& options);
/// Serves a page as serveSession() does, for a recording.
VPS_VIEWER_API void serveRecording(const device::RecordedRun& run, const WebOptions& options);

}  // namespace vps::viewer
