// SPDX-License-Identifier: BSD-3-Clause
#include "files/html.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <span>
#include <string_view>
#include <system_error>

#include "files/external.h"
#include "vps_scenes/scene/number_words.h"

namespace vps::viewer {

std::string lengthOnPage(double length_m) {
  std::string out = scenes::lengthInWords(length_m, 2);
  if (const std::size_t at = out.find("um"); at != std::string::npos) out.replace(at, 2, "µm");
  return out;
}

std::string escapeHtml(const std::string& text) {
  std::string out;
  out.reserve(text.size());
  for (const char c : text) {
    switch (c) {
      case '&':
        out += "&amp;";
        break;
      case '<':
        out += "&lt;";
        break;
      case '>':
        out += "&gt;";
        break;
      case '"':
        out += "&quot;";
        break;
      case '\'':
        out += "&#39;";
        break;
      default:
        out += c;
    }
  }
  return out;
}

namespace html {
namespace {

constexpr const char* kStyleSheet = R"(
:root { color-scheme: light; }
body { font: 15px/1.5 system-ui, "DejaVu Sans", sans-serif; color: #222; background: #fff; max-width: 1180px;
       margin: 0 auto; padding: 28px 24px 60px; }
h1 { font-size: 26px; margin: 0 0 4px; } h2 { font-size: 20px; margin: 44px 0 10px; border-bottom: 1px solid #ddd;
       padding-bottom: 4px; } h3 { font-size: 17px; margin: 30px 0 8px; }
p { max-width: 76ch; } .quiet { color: #666; } .good { color: #1b6e3c; } .bad { color: #b00020; }
.verdict { font-size: 19px; font-weight: 600; padding: 12px 16px; border-radius: 6px; margin: 16px 0; }
.verdict.good { background: #e8f4ec; } .verdict.bad { background: #fbe9eb; } .verdict.unsure { background: #fff6df; }
.note { background: #fff6df; border-left: 4px solid #e2a400; padding: 8px 14px; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; margin: 10px 0; font-variant-numeric: tabular-nums; }
th, td { padding: 5px 12px 5px 0; text-align: left; border-bottom: 1px solid #e6e6e6; vertical-align: top; }
th { font-weight: 600; color: #444; border-bottom: 2px solid #ccc; } td.n, th.n { text-align: right; }
.facts td:first-child { color: #555; padding-right: 26px; }
.pictures { display: grid; grid-template-columns: repeat(3, 1fr); gap: 12px; }
.pictures.two { grid-template-columns: repeat(2, 1fr); }
figure { margin: 0; } figure img { width: 100%; border: 1px solid #e0e0e0; border-radius: 4px; display: block; }
figure.section { margin: 18px 0 26px; } figure.section svg { width: 100%; max-width: 912px; display: block; }
figcaption { color: #555; font-size: 13px; margin-top: 4px; }
code, pre { font: 13px/1.5 "DejaVu Sans Mono", monospace; background: #f4f4f4; border-radius: 4px; }
code { padding: 1px 4px; } pre { padding: 10px 14px; overflow-x: auto; }
#run-view { margin: 12px 0 24px; } #run-view canvas { display: block; width: 100%; border: 1px solid #e0e0e0;
       border-radius: 4px; touch-action: none; } #run-view .screen { min-height: 3em; }
#run-view .controls { display: flex; gap: 12px; align-items: center; margin: 8px 0 4px; }
#run-view input { flex: 1; min-width: 0; } #run-view button, #run-view select { font: inherit; padding: 3px 12px; }
#run-view output { display: block; min-height: 1.5em; font-variant-numeric: tabular-nums; } #run-view p { margin: 2px 0; }
@media (max-width: 800px) { .pictures, .pictures.two { grid-template-columns: 1fr; } }
@media print { body { padding: 0; max-width: none; font-size: 12px; } h2, h3 { break-after: avoid; }
       figure { break-inside: avoid; } #run-view { display: none; } .scroll { overflow: visible; } th, td { padding-right: 8px; }
       .pictures, .pictures.two { grid-template-columns: repeat(2, 1fr); } }
)";

std::string attribute(const std::string& css_class) {
  return css_class.empty() ? std::string() : " class=\"" + escapeHtml(css_class) + "\"";
}

/// The body with the pictures from the folder embedded in place of their names.
std::string withPictures(const std::string& body, const std::string& folder) {
  static const std::string kSource = "<img src=\"";
  std::string out;
  std::size_t done = 0;
  for (std::size_t at = body.find(kSource); at != std::string::npos; at = body.find(kSource, done)) {
    const std::size_t from = at + kSource.size(), to = body.find('"', from);
    out.append(body, done, from - done);
    done = to;
    const std::string file = body.substr(from, to - from);
    const std::string bytes = textOf(folder + "/" + file);
    out.append(bytes.empty() ? file : pngInText(bytes));
  }
  return out.append(body, done);
}

/// Embeds files of the folder to which the body links; a click saves them. A file that is missing or too
/// large for mail is named without a link. Links to other pages and within this page stay.
std::string withLinkedFiles(const std::string& body, const std::string& folder) {
  static const std::string kLink = "<a href=\"";
  constexpr std::uintmax_t kMost_bytes = 4'000'000;  // common mail servers accept 10 MB; base64 adds a third
  std::string out;
  std::size_t done = 0;
  for (std::size_t at = body.find(kLink); at != std::string::npos; at = body.find(kLink, done)) {
    const std::size_t from = at + kLink.size(), to = body.find('"', from);
    const std::string file = body.substr(from, to - from);
    const std::string_view kind = file.ends_with(".csv")   ? "text/csv"
                                  : file.ends_with(".svg") ? "image/svg+xml"
                                  : file.ends_with(".png") ? "image/png"
                                                           : "";
    if (kind.empty() || file.find(':') != std::string::npos) {
      out.append(body, done, to - done);
      done = to;
      continue;
    }
    out.append(body, done, at - done).append("<a");
    done = to + 1;
    const std::string path = folder + "/" + file;
    std::error_code error;
    const std::uintmax_t size_bytes = std::filesystem::file_size(path, error);
    if (error || size_bytes > kMost_bytes) continue;
    const std::string bytes = textOf(path);
    if (bytes.empty()) continue;
    out.append(" download=\"")
        .append(file.substr(file.rfind('/') + 1))
        .append("\" href=\"data:")
        .append(kind);
    out.append(";base64,").append(base64(std::as_bytes(std::span(bytes)))).append("\"");
  }
  return out.append(body, done);
}

}  // namespace

std::string format(double value, const char* form) {
  char text[64];
  std::snprintf(text, sizeof text, form, value);
  return text;
}

std::string table(const std::vector<std::string>& header, const std::vector<std::vector<Cell>>& rows,
                  const std::string& css_class) {
  std::string out = "<div class=\"scroll\"><table" + attribute(css_class) + "><thead><tr>";
  for (std::size_t i = 0; i < header.size(); ++i) {
    // Numbers are on the right, and so is their header. "n bad" is a number that is marked.
    const bool is_number = !rows.empty() && i < rows[0].size() && rows[0][i].css_class.starts_with("n");
    out += "<th" + attribute(is_number ? "n" : "") + ">" + header[i] + "</th>";
  }
  out += "</tr></thead><tbody>\n";
  for (const auto& row : rows) {
    out += "<tr>";
    for (const Cell& cell : row) out += "<td" + attribute(cell.css_class) + ">" + cell.html + "</td>";
    out += "</tr>\n";
  }
  return out + "</tbody></table></div>\n";
}

std::string facts(const std::vector<std::pair<std::string, std::string>>& rows) {
  std::string out = "<table class=\"facts\"><tbody>\n";
  for (const auto& [name, value] : rows) out += "<tr><td>" + name + "</td><td>" + value + "</td></tr>\n";
  return out + "</tbody></table>\n";
}

std::string figure(const std::string& file, const std::string& caption_html, const std::string& link) {
  const std::string image = "<img src=\"" + escapeHtml(file) + "\" alt=\"\" loading=\"lazy\">";
  return "<figure>" + (link.empty() ? image : "<a href=\"" + escapeHtml(link) + "\">" + image + "</a>") +
         "<figcaption>" + caption_html + "</figcaption></figure>\n";
}

std::string pageStart(const std::string& title, const std::string& style, int reload_s) {
  std::string reload;
  if (reload_s > 0) reload = "<meta http-equiv=\"refresh\" content=\"" + std::to_string(reload_s) + "\">\n";
  return "<!DOCTYPE html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n" + reload +
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         escapeHtml(title) + "</title>\n<style>" + kStyleSheet + style + "</style>\n</head>\n<body>\n";
}

std::string page(const std::string& title, const std::string& body, const std::string& folder) {
  return pageStart(title) + (folder.empty() ? body : withPictures(withLinkedFiles(body, folder), folder)) +
         kPageEnd;
}

}  // namespace html

std::string base64(std::span<const std::byte> bytes) {
  constexpr std::string_view kDigits = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string out;
  out.reserve((bytes.size() + 2) / 3 * 4);
  for (std::size_t i = 0; i < bytes.size(); i += 3) {
    const std::size_t count = std::min<std::size_t>(3, bytes.size() - i);
    std::uint32_t group = 0;
    for (std::size_t k = 0; k < 3; ++k)
      group = group << 8 | (k < count ? std::to_integer<std::uint32_t>(bytes[i + k]) : 0);
    for (std::size_t k = 0; k < 4; ++k) out += k <= count ? kDigits[group >> (18 - 6 * k) & 63] : '=';
  }
  return out;
}

std::string pngInText(std::string_view bytes) {
  return std::string("data:image/png;base64,").append(base64(std::as_bytes(std::span(bytes))));
}

}  // namespace vps::viewer
