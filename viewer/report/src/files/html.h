// SPDX-License-Identifier: BSD-3-Clause
// Pieces of an HTML page.
#pragma once

#include <string>
#include <utility>
#include <vector>

namespace vps::viewer {

/// Escapes text for HTML elements and quoted attributes.
std::string escapeHtml(const std::string& text);

namespace html {

/// printf with one double: format(1e6 * depth_m, "%.2f").
std::string format(double value, const char* form);

/// A cell of a table; its text is HTML.
struct Cell {
  std::string html;
  std::string css_class;
};

/// A table with a header row.
std::string table(const std::vector<std::string>& header, const std::vector<std::vector<Cell>>& rows,
                  const std::string& css_class = {});

/// A two-column table: name, value.
std::string facts(const std::vector<std::pair<std::string, std::string>>& rows);

/// A picture, which links to `link` if there is one. Both are relative to the page.
std::string figure(const std::string& file, const std::string& caption_html, const std::string& link = {});

/// The page around a body. Pictures (PNG) that it shows from `folder`, and tables and drawings (CSV, SVG)
/// that it links to, are written into it, so that it can be sent on without the folder.
std::string page(const std::string& title, const std::string& body, const std::string& folder = {});

}  // namespace html

}  // namespace vps::viewer
