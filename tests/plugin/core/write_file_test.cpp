// SPDX-License-Identifier: BSD-3-Clause
#include "vps/write_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <string>

#include "support/temporary_folder.h"
#include "vps/errors.h"

namespace vps {
namespace {

namespace fs = std::filesystem;

std::string contentOf(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  return {std::istreambuf_iterator<char>(in), std::istreambuf_iterator<char>()};
}

std::ptrdiff_t fileCount(const fs::path& folder) {
  return std::distance(fs::directory_iterator(folder), fs::directory_iterator());
}

TEST(WriteFile, ReplacesTheWholeContentAndLeavesNoOtherFile) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "a.bin";
  writeWholeFile(file, "a long first content");
  writeWholeFile(file, std::string_view("sh\0rt", 5));
  EXPECT_EQ(contentOf(file), std::string("sh\0rt", 5));
  EXPECT_EQ(fileCount(file.parent_path()), 1);
}

TEST(WriteFile, AFailureNamesTheFileAndTheReasonAndLeavesTheTarget) {
  const test::TemporaryFolder folder;
  fs::create_directory(folder.path() / "target");
  try {
    writeWholeFile(folder.path() / "target", "bytes");
    FAIL() << "a folder was replaced by a file";
  } catch (const LoadError& error) {
    EXPECT_NE(std::string(error.what()).find("target: cannot be written: "), std::string::npos)
        << error.what();
  }
  EXPECT_TRUE(fs::is_directory(folder.path() / "target"));
  EXPECT_EQ(fileCount(folder.path()), 1) << "the temporary file is left";
  EXPECT_THROW(writeWholeFile(folder.path() / "no such folder/a", "bytes"), LoadError);
}

TEST(WriteFile, AnAbandonedFileIsRemovedAndTheTargetKeepsItsContent) {
  const test::TemporaryFolder folder;
  const fs::path file = folder.path() / "a.txt";
  writeWholeFile(file, "old");
  {
    const WholeFile first(file), second(file);
    EXPECT_NE(first.temporary(), second.temporary());
    std::ofstream(first.temporary()) << "new";
  }
  EXPECT_EQ(contentOf(file), "old");
  EXPECT_EQ(fileCount(file.parent_path()), 1);
}

TEST(WriteFile, CommitReplacesTheTarget) {
  const test::TemporaryFolder folder;
  WholeFile whole(folder.path() / "a.txt");
  std::ofstream(whole.temporary()) << "new";
  EXPECT_FALSE(fs::exists(whole.target()));
  EXPECT_FALSE(whole.commit());
  EXPECT_EQ(contentOf(whole.target()), "new");
}

}  // namespace
}  // namespace vps
