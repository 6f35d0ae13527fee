#pragma once

#include <algorithm>
#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>
#include <utility>

namespace grinder {

/// A value that one thread writes and any number of threads read consistently. store() never waits; load() retries
/// while a store is in progress. Every word is atomic, so there are no data races. Real-time safe.
template <typename T>
class SeqLock {
  static_assert(std::is_trivially_copyable_v<T>, "a torn copy must be harmless");

 public:
  SeqLock() noexcept { store(T{}); }

  /// For one thread only.
  void store(const T& value) noexcept {
    const std::uint64_t version = version_.load(std::memory_order_relaxed);
    version_.store(version + 1, std::memory_order_relaxed);
    // Release: a reader that sees one of these words also sees the odd version.
    storeWords(reinterpret_cast<const char*>(&value), std::make_index_sequence<kWords>());
    version_.store(version + 2, std::memory_order_release);
  }

  /// For any thread.
  T load() const noexcept {
    Words words;
    std::uint64_t before, after;
    do {
      before = version_.load(std::memory_order_acquire);
      for (std::size_t i = 0; i < words.size(); ++i) words[i] = words_[i].load(std::memory_order_acquire);
      after = version_.load(std::memory_order_relaxed);
    } while (before != after || before % 2 == 1);
    T value;
    std::memcpy(static_cast<void*>(&value), words.data(), sizeof value);
    return value;
  }

 private:
  static constexpr std::size_t kWord = sizeof(std::uint64_t);
  static constexpr std::size_t kWords = (sizeof(T) + kWord - 1) / kWord;
  using Words = std::array<std::uint64_t, kWords>;

  /// Unrolled, and without an intermediate copy of the value: the store is a good part of a cycle.
  template <std::size_t... Index>
  void storeWords(const char* bytes, std::index_sequence<Index...>) noexcept {
    (storeWord<Index>(bytes), ...);
  }
  template <std::size_t Index>
  void storeWord(const char* bytes) noexcept {
    std::uint64_t word = 0;
    std::memcpy(&word, bytes + Index * kWord, std::min(kWord, sizeof(T) - Index * kWord));
    words_[Index].store(word, std::memory_order_release);
  }

  std::atomic<std::uint64_t> version_{0};  ///< odd while a store is in progress
  std::array<std::atomic<std::uint64_t>, kWords> words_{};
};

}  // namespace grinder
