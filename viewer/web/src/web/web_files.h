// SPDX-License-Identifier: BSD-3-Clause
// The files that a browser loads: the page (page.html, page.css, page.js), three.js of this machine, and parts as glTF.
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

class WebPage {
 public:
  /// Reads three.js. Without it missing() says so.
  WebPage();
  /// By the path of a request, such as "/page.js"; null: there is none.
  [[nodiscard]] const WebFile* find(std::string_view path) const;
  /// In words, what this machine lacks; empty: nothing.
  [[nodiscard]] const std::string& missing() const { return missing_; }

 private:
  std::map<std::string, WebFile, std::less<>> files_;
  std::string missing_;
};

extern const char* const kPageHtml;
extern const char* const kPageCss;
extern const char* const kPageScript;

/// The bytes of a .glb file: one node with the surface (positions, normals, triangles) and, as lines, the
/// sharp edges; in metres and in the part's frame. The node's translation is the mesh's center, so that
/// floats keep their precision far out.
/// @param wanted     about as many triangles; a surface with no more stays as it is
/// @param has_edges  false: without the edges, from which a coarse surface is off
/// O(triangles). Source: Khronos, "glTF 2.0 Specification".
std::string partGlb(const ShadingMesh& mesh, std::size_t wanted, bool has_edges = true);

}  // namespace vps::viewer
