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
  bool is_exhaustive = false;  ///< read every point
  bool is_coherent = true;     ///< use temporal coherence; ignored when exhaustive
  std::string path = "best";   ///< one of instructionPaths()
};

/// The instruction sets that this build can use on this machine; "best" first.
std::vector<std::string> instructionPaths();

/// A shell against a map, step by step. Answers are those of one-sided contact with the trilinear gradient,
/// like the rivals'.
class Subject {
 public:
  /// Map and shell must outlive it.
  Subject(const VoxMap& map, const PointShell& shell, const SubjectOptions& options);
  ~Subject();
  Answer step(const Pose& X_MP);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// Times mounting a second part on a base part at a pose; everything else is done before.
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
