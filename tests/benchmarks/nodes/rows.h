// SPDX-License-Identifier: BSD-3-Clause
// The rows of the table of nodes. Each prints its lines, and returns whether its bar is reached.
#pragma once

#include <string>

namespace vps::bench {

/// One line of the table: case, bar, and what was measured.
void printRow(const std::string& what, const std::string& bar, const std::string& measured, bool is_reached);

/// Times from device to render and back at 1600 Hz between two processes, compared with the same calls in one
/// process.
bool latencyRows(double seconds);
/// Times of the same bytes through iceoryx, for comparison with our shared memory.
bool iceoryxRow(double seconds);
/// A scene in real time, in three processes and in one.
bool runRows(const std::string& scene);
/// A scene in real time, with device and render in two network namespaces that are joined by a wire without
/// and with faults.
bool wireRows(const std::string& scene);
/// Compares the states on our link with wave variables and passivity controllers, in simulated time.
bool linkRows();
/// Kills each node in turn with SIGKILL.
/// @param network  interface; empty: shared memory
bool killRows(int kills, const std::string& network);

/// The error with which a node knows the clock of another node, which is 3 s ahead and gains 100 ppm.
bool clockRow(double seconds);
/// A scene in real time, without watchers and with ten watchers.
bool watcherRows(const std::string& scene);
/// Garbage, foreign versions, replayed messages, a flood and a second device during a run over UDP.
bool hostileRow(const std::string& scene);
/// Sessions for this time: one run that does not end, and short runs one after the other.
bool enduranceRow(double seconds);

}  // namespace vps::bench
