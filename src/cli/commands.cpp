#include "cli/commands.h"

#include "cli/online.h"

#include <utility>

namespace grinder {

CLI::App& Commands::add(const std::string& name, const std::string& description, const std::string& example,
                        Action action) {
  return addTo(app_, name, description, example, std::move(action));
}

CLI::App& Commands::addTo(CLI::App& command, const std::string& name, const std::string& description,
                          const std::string& example, Action action) {
  const std::string path = &command == &app_ ? name : command.get_name() + " " + name;
  CLI::App& added = *command.add_subcommand(name, description);
  added.footer("Example:\n  rosrun flute_grinder grind " + path + (example.empty() ? "" : " ") + example);
  if (action) {
    actions_[&added] = std::move(action);
  } else {
    added.require_subcommand(1);
  }
  return added;
}

Action Commands::online(Action action) const {
  return [this, action = std::move(action)] { return joinRos(node) ? action() : 1; };
}

int Commands::carryOut() const {
  const CLI::App* command = &app_;
  while (!command->get_subcommands().empty()) command = command->get_subcommands().front();
  return actions_.at(command)();
}

}  // namespace grinder
