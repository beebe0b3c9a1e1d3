// SPDX-License-Identifier: BSD-3-Clause
// Our side of every comparison: the only file here that depends on vps/query.h.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "rival.h"
#include "vps/query.h"

namespace vps::bench {

struct SubjectOptions {
  bool is_exhaustive = false;  ///< reads every point
  bool is_coherent = true;     ///< uses temporal coherence; ignored if is_exhaustive
  std::string path = "best";   ///< one of instructionPaths()
};

/// The instruction sets that this build can use on this machine; "best" first.
std::vector<std::string> instructionPaths();

/// A shell against a map, step by step. Answers are for one-sided contact with the trilinear gradient, like
/// the rivals' answers.
class Subject {
 public:
  /// Map and shell must outlive this object.
  Subject(const VoxMap& map, const PointShell& shell, const SubjectOptions& options);
  ~Subject();
  Answer step(const Pose& X_MP);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Mounts a second part on a base part at a pose; the constructor does everything else, so that mount() can
/// be timed.
class Mounting {
 public:
  Mounting(const Mesh& base, const Mesh& mounted, const VoxMapSettings& settings);
  ~Mounting();
  VoxMap mount(const Pose& X_BM) const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace vps::bench
