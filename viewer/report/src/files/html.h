// SPDX-License-Identifier: BSD-3-Clause
// Pieces of an HTML page: escaped text, numbers, tables, pictures, and files written into the page.
#pragma once

#include <cstddef>
#include <span>
#include <string>
#include <string_view>
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

/// A picture with a caption. The picture links to `link` if `link` is not empty; both paths are relative to
/// the page.
std::string figure(const std::string& file, const std::string& caption_html, const std::string& link = {});

/// A page that is written in pieces: its start up to the body, and its end.
/// @param style  style sheet of this page, after that of all pages
/// @param reload_s  a browser loads the page again after this many seconds; 0: never
std::string pageStart(const std::string& title, const std::string& style = {}, int reload_s = 0);
inline constexpr const char* kPageEnd = "</body>\n</html>\n";

/// A whole page with the given body. Pictures (PNG) from `folder` that the page shows, and tables and
/// drawings (CSV, SVG) that it links to, are embedded, so that the page can be sent without the folder.
std::string page(const std::string& title, const std::string& body, const std::string& folder = {});

}  // namespace html

/// Bytes as base64 text: RFC 4648, section 4, with padding.
std::string base64(std::span<const std::byte> bytes);
/// The bytes of a PNG file as a data URL (RFC 2397), for a picture inside a page.
std::string pngInText(std::string_view bytes);

/// A length in micrometres, without unit: "12.34".
inline std::string micrometres(double length_m, const char* form = "%.2f") {
  return html::format(1e6 * length_m, form);
}

/// A measured length with a suitable unit: "12.34 µm", "11.716 mm".
std::string lengthOnPage(double length_m);

/// A round length with a suitable unit: "5 mm", "200 µm".
inline std::string lengthText(double length_m) {
  if (length_m >= 1) return html::format(length_m, "%g m");
  if (length_m >= 1e-3) return html::format(1e3 * length_m, "%g mm");
  if (length_m >= 1e-6) return html::format(1e6 * length_m, "%g µm");
  return html::format(1e9 * length_m, "%g nm");
}

}  // namespace vps::viewer
