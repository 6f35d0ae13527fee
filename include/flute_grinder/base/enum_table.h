#pragma once

#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>

/// @file
/// The values of an enum, their names and other properties: one table beside the enum, with a row for every value in
/// order. `rowsOf(Enum)` returns the table.
namespace grinder {

/// A table row with only a name; other row types derive from it.
template <typename Enum>
struct EnumRow {
  Enum value{};
  const char* name = "unknown";
};

template <typename Row, std::size_t N>
constexpr bool isInOrder(const Row (&rows)[N]) noexcept {
  for (std::size_t i = 0; i < N; ++i) {
    if (static_cast<std::size_t>(rows[i].value) != i) return false;
  }
  return true;
}

/// The row for values from outside that are not in the table: default members, and the name "unknown".
template <typename Row>
inline constexpr Row kUnknownRow{};

/// The row of a value. Real-time safe.
template <typename Enum>
constexpr const auto& rowOf(Enum value) noexcept {
  constexpr auto& rows = rowsOf(Enum{});
  static_assert(isInOrder(rows), "a row for every value, in their order");
  const auto i = static_cast<std::size_t>(value);
  return i < std::size(rows) ? rows[i] : kUnknownRow<std::decay_t<decltype(rows[0])>>;
}

/// The number of values of an enum.
template <typename Enum>
constexpr int countOf() noexcept {
  return static_cast<int>(std::size(rowsOf(Enum{})));
}

/// The name of a value, e.g. "third_order". Real-time safe.
template <typename Enum>
constexpr auto toString(Enum value) noexcept -> decltype(rowsOf(value)->name) {
  return rowOf(value).name;
}

/// The value with this name; std::nullopt if there is none.
template <typename Enum>
constexpr std::optional<Enum> valueOf(std::string_view name) noexcept {
  for (const auto& row : rowsOf(Enum{})) {
    if (name == row.name) return row.value;
  }
  return std::nullopt;
}

/// The names of the values that satisfy a condition, separated by commas, e.g. "published, third_order, exact".
template <typename Enum, typename Condition>
std::string namesOf(Condition condition) {
  std::string names;
  for (const auto& row : rowsOf(Enum{})) {
    if (condition(row.value)) names += (names.empty() ? "" : ", ") + std::string(row.name);
  }
  return names;
}
template <typename Enum>
std::string namesOf() {
  return namesOf<Enum>([](Enum) { return true; });
}

}  // namespace grinder
