// SPDX-License-Identifier: BSD-3-Clause
// Requests within a machine, over a socket with an abstract name (Linux). Such names vanish with their
// process, and the system tells each end the other's user. Only this file uses these POSIX calls.
#include <poll.h>
#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <utility>
#include <vector>

#include "link/shared_region.h"
#include "requests/request_channel.h"
#include "vps/errors.h"

namespace vps::scenes {

namespace {

constexpr std::size_t kMostConnected = 16;  // limit of connections of this user
constexpr std::size_t kMostStrangers = 4;   // limit of connections of other users, who only get a refusal

class Socket {
 public:
  explicit Socket(int file) : file_(file) {}
  Socket(Socket&& other) noexcept : file_(std::exchange(other.file_, -1)) {}
  Socket& operator=(Socket&& other) noexcept {
    std::swap(file_, other.file_);
    return *this;
  }
  Socket(const Socket&) = delete;
  Socket& operator=(const Socket&) = delete;
  ~Socket() {
    if (file_ >= 0) close(file_);
  }
  [[nodiscard]] int file() const { return file_; }

 private:
  int file_;
};

struct Name {
  sockaddr_un address{};
  socklen_t size = 0;
};

Name socketName(const std::string& session, uid_t user) {
  requireSessionName(session);
  Name name;
  name.address.sun_family = AF_UNIX;
  const std::string text = "bullet-vps." + std::to_string(user) + "." + session + ".requests";
  std::memcpy(name.address.sun_path + 1, text.data(),
              text.size());  // an abstract name starts with a zero byte
  name.size = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + 1 + text.size());
  return name;
}

Socket newSocket(int flags) {
  Socket socket(::socket(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC | flags, 0));
  if (socket.file() < 0)
    throw LoadError("", "", std::string("no socket can be created: ") + std::strerror(errno));
  return socket;
}

/// The user at the other end; empty: the other end has closed.
std::optional<uid_t> userOf(int file) {
  ucred peer{};
  socklen_t size = sizeof peer;
  if (getsockopt(file, SOL_SOCKET, SO_PEERCRED, &peer, &size) != 0) return {};
  return peer.uid;
}

bool isTrusted(uid_t user) {
  return user == getuid() || user == 0;
}

/// Received bytes, possibly none; no value: the other end has closed.
std::optional<std::string> receiveFrom(int file) {
  std::string bytes(kLongestAsk, '\0');
  const ssize_t size = recv(file, bytes.data(), bytes.size(), MSG_DONTWAIT);
  if (size < 0 && (errno == EAGAIN || errno == EINTR)) return std::string();
  if (size <= 0) return {};
  bytes.resize(static_cast<std::size_t>(size));
  return bytes;
}

bool waitFor(std::vector<pollfd>& files, std::chrono::milliseconds limit) {
  return poll(files.data(), files.size(), static_cast<int>(limit.count())) > 0;
}

class LocalServer final : public ServerChannel {
 public:
  explicit LocalServer(const std::string& session) : listener_(newSocket(SOCK_NONBLOCK)) {
    const Name name = socketName(session, getuid());
    if (bind(listener_.file(), reinterpret_cast<const sockaddr*>(&name.address), name.size) != 0)
      throw LoadError("", "",
                      sessionWords(session) + (errno == EADDRINUSE
                                                   ? ": another vps render already runs this session; choose "
                                                     "another --session, or stop that vps render"
                                                   : std::string(": the request socket cannot be opened: ") +
                                                         std::strerror(errno)));
    if (listen(listener_.file(), static_cast<int>(kMostConnected)) != 0)
      throw LoadError(
          "", "", sessionWords(session) + ": the request socket cannot be opened: " + std::strerror(errno));
  }

