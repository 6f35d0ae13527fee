#include "cli/arguments.h"

#include "cli/completion.h"
#include "cli/machine_file.h"
#include "cli/offsets.h"

#include <vector>

namespace grinder {

void addJob(CLI::App& command, std::string& job) {
  command.add_option("JOB", job, "job file (YAML, mm, deg, mm/min)")->required()->type_name(kYamlFile);
}

CLI::Option& addOperation(CLI::App& command, std::string& operation) {
  return *command
              .add_option("--operation", operation,
                          "which of the job's operations, by number or kind: 1 or flute, 2 or primary, ...")
              ->type_name("NAME");
}

void addCsv(CLI::App& command, std::string& csv, const char* description) {
  command.add_option("--csv", csv, description)->type_name(kAnyFile);
}

void addJson(CLI::App& command, bool& json) { command.add_flag("--json", json, "print only JSON"); }

CLI::Option* addAnswer(CLI::App& command, std::vector<std::string>& answers, const std::vector<NeedAnswer>& possible) {
  std::vector<std::string> names;
  std::string listed;
  for (const NeedAnswer answer : possible) {
    names.emplace_back(toString(answer));
    listed += (listed.empty() ? "" : "|") + names.back();
  }
  return command
      .add_option("--answer", answers, "answer beforehand what the grinder would ask; may be given several times")
      ->allow_extra_args(false)
      ->check(CLI::IsMember(names).description(""))
      ->type_name("{" + listed + "}");
}

void addCountedJob(CLI::App& command, const char* name, int& number) {
  command.add_option(name, number, "which of a bag's jobs, counted from 1 (default: the last)")
      ->check([](const std::string& text) {
        return std::strtol(text.c_str(), nullptr, 10) >= 1 ? "" : text + "; allowed: 1 or more";
      });
}

void addMachine(CLI::App& command, std::string& parameters, std::string& urdf) {
  command.add_option("--machine", parameters, "parameters of the machine (default: config/grinder.yaml)")
      ->type_name(kYamlFile);
  command.add_option("--urdf", urdf, "robot description (default: urdf/grinder.urdf)")->type_name(kUrdfFile);
  command.final_callback([&parameters, &urdf] {
    if (parameters.empty()) parameters = packageFile("config/grinder.yaml");
    if (urdf.empty()) urdf = packageFile("urdf/grinder.urdf");
  });
}

void addAxis(CLI::App& command, std::string& axis) {
  std::vector<std::string> axes;
  std::string names;
  for (const char* letter = kAxisLetters; *letter != '\0'; ++letter) {
    axes.emplace_back(1, *letter);
    names += (names.empty() ? "" : "|") + axes.back();
  }
  command.add_option("AXIS", axis, "which axis")
      ->required()
      ->check(CLI::IsMember(axes).description(""))
      ->type_name("{" + names + "}");
}

void addFlange(CLI::App& command, std::optional<double>& flange_mm) {
  command
      .add_option("--flange", flange_mm, "from the flange's face to the wheel's upper face (default: the wheel file's)")
      ->type_name("MM")
      ->check(within(-100, 100, "mm"));
}

}  // namespace grinder
