// SPDX-License-Identifier: BSD-3-Clause
// The space mouse, simulated by a daemon of the test that answers libspnav through SPNAV_SOCKET.
#include <gtest/gtest.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <array>
#include <chrono>
#include <cstdlib>
#include <cstring>
#include <thread>

#include "support/device/fake_device.h"
#include "support/no_alloc.h"
#include "support/temporary_folder.h"
#include "vps/errors.h"
#include "vps_device/rate_control.h"

namespace vps::device {
namespace {

using test::isThere;
using test::within10s;

using Packet = std::array<std::int32_t, 8>;
constexpr std::int32_t kMotion = 0, kPress = 1, kRelease = 2, kDevice = 3;

/// Stands for spacenavd: listens, answers the handshake, sends events.
class FakeDaemon {
 public:
  explicit FakeDaemon(const std::string& socket_file) : file_(socket_file) {
    listener_ = socket(AF_UNIX, SOCK_STREAM, 0);
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::strncpy(address.sun_path, file_.c_str(), sizeof address.sun_path - 1);
    if (bind(listener_, reinterpret_cast<sockaddr*>(&address), sizeof address) != 0 ||
        listen(listener_, 1) != 0)
      ADD_FAILURE() << std::strerror(errno);
  }
  ~FakeDaemon() {
    if (client_ >= 0) close(client_);
    close(listener_);
    unlink(file_.c_str());
  }
  FakeDaemon(const FakeDaemon&) = delete;
  FakeDaemon& operator=(const FakeDaemon&) = delete;

