// SPDX-License-Identifier: BSD-3-Clause
// The files of the web page: page.html, page.css and page.js of this folder, and three.js of this machine.
#pragma once

#include <map>
#include <string>
#include <string_view>

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

}  // namespace vps::viewer
