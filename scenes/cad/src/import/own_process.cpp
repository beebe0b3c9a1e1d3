// SPDX-License-Identifier: BSD-3-Clause
#include "import/child_processes.h"

#if !defined(__unix__)

namespace vps::scenes::import {
RawCad inOwnProcess(const std::string&, const std::string&, const ImportSettings&, const Progress& progress,
                    const std::function<RawCad(const Progress&)>& read) {
  return read(progress);
}
}  // namespace vps::scenes::import

#else

#include <algorithm>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <memory>
#include <mutex>
#include <new>
#include <vector>

#include <fcntl.h>
#include <poll.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include "import/child_processes.h"
#include "import/part_bytes.h"
#include "vps/errors.h"
#include "vps/stoppable.h"
#include "vps_scenes/cad/time_limit.h"

namespace vps::scenes::import {
namespace {

// Messages of the child: Progressed (share, text) any number of times, then once Done (a RawCad) or Failed
// (the text of the error). Both processes run the same program, so values keep their layout in memory
// (part_bytes.h).
enum class Message : std::uint8_t { Progressed, Done, Failed };

/// Longest wait for a message, and interval between checks of the child's memory, for which the kernel walks
/// through its page tables.
constexpr int kLook_ms = 200;

/// Thrown when the child's messages end early.
struct Broken {};

struct Close {
  void operator()(std::FILE* stream) const { std::fclose(stream); }
};
using Stream = std::unique_ptr<std::FILE, Close>;

class Writer {
 public:
  explicit Writer(Stream stream) : stream_(std::move(stream)) {}
  void operator()(const void* data, std::size_t size) {
    if (size > 0 && std::fwrite(data, 1, size, stream_.get()) != size) throw Broken();
  }
  void flush() {
    if (std::fflush(stream_.get()) != 0) throw Broken();
  }

 private:
  Stream stream_;
};

/// In the child: makes a crash silent, fast and harmless to the parent.
void prepareToCrash() {
  // The child writes no core file and has none of the program's signal handlers.
  const rlimit no_core = {0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTERM, SIGPIPE})
    std::signal(signal, SIG_DFL);
  // A terminal sends Ctrl-C to both processes. Only the parent handles it, and ends the child if necessary.
  std::signal(SIGINT, SIG_IGN);
  // The child must not write the parent's unflushed output to stdout. stderr is unbuffered, and sanitizers
  // use it.
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere >= 0) ::dup2(nowhere, STDOUT_FILENO);
#ifdef __linux__
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // a reader that hangs ends with the program
  // If memory runs out, the kernel ends this process first.
  if (const Stream score(std::fopen("/proc/self/oom_score_adj", "w")); score) std::fputs("1000", score.get());
#endif
}

/// Runs the reader in the child. Ends by _exit, since buffers, handlers and statics belong to the parent.
[[noreturn]] void runChild(Stream stream, const std::string& file, const Progress& progress,
                           const std::function<RawCad(const Progress&)>& read) noexcept {
  prepareToCrash();
  const WorkOnThread none(nullptr);  // the callback of the parent's work is for the parent alone
  Writer out(std::move(stream));
  const Progress send = [&](std::string_view doing, double share) {
    auto message = Message::Progressed;
    std::string text(doing);
    transfer(out, message);
    transfer(out, share);
    transferArray(out, text);
    out.flush();
  };
  try {
    RawCad cad;
    std::string error;  // empty: no error
    try {
      cad = read(progress ? send : Progress());
    } catch (const LoadError& e) {
      error = e.what();
    } catch (const std::bad_alloc&) {
      error = LoadError(file, "", "needs more memory than is available; the file may be damaged").what();
    } catch (const std::exception& e) {
      error = LoadError(file, "", e.what()).what();
    }
    auto message = error.empty() ? Message::Done : Message::Failed;
    transfer(out, message);
    if (message == Message::Done) {
      transfer(out, cad);
    } else {
      transferArray(out, error);
    }
    out.flush();
    ::_exit(0);
  } catch (...) {  // the parent has ended, or the library threw an object that is not a std::exception
    ::_exit(1);
  }
}