  /// Waits for a client, and returns the number that it sends, which agrees on protocol 1.
  void acceptClient() {
    pollfd waited{listener_, POLLIN, 0};
    ASSERT_EQ(::poll(&waited, 1, 10'000), 1) << "no client connected";
    client_ = accept(listener_, nullptr, nullptr);
    std::int32_t request = 0;
    ASSERT_EQ(recv(client_, &request, sizeof request, MSG_WAITALL), 4);
    EXPECT_EQ(request & 0x7fffff00, 0x7faa5500);
    ASSERT_EQ(send(client_, &request, sizeof request, MSG_NOSIGNAL), 4);
  }
  void sendPacket(const Packet& packet) {
    ASSERT_EQ(send(client_, packet.data(), sizeof packet, MSG_NOSIGNAL), static_cast<ssize_t>(sizeof packet));
  }

 private:
  std::string file_;
  int listener_ = -1, client_ = -1;
};

class SpaceMouse : public testing::Test {
 protected:
  void SetUp() override {
    setenv("SPNAV_SOCKET", file_.c_str(), 1);
    try {
      device_ = openSpaceMouse();
    } catch (const LoadError& error) {
      GTEST_SKIP() << error.what();
    }
  }
  void TearDown() override {
    device_.reset();
    unsetenv("SPNAV_SOCKET");
  }

  test::TemporaryFolder folder_;
  std::string file_ = folder_.path() / "spnav.sock";
  std::unique_ptr<Device> device_;
};

TEST_F(SpaceMouse, WithoutADaemonItIsLostAndFoundOnceOneStarts) {
  for (int i = 0; i < 100; ++i) EXPECT_EQ(device_->read().status, Status::Fault);
  FakeDaemon daemon(file_);
  daemon.acceptClient();
  EXPECT_TRUE(within10s(*device_, isThere));
}

TEST_F(SpaceMouse, EachAxisMovesTheHandleInItsOwnDirection) {
  FakeDaemon daemon(file_);
  daemon.acceptClient();
  ASSERT_TRUE(within10s(*device_, isThere));
  // libspnav: x right, y up, z away from the person. D: x towards the person, y right, z up.
  const struct {
    Packet packet;
    Vec3 v, w;
  } cases[] = {
      {{kMotion, 350, 0, 0, 0, 0, 0, 16}, Vec3::UnitY(), Vec3::Zero()},
      {{kMotion, 0, 350, 0, 0, 0, 0, 16}, Vec3::UnitZ(), Vec3::Zero()},
      {{kMotion, 0, 0, 350, 0, 0, 0, 16}, -Vec3::UnitX(), Vec3::Zero()},
      {{kMotion, 0, 0, 0, 350, 0, 0, 16}, Vec3::Zero(), Vec3::UnitY()},
      {{kMotion, 0, 0, 0, 0, 350, 0, 16}, Vec3::Zero(), Vec3::UnitZ()},
      {{kMotion, 0, 0, 0, 0, 0, 350, 16}, Vec3::Zero(), -Vec3::UnitX()},
  };
  for (const auto& c : cases) {
    daemon.sendPacket(c.packet);
    EXPECT_TRUE(within10s(*device_,
                          [&](const DeviceSample& s) {
                            return (s.V_DH.v - 0.08 * c.v).norm() < 1e-9 &&
                                   (s.V_DH.w - 0.8 * c.w).norm() < 1e-9;
                          }))
        << c.packet[1] << c.packet[2] << c.packet[3];
  }
  daemon.sendPacket({kMotion, 20, 30, -34, 10, 0, -30, 16});  // less than a tenth of 350: at rest
  EXPECT_TRUE(within10s(*device_, [](const DeviceSample& s) {
    return s.V_DH.v.isZero(0) && s.V_DH.w.isZero(0) && s.X_DH.p.norm() > 0;
  }));
}

TEST_F(SpaceMouse, Button0Recentres) {
  FakeDaemon daemon(file_);
  daemon.acceptClient();
  ASSERT_TRUE(within10s(*device_, isThere));
  daemon.sendPacket({kMotion, 350, 0, 0, 0, 0, 0, 16});
  ASSERT_TRUE(within10s(*device_, [](const DeviceSample& s) { return s.X_DH.p.y() > 0.005; }));
  daemon.sendPacket({kPress, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_TRUE(within10s(*device_, [](const DeviceSample& s) { return s.X_DH.p.norm() < 1e-12; }));
  daemon.sendPacket({kRelease, 0, 0, 0, 0, 0, 0, 0});  // the cap is still pushed
  EXPECT_TRUE(within10s(*device_, [](const DeviceSample& s) { return s.X_DH.p.y() > 0.001; }));
}

TEST_F(SpaceMouse, ADaemonThatEndsWhileTheCapIsPushedStopsTheHandleAndANewOneIsFound) {
  Vec3 p_lost;
  {
    FakeDaemon daemon(file_);
    daemon.acceptClient();
    ASSERT_TRUE(within10s(*device_, isThere));
    daemon.sendPacket({kMotion, 350, 0, 0, 0, 0, 0, 16});
    ASSERT_TRUE(within10s(*device_, [](const DeviceSample& s) { return s.X_DH.p.y() > 0.001; }));
  }
  ASSERT_TRUE(within10s(*device_, [&](const DeviceSample& s) {
    p_lost = s.X_DH.p;
    return s.status == Status::Fault;
  }));
  std::this_thread::sleep_for(std::chrono::milliseconds(20));
  EXPECT_EQ(device_->read().X_DH.p, p_lost);
  FakeDaemon again(file_);
  again.acceptClient();
  ASSERT_TRUE(within10s(*device_, isThere));
  EXPECT_EQ(device_->read().X_DH.p, p_lost);
}

TEST_F(SpaceMouse, AnUnpluggedMouseIsLostUntilItIsBack) {
  FakeDaemon daemon(file_);
  daemon.acceptClient();
  ASSERT_TRUE(within10s(*device_, isThere));
  daemon.sendPacket({kDevice, 1, 0, 0, 0, 0, 0, 0});
  EXPECT_TRUE(within10s(*device_, [](const DeviceSample& s) { return s.status == Status::Fault; }));
  daemon.sendPacket({kDevice, 0, 0, 0, 0, 0, 0, 0});
  EXPECT_TRUE(within10s(*device_, isThere));
}

TEST_F(SpaceMouse, ASecondOneIsRefusedWithAMessage) {
  EXPECT_THROW(openSpaceMouse(), LoadError);
  device_.reset();
  device_ = openSpaceMouse();
  EXPECT_EQ(device_->name(), "space_mouse");
}

TEST_F(SpaceMouse, ReadingNeverAllocates) {
  FakeDaemon daemon(file_);
  daemon.acceptClient();
  ASSERT_TRUE(within10s(*device_, isThere));
  daemon.sendPacket({kMotion, 350, 0, 0, 0, 0, 0, 16});
  const vps_test::NoAllocScope guard;
  for (int i = 0; i < 10'000; ++i) {
    device_->read();
    device_->write({});
  }
}

}  // namespace
}  // namespace vps::device
