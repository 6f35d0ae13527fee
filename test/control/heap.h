#pragma once

#include <cstddef>
#include <utility>

// Counts what a piece of code asks of the heap, in the programs that are linked with heap.cpp; in others it is always
// nothing.
namespace grinder::test_support {

struct HeapUse {
  int allocations = 0;
  int releases = 0;

  bool any() const { return allocations + releases > 0; }
};

// Of this thread alone, and initialised before any constructor runs: some of them allocate.
inline thread_local bool heap_counted = false;
inline thread_local HeapUse heap_use;
inline thread_local bool heap_holds_exception = false;  ///< what it takes is the thrower's

template <typename Work>
HeapUse heapUse(const Work& work) {
  heap_use = {};
  heap_counted = true;
  work();
  heap_counted = false;
  if (std::exchange(heap_holds_exception, false)) heap_use = {};
  return heap_use;
}

/// While it lives, what a test itself does amid a piece of code is not counted.
class HeapNotCounted {
 public:
  HeapNotCounted() { heap_counted = false; }
  ~HeapNotCounted() { heap_counted = was_; }
  HeapNotCounted(const HeapNotCounted&) = delete;
  HeapNotCounted& operator=(const HeapNotCounted&) = delete;

 private:
  const bool was_ = heap_counted;
};

}  // namespace grinder::test_support
