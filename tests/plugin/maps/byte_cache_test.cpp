// SPDX-License-Identifier: BSD-3-Clause
// The byte cache returns bytes as they were kept, or nothing.
#include "vps/byte_cache.h"

#include <gtest/gtest.h>

#include <fstream>
#include <iterator>
#include <vector>

#include "support/temporary_folder.h"

namespace vps::test {
namespace {

namespace fs = std::filesystem;

class ByteCacheTest : public testing::Test {
 protected:
  TemporaryFolder folder_;
  std::vector<std::string> warnings_;
  ByteCache cache_{folder_.path() / "cache", [this](const std::string& line) { warnings_.push_back(line); }};
};

TEST_F(ByteCacheTest, FindsWhatWasKeptByWhatItWasMadeFrom) {
  const std::string zeros("a\0b", 3);
  EXPECT_FALSE(cache_.find("one"));
  cache_.keep("one", zeros);
  cache_.keep("two", "");
  EXPECT_EQ(cache_.find("one"), zeros);
  EXPECT_EQ(cache_.find("two"), "");
  EXPECT_FALSE(cache_.find("three"));
  EXPECT_TRUE(warnings_.empty());
}

TEST_F(ByteCacheTest, AFileThatIsCutOrChangedAnywhereIsNotUsedAndReplaced) {
  cache_.keep("one", "some bytes");
  const fs::path file = cache_.fileOf("one");
  const std::string whole = test::bytesOf(file);
  for (std::size_t i = 0; i < whole.size(); ++i) {
    test::write(file, whole.substr(0, i));
    EXPECT_FALSE(cache_.find("one")) << "cut at " << i;
    std::string changed = whole;
    changed[i] ^= 1;
    test::write(file, changed);
    EXPECT_FALSE(cache_.find("one")) << "changed at " << i;
  }
  EXPECT_EQ(warnings_.size(), 2 * whole.size());
  test::write(file, whole + "x");
  EXPECT_FALSE(cache_.find("one"));
  cache_.keep("one", "some bytes");
  EXPECT_EQ(cache_.find("one"), "some bytes");
}

TEST_F(ByteCacheTest, AFileOfSomethingElseIsNotUsed) {
  cache_.keep("one", "some bytes");
  cache_.keep("two", "other bytes");
  fs::copy_file(cache_.fileOf("two"), cache_.fileOf("one"), fs::copy_options::overwrite_existing);
  EXPECT_FALSE(cache_.find("one"));
  ASSERT_EQ(warnings_.size(), 1U);
  EXPECT_NE(warnings_[0].find("other data"), std::string::npos) << warnings_[0];
}

TEST_F(ByteCacheTest, TheLimitRemovesWhatWasNotUsedForLongest) {
  const ByteCache small(folder_.path() / "small", {}, 3000);
  for (const char* name : {"a", "b", "c"}) {
    small.keep(name, std::string(900, 'x'));
    fs::last_write_time(small.fileOf(name),
                        fs::file_time_type::clock::now() - std::chrono::hours('d' - *name));
  }
  EXPECT_TRUE(small.find("a"));  // `a` is now the entry used last
  small.keep("d", std::string(900, 'x'));
  EXPECT_TRUE(small.find("a"));
  EXPECT_FALSE(small.find("b"));
  EXPECT_TRUE(small.find("d"));
}

}  // namespace
}  // namespace vps::test
