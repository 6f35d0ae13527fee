#include "cli/usage.h"

#include "flute_grinder/base/did_you_mean.h"

#include <algorithm>
#include <vector>

namespace grinder {

namespace {

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

/// @param path path of the command, e.g. "grind wheel". @param word word that the command does not know.
std::string refusal(const CLI::App& app, const CLI::App& command, const std::string& path, const std::string& word) {
  const std::string name = word.substr(0, word.find('='));
  const std::vector<std::string> commands = commandsOf(command);
  if (name.size() > 1 && name[0] == '-') {
    const std::vector<std::string> before = optionsOf(app);
    if (std::find(before.begin(), before.end(), name) != before.end()) {
      const std::string words = path.substr(app.get_name().size() + 1);
      return name + ": goes before the command: grind " + name + " ... " + words;
    }
    return name + ": no such option of '" + path + "'" + didYouMean(name, optionsOf(command));
  }
  if (commands.empty()) return word + ": no such argument of '" + path + "'";
  return word + ": no such command of '" + path + "'" + didYouMean(word, commands);
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

std::string wrongNumber(const CLI::ParseError& error) {
  const std::string words = error.what(), begin = "Could not convert: ";
  if (words.rfind(begin, 0) != 0) return "";
  return words.substr(begin.size()) + "; allowed: a number, with a point as in 124.7, or a whole one where it counts";
}

}  // namespace grinder
