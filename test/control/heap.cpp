#include "control/heap.h"

#include <cerrno>
#include <cstdlib>

// Counts every access to the heap: the executable's malloc and related functions replace the C library's, for the
// shared libraries too, and the C++ library's operator new calls them.

extern "C" {
void* __libc_malloc(std::size_t size);
void* __libc_calloc(std::size_t count, std::size_t size);
void* __libc_realloc(void* memory, std::size_t size);
void* __libc_memalign(std::size_t alignment, std::size_t size);
void __libc_free(void* memory);
}

namespace {

using grinder::test_support::heap_counted;
using grinder::test_support::heap_use;

void countAllocation() {
  if (heap_counted) ++heap_use.allocations;
}

}  // namespace

extern "C" {

void* malloc(std::size_t size) noexcept {
  countAllocation();
  return __libc_malloc(size);
}

void* calloc(std::size_t count, std::size_t size) noexcept {
  countAllocation();
  return __libc_calloc(count, size);
}

void* realloc(void* memory, std::size_t size) noexcept {
  countAllocation();
  return __libc_realloc(memory, size);
}

void* memalign(std::size_t alignment, std::size_t size) noexcept {
  countAllocation();
  return __libc_memalign(alignment, size);
}

void* aligned_alloc(std::size_t alignment, std::size_t size) noexcept {
  countAllocation();
  return __libc_memalign(alignment, size);
}

int posix_memalign(void** memory, std::size_t alignment, std::size_t size) noexcept {
  countAllocation();
  *memory = __libc_memalign(alignment, size);
  return *memory ? 0 : ENOMEM;
}

void free(void* memory) noexcept {
  // Releasing a null pointer does not use the heap.
  if (heap_counted && memory) ++heap_use.releases;
  __libc_free(memory);
}

}  // extern "C"
