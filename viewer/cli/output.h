// SPDX-License-Identifier: BSD-3-Clause
// Results appear whole at the end of a run that succeeded, or not at all; what an earlier run left stays
// until then. What is there and no plain file stays what it is: symbolic links are followed, devices and
// pipes are written directly.
#pragma once

#include <string>
#include <string_view>
#include <vector>

namespace vps::viewer {

/// Throws LoadError when `output` is one of the files that a command reads, under whatever name.
void requireNotRead(const std::string& output, const std::vector<std::string>& inputs);

/// One output file. Opened when the work starts, so that a place that cannot be written is said before it.
class OutputFile {
 public:
  /// Throws LoadError when nothing can be written there, or when it is one of the command's `inputs`. An
  /// empty name is no output: write() then does nothing.
  OutputFile(const std::string& file, const std::vector<std::string>& inputs);
  ~OutputFile();
  OutputFile(const OutputFile&) = delete;
  OutputFile& operator=(const OutputFile&) = delete;

  /// Where to write until commit(): in the same folder, so that the move is atomic; a device or pipe itself.
  [[nodiscard]] const std::string& partial() const { return partial_; }
  /// Writes the whole content and commits it.
  void write(std::string_view bytes);
  /// Puts the partial file in its place. Throws std::runtime_error in words.
  void commit();

 private:
  std::string file_, partial_;
  bool is_stream_ = false;
};

/// A folder of results.
class OutputFolder {
 public:
  /// Makes the folder if need be; throws LoadError when nothing can be written there.
  explicit OutputFolder(const std::string& folder);
  ~OutputFolder();
  OutputFolder(const OutputFolder&) = delete;
  OutputFolder& operator=(const OutputFolder&) = delete;

  /// The folder to fill until commit().
  [[nodiscard]] const std::string& partial() const { return partial_; }
  /// A new file in the folder to fill, with its content.
  void write(const std::string& name, std::string_view bytes) const;
  /// Moves each file into place, over earlier ones of its name. Files of other names stay.
  void commit();

 private:
  std::string folder_, partial_;
  bool is_new_ = false;
};

/// Writes a file; throws std::runtime_error with its name and the reason.
void writeWhole(const std::string& file, std::string_view bytes);

}  // namespace vps::viewer
