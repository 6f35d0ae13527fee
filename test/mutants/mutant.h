#pragma once
// Without warnings: the functions below mix types as the code that they stand in for does.
#pragma GCC system_header

#include <fcntl.h>
#include <unistd.h>
#include <array>
#include <atomic>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <type_traits>

/// Mutants: small breaks of a module, all compiled in, of which a process has at most one. breaks.py writes the calls,
/// and defines how many there are (MUTANTS).
namespace mutants {

/// Which mutant this process has, by the environment variable MUTANT, and which of them it has come by. The latter are
/// written into the folder MUTANTS_REACHED, if it is set.
class Process {
 public:
  Process() {
    const char* number = std::getenv("MUTANT");
    if (number) own_ = std::atoi(number);
    const char* folder = std::getenv("MUTANTS_REACHED");
    if (!folder) return;
    const std::string name = std::string(folder) + "/" + std::to_string(getpid());
    const int file = open(name.c_str(), O_WRONLY | O_CREAT | O_APPEND | O_CLOEXEC, 0644);
    reached_file_ = fcntl(file, F_DUPFD_CLOEXEC, STDERR_FILENO + 1);  // a standard stream that is closed stays so
    close(file);
  }
  bool comesBy(int number) {
    // Written at once: a program may end without destroying its statics.
    std::atomic<bool>& reached = reached_[static_cast<std::size_t>(number)];
    if (!reached.load(std::memory_order_relaxed) && !reached.exchange(true) && reached_file_ >= 0) {
      // Without the heap, of which the control cycle is asked whether it uses any.
      char line[16];
      const int size = std::snprintf(line, sizeof line, "%d\n", number);
      if (write(reached_file_, line, static_cast<std::size_t>(size)) != size) std::abort();
    }
    return number == own_;
  }

 private:
  int own_ = -1;
  int reached_file_ = -1;
  std::array<std::atomic<bool>, MUTANTS> reached_{};
};

/// Made by whichever static asks first, and before main(), where the heap may be used.
inline Process& process() {
  static Process process;
  return process;
}
inline const Process& kMade = process();

/// Whether this process has a mutant. The compiler, which may compute an expression itself, has none.
constexpr bool at(int number) { return !__builtin_is_constant_evaluated() && process().comesBy(number); }

template <typename T>
constexpr T value(int number, T v) {
  if (!at(number)) return v;
  if constexpr (std::is_same_v<T, bool>) return !v;
  if constexpr (std::is_integral_v<T>) return static_cast<T>(v + 1);
  if constexpr (std::is_floating_point_v<T>) return v == 0 ? T(1) : 2 * v;
  return v;
}

template <typename A, typename B>
constexpr auto plus(int number, A a, B b) {
  return at(number) ? a - b : a + b;
}
template <typename A, typename B>
constexpr auto minus(int number, A a, B b) {
  return at(number) ? a + b : a - b;
}
template <typename A, typename B>
constexpr auto times(int number, A a, B b) {
  return at(number) ? a + b : a * b;
}
template <typename A, typename B>
constexpr auto over(int number, A a, B b) {
  return at(number) ? a * b : a / b;
}
template <typename A>
constexpr auto negative(int number, A a) {
  return at(number) ? +a : -a;
}

// Comparisons have two mutants each: the end that counts or does not, and the opposite.
template <typename A, typename B>
constexpr bool less(int number, const A& a, const B& b) {
  return (at(number) ? a <= b : a < b) != at(number + 1);
}
template <typename A, typename B>
constexpr bool lessEqual(int number, const A& a, const B& b) {
  return (at(number) ? a < b : a <= b) != at(number + 1);
}
template <typename A, typename B>
constexpr bool greater(int number, const A& a, const B& b) {
  return (at(number) ? a >= b : a > b) != at(number + 1);
}
template <typename A, typename B>
constexpr bool greaterEqual(int number, const A& a, const B& b) {
  return (at(number) ? a > b : a >= b) != at(number + 1);
}

template <typename T>
constexpr T min(int number, const T& a, const T& b) {
  return (b < a) != at(number) ? b : a;
}
template <typename T>
constexpr T max(int number, const T& a, const T& b) {
  return (a < b) != at(number) ? b : a;
}

}  // namespace mutants