  std::optional<IncomingRequest> receive(std::chrono::milliseconds limit) override {
    std::vector<pollfd> files = {{listener_.file(), POLLIN, 0}};
    for (const Client& client : clients_) files.push_back({client.socket.file(), POLLIN, 0});
    if (!waitFor(files, limit)) return {};
    const std::size_t known = clients_.size();
    for (std::size_t i = 0; i < known; ++i) {
      if (files[i + 1].revents == 0) continue;
      std::optional<std::string> bytes = receiveFrom(files[i + 1].fd);
      if (bytes && bytes->empty()) continue;
      const Client& client = clients_[i];
      const std::uint64_t number = client.number;
      const bool is_stranger = client.is_stranger;
      if (!bytes) {
        clients_.erase(clients_.begin() + static_cast<std::ptrdiff_t>(i));
        return {};
      }
      // The served client moves to the end of the list, so that a client that sends continuously does not
      // block the others.
      std::rotate(clients_.begin() + static_cast<std::ptrdiff_t>(i),
                  clients_.begin() + static_cast<std::ptrdiff_t>(i) + 1, clients_.end());
      if (files[0].revents != 0) accept();
      return IncomingRequest{number, std::move(*bytes), is_stranger};
    }
    if (files[0].revents != 0) accept();
    return {};
  }
  void answer(std::uint64_t to, std::string_view bytes) override {
    const auto client =
        std::find_if(clients_.begin(), clients_.end(), [to](const Client& one) { return one.number == to; });
    if (client == clients_.end()) return;
    send(client->socket.file(), bytes.data(), bytes.size(), MSG_DONTWAIT | MSG_NOSIGNAL);
    if (client->is_stranger) clients_.erase(client);
  }

 private:
  struct Client {
    Socket socket;
    std::uint64_t number;
    bool is_stranger;
  };

  void accept() {
    Socket socket(accept4(listener_.file(), nullptr, nullptr, SOCK_CLOEXEC | SOCK_NONBLOCK));
    if (socket.file() < 0) return;
    const std::optional<uid_t> user = userOf(socket.file());
    if (!user) return;
    const bool is_stranger = !isTrusted(*user);
    const auto is_alike = [is_stranger](const Client& one) { return one.is_stranger == is_stranger; };
    const auto alike = static_cast<std::size_t>(std::count_if(clients_.begin(), clients_.end(), is_alike));
    if (alike >= (is_stranger ? kMostStrangers : kMostConnected))
      clients_.erase(std::find_if(clients_.begin(), clients_.end(),
                                  is_alike));  // the client that was silent for longest
    clients_.push_back({std::move(socket), ++count_, is_stranger});
  }

  Socket listener_;
  std::vector<Client> clients_;
  std::uint64_t count_ = 0;
};

class LocalClient final : public ClientChannel {
 public:
  explicit LocalClient(Socket socket) : socket_(std::move(socket)) {}
  /// If the other end does not read, a message that does not fit is dropped; the caller repeats it later.
  void send(std::string_view bytes) override {
    if (::send(socket_.file(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT) < 0)
      is_over_ = errno != EAGAIN && errno != ENOBUFS && errno != EINTR;
  }
  std::string receive(std::chrono::milliseconds limit) override {
    std::vector<pollfd> files = {{socket_.file(), POLLIN, 0}};
    if (is_over_ || !waitFor(files, limit)) return {};
    std::optional<std::string> bytes = receiveFrom(socket_.file());
    is_over_ = !bytes;
    return bytes.value_or("");
  }
  [[nodiscard]] bool isOver() const override { return is_over_; }

 private:
  Socket socket_;
  bool is_over_ = false;
};

}  // namespace

std::unique_ptr<ServerChannel> makeLocalServer(const std::string& session) {
  return std::make_unique<LocalServer>(session);
}

std::unique_ptr<ClientChannel> findLocalServer(const std::string& session, uid_t user) {
  const Name name = socketName(session, user);
  Socket socket = newSocket(SOCK_NONBLOCK);
  if (connect(socket.file(), reinterpret_cast<const sockaddr*>(&name.address), name.size) != 0) {
    if (errno == EAGAIN)
      throw LoadError("", "", sessionWords(session) + ": the session's vps render does not respond");
    return nullptr;
  }
  // Any user may bind a free name, so the owner of the socket is checked.
  if (const std::optional<uid_t> owner = userOf(socket.file()); !owner || (*owner != user && *owner != 0))
    throw LoadError("", "",
                    sessionWords(session) + ": the session's name is used by a program of another user");
  return std::make_unique<LocalClient>(std::move(socket));
}

}  // namespace vps::scenes
