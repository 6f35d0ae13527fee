#include "flute_grinder/cli/usage.h"

#include <algorithm>
#include <numeric>
#include <utility>
#include <vector>

namespace flute_grinder {

namespace {

/// How many letters must be inserted, removed, replaced or swapped with the next to make one word the other.
std::size_t distance(const std::string& a, const std::string& b) {
  std::vector<std::size_t> before_last, last, row(b.size() + 1);
  std::iota(row.begin(), row.end(), 0U);
  for (std::size_t i = 1; i <= a.size(); ++i) {
    before_last = std::exchange(last, row);
    row[0] = i;
    for (std::size_t j = 1; j <= b.size(); ++j) {
      row[j] = std::min({last[j] + 1, row[j - 1] + 1, last[j - 1] + (a[i - 1] == b[j - 1] ? 0 : 1)});
      const bool swapped = i > 1 && j > 1 && a[i - 1] == b[j - 2] && a[i - 2] == b[j - 1];
      if (swapped) row[j] = std::min(row[j], before_last[j - 2] + 1);
    }
  }
  return row.back();
}

/// "; did you mean 'hold'?", or nothing if none is near.
std::string nearest(const std::string& word, const std::vector<std::string>& known) {
  // Of a short word less may differ, or each would be near.
  constexpr std::size_t most = 2;
  const std::size_t farthest = std::min(most, (word.size() - std::min(word.size(), word.find_first_not_of('-'))) / 2);
  const auto far = [&](const std::string& other) {
    return other.rfind(word, 0) == 0 ? 0 : distance(word, other);  // a word that was begun is near
  };
  const auto best =
      std::min_element(known.begin(), known.end(), [&](const auto& a, const auto& b) { return far(a) < far(b); });
  if (best == known.end() || far(*best) > farthest) return "";
  return "; did you mean '" + *best + "'?";
}

std::vector<std::string> commandsOf(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::App* command : app.get_subcommands([](const CLI::App*) { return true; })) {
    names.push_back(command->get_name());
  }
  return names;
}

std::vector<std::string> optionsOf(const CLI::App& app) {
  std::vector<std::string> names;
  for (const CLI::Option* option : app.get_options()) {
    for (const std::string& name : option->get_lnames()) names.push_back("--" + name);
    for (const std::string& name : option->get_snames()) names.push_back("-" + name);
  }
  return names;
}

/// @param path of the command, e.g. "grind wheel". @param word that it does not know.
std::string refusal(const CLI::App& app, const CLI::App& command, const std::string& path, const std::string& word) {
  const std::string name = word.substr(0, word.find('='));
  const std::vector<std::string> commands = commandsOf(command);
  if (name.size() > 1 && name[0] == '-') {
    const std::vector<std::string> before = optionsOf(app);
    if (std::find(before.begin(), before.end(), name) != before.end()) {
      const std::string words = path.substr(app.get_name().size() + 1);
      return name + ": goes before the command: grind " + name + " ... " + words;
    }
    return name + ": no such option of '" + path + "'" + nearest(name, optionsOf(command));
  }
  if (commands.empty()) return word + ": no such argument of '" + path + "'";
  return word + ": no such command of '" + path + "'" + nearest(word, commands);
}

}  // namespace

std::string unknownWord(const CLI::App& app) {
  const CLI::App* command = &app;
  std::string path = app.get_name();
  while (true) {
    const std::vector<std::string> words = command->remaining();
    if (!words.empty()) return refusal(app, *command, path, words.front());
    if (command->get_subcommands().empty()) return "";
    command = command->get_subcommands().front();
    path += " " + command->get_name();
  }
}

}  // namespace flute_grinder
