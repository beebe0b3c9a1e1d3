// SPDX-License-Identifier: BSD-3-Clause
#include "web/web_page.h"

#include <utility>

#include "files/text_file.h"
#include "files/three.h"

namespace vps::viewer {

WebPage::WebPage() {
  constexpr const char* kScript = "text/javascript; charset=utf-8";
  files_["/"] = {"text/html; charset=utf-8", kPageHtml};
  files_["/page.css"] = {"text/css; charset=utf-8", kPageCss};
  files_["/page.js"] = {kScript, kPageScript};
  constexpr std::pair<const char*, const char*> kLibrary[] = {
      {"/three.js", "build/three.min.js"},
      {"/orbit_controls.js", "examples/js/controls/OrbitControls.js"},
      {"/gltf_loader.js", "examples/js/loaders/GLTFLoader.js"}};
  for (const auto& [path, file] : kLibrary) {
    std::string text = textOf(std::string(kThreeFolder) + file);
    if (text.empty())
      missing_ = std::string("three.js, which draws in the browser, is not in ") + kThreeFolder +
                 ": install libjs-three";
    files_[path] = {kScript, std::move(text)};
  }
}

const WebFile* WebPage::find(std::string_view path) const {
  const auto found = files_.find(path);
  return found == files_.end() ? nullptr : &found->second;
}

}  // namespace vps::viewer
