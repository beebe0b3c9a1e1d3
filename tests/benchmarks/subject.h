// SPDX-License-Identifier: BSD-3-Clause
// Our side of every comparison, behind one door: the only file here that changes when vps/query.h does.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "answer.h"
#include "vps/query.h"

namespace vps::bench {

struct SubjectOptions {
  bool is_exhaustive = false;  ///< read every point
  bool is_coherent = true;     ///< remember the last step; ignored when exhaustive
  std::string path = "best";   ///< one of instructionPaths()
};

/// The ways this build of the engine can run on this machine; "best" first.
std::vector<std::string> instructionPaths();

/// A shell against a map, step by step. Answers are those of one-sided contact with the trilinear gradient,
/// as the rivals'.
class Subject {
 public:
  /// Both must outlive it.
  Subject(const VoxMap& map, const PointShell& shell, const SubjectOptions& options);
  ~Subject();
  Answer step(const Pose& X_MP);

 private:
  struct State;
  std::unique_ptr<State> state_;
};

/// A base part with a second one mounted at a pose, timed alone: what is needed before is made once.
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
