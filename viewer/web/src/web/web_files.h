// SPDX-License-Identifier: BSD-3-Clause
// The files that a browser loads: the page (page.html, page.css, page.js), three.js of this machine, and
// parts as glTF.
#pragma once

#include <cstddef>
#include <map>
#include <string>
#include <string_view>

#include "mesh/shading_mesh.h"

namespace vps::viewer {

struct WebFile {
  std::string type;  ///< "text/html; charset=utf-8"
  std::string bytes;
};

/// The page's files.
class WebPage {
 public:
  /// Reads three.js. If three.js is not installed, missing() returns a message.
  WebPage();
  /// Finds a file by the path of a request, such as "/page.js"; null: there is none.
  [[nodiscard]] const WebFile* find(std::string_view path) const;
  /// Message about missing files of three.js, with a remedy; empty: none is missing.
  [[nodiscard]] const std::string& missing() const { return missing_; }

 private:
  std::map<std::string, WebFile, std::less<>> files_;
  std::string missing_;
};

extern const char* const kPageHtml;
extern const char* const kPageCss;
extern const char* const kPageScript;

/// The bytes of a .glb file, in metres and in the part's frame. The file has one node with the surface
/// (positions, normals, triangles) and the sharp edges as lines. The node's translation is the centre of the
/// mesh, so that floats stay precise far from the origin.
/// @param wanted     approximate number of triangles; a surface with fewer triangles is not simplified
/// @param has_edges  false: without edges, which do not lie on a coarse surface
/// O(triangles). Source: Khronos, "glTF 2.0 Specification".
std::string partGlb(const ShadingMesh& mesh, std::size_t wanted, bool has_edges = true);

}  // namespace vps::viewer
