// SPDX-License-Identifier: BSD-3-Clause
#include "support/no_alloc.h"

#include <gtest/gtest.h>

#include <cerrno>
#include <cstdlib>
#include <new>

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
#define VPS_MALLOC_IS_OURS 0
#elif defined(__has_feature)
#if __has_feature(address_sanitizer) || __has_feature(thread_sanitizer)
#define VPS_MALLOC_IS_OURS 0
#endif
#endif
#if !defined(VPS_MALLOC_IS_OURS) && defined(__GLIBC__)
#define VPS_MALLOC_IS_OURS 1
#endif

namespace {

thread_local std::size_t scope_depth = 0;
thread_local std::size_t heap_calls = 0;
const bool abort_on_heap_call = [] {
  const char* wish = std::getenv("VPS_NO_ALLOC_ABORT");
  return wish != nullptr && *wish == '1';
}();

void noteHeapCall() noexcept {
  if (scope_depth == 0) return;
  ++heap_calls;
  if (abort_on_heap_call) std::abort();
}

}  // namespace

#if VPS_MALLOC_IS_OURS
// These are glibc's own entry points; with them, overriding the public names needs no dlsym, which allocates
// itself. operator new and delete call these functions too.
extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* old, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* block);

void* malloc(std::size_t size) {
  noteHeapCall();
  return __libc_malloc(size);
}
void* calloc(std::size_t count, std::size_t size) {
  noteHeapCall();
  return __libc_calloc(count, size);
}
void* realloc(void* old, std::size_t size) {
  noteHeapCall();
  return __libc_realloc(old, size);
}
void* memalign(std::size_t alignment, std::size_t size) {
  noteHeapCall();
  return __libc_memalign(alignment, size);
}
void* aligned_alloc(std::size_t alignment, std::size_t size) {
  return memalign(alignment, size);
}
int posix_memalign(void** block, std::size_t alignment, std::size_t size) {
  *block = memalign(alignment, size);
  return *block != nullptr ? 0 : ENOMEM;
}
void free(void* block) {
  if (block != nullptr) noteHeapCall();
  __libc_free(block);
}
}
#else
void* operator new(std::size_t size) {
  noteHeapCall();
  if (void* block = std::malloc(size > 0 ? size : 1)) return block;
  throw std::bad_alloc();
}
void* operator new[](std::size_t size) {
  return operator new(size);
}
void* operator new(std::size_t size, const std::nothrow_t&) noexcept {  // std::stable_sort's buffer
  noteHeapCall();
  return std::malloc(size > 0 ? size : 1);
}
void* operator new[](std::size_t size, const std::nothrow_t& nothrow) noexcept {
  return operator new(size, nothrow);
}
void operator delete(void* block) noexcept {
  if (block != nullptr) noteHeapCall();
  std::free(block);
}
void operator delete[](void* block) noexcept {
  operator delete(block);
}
void operator delete(void* block, std::size_t) noexcept {
  operator delete(block);
}
void operator delete[](void* block, std::size_t) noexcept {
  operator delete(block);
}
void operator delete(void* block, const std::nothrow_t&) noexcept {
  operator delete(block);
}
void operator delete[](void* block, const std::nothrow_t&) noexcept {
  operator delete(block);
}
#endif

namespace vps_test {

NoAllocScope::NoAllocScope() noexcept : count_before_(heap_calls) {
  ++scope_depth;
}

NoAllocScope::~NoAllocScope() {
  const std::size_t calls = count();
  --scope_depth;
  if (calls > 0)
    ADD_FAILURE() << calls
                  << " heap calls in a scope that must have none; VPS_NO_ALLOC_ABORT=1 shows the first";
}

std::size_t NoAllocScope::count() const noexcept {
  return heap_calls - count_before_;
}

}  // namespace vps_test
