// SPDX-License-Identifier: BSD-3-Clause
// Shared memory of a session: access, live processes, and remains of a crash.
#include "link/shared_region.h"

#include <gtest/gtest.h>
#include <signal.h>
#include <sys/mman.h>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

#include <filesystem>
#include <functional>

#include "scenes/session_name.h"
#include "vps/errors.h"

namespace vps::scenes {
namespace {

std::filesystem::path fileOf(const std::string& name) {
  return "/dev/shm/bullet-vps." + std::to_string(getuid()) + "." + name;
}

std::string refusal(const std::function<void()>& act) {
  try {
    act();
  } catch (const LoadError& error) {
    return error.what();
  }
  return "";
}

/// A process that does its work, reports completion, and sleeps until it is killed.
class Sleeper {
 public:
  explicit Sleeper(const std::function<void()>& work) {
    int ready[2];
    if (pipe(ready) != 0) throw std::runtime_error("no pipe");
    id_ = fork();
    if (id_ == 0) {
      work();
      const char done = 1;
      if (write(ready[1], &done, 1) != 1) _exit(1);
      for (;;) pause();
    }
    char done = 0;
    EXPECT_EQ(read(ready[0], &done, 1), 1);
    close(ready[0]);
    close(ready[1]);
  }
  ~Sleeper() { killNow(); }
  void killNow() {
    if (id_ <= 0) return;
    kill(id_, SIGKILL);
    waitpid(id_, nullptr, 0);
    id_ = 0;
  }

 private:
  pid_t id_ = 0;
};

TEST(SharedRegion, ItsUserAloneCanOpenItAndItsNameGoesWithIt) {
  const std::string name = sessionName("test");
  {
    const SharedRegion region = SharedRegion::create(name, 4096);
    struct stat status {};
    ASSERT_EQ(stat(fileOf(name).c_str(), &status), 0);
    EXPECT_EQ(status.st_mode & 0777u, 0600u);
    region.memory()[100] = std::byte{42};
    const SharedRegion other = SharedRegion::open(name, false);
    ASSERT_TRUE(other.isOpen());
    EXPECT_EQ(other.memory()[100], std::byte{42});
  }
  EXPECT_FALSE(std::filesystem::exists(fileOf(name)));
  EXPECT_FALSE(SharedRegion::open(name, false).isOpen());
}

TEST(SharedRegion, OneThatOthersCouldHaveWrittenToIsRefused) {
  const std::string name = sessionName("test");
  const SharedRegion region = SharedRegion::create(name, 4096);
  ASSERT_EQ(chmod(fileOf(name).c_str(), 0666), 0);
  EXPECT_NE(refusal([&] { SharedRegion::open(name, true); }).find("accessible to other users"),
            std::string::npos);
}

TEST(SharedRegion, ASecondOwnerIsRefusedWhileTheFirstLives) {
  const std::string name = sessionName("test");
  const Sleeper owner([&] { new SharedRegion(SharedRegion::create(name, 4096)); });
  EXPECT_NE(refusal([&] { SharedRegion::create(name, 4096); }).find("another vps render"), std::string::npos);
  EXPECT_TRUE(std::filesystem::exists(fileOf(name)));
  removeDeadRegions();
  removeIfDead(name);
  EXPECT_TRUE(std::filesystem::exists(fileOf(name)));
}

TEST(SharedRegion, WhatAKilledOwnerLeavesIsReplacedByANewEmptyOne) {
  const std::string name = sessionName("test");
  Sleeper owner([&] {
    auto* region = new SharedRegion(SharedRegion::create(name, 4096));
    region->memory()[0] = std::byte{1};
  });
  const SharedRegion old = SharedRegion::open(name, true);
  EXPECT_TRUE(old.isTaken(NodeRole::Render));
  owner.killNow();
  EXPECT_FALSE(old.isTaken(NodeRole::Render));
  const SharedRegion region = SharedRegion::create(name, 4096);
  EXPECT_EQ(region.memory()[0], std::byte{0});
  EXPECT_EQ(old.memory()[0], std::byte{1});  // the old region stays valid for processes that have it open
  EXPECT_TRUE(SharedRegion::open(name, false).isTaken(NodeRole::Render));
}

TEST(SharedRegion, WhatAKilledOwnerLeavesIsRemovedByTheNextSessionOfAnyName) {
  const std::string name = sessionName("test");
  Sleeper owner([&] { new SharedRegion(SharedRegion::create(name, 4096)); });
  owner.killNow();
  EXPECT_TRUE(std::filesystem::exists(fileOf(name)));
  EXPECT_GE(removeDeadRegions(), 1u);
  EXPECT_FALSE(std::filesystem::exists(fileOf(name)));
}

TEST(SharedRegion, ARoleBelongsToOneProcessUntilThatDies) {
  const std::string name = sessionName("test");
  const SharedRegion region = SharedRegion::create(name, 4096);
  EXPECT_FALSE(region.isTaken(NodeRole::Device));
  Sleeper device([&] {
    auto* joined = new SharedRegion(SharedRegion::open(name, true));
    if (!joined->take(NodeRole::Device)) _exit(1);
  });
  EXPECT_TRUE(region.isTaken(NodeRole::Device));
  EXPECT_FALSE(SharedRegion::open(name, true).take(NodeRole::Device));
  device.killNow();
  EXPECT_FALSE(region.isTaken(NodeRole::Device));
  EXPECT_TRUE(SharedRegion::open(name, true).take(NodeRole::Device));
}

TEST(SharedRegion, NamesThatCouldLeadElsewhereAreRefused) {
  for (const std::string name : {"", "a/b", "..", "a b", "a\n", "123456789012345678901234567890123"})
    EXPECT_NE(refusal([&] { SharedRegion::create(name, 64); }).find("letters"), std::string::npos) << name;
  EXPECT_EQ(refusal([] { requireSessionName("Desk-2_b"); }), "");
}

}  // namespace
}  // namespace vps::scenes
