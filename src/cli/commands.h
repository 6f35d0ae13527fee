#pragma once

#include <CLI/CLI.hpp>

#include <functional>
#include <map>
#include <string>

namespace grinder {

/// The action of a command, carried out once the whole command line has been parsed. @return the exit status.
using Action = std::function<int()>;

/// The commands of the command line, each with its action.
class Commands {
 public:
  explicit Commands(CLI::App& app) : app_(app) {}
  Commands(const Commands&) = delete;
  Commands& operator=(const Commands&) = delete;

  /// @param example realistic arguments. @param action null for a command with sub-commands.
  CLI::App& add(const std::string& name, const std::string& description, const std::string& example, Action action);

  /// Adds a sub-command. @param command result of add() for its parent.
  CLI::App& addTo(CLI::App& command, const std::string& name, const std::string& description,
                  const std::string& example, Action action);

  /// An action that first makes sure that the ROS master knows the grinder's node, and then carries out `action`.
  Action online(Action action) const;

  /// Carries out the command that was parsed. @return the exit status.
  int carryOut() const;

  const CLI::App& app() const { return app_; }

  std::string node = "grinder";  ///< name of the grinder's node

 private:
  CLI::App& app_;
  std::map<const CLI::App*, Action> actions_;
};

// One function for each group of commands, in the order of the help. Its commands refer to `commands`, which must
// outlive their actions.

/// The commands for a job and its record: `table`, `plan`, `setup`, `simulate`, `run`, `goal`, `report`, `history`,
/// `measured`, `correct`.
void addJobCommands(Commands& commands);

/// The commands for a wheel, its zeros, and the machine's files: `wheel`, `zeros`, `machine`.
void addWheelCommands(Commands& commands);

/// Requests to the machine: `override`, `confirm-swivel`, `jog`, `status` and the requests without arguments.
void addMachineCommands(Commands& commands);

/// The commands for the work offsets, the wheel and the tool: `confirm-wheel`, `reclamped`, `offsets`, `touch-off`,
/// `probe`.
void addOffsetCommands(Commands& commands);

}  // namespace grinder
