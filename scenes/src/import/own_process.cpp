// SPDX-License-Identifier: BSD-3-Clause
#include "import/own_process.h"

#if !defined(__unix__)

namespace vps::scenes::import {
RawCad inOwnProcess(const std::string&, const std::string&, const Progress& progress,
                    const std::function<RawCad(const Progress&)>& read) {
  return read(progress);
}
}  // namespace vps::scenes::import

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

namespace vps::scenes::import {
namespace {

// What the child says, one after another: Doing (share, text) any number of times, then once Done (a RawCad)
// or Failed (the error's text). Both ends are one program, so values travel as they lie in memory.
enum class Message : std::uint8_t { Doing, Done, Failed };

/// The child's words ended early.
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

// One transfer() for each type serves both directions, so that they cannot disagree: `io` copies bytes out of
// or into the value.
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
  });
  transferEach(io, cad.warnings, [&](std::string& line) { transferArray(io, line); });
  transfer(io, cad.unit_m);
  transfer(io, cad.open_shapes);
}

/// In the child: a crash is quiet, quick and harms nobody else.
void prepareToCrash() {
  // Leaves no core file, and calls no handler that the program has set for crashes of its own.
  const rlimit no_core = {0, 0};
  ::setrlimit(RLIMIT_CORE, &no_core);
  for (const int signal : {SIGSEGV, SIGBUS, SIGFPE, SIGILL, SIGABRT, SIGTERM, SIGINT, SIGPIPE})
    std::signal(signal, SIG_DFL);
  // What the program has not flushed yet is its own to write. stderr keeps nothing back, and sanitizers use
  // it.
  const int nowhere = ::open("/dev/null", O_WRONLY | O_CLOEXEC);
  if (nowhere >= 0) ::dup2(nowhere, STDOUT_FILENO);
#ifdef __linux__
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);  // a reader that hangs goes with the program
  // If memory runs out, the kernel ends this process first.
  if (const Stream score(std::fopen("/proc/self/oom_score_adj", "w")); score) std::fputs("1000", score.get());
#endif
}

/// The child's life. Ends by _exit: the parent's buffers, handlers and statics are not the child's to finish.
[[noreturn]] void speak(Stream stream, const std::string& file, const Progress& progress,
                        const std::function<RawCad(const Progress&)>& read) noexcept {
  prepareToCrash();
  Writer out(std::move(stream));
  const Progress tell = [&](std::string_view doing, double share) {
    auto message = Message::Doing;
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
      cad = read(progress ? tell : Progress());
    } catch (const LoadError& e) {
      error = e.what();
    } catch (const std::bad_alloc&) {
      error = LoadError(file, "", "needs more memory than there is; is it damaged?").what();
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
  } catch (...) {  // the parent is gone, or the library threw what is no exception
    ::_exit(1);
  }
}

class Child {
 public:
  explicit Child(pid_t id) : id_(id) {}
  ~Child() {
    // By now it has said all, or nobody listens: progress threw.
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

/// AddressSanitizer's malloc, unlike glibc's, is no use in the fork of a program with threads: a lock that
/// one of them held stays taken (GCC 12: the child hangs).
bool mayFork() {
#ifdef VPS_ADDRESS_SANITIZER
  std::error_code error;
  const std::filesystem::directory_iterator tasks("/proc/self/task", error);
  return !error && std::distance(begin(tasks), end(tasks)) == 1;
#else
  return true;
#endif
}

RawCad listen(Reader& in, const Progress& progress) {
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
    if (message == Message::Doing) transfer(in, share);
    transferArray(in, text);
    if (message != Message::Doing) throw LoadError("", "", text);
    progress(text, share);
  }
}

}  // namespace

RawCad inOwnProcess(const std::string& file, const std::string& library, const Progress& progress,
                    const std::function<RawCad(const Progress&)>& read) {
  if (!mayFork()) return read(progress);
  // A child forked meanwhile would hold this pipe open, and a crash would be heard only when that one ends.
  static std::mutex one_at_a_time;
  std::unique_lock lock(one_at_a_time);
  int ends[2];
  if (::pipe(ends) != 0)
    throw LoadError(file, "", std::string("no pipe to its reader: ") + std::strerror(errno));
  for (const int end : ends) ::fcntl(end, F_SETFD, FD_CLOEXEC);
  Stream from_child(::fdopen(ends[0], "rb")), to_parent(::fdopen(ends[1], "wb"));
  const pid_t id = ::fork();
  if (id < 0) throw LoadError(file, "", std::string("no process for its reader: ") + std::strerror(errno));
  if (id == 0) {
    from_child.reset();
    speak(std::move(to_parent), file, progress, read);
  }
  to_parent.reset();
  lock.unlock();
  const Child child(id);
  Reader in(std::move(from_child));
  try {
    return listen(in, progress);
  } catch (const Broken&) {
    throw LoadError(file, "", library + " crashed while reading it; the file is damaged; export it again");
  }
}

}  // namespace vps::scenes::import

#endif
