#include "cli/command_line.h"

#include "cli/completion.h"
#include "cli/usage.h"
#include "flute_grinder/base/escaped.h"

#include <cstdio>
#include <memory>

namespace grinder {

namespace {

void addCompletion(Commands& commands) {
  const auto shell = std::make_shared<std::string>();
  auto& command = commands.add("completion", "print a script that completes command lines; source it", "bash",
                               [&commands] { return std::fputs(bashCompletion(commands.app()).c_str(), stdout), 0; });
  const std::string bash = "bash";
  command.add_option("SHELL", *shell, "for which shell")
      ->required()
      ->check(CLI::IsMember({bash}).description(""))
      ->type_name("{" + bash + "}");
}

}  // namespace

CommandLine::CommandLine() {
  app_.require_subcommand(1);
  app_.footer("Example:\n  rosrun flute_grinder grind plan --help");
  app_.set_version_flag("--version", "flute_grinder " FLUTE_GRINDER_VERSION, "print the version and exit");
  app_.add_option("--node", commands_.node, "name of the grinder's node")->capture_default_str();
  addJobCommands(commands_);
  addWheelCommands(commands_);
  addMachineCommands(commands_);
  addOffsetCommands(commands_);
  addCompletion(commands_);
}

std::optional<int> CommandLine::parse(int argc, const char* const* argv) {
  try {
    app_.parse(argc, argv);
    return std::nullopt;
  } catch (const CLI::ParseError& error) {
    // An unknown word is named before a missing argument, for which it may have been meant.
    const std::string unknown = error.get_exit_code() == 0 ? "" : unknownWord(app_);
    const std::string wrong = unknown.empty() ? wrongNumber(error) : unknown;
    if (wrong.empty()) return app_.exit(error) == 0 ? 0 : kUsage;
    std::fprintf(stderr, "%s\nRun with --help for more information.\n", escaped(wrong).c_str());
    return kUsage;
  }
}

}  // namespace grinder
