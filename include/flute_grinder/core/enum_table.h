#pragma once

#include <cstddef>
#include <iterator>
#include <optional>
#include <string>
#include <string_view>

/// @file
/// The values of an enum with their names, and whatever else is known of each: one table beside the enum, with a row
/// for every value in order, which `rowsOf` of the enum gives. Nothing else lists the values.
namespace flute_grinder {

/// A row of a table that has names alone; others derive from it.
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

/// For values that come from outside and are not in the table: its members' defaults, and the name "unknown".
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

/// How many values an enum has.
template <typename Enum>
constexpr int countOf() noexcept {
  return static_cast<int>(std::size(rowsOf(Enum{})));
}

/// The name of a value, e.g. "third_order". Real-time safe.
template <typename Enum>
constexpr auto toString(Enum value) noexcept -> decltype(rowsOf(value)->name) {
  return rowOf(value).name;
}

/// The value of a name; nothing where it is none.
template <typename Enum>
constexpr std::optional<Enum> valueOf(std::string_view name) noexcept {
  for (const auto& row : rowsOf(Enum{})) {
    if (name == row.name) return row.value;
  }
  return std::nullopt;
}

/// The names of those values that a condition holds for, e.g. "published, third_order, exact" of all.
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

}  // namespace flute_grinder
