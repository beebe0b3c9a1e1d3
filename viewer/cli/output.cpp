// SPDX-License-Identifier: BSD-3-Clause
#include "output.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>
#include <stdexcept>

#include "terminal.h"
#include "vps/load_error.h"

namespace vps::viewer {

namespace {

namespace fs = std::filesystem;

std::string partialName(const std::string& name) {
  return ".partial-" + std::to_string(processId()) + (name.empty() ? "" : "-" + name);
}

/// A device or a pipe: written as it stands, since a rename would put a file in its place.
bool isStream(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

/// The file behind symbolic links, which may be missing yet: a rename onto the link would replace the link.
fs::path throughLinks(fs::path path) {
  constexpr int kMaxLinks = 40;  // as Linux follows
  std::error_code error;
  for (int i = 0; i < kMaxLinks && fs::is_symlink(path, error); ++i)
    path = path.parent_path() / fs::read_symlink(path, error);
  return path;
}

void move(const fs::path& from, const fs::path& to) {
  std::error_code error;
  const fs::path target = throughLinks(to);
  fs::rename(from, target, error);
  if (error == std::errc::cross_device_link)
    fs::copy_file(from, target, fs::copy_options::overwrite_existing, error);
  if (error) throw std::runtime_error(to.string() + ": cannot be written: " + error.message());
}

std::string contentOf(const fs::path& file) {
  std::ostringstream out;
  out << std::ifstream(file, std::ios::binary).rdbuf();
  return out.str();
}

}  // namespace

void writeWhole(const std::string& file, std::string_view bytes) {
  errno = 0;
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) throw std::runtime_error(file + ": cannot be written: " + std::strerror(errno));
}

void requireNotRead(const std::string& output, const std::vector<std::string>& inputs) {
  std::error_code error;
  if (output.empty() || !fs::is_regular_file(output, error)) return;
  for (const std::string& input : inputs)
    if (fs::equivalent(output, input, error))
      throw LoadError(output, "", "is read by this command, which would overwrite it; choose another place");
}

OutputFile::OutputFile(const std::string& file, const std::vector<std::string>& inputs) : file_(file) {
  if (file.empty()) return;
  std::error_code error;
  if (fs::is_directory(file, error)) throw LoadError(file, "", "is a folder; name a file to write");
  requireNotRead(file, inputs);
  is_stream_ = isStream(file);
  if (is_stream_) {
    partial_ = file;  // not tried out: the reader of a pipe would take the end of the trial for the end
    return;
  }
  const fs::path path = throughLinks(file);
  partial_ = (path.parent_path() / partialName(path.filename().string())).string();
  errno = 0;
  if (!std::ofstream(partial_, std::ios::binary)) {
    const std::string reason = std::strerror(errno);
    throw LoadError(file, "", "cannot be written: " + reason + "; choose another place");
  }
}

OutputFile::~OutputFile() {
  std::error_code ignored;
  if (!partial_.empty() && !is_stream_) fs::remove(partial_, ignored);
}

void OutputFile::write(std::string_view bytes) {
  if (file_.empty()) return;
  writeWhole(partial_, bytes);
  commit();
}

void OutputFile::commit() {
  if (!file_.empty() && !is_stream_) move(partial_, file_);
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
    if (isStream(to))
      writeWhole(to.string(), contentOf(file));
    else
      move(file, to);
  }
}

}  // namespace vps::viewer
