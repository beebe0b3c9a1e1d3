// SPDX-License-Identifier: BSD-3-Clause
// Universal Ctags, on which many editors stand, finds what the public headers export, in its namespace.
#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <regex>
#include <set>
#include <string>
#include <vector>

#include "support/temporary_folder.h"

namespace vps::boundaries {

namespace fs = std::filesystem;

namespace {

std::vector<fs::path> publicHeaders() {
  std::vector<fs::path> headers;
  for (const char* folder : {"plugin", "bullet_bridge", "device", "scenes", "viewer"})
    for (const fs::directory_entry& entry :
         fs::recursive_directory_iterator(fs::path(VPS_SOURCE_DIR) / folder)) {
      const std::string path = entry.path().generic_string();
      if (entry.path().extension() == ".h" && path.find("/include/vps") != std::string::npos)
        headers.push_back(entry.path());
    }
  return headers;
}

/// Names of the functions and classes that a header marks as exported.
std::vector<std::string> exportedNames(const std::string& header) {
  static const std::regex comment("//[^\n]*"), marked(R"(VPS_(?:[A-Z]+_)?API\s+([^;{}]*))"),
      of_class(R"(^(?:class|struct)\s+(\w+))"), of_function(R"((\w+)\s*\()");
  const std::string code = std::regex_replace(header, comment, "");
  std::vector<std::string> names;
  for (auto it = std::sregex_iterator(code.begin(), code.end(), marked); it != std::sregex_iterator(); ++it) {
    const std::string declaration = (*it)[1];
    // `class VPS_API Name` and `VPS_API type name(...)`; template arguments such as function<void(int)> in
    // the type are no names.
    std::string plain;
    int depth = 0;
    for (const char c : declaration) {
      depth += c == '<' ? 1 : 0;
      if (depth == 0) plain += c;
      depth -= c == '>' ? 1 : 0;
    }
    std::smatch name;
    const bool is_class =
        std::regex_search(code.begin() + std::max<std::ptrdiff_t>(0, it->position() - 8),
                          code.begin() + it->position(), std::regex(R"((class|struct)\s+$)"));
    if (is_class)
      names.push_back(plain.substr(0, plain.find_first_of(" :\n")));
    else if (std::regex_search(plain, name, of_function))
      names.push_back(name[1]);
  }
  return names;
}

/// "vps::bullet::install" for each definition or declaration that ctags finds in the headers.
std::set<std::string> tagsOf(const std::vector<fs::path>& headers) {
  std::string command = "ctags --language-force=C++ --kinds-C++=+p --fields=+sZ --extras=+q -f - 2>/dev/null";
  for (const fs::path& header : headers) command += " '" + header.string() + "'";
  std::set<std::string> names;
  FILE* pipe = popen(command.c_str(), "r");
  if (pipe == nullptr) return names;
  char line[4096];
  while (std::fgets(line, sizeof line, pipe) != nullptr) {
    const std::string text = line;
    names.insert(text.substr(0, text.find('\t')));
  }
  pclose(pipe);
  return names;
}

TEST(Tags, HaveEveryExportedNameInItsNamespace) {
  const std::vector<fs::path> headers = publicHeaders();
  const std::set<std::string> tags = tagsOf(headers);
  if (tags.empty()) GTEST_SKIP() << "universal-ctags is not installed";
  EXPECT_TRUE(tags.contains("vps::queryContacts"));
  std::size_t exported = 0;
  for (const fs::path& header : headers) {
    const std::string path = header.generic_string();
    const std::string space = path.find("/vps_bullet/") != std::string::npos   ? "vps::bullet::"
                              : path.find("/vps_device/") != std::string::npos ? "vps::device::"
                              : path.find("/vps_scenes/") != std::string::npos ? "vps::scenes::"
                              : path.find("/vps_viewer/") != std::string::npos ? "vps::viewer::"
                                                                               : "vps::";
    for (const std::string& name : exportedNames(test::bytesOf(header))) {
      ++exported;
      // The tag of a member that is exported by itself has the member's class between namespace and name.
      const bool is_found = std::ranges::any_of(
          tags, [&](const std::string& tag) { return tag.starts_with(space) && tag.ends_with("::" + name); });
      EXPECT_TRUE(is_found) << path << ": " << name;
    }
  }
  EXPECT_GT(exported, 300U);
}

}  // namespace

}  // namespace vps::boundaries