class Child {
 public:
  explicit Child(pid_t id) : id_(id) {}
  ~Child() {
    // The child's result has been read, or `progress` threw and the result is not needed.
    if (!is_gone_) end();
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

  /// Ends the child if it still runs.
  /// @return the signal that ended the child; 0: no signal, or the SIGKILL of this function
  int end() {
    // A child that closed its pipe is about to end by itself, and its own signal is wanted.
    int status = 0;
    constexpr int kRounds = 100;
    for (int i = 0; i < kRounds && !is_gone_; ++i) {
      is_gone_ = ::waitpid(id_, &status, WNOHANG) == id_;
      if (!is_gone_ && i == 0 && !is_closed_) break;
      if (!is_gone_) ::usleep(1000);
    }
    if (!is_gone_) {
      ::kill(id_, SIGKILL);
      while (::waitpid(id_, &status, 0) < 0 && errno == EINTR) {
      }
      is_gone_ = true;
      return 0;  // ended by the SIGKILL above
    }
    return WIFSIGNALED(status) ? WTERMSIG(status) : 0;
  }
  void setClosed() { is_closed_ = true; }

  /// Memory of the child and of the copies that it forked; 0 if it is unknown. With copies, a page that
  /// several processes share counts in equal shares for each of them, so that no page is counted twice.
  [[nodiscard]] std::uint64_t memory_bytes() const {
    const std::string process = "/proc/" + std::to_string(id_);
    const std::string list = process + "/task/" + std::to_string(id_) + "/children";
    const Stream copies(std::fopen(list.c_str(), "r"));
    std::uint64_t sum = 0;
    long copy = 0;
    bool has_copies = false;
    for (; copies && std::fscanf(copies.get(), "%ld", &copy) == 1; has_copies = true)
      sum += ownShare_bytes(copy);
    if (has_copies) return sum + ownShare_bytes(id_);
    const Stream statm(std::fopen((process + "/statm").c_str(), "r"));
    unsigned long long all = 0, resident = 0, shared = 0;
    if (!statm || std::fscanf(statm.get(), "%llu %llu %llu", &all, &resident, &shared) != 3) return 0;
    return (resident - std::min(resident, shared)) * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE));
  }

 private:
  /// A process's proportional set size: its own pages and its share of the shared pages.
  static std::uint64_t ownShare_bytes(long id) {
    const Stream rollup(std::fopen(("/proc/" + std::to_string(id) + "/smaps_rollup").c_str(), "r"));
    unsigned long long kilobytes = 0;
    for (char line[256]; rollup && std::fgets(line, sizeof line, rollup.get()) != nullptr;)
      if (std::sscanf(line, "Pss: %llu", &kilobytes) == 1) break;
    return 1024 * kilobytes;
  }

  pid_t id_;
  bool is_gone_ = false, is_closed_ = false;
};

/// Calls progress while the child computes, and watches its limits.
class Watch {
 public:
  Watch(const Child& child, const std::string& file, const ImportSettings& limits, const Progress& progress)
      : child_(child),
        file_(file),
        limits_(limits),
        progress_(withTimeLimit(progress, {limits.most_s}, file)),
        doing_("reading " + stem(file)) {}

  void said(const std::string& doing, double share) {
    doing_ = doing;
    share_ = share;
    look();
  }
  void look() {
    if (progress_) progress_(doing_, share_);
    const std::string remedy =
        " (" + doing_ +
        "); export fewer parts into one file, or read STEP and IGES with a greater deflection";
    const auto now = std::chrono::steady_clock::now();
    if (limits_.most_memory_bytes == 0 || now < next_memory_) return;
    next_memory_ = now + std::chrono::milliseconds(kLook_ms);
    if (child_.memory_bytes() > limits_.most_memory_bytes)
      throw LoadError(file_, "",
                      "needs more than " + number(1e-9 * static_cast<double>(limits_.most_memory_bytes)) +
                          " GB of memory to read" + remedy);
  }

