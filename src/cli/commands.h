#pragma once

#include <CLI/CLI.hpp>

#include <functional>
#include <map>
#include <string>

namespace grinder {

/// What a command does once the whole command line has been parsed. @return the exit status.
using Action = std::function<int()>;

/// The commands of the command line, each with its action.
class Commands {
 public:
  explicit Commands(CLI::App& app) : app_(app) {}
  Commands(const Commands&) = delete;
  Commands& operator=(const Commands&) = delete;

  /// @param example realistic arguments. @param action null for a command that has commands of its own.
  CLI::App& add(const std::string& name, const std::string& description, const std::string& example, Action action);

  /// A command of a command. @param command as add() returned it.
  CLI::App& addTo(CLI::App& command, const std::string& name, const std::string& description,
                  const std::string& example, Action action);

  /// The same action for what needs the grinder's node: makes sure first that the ROS master knows it.
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

/// What is done with a job and its record: `table`, `plan`, `setup`, `simulate`, `run`, `goal`, `report`, `history`.
void addJobCommands(Commands& commands);

/// What is done with a wheel, the zeros that follow from it, and the machine's files: `wheel`, `zeros`, `machine`.
void addWheelCommands(Commands& commands);

/// Requests to the machine: `override`, `confirm-swivel`, `jog`, `status` and the requests without arguments.
void addMachineCommands(Commands& commands);

/// The work offsets, what they depend on and how they are found: `confirm-wheel`, `reclamped`, `offsets`, `touch-off`,
/// `probe`.
void addOffsetCommands(Commands& commands);

}  // namespace grinder
