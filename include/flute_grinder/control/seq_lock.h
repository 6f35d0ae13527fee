#pragma once

#include <array>
#include <atomic>
#include <cstddef>
#include <cstdint>
#include <cstring>
#include <type_traits>

namespace flute_grinder {

/// A value that one thread writes and any number of threads read consistently. store() never waits; load() retries
/// while a store is in progress. Every word is atomic, so there are no data races. Real-time safe.
template <typename T>
class SeqLock {
  static_assert(std::is_trivially_copyable_v<T>, "a torn copy must be harmless");

 public:
  SeqLock() noexcept { store(T{}); }

  /// For one thread only.
  void store(const T& value) noexcept {
    Words words{};
    std::memcpy(words.data(), &value, sizeof value);
    const std::uint64_t version = version_.load(std::memory_order_relaxed);
    version_.store(version + 1, std::memory_order_relaxed);
    // Release: a reader that sees one of these words also sees the odd version.
    for (std::size_t i = 0; i < words.size(); ++i) words_[i].store(words[i], std::memory_order_release);
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
  using Words = std::array<std::uint64_t, (sizeof(T) + sizeof(std::uint64_t) - 1) / sizeof(std::uint64_t)>;

  std::atomic<std::uint64_t> version_{0};  ///< odd while a store is in progress
  std::array<std::atomic<std::uint64_t>, std::tuple_size_v<Words>> words_{};
};

}  // namespace flute_grinder
