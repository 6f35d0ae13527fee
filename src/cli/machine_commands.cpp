#include "cli/arguments.h"
#include "cli/commands.h"
#include "cli/offsets.h"
#include "cli/online.h"
#include "flute_grinder/motion/feed_schedule.h"

#include <map>
#include <memory>
#include <string>

namespace grinder {

namespace {

void addOverride(Commands& commands) {
  const auto percent = std::make_shared<double>(100);
  auto& command =
      commands.add("override", "set the feed override; 0 stops the feed, rapids keep their speed", "50",
                   commands.online([&commands, percent] { return setFeedOverride(commands.node, *percent); }));
  constexpr double max = kMaxFeedOverride * 100;
  command.add_option("PERCENT", *percent, format("of the job's feed, 0 to %g", max))
      ->required()
      ->check(within(0, max, "%"));
}

void addConfirmSwivel(Commands& commands) {
  const auto degrees = std::make_shared<double>(0);
  auto& command =
      commands.add("confirm-swivel", "confirm the angle at which the swivel has been set and clamped by hand", "32.34",
                   commands.online([&commands, degrees] { return confirmSwivel(commands.node, *degrees); }));
  command.add_option("DEG", *degrees, "as setup.swivel_deg of the job, -90 to 90")
      ->required()
      ->check(within(-90, 90, "deg"));
}

/// Arguments of `grind jog`.
struct JogOptions {
  std::string axis;
  double distance = 0;
  double feed = 0;
};

void addJog(Commands& commands) {
  const auto options = std::make_shared<JogOptions>();
  auto& command = commands.add("jog", "move an axis by hand; waits until it rests, and Ctrl-C and Ctrl-Z stop it",
                               "y 0.5 --feed 100", commands.online([&commands, options] {
                                 const auto axis = std::string(kAxisLetters).find(options->axis);
                                 return jog(commands.node, static_cast<int>(axis), options->distance, options->feed);
                               }));
  addAxis(command, options->axis);
  command.add_option("DISTANCE", options->distance, "in mm, of A in deg; negative in the other direction")->required();
  command.add_option("--feed", options->feed, "in mm/min, of A in deg/min (default: parameter jog_velocity)")
      ->check([](const std::string& text) { return parseNumber(text.c_str()) > 0 ? "" : text + "; allowed: above 0"; });
}

void addStatus(Commands& commands) {
  const auto json = std::make_shared<bool>(false);
  addJson(commands.add("status", "print what the grinder is doing", "",
                       commands.online([&commands, json] { return printStatus(commands.node, *json); })),
          *json);
}

/// The text in the help on what the command waits for.
std::string waiting(MachineEvent event) {
  switch (event) {
    case MachineEvent::kHome: return "; waits for the end, and Ctrl-C switches the power off";
    case MachineEvent::kLift: return "; waits for the end, and Ctrl-C and Ctrl-Z stop it";
    case MachineEvent::kCancel: return ", whoever started it; waits for the end";
    default: return "";
  }
}

/// Adds the requests without arguments.
void addRequests(Commands& commands) {
  for (const EventRow& row : kMachineEvents) {
    if (isSwitch(row.value) || (!isTrigger(row.value) && !isStop(row.value))) continue;
    commands.add(row.name, row.help + waiting(row.value), "",
                 commands.online([&commands, event = row.value] { return request(commands.node, event); }));
  }
}

/// Adds `spindle on` and the like: a command for each first word, with the second as its sub-command.
void addSwitches(Commands& commands) {
  std::map<std::string, CLI::App*> parents;
  for (const EventRow& row : kMachineEvents) {
    if (!isSwitch(row.value)) continue;
    const std::string name = row.name;
    const std::string part = name.substr(0, name.find(' '));
    CLI::App*& parent = parents[part];
    if (!parent) parent = &commands.add(part, "switch the " + part + " by hand", "on", nullptr);
    commands.addTo(*parent, name.substr(part.size() + 1), row.help, "",
                   commands.online([&commands, event = row.value] { return request(commands.node, event); }));
  }
}

}  // namespace

void addMachineCommands(Commands& commands) {
  addOverride(commands);
  addConfirmSwivel(commands);
  addJog(commands);
  addStatus(commands);
  addRequests(commands);
  addSwitches(commands);
}

}  // namespace grinder
