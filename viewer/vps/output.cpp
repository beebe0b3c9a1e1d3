// SPDX-License-Identifier: BSD-3-Clause
#include "output.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <stdexcept>
#include <vector>

#include "terminal.h"
#include "vps/load_error.h"

namespace vps {

namespace {

namespace fs = std::filesystem;

std::string partialName(const std::string& name) {
  return ".partial-" + std::to_string(processId()) + (name.empty() ? "" : "-" + name);
}

void move(const fs::path& from, const fs::path& to) {
  std::error_code error;
  fs::rename(from, to, error);
  if (error) throw std::runtime_error(to.string() + ": cannot be written: " + error.message());
}

}  // namespace

void writeWhole(const std::string& file, std::string_view bytes) {
  errno = 0;
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) throw std::runtime_error(file + ": cannot be written: " + std::strerror(errno));
}

OutputFile::OutputFile(const std::string& file) : file_(file) {
  if (file.empty()) return;
  const fs::path path(file);
  std::error_code error;
  if (fs::is_directory(path, error)) throw LoadError(file, "", "is a folder; name a file to write");
  partial_ = (path.parent_path() / partialName(path.filename().string())).string();
  errno = 0;
  if (!std::ofstream(partial_, std::ios::binary)) {
    const std::string reason = std::strerror(errno);
    throw LoadError(file, "", "cannot be written: " + reason + "; choose another place");
  }
}

OutputFile::~OutputFile() {
  std::error_code ignored;
  if (!partial_.empty()) fs::remove(partial_, ignored);
}

void OutputFile::write(std::string_view bytes) {
  if (file_.empty()) return;
  writeWhole(partial_, bytes);
  commit();
}

void OutputFile::commit() {
  if (!file_.empty()) move(partial_, file_);
}

OutputFolder::OutputFolder(const std::string& folder) : folder_(folder) {
  std::error_code error;
  is_new_ = !fs::exists(folder_, error);
  if (is_new_) fs::create_directories(folder_, error);
  if (!error && !fs::is_directory(folder_, error))
    throw LoadError(folder_, "", "is not a folder; choose another --out");
  partial_ = (fs::path(folder_) / partialName("")).string();
  if (!error) fs::create_directory(partial_, error);
  if (error) throw LoadError(folder_, "", "cannot be written: " + error.message() + "; choose another --out");
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  fs::remove_all(partial_, ignored);
  if (is_new_) fs::remove(folder_, ignored);  // only if nothing came into it
}

void OutputFolder::write(const std::string& name, std::string_view bytes) const {
  const fs::path file = fs::path(partial_) / name;
  fs::create_directories(file.parent_path());
  writeWhole(file.string(), bytes);
}

void OutputFolder::commit() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(partial_))
    if (entry.is_regular_file()) files.push_back(entry.path());
  for (const fs::path& file : files) {
    const fs::path to = fs::path(folder_) / file.lexically_relative(partial_);
    fs::create_directories(to.parent_path());
    move(file, to);
  }
}

}  // namespace vps
