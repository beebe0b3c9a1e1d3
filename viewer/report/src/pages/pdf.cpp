// SPDX-License-Identifier: BSD-3-Clause
#include "vps_viewer/report/pages.h"

#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <vector>

#include "files/external.h"

namespace vps::viewer {
namespace {

namespace fs = std::filesystem;

constexpr const char* kNoChromium = "needs Chromium (Debian: apt install chromium)";

/// The browser's program: Debian's name, the name in other distributions, or Google's; empty if none is
/// installed.
std::string browser() {
  for (const char* name : {"chromium", "chromium-browser", "google-chrome"})
    if (hasProgram(name)) return name;
  return {};
}

/// A temporary folder for the browser's own files, removed on destruction.
class ProfileFolder {
 public:
  ProfileFolder() {
    std::string name = (fs::temp_directory_path() / "vps_pdf_XXXXXX").string();
    if (mkdtemp(name.data()) != nullptr) path_ = name;
  }
  ~ProfileFolder() {
    std::error_code ignored;
    if (!path_.empty()) fs::remove_all(path_, ignored);
  }
  ProfileFolder(const ProfileFolder&) = delete;
  ProfileFolder& operator=(const ProfileFolder&) = delete;
  [[nodiscard]] const std::string& path() const { return path_; }

 private:
  std::string path_;  ///< empty if the folder could not be made
};

bool isPdf(const std::string& file) {
  std::ifstream in(file, std::ios::binary);
  std::string start(5, '\0');
  return in.read(start.data(), 5) && start == "%PDF-";
}

}  // namespace

std::string missingForPdf() {
  return browser().empty() ? kNoChromium : "";
}

namespace {

std::string print(const ProfileFolder& profile, const std::string& page, const std::string& pdf) {
  const std::string program = browser();
  if (program.empty()) return kNoChromium;
  const std::string printed = profile.path() + "/page.pdf";
  std::vector<std::string> words = {program,
                                    "--headless=new",
                                    "--disable-gpu",
                                    "--no-first-run",
                                    "--no-pdf-header-footer",
                                    "--user-data-dir=" + profile.path() + "/profile",
                                    "--print-to-pdf=" + printed};
  if (geteuid() == 0) words.emplace_back("--no-sandbox");  // as root Chromium refuses to run with a sandbox
  words.push_back("file://" + fs::absolute(page).string());
  if (std::string failure = runProgram(words, "", kNoChromium); !failure.empty()) return failure;
  if (!isPdf(printed))
    return program + " printed nothing";  // Chromium's exit status is 0 even if it printed nothing
  std::error_code error;
  fs::copy_file(printed, pdf, fs::copy_options::overwrite_existing, error);
  return error ? "cannot be written: " + error.message() : "";
}

}  // namespace

std::string printPdf(const std::string& page, const std::string& pdf) {
  const ProfileFolder profile;
  if (profile.path().empty()) return "no temporary folder for Chromium";
  return print(profile, page, pdf);
}

std::string printPdfOf(const std::string& html, const std::string& pdf) {
  const ProfileFolder profile;
  if (profile.path().empty()) return "no temporary folder for Chromium";
  const std::string page = profile.path() + "/page.html";
  std::ofstream(page, std::ios::binary) << html;
  return print(profile, page, pdf);
}

}  // namespace vps::viewer
