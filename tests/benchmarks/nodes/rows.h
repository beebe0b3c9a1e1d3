// SPDX-License-Identifier: BSD-3-Clause
// The rows of the table of nodes. Each prints its lines, and returns whether its bar is reached.
#pragma once

#include <string>

namespace vps::bench {

/// One line of the table: case, bar, and what was measured.
void printRow(const std::string& what, const std::string& bar, const std::string& measured, bool is_reached);

/// Device to render and back at 1600 Hz between two processes, against the same calls within one.
bool latencyRows(double seconds);
/// The same bytes through iceoryx, for comparison with our shared memory.
bool iceoryxRow(double seconds);
/// A scene in three processes and in one, by the clock.
bool runRows(const std::string& scene);
/// The same with device and render in two network namespaces, joined by a wire without and with faults.
bool wireRows(const std::string& scene);
/// What the link carries, against wave variables and passivity controllers, in simulated time.
bool linkRows();
/// kill -9 of each node in turn.
/// @param network  interface; empty: shared memory
bool killRows(int kills, const std::string& network);

/// How well a node knows the clock of another one, which is 3 s ahead and gains 100 ppm.
bool clockRow(double seconds);
/// A scene by the clock without watchers and with ten of them.
bool watcherRows(const std::string& scene);
/// Garbage, foreign versions, replayed messages, a flood and a second device beside a run over UDP.
bool hostileRow(const std::string& scene);
/// Sessions for so long: one run that does not end, and short ones one after the other.
bool enduranceRow(double seconds);

}  // namespace vps::bench
