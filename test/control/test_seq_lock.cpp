#include "flute_grinder/control/seq_lock.h"

#include <gtest/gtest.h>

#include <array>
#include <atomic>
#include <chrono>
#include <cstring>
#include <string>
#include <thread>
#include <vector>

namespace grinder {
namespace test_seq_lock {

/// Every word the same, so that a torn copy shows.
struct Row {
  std::array<std::uint64_t, 33> words{};
};

Row rowOf(std::uint64_t number) {
  Row row;
  row.words.fill(number);
  return row;
}

TEST(SeqLock, HoldsTheDefaultAndThenWhatWasStoredToTheLastByte) {
  struct Odd {
    char text[13] = "the default!";
  };
  SeqLock<Odd> lock;
  EXPECT_STREQ(lock.load().text, "the default!");
  Odd odd;
  std::memcpy(odd.text, "abcdefghijklm", sizeof odd.text);
  lock.store(odd);
  EXPECT_EQ(std::string(lock.load().text, sizeof odd.text), "abcdefghijklm");
}

TEST(SeqLock, ReadersSeeWholeValuesInTheirOrder) {
  SeqLock<Row> lock;
  std::atomic<bool> writing{true};
  std::atomic<int> ready{0};
  std::vector<std::thread> readers;
  std::array<std::uint64_t, 3> torn{}, back{};
  std::atomic<bool> read{false};
  for (std::size_t r = 0; r < torn.size(); ++r) {
    readers.emplace_back([&, r] {
      std::uint64_t last = 0;
      ++ready;
      while (writing) {
        const Row row = lock.load();
        for (const std::uint64_t word : row.words) torn[r] += word != row.words[0];
        back[r] += row.words[0] < last;
        if (last > 0 && row.words[0] > last) read = true;
        last = row.words[0];
      }
    });
  }
  while (ready < 3) std::this_thread::yield();
  // On a busy computer until somebody has read meanwhile.
  const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(60);
  std::uint64_t last = 0;
  while (last < 300000 || (!read && std::chrono::steady_clock::now() < deadline)) lock.store(rowOf(++last));
  writing = false;
  for (std::thread& reader : readers) reader.join();
  for (std::size_t r = 0; r < torn.size(); ++r) {
    EXPECT_EQ(torn[r], 0u);
    EXPECT_EQ(back[r], 0u);
  }
  EXPECT_TRUE(read);
  EXPECT_EQ(lock.load().words[0], last);
}

}  // namespace test_seq_lock
}  // namespace grinder
