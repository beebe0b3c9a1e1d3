// SPDX-License-Identifier: BSD-3-Clause
// The rows of the table of nodes. Each prints its lines, and returns whether its bar is reached.
#pragma once

#include <string>

namespace vps::bench {

/// One line of the table: case, bar, and what was measured.
void printRow(const std::string& what, const std::string& bar, const std::string& measured, bool is_reached);

/// Device to render and back at 1600 Hz between two processes, against the same calls within one.
bool latencyRows(double seconds);
/// A scene in three processes and in one, by the clock.
bool runRows(const std::string& scene);
/// The same with device and render in two network namespaces, joined by a wire without and with faults.
bool wireRows(const std::string& scene);
/// kill -9 of each node in turn.
/// @param network  interface; empty: shared memory
bool killRows(int kills, const std::string& network);

}  // namespace vps::bench
