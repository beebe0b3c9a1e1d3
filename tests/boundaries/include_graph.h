// SPDX-License-Identifier: BSD-3-Clause
// Which source file includes which, and the rules that those includes must keep.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

namespace vps::boundaries {

/// One `#include` line of a source file of the project.
struct Include {
  std::string file;  ///< path of the including file, relative to the project's root
  int line = 0;
  std::string target;        ///< as written between quotes or angle brackets
  bool is_external = false;  ///< written in angle brackets
};

/// All include lines of the .h, .cpp and .inc files below `folder`. Paths are relative to `root`.
std::vector<Include> includesBelow(const std::filesystem::path& root, const std::string& folder);

/// One message per include that breaks the order of the folders, or that names a library which another folder
/// owns.
std::vector<std::string> folderViolations(const std::filesystem::path& root);

/// One message per circle among the groups of one folder, with one include line for each of its arrows.
///
/// A group is a folder in `folder`/src, in the src of one of its wings (`folder`/<wing>/src), or in
/// `folder`/cli. A public header belongs to the group that holds the source file of the same name, or, in a
/// sub-folder of the public headers, to the group of that name. A public header without a source is a group
/// of its own, unless the table in include_graph.cpp names its group.
std::vector<std::string> groupCircles(const std::filesystem::path& root, const std::string& folder);

}  // namespace vps::boundaries
