// SPDX-License-Identifier: BSD-3-Clause
// Detects a file's format, by content before extension. Refuses a file that is cut if its format defines the
// end of a complete file, since a library may read half an assembly without an error.
#include <algorithm>
#include <cctype>
#include <cstdint>
#include <filesystem>
#include <fstream>
#include <iterator>

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

/// True if the file ends as a complete file of this format does.
bool isWhole(CadFormat format, std::ifstream& in, std::uint64_t size, const std::string& head) {
  const std::uint64_t tail_at = size > 1024 ? size - 1024 : 0;
  if (format == CadFormat::Step)
    return bytes(in, tail_at, 1024).find("END-ISO-10303-21") != std::string::npos;
  if (format == CadFormat::Iges) {
    const std::string tail = bytes(in, tail_at, 1024);
    const std::size_t last = tail.find_last_not_of(" \r\n\t");
    if (last == std::string::npos) return false;
    const std::size_t before = tail.find_last_of("\r\n", last);
    const std::size_t line = before == std::string::npos ? 0 : before + 1;
    return last - line >= 72 && tail[line + 72] == 'T';  // the terminate section
  }
  if (format == CadFormat::Gltf && head.starts_with("glTF"))
    return head.size() >= 12 && littleEndian(head.substr(8, 4)) == size;
  if (format == CadFormat::Stl && head.starts_with("solid") && head.find("facet") != std::string::npos) {
    return bytes(in, tail_at, 1024).find("endsolid") != std::string::npos;
  }
  if (format == CadFormat::Stl)
    return head.size() >= 84 && size >= 84 + 50 * std::uint64_t(littleEndian(head.substr(80, 4)));
  return true;
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