 private:
  static std::string number(double value) {
    char text[32];
    std::snprintf(text, sizeof text, "%.3g", value);
    return text;
  }
  const Child& child_;
  const std::string& file_;
  const ImportSettings& limits_;
  const Progress progress_;
  std::string doing_;
  double share_ = 0;
  std::chrono::steady_clock::time_point next_memory_ = std::chrono::steady_clock::now();
};

class Reader {
 public:
  /// @param watch looks at the child five times a second while no message arrives
  Reader(Stream stream, Watch& watch) : stream_(std::move(stream)), watch_(watch) { ready_.resize(kBuffer); }
  void operator()(void* data, std::size_t size) {
    for (auto* to = static_cast<char*>(data); size > 0;) {
      if (next_ == end_) fill();
      const std::size_t count = std::min(size, end_ - next_);
      std::memcpy(to, ready_.data() + next_, count);
      next_ += count;
      to += count;
      size -= count;
    }
  }

 private:
  static constexpr std::size_t kBuffer = 65536;

  void fill() {
    const int from = ::fileno(stream_.get());
    pollfd waiting{from, POLLIN, 0};
    for (;;) {
      const int ready = ::poll(&waiting, 1, kLook_ms);
      if (ready > 0) break;
      if (ready < 0 && errno != EINTR) throw Broken();
      watch_.look();
    }
    ssize_t count = 0;
    do count = ::read(from, ready_.data(), ready_.size());
    while (count < 0 && errno == EINTR);
    if (count <= 0) throw Broken();
    next_ = 0;
    end_ = static_cast<std::size_t>(count);
  }

  Stream stream_;
  Watch& watch_;
  std::vector<char> ready_;
  std::size_t next_ = 0, end_ = 0;
};

RawCad receive(Reader& in, Watch& watch) {
  for (;;) {
    auto message = Message::Failed;
    transfer(in, message);
    if (message == Message::Done) {
      RawCad cad;
      transfer(in, cad);
      return cad;
    }
    double share = 0;
    std::string text;
    if (message == Message::Progressed) transfer(in, share);
    transferArray(in, text);
    if (message != Message::Progressed) throw LoadError("", "", text);
    watch.said(text, share);
  }
}

}  // namespace

RawCad inOwnProcess(const std::string& file, const std::string& library, const ImportSettings& limits,
                    const Progress& progress, const std::function<RawCad(const Progress&)>& read) {
  if (!limits.in_own_process || !mayFork()) return read(progress);
  // A child that another thread forks meanwhile would keep this pipe open, and hide a crash until that child
  // ends.
  static std::mutex one_at_a_time;
  std::unique_lock lock(one_at_a_time);
  int ends[2];
  if (::pipe(ends) != 0)
    throw LoadError(file, "", std::string("cannot make a pipe to its reader: ") + std::strerror(errno));
  for (const int end : ends) ::fcntl(end, F_SETFD, FD_CLOEXEC);
  Stream from_child(::fdopen(ends[0], "rb")), to_parent(::fdopen(ends[1], "wb"));
  const pid_t id = ::fork();
  if (id < 0)
    throw LoadError(file, "", std::string("cannot start a process for its reader: ") + std::strerror(errno));
  if (id == 0) {
    from_child.reset();
    runChild(std::move(to_parent), file, progress, read);
  }
  to_parent.reset();
  lock.unlock();
  Child child(id);
  Watch watch(child, file, limits, progress);
  Reader in(std::move(from_child), watch);
  try {
    return receive(in, watch);
  } catch (const Broken&) {
    watch.look();  // if a limit ended the child, that error is the cause
    child.setClosed();
    const int signal = child.end();
    if (signal == SIGKILL || signal == SIGTERM || signal == SIGINT)
      throw LoadError(
          file, "",
          "was not read, because the process that reads it was ended from outside, for example when memory "
          "ran out; export fewer parts into one file, or read STEP and IGES with a greater deflection");
    throw LoadError(file, "", library + " crashed while reading it; the file is damaged, so export it again");
  }
}

}  // namespace vps::scenes::import

#endif
