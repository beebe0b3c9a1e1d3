// SPDX-License-Identifier: BSD-3-Clause
// Detects a file's format, by content before extension. Refuses a file that is cut if its format defines the
// end of a complete file, since a library may read half an assembly without an error.
#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string_view>

#include "import/readers.h"
#include "vps/errors.h"

namespace vps::scenes::import {
namespace {

namespace fs = std::filesystem;

/// The extension without its point.
std::string extensionOf(const fs::path& file) {
  std::string extension = file.extension().string();
  if (!extension.empty()) extension.erase(0, 1);
  return extension;
}

FileFormat byExtension(const std::string& file) {
  const std::string extension = extensionOf(file);
  FileFormat format = formatOfExtension(extension);
  if (format.id == CadFormat::Other)
    std::ranges::transform(extension, std::back_inserter(format.name),
                           [](unsigned char c) { return char(std::toupper(c)); });
  return format;
}

std::string bytes(std::ifstream& in, std::uint64_t at, std::size_t count) {
  std::string text(count, '\0');
  in.clear();
  in.seekg(std::streamoff(at));
  in.read(text.data(), std::streamsize(count));
  text.resize(std::size_t(std::max<std::streamsize>(in.gcount(), 0)));
  return text;
}

std::uint32_t littleEndian(const std::string& four) {
  std::uint32_t value = 0;
  for (int i = 3; i >= 0; --i) value = value << 8 | std::uint8_t(four[std::size_t(i)]);
  return value;
}

FileFormat formatOf(const std::string& head, const std::string& file) {
  const auto startsWith = [&](const char* text) { return head.starts_with(text); };
  const FileFormat by_extension = byExtension(file);
  if (startsWith("ISO-10303-21")) return CadFormat::Step;
  if (startsWith("#VRML")) return CadFormat::Vrml;
  if (startsWith("#Inventor")) return CadFormat::Inventor;
  if (startsWith("DBRep_DrawableShape") || startsWith("CASCADE Topology")) return CadFormat::Brep;
  if (startsWith("glTF") || by_extension.id == CadFormat::Gltf) return CadFormat::Gltf;
  if (startsWith("\x1f\x8b")) {  // gzip: Inventor and VRML files may be compressed
    const CadFormat inner = formatOfExtension(extensionOf(fs::path(file).stem()));  // "wrl" of .wrl.gz
    const bool is_vrml = by_extension.id == CadFormat::Vrml || inner == CadFormat::Vrml;
    return is_vrml ? CadFormat::Vrml : CadFormat::Inventor;
  }
  // An IGES line is 80 columns; the first section's letter is in column 73.
  if (head.size() >= 80 && (head[72] == 'S' || head[72] == 'B') && head.find('\n') >= 80)
    return CadFormat::Iges;
  return by_extension;
}

std::string inSmallLetters(std::string text) {
  std::ranges::transform(text, text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  return text;
}

/// The end of a file, without blanks, empty lines and zero bytes at its end. Long enough for a signature
/// after the end of a STEP file, and for thousands of empty lines.
std::string tailOf(std::ifstream& in, std::uint64_t size) {
  constexpr std::uint64_t kTail = 1 << 16;
  std::string tail = bytes(in, size > kTail ? size - kTail : 0, kTail);
  tail.resize(tail.find_last_not_of(std::string_view(" \r\n\t\0", 5)) + 1);
  return tail;
}

/// An STL file is text if it begins with the word "solid" and has no zero byte; a binary file may begin with
/// that word as well.
bool isWholeStl(std::ifstream& in, std::uint64_t size, const std::string& head) {
  const std::uint64_t binary_size =
      head.size() >= 84 ? 84 + 50 * std::uint64_t(littleEndian(head.substr(80, 4))) : 0;
  if (binary_size == size) return true;
  const std::size_t first = std::min(head.find_first_not_of(" \t\r\n"), head.size());
  if (inSmallLetters(head.substr(first, 5)) != "solid" || head.find('\0') != std::string::npos)
    return binary_size > 0 && size >= binary_size;
  const std::string tail = inSmallLetters(tailOf(in, size));
  const std::size_t end = tail.rfind("endsolid"), facet = tail.rfind("endfacet");
  return end != std::string::npos && (facet == std::string::npos || facet < end);
}

/// True if the file ends as a complete file of this format does.
bool isWhole(CadFormat format, std::ifstream& in, std::uint64_t size, const std::string& head) {
  if (format == CadFormat::Step) return tailOf(in, size).find("END-ISO-10303-21") != std::string::npos;
  if (format == CadFormat::Iges) {
    const std::string tail = tailOf(in, size);
    const std::size_t before = tail.find_last_of("\r\n");
    const std::size_t line = before == std::string::npos ? 0 : before + 1;
    return tail.size() > line + 72 && tail[line + 72] == 'T';  // the terminate section
  }
  if (format == CadFormat::Gltf && head.starts_with("glTF"))
    return head.size() >= 12 && littleEndian(head.substr(8, 4)) == size;
  return format != CadFormat::Stl || isWholeStl(in, size, head);
}

}  // namespace

std::string stem(const std::string& file) {
  fs::path path(file);
  if (path.extension() == ".gz") path = path.stem();
  return path.stem().string();
}

FileFormat detectFormat(const std::string& file) {
  std::error_code error;
  const fs::file_status status = fs::status(file, error);
  if (!fs::exists(status)) throw LoadError(file, "", "no such file; check the path");
  if (fs::is_directory(status)) throw LoadError(file, "", "is a folder; name a CAD file in it");
  if (!fs::is_regular_file(status)) throw LoadError(file, "", "is not a regular file; name a CAD file");
  std::ifstream in(file, std::ios::binary);
  if (!in) throw LoadError(file, "", "cannot be opened; check its permissions");
  const std::uint64_t size = fs::file_size(file, error);
  if (error || size == 0) throw LoadError(file, "", "is empty; export it again");
  const std::string head(withoutByteOrderMark(bytes(in, 0, 1024)));
  const FileFormat format = formatOf(head, file);
  if (!isWhole(format.id, in, size, head)) {
    throw LoadError(file, "",
                    "is truncated or is not in " + format.name + " format (" + std::to_string(size) +
                        " bytes); copy or export it again");
  }
  return format;
}

}  // namespace vps::scenes::import
