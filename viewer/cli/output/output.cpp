// SPDX-License-Identifier: BSD-3-Clause
#include "output/output.h"

#include <cerrno>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <sstream>

#include "output/terminal.h"
#include "vps/errors.h"
#include "vps_viewer/report/pages.h"

namespace vps::viewer {

namespace {

namespace fs = std::filesystem;

[[noreturn]] void failToWrite(const std::string& file, const std::string& reason) {
  throw LoadError(file, "", "cannot be written: " + reason + "; choose another place");
}

/// Whether the path is a device or a pipe, which a rename would replace by a file.
bool isStream(const fs::path& path) {
  std::error_code error;
  const fs::file_status status = fs::status(path, error);
  return fs::exists(status) && !fs::is_regular_file(status) && !fs::is_directory(status);
}

/// The target of symbolic links; the target need not exist. A rename onto a link would replace the link
/// itself.
fs::path resolveLinks(fs::path path) {
  constexpr int kMaxLinks = 40;  // as many as Linux follows
  std::error_code error;
  for (int i = 0; i < kMaxLinks && fs::is_symlink(path, error); ++i)
    path = path.parent_path() / fs::read_symlink(path, error);
  return path;
}

/// @param named  file name for messages; `file` may be a temporary file
void writeDirectly(const std::string& file, std::string_view bytes, const std::string& named) {
  errno = 0;
  std::ofstream out(file, std::ios::binary | std::ios::trunc);
  out.write(bytes.data(), static_cast<std::streamsize>(bytes.size()));
  out.close();
  if (!out) failToWrite(named, std::strerror(errno));
}

/// A link in a folder of results may lead to another file system, where a rename fails.
void move(const fs::path& from, const fs::path& to) {
  std::error_code error;
  const fs::path target = resolveLinks(to);
  fs::rename(from, target, error);
  if (error == std::errc::cross_device_link)
    fs::copy_file(from, target, fs::copy_options::overwrite_existing, error);
  if (error) failToWrite(to.string(), error.message());
}

std::string contentOf(const fs::path& file) {
  std::ostringstream out;
  out << std::ifstream(file, std::ios::binary).rdbuf();
  return out.str();
}

}  // namespace

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
  if (isStream(file)) {
    partial_ = file;  // opening a pipe now would end its reader's input when the pipe is closed again
    return;
  }
  whole_.emplace(resolveLinks(file));
  partial_ = whole_->temporary().string();
  errno = 0;
  if (!std::ofstream(partial_, std::ios::binary)) failToWrite(file, std::strerror(errno));
}

void OutputFile::stage(std::string_view bytes) {
  if (!file_.empty()) writeDirectly(partial_, bytes, file_);
}

void OutputFile::write(std::string_view bytes) {
  stage(bytes);
  commit();
}

void OutputFile::commit() {
  if (!whole_) return;
  if (const std::error_code error = whole_->commit()) failToWrite(file_, error.message());
}

OutputFolder::OutputFolder(const std::string& folder) : folder_(folder) {
  std::error_code error;
  is_new_ = !fs::exists(folder_, error);
  if (is_new_) fs::create_directories(folder_, error);
  if (!error && !fs::is_directory(folder_, error))
    throw LoadError(folder_, "", "is not a folder; choose another --out");
  partial_ = (fs::path(folder_) / ("." + std::to_string(processId()) + ".unfinished")).string();
  if (!error) fs::create_directory(partial_, error);
  if (error) throw LoadError(folder_, "", "cannot be written: " + error.message() + "; choose another --out");
}

OutputFolder::~OutputFolder() {
  std::error_code ignored;
  fs::remove_all(partial_, ignored);
  if (is_new_) fs::remove(folder_, ignored);  // succeeds only for an empty folder
}

void OutputFolder::write(const std::string& name, std::string_view bytes) const {
  const fs::path file = fs::path(partial_) / name;
  fs::create_directories(file.parent_path());
  writeWholeFile(file, bytes);
}

void OutputFolder::commit() {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(partial_))
    if (entry.is_regular_file()) files.push_back(entry.path());
  for (const fs::path& file : files) {
    const fs::path to = fs::path(folder_) / file.lexically_relative(partial_);
    fs::create_directories(to.parent_path());
    if (isStream(to))
      writeDirectly(to.string(), contentOf(file), to.string());
    else
      move(file, to);
  }
}

namespace {

const std::string& checked(const std::string& file) {
  if (!file.empty()) requirePdf();
  return file;
}

}  // namespace

void addPdfOption(CLI::App& command, std::string& file) {
  command.add_option("--pdf", file, "write the page as PDF, printed by Chromium")->type_name("FILE");
}

void requirePdf() {
  if (const std::string missing = missingForPdf(); !missing.empty())
    throw LoadError("", "", "--pdf " + missing);
}

void requirePrinted(const std::string& page, const std::string& pdf) {
  OutputFile out(pdf, {page});
  if (const std::string failure = printPdf(page, out.partial()); !failure.empty())
    throw LoadError(pdf, "", "was not made: " + failure);
  out.commit();
}

PdfFile::PdfFile(const std::string& file, const std::vector<std::string>& inputs)
    : file_(checked(file)), out_(file, inputs) {}

void PdfFile::write(const std::string& html) {
  if (file_.empty()) return;
  if (const std::string failure = printPdfOf(html, out_.partial()); !failure.empty())
    throw LoadError(file_, "", "was not made: " + failure);
  out_.commit();
}

}  // namespace vps::viewer
