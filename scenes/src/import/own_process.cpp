// SPDX-License-Identifier: BSD-3-Clause
#include "import/own_process.h"

#if !defined(__unix__)

namespace vps::scenes::inline v0::import {
RawCad inOwnProcess(const std::string&, const std::string&, const Progress& progress,
                    const std::function<RawCad(const Progress&)>& read) {
  return read(progress);
}
}  // namespace vps::scenes::inline v0::import

#else

#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <iterator>
#include <memory>
#include <mutex>
#include <new>
#include <system_error>
#include <type_traits>

#include <fcntl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>
#ifdef __linux__
#include <sys/prctl.h>
#endif

#include "vps/load_error.h"

namespace vps::scenes::inline v0::import {
namespace {

// Messages of the child: Progressed (share, text) any number of times, then once Done (a RawCad) or Failed
// (the text of the error). Both ends are the same program, so values are sent as they lie in memory.
enum class Message : std::uint8_t { Progressed, Done, Failed };

/// The child's messages ended early.
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

class Reader {
 public:
  explicit Reader(Stream stream) : stream_(std::move(stream)) {}
  void operator()(void* data, std::size_t size) {
    if (size > 0 && std::fread(data, 1, size, stream_.get()) != size) throw Broken();
  }

 private:
  Stream stream_;
};

// One transfer() for each type serves both directions, so that they cannot disagree: `io` copies the bytes of
// the value out or in.
template <class Io, class T>
requires std::is_arithmetic_v<T> || std::is_enum_v<T>
void transfer(Io& io, T& value) {
  io(&value, sizeof value);
}

/// A string, or a vector of values without pointers.
template <class Io, class Array>
void transferArray(Io& io, Array& values) {
  std::uint64_t count = values.size();
  transfer(io, count);
  values.resize(std::size_t(count));
  io(static_cast<void*>(values.data()), values.size() * sizeof(values[0]));
}

template <class Io, class T, class Each>
void transferEach(Io& io, std::vector<T>& values, Each each) {
  std::uint64_t count = values.size();
  transfer(io, count);
  values.resize(std::size_t(count));
  for (T& value : values) each(value);
}

template <class Io>
void transfer(Io& io, RawCad& cad) {
  static_assert(sizeof(Vec3) == 3 * sizeof(double) && sizeof(cad.parts[0].color) == 3 * sizeof(float));
  transferEach(io, cad.parts, [&](RawPart& part) {
    transferArray(io, part.name);
    transferArray(io, part.mesh.vertices);
    transferArray(io, part.mesh.triangles);
    io(part.X_WP.data(), 16 * sizeof(double));
    io(part.color.data(), sizeof part.color);
    transfer(io, part.deviation_m);
    transferArray(io, part.note);
  });
  transferEach(io, cad.warnings, [&](std::string& line) { transferArray(io, line); });
  transfer(io, cad.unit_m);
  transfer(io, cad.open_shapes);
}

/// In the child: makes a crash silent, fast and harmless to the parent.
void prepareToCrash() {
  // No core file, and none of the signal handlers that the program has set for itself.
  const rlimit no_core = {0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTERM, SIGINT, SIGPIPE})
    std::signal(signal, SIG_DFL);
  // The parent writes what it has not flushed yet. stderr is unbuffered, and sanitizers use it.
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere >= 0) ::dup2(nowhere, STDOUT_FILENO);
#ifdef __linux__
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // a reader that hangs goes with the program
  // If memory runs out, the kernel ends this process first.
  if (const Stream score(std::fopen("/proc/self/oom_score_adj", "w")); score) std::fputs("1000", score.get());
#endif
}

/// Runs the child. Ends by _exit, since buffers, handlers and statics belong to the parent.
[[noreturn]] void runChild(Stream stream, const std::string& file, const Progress& progress,
                           const std::function<RawCad(const Progress&)>& read) noexcept {
  prepareToCrash();
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
    std::string error;  // none while empty
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
  } catch (...) {  // the parent has ended, or the library threw something that is no std::exception
    ::_exit(1);
  }
}

class Child {
 public:
  explicit Child(pid_t id) : id_(id) {}
  ~Child() {
    // Its result has been read, or progress threw and it is not needed.
    ::kill(id_, SIGKILL);
    while (::waitpid(id_, nullptr, 0) < 0 && errno == EINTR) {
    }
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;

 private:
  pid_t id_;
};

#if defined(__SANITIZE_ADDRESS__)
#define VPS_ADDRESS_SANITIZER
#elif defined(__has_feature)
#if __has_feature(address_sanitizer)
#define VPS_ADDRESS_SANITIZER
#endif
#endif

/// AddressSanitizer's malloc, unlike glibc's, does not work in the fork of a program with threads: a lock
/// that one of them held stays locked (GCC 12: the child hangs).
bool mayFork() {
#ifdef VPS_ADDRESS_SANITIZER
  std::error_code error;
  const std::filesystem::directory_iterator tasks("/proc/self/task", error);
  return !error && std::distance(begin(tasks), end(tasks)) == 1;
#else
  return true;
#endif
}

RawCad receive(Reader& in, const Progress& progress) {
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
    progress(text, share);
  }
}

}  // namespace

RawCad inOwnProcess(const std::string& file, const std::string& library, const Progress& progress,
                    const std::function<RawCad(const Progress&)>& read) {
  if (!mayFork()) return read(progress);
  // A child that is forked meanwhile would keep this pipe open, and hide a crash until it ends.
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
  const Child child(id);
  Reader in(std::move(from_child));
  try {
    return receive(in, progress);
  } catch (const Broken&) {
    throw LoadError(file, "", library + " crashed while reading it; the file is damaged, so export it again");
  }
}

}  // namespace vps::scenes::inline v0::import

#endif
