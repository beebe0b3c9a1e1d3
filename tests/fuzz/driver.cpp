// SPDX-License-Identifier: BSD-3-Clause
// Runs a fuzz entry without libFuzzer, so that any compiler's sanitizers can watch: every seed, every seed
// cut at every byte, then random changes of seeds for some seconds. The changes are the same in each run.
//
//   fuzz_ply [seconds] [file ...]    with files: runs only these, to reproduce a failure
//
// An input that fails is kept as fuzz-failed in the working folder.
#include <sys/time.h>
#include <unistd.h>
#include <csignal>

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <random>
#include <string>

#include "fuzz.h"

extern "C" __attribute__((weak)) void __sanitizer_set_death_callback(void (*callback)());

namespace {

// Greatest number of cuts of one seed; a longer seed is cut at every second byte, third, ....
constexpr std::size_t kMaxCuts = 3000;
constexpr int kSlow_s = 30;  // an input that takes more processor time is a failure too
std::string current;

void keepInput() {
  std::FILE* file = std::fopen("fuzz-failed", "wb");
  if (file == nullptr) return;
  std::fwrite(current.data(), 1, current.size(), file);
  std::fclose(file);
  std::fprintf(stderr, "its %zu bytes are in ./fuzz-failed\n", current.size());
}

void onSignal(int signal) {
  std::fprintf(stderr, signal == SIGPROF ? "took too long\n" : "aborted\n");
  keepInput();
  _exit(1);
}

/// Sends SIGPROF after this many seconds of the program's own processor time; 0 cancels it.
void limitTime(int seconds) {
  itimerval timer{};
  timer.it_value.tv_sec = seconds;
  setitimer(ITIMER_PROF, &timer, nullptr);
}

void runOne(std::string bytes) {
  current = std::move(bytes);
  limitTime(kSlow_s);
  LLVMFuzzerTestOneInput(reinterpret_cast<const std::uint8_t*>(current.data()), current.size());
  limitTime(0);
}

/// Makes one to four changes: a bit, a byte, a number, or a piece that is cut out, doubled or taken from
/// another seed.
std::string changed(std::string bytes, const std::string& other, std::mt19937& random) {
  const auto below = [&](std::size_t n) { return n == 0 ? 0 : random() % n; };
  for (std::size_t changes = 1 + below(4); changes > 0 && !bytes.empty(); --changes) {
    const std::size_t at = below(bytes.size()),
                      length = 1 + below(std::min<std::size_t>(64, bytes.size() - at));
    static const std::string kBytes("\0\1\x7f\x80\xff 9-.en\n", 13);
    switch (below(6)) {
      case 0:
        bytes[at] = static_cast<char>(bytes[at] ^ 1 << below(8));
        break;
      case 1:
        bytes[at] = kBytes[below(kBytes.size())];
        break;
      case 2:
        bytes[at] = static_cast<char>(random());
        break;
      case 3:
        bytes.erase(at, length);
        break;
      case 4:
        bytes.insert(at, bytes.substr(at, length));
        break;
      default:
        if (!other.empty()) bytes.replace(at, length, other.substr(below(other.size()), 1 + below(64)));
    }
  }
  return bytes;
}

}  // namespace

int main(int argc, char** argv) {
  if (__sanitizer_set_death_callback != nullptr)
    __sanitizer_set_death_callback(keepInput);
  else
    std::signal(SIGSEGV, onSignal);
  std::signal(SIGPROF, onSignal);
  std::signal(SIGABRT, onSignal);
  for (int i = 2; i < argc; ++i) runOne(vps::fuzz::bytesOf(argv[i]));
  if (argc > 2) return 0;

  const double seconds = argc > 1 ? std::atof(argv[1]) : 10;
  const auto start = std::chrono::steady_clock::now();
  const auto isOver = [&] {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count() > seconds;
  };
  const std::vector<std::string> seeds = vps::fuzz::seeds();
  std::size_t runs = 0, cuts = 0;
  for (const std::string& seed : seeds) {
    runOne(seed);
    const std::size_t step = 1 + seed.size() / kMaxCuts;
    for (std::size_t length = 0; length < seed.size(); length += step, ++cuts) runOne(seed.substr(0, length));
  }
  std::mt19937 random(1);
  for (; !isOver(); ++runs) {
    const std::string& seed = seeds[random() % seeds.size()];
    runOne(changed(seed, seeds[random() % seeds.size()], random));
  }
  std::printf("%zu seeds, %zu cuts, %zu changes: no failure\n", seeds.size(), cuts, runs);
  return 0;
}
