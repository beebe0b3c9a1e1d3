// SPDX-License-Identifier: BSD-3-Clause
#include "import/child_processes.h"

#include <algorithm>
#include <optional>
#include <thread>

#if defined(__unix__)
#include <atomic>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <filesystem>
#include <iterator>
#include <new>
#include <system_error>

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif
#endif

#if defined(__SANITIZE_ADDRESS__)
#define VPS_ADDRESS_SANITIZER
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define VPS_ADDRESS_SANITIZER
#endif
#endif

namespace vps::scenes::import {

namespace {

using Make = std::function<std::string(std::size_t)>;
using Results = std::vector<std::optional<std::string>>;

#if defined(__unix__)

struct Header {
  std::uint64_t index = 0, size = 0;
};

bool writeAll(int to, const void* data, std::size_t size) {
  for (auto* from = static_cast<const char*>(data); size > 0;) {
    const ssize_t count = ::write(to, from, size);
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return false;
    from += count;
    size -= static_cast<std::size_t>(count);
  }
  return true;
}

/// Runs a copy. @param parent the process that forked this copy
[[noreturn]] void runCopy(pid_t parent, int to, SharedCounter& counter, const std::vector<std::size_t>& order,
                          const Make& make) noexcept {
#ifdef __linux__
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
#endif
  if (::getppid() != parent) ::_exit(1);  // the parent ended before prctl()
  try {
    for (std::size_t k = counter.add(1); k < order.size(); k = counter.add(1)) {
      const std::string result = make(order[k]);
      const Header header{order[k], result.size()};
      if (!writeAll(to, &header, sizeof header) || !writeAll(to, result.data(), result.size())) break;
    }
    ::_exit(0);
  } catch (...) {  // the parent makes the missing results, and throws the same exception
    ::_exit(1);
  }
}

/// A copy and the bytes that it has sent so far.
struct Copy {
  pid_t id = -1;
  int from = -1;
  std::string received;
};

/// Takes complete results out of the bytes that a copy has sent.
void takeResults(Copy& copy, Results& results, const std::function<void()>& done) {
  std::size_t at = 0;
  for (Header header; copy.received.size() - at >= sizeof header;) {
    copy.received.copy(reinterpret_cast<char*>(&header), sizeof header, at);
    if (copy.received.size() - at - sizeof header < header.size) break;
    at += sizeof header;
    if (header.index < results.size()) results[header.index] = copy.received.substr(at, header.size);
    at += header.size;
    if (done) done();
  }
  copy.received.erase(0, at);
}

/// Reads the available bytes; false at the end of the pipe.
bool receive(Copy& copy) {
  constexpr std::size_t kBuffer = 1 << 20;
  const std::size_t before = copy.received.size();
  copy.received.resize(before + kBuffer);
  ssize_t count = 0;
  do count = ::read(copy.from, copy.received.data() + before, kBuffer);
  while (count < 0 && errno == EINTR);
  copy.received.resize(before + static_cast<std::size_t>(std::max<ssize_t>(0, count)));
  return count > 0;
}

/// All copies of this process that were forked as workers. The destructor ends copies that still run.
class Copies {
 public:
  ~Copies() {
    for (Copy& copy : copies_) {
      if (copy.from >= 0) {
        ::close(copy.from);
        ::kill(copy.id, SIGKILL);
      }
      while (::waitpid(copy.id, nullptr, 0) < 0 && errno == EINTR) {
      }
    }
  }
  Copies() = default;
  Copies(const Copies&) = delete;
  Copies& operator=(const Copies&) = delete;

  void start(SharedCounter& counter, const std::vector<std::size_t>& order, const Make& make) {
    int ends[2];
    if (::pipe(ends) != 0) return;
    for (const int end : ends) ::fcntl(end, F_SETFD, FD_CLOEXEC);
    const pid_t parent = ::getpid(), id = ::fork();
    if (id == 0) {
      ::close(ends[0]);
      for (const Copy& other : copies_) ::close(other.from);
      runCopy(parent, ends[1], counter, order, make);
    }
    ::close(ends[1]);
    if (id < 0) {
      ::close(ends[0]);
      return;
    }
    copies_.push_back({id, ends[0], {}});
  }

  void collect(Results& results, const std::function<void()>& done, const std::function<void()>& look) {
    constexpr int kLook_ms = 200;
    for (;;) {
      std::vector<pollfd> waiting;
      for (const Copy& copy : copies_)
        if (copy.from >= 0) waiting.push_back({copy.from, POLLIN, 0});
      if (waiting.empty()) return;
      if (::poll(waiting.data(), waiting.size(), look ? kLook_ms : -1) < 0 && errno != EINTR) return;
      if (look) look();
      for (const pollfd& one : waiting) {
        if (one.revents == 0) continue;
        Copy& copy = *std::ranges::find(copies_, one.fd, &Copy::from);
        if (receive(copy)) {
          takeResults(copy, results, done);
        } else {
          ::close(copy.from);
          copy.from = -1;
        }
      }
    }
  }

 private:
  std::vector<Copy> copies_;
};

#endif

}  // namespace

#if defined(__unix__)
SharedCounter::SharedCounter()
    : memory_(::mmap(nullptr, sizeof(Counter), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) {
  if (memory_ == MAP_FAILED)
    memory_ = nullptr;
  else
    counter_ = new (memory_) Counter(0);
}
SharedCounter::~SharedCounter() {
  if (memory_ != nullptr) ::munmap(memory_, sizeof(Counter));
}
#else
SharedCounter::SharedCounter() = default;
SharedCounter::~SharedCounter() = default;
#endif

long processNumber() {
#if defined(__unix__)
  return ::getpid();
#else
  return 0;
#endif
}

std::size_t SharedCounter::add(std::size_t count) {
  return counter_->fetch_add(count);
}

std::size_t SharedCounter::value() const {
  return counter_->load();
}

bool mayFork() {
#if !defined(__unix__)
  return false;
#elif defined(VPS_ADDRESS_SANITIZER)
  std::error_code error;
  const std::filesystem::directory_iterator tasks("/proc/self/task", error);
  return !error && std::distance(begin(tasks), end(tasks)) == 1;
#else
  return true;
#endif
}

std::vector<std::string> madeInCopies(const std::vector<std::size_t>& order, const Make& make,
                                      const std::function<void()>& done, std::size_t copies,
                                      const std::function<void()>& look) {
  Results results(order.size());
#if defined(__unix__)
  const std::size_t count =
      std::min<std::size_t>(copies > 0 ? copies : std::thread::hardware_concurrency(), order.size());
  if (SharedCounter counter; count > 1 && mayFork() && counter.isShared()) {
    Copies running;
    for (std::size_t i = 0; i < count; ++i) running.start(counter, order, make);
    running.collect(results, done, look);
  }
#endif
  std::vector<std::string> out(order.size());
  for (const std::size_t i : order) {
    if (results[i]) {
      out[i] = std::move(*results[i]);
      continue;
    }
    out[i] = make(i);
    if (done) done();
  }
  return out;
}

}  // namespace vps::scenes::import
