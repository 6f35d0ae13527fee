#include "cli/command_line.h"
#include "temp_folder.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

// What the command line says of its arguments; nothing is carried out.
namespace grinder {
namespace test_usage {

using Words = std::vector<std::string>;

struct Said {
  std::optional<int> status;
  std::string out, err;
};

Said parse(const Words& words) {
  std::vector<const char*> arguments{"grind"};
  for (const std::string& word : words) arguments.push_back(word.c_str());
  ::testing::internal::CaptureStdout();
  ::testing::internal::CaptureStderr();
  CommandLine line;
  Said said{line.parse(static_cast<int>(arguments.size()), arguments.data()), "", ""};
  said.out = ::testing::internal::GetCapturedStdout();
  said.err = ::testing::internal::GetCapturedStderr();
  return said;
}

Words wordsOf(const std::string& line) {
  std::istringstream words(line);
  return {std::istream_iterator<std::string>(words), {}};
}

struct Unknown {
  const char *line, *refusal;
};

TEST(UnknownWord, IsNamedWithTheNearest) {
  for (const Unknown& it : {
           Unknown{"frob", "frob: no such command of 'grind'; did you mean 'probe'?"},
           Unknown{"stauts", "stauts: no such command of 'grind'; did you mean 'status'?"},
           Unknown{"hodl", "hodl: no such command of 'grind'; did you mean 'hold'?"},
           Unknown{"off", "off: no such command of 'grind'; did you mean 'offsets'?"},
           Unknown{"polish", "polish: no such command of 'grind'"},
           Unknown{"-", "-: no such command of 'grind'"},
           Unknown{"wheel shw w.yaml", "shw: no such command of 'grind wheel'; did you mean 'show'?"},
           Unknown{"report --ros-args", "--ros-args: no such option of 'grind report'"},
           Unknown{"plan --speed=9", "--speed: no such option of 'grind plan'"},
           Unknown{"plan j --cvs x", "--cvs: no such option of 'grind plan'; did you mean '--csv'?"},
           Unknown{"jog x 1 -x", "-x: no such option of 'grind jog'"},
           Unknown{"--nod x status", "--nod: no such option of 'grind'; did you mean '--node'?"},
           Unknown{"status --node x", "--node: goes before the command: grind --node ... status"},
           Unknown{"probe tooth --node x", "--node: goes before the command: grind --node ... probe tooth"},
           Unknown{"hold now", "now: no such argument of 'grind hold'"},
           Unknown{"jog x 1 2", "2: no such argument of 'grind jog'"},
       }) {
    const Said said = parse(wordsOf(it.line));
    EXPECT_EQ(said.status, kUsage) << it.line;
    EXPECT_EQ(said.err, it.refusal + std::string("\nRun with --help for more information.\n"));
    EXPECT_EQ(said.out, "");
  }
}

TEST(Usage, ThatIsWrongIsRefused) {
  const std::vector<std::pair<std::string, Words>> rows{
      {"", {"", "plan", "run", "spindle", "wheel", "probe", "override", "touch-off", "completion"}},
      {"table j", {"", "--step-length 0", "--step-length -0.2", "--step-length long", "--step-length nan"}},
      {"table j --step-length 0.2 --even-step", {"newest"}},
      {"simulate j", {"--at 1,x", "--sections 1", "--sections 2000", "--at 1 --sections 3"}},
      {"history", {"--since yesterday", "--until 2026-02-30", "--verdict good", "--grinder left"}},
      {"spindle", {"1"}},
      {"wheel", {"show", "turn w.yaml", "measure w", "measure w --width 2"}},
      {"wheel measure w --diameter", {"nan", "-1", "0", "inf", "small", "124 --width -1"}},
      {"wheel dress w", {"--radial -0.1", "--radial nan", "--face inf"}},
      {"wheel dress w --radial 0.1 --face", {"-1"}},
      {"zeros j", {"--flange 2", "--stickout nan --flange 2", "--stickout 0 --flange 2"}},
      {"zeros j --stickout 60", {"--flange 100.1", "--flange nan", "--set --machine m", "--set --urdf u"}},
      {"probe", {"end-face", "tooth", "end-face --job j --within 0", "tooth --job j --within 361"}},
      {"probe diameter", {"--within nan", "--at -1 --job j"}},
      {"override", {"-1", "120.5", "nan", "full"}},
      {"confirm-swivel", {"", "90.5", "-91", "nan", "steep"}},
      {"offsets --set", {"b=1"}},
      {"touch-off", {"b", "x --at nan"}},
      {"jog", {"b 1", "x", "x 1 --feed 0"}},
      {"run", {"--continue", "j --answer yes", "j --answer set-offset"}},
      {"report record.bag -o report.html --job", {"0"}},
      {"completion", {"fish"}},
  };
  for (const auto& [command, all] : rows) {
    for (const std::string& arguments : all) {
      SCOPED_TRACE(command + " " + arguments);
      const Said said = parse(wordsOf(command + " " + arguments));
      EXPECT_EQ(said.status, kUsage);
      EXPECT_NE(said.err, "");
    }
  }
}

TEST(Usage, ThatIsRightIsTaken) {
  for (const char* line :
       {"--node left/grinder status --json", "table j --step-length 0.2 --even-step exact", "run j --continue --csv c",
        "probe tooth --job j --within 360 --flange 2", "probe diameter --at 10 --job j", "jog a -1.5 --feed 10",
        "confirm-swivel -90", "override 120", "offsets --set x=-1.5 --set a=2 --answer set-offset",
        "wheel measure w --diameter 124 --width 2", "wheel dress w --radial 0.1", "wheel dress w --face 0.1",
        "zeros j --stickout 62 --flange 100 --machine m --urdf u", "simulate j --sections 2"}) {
    const Said said = parse(wordsOf(line));
    EXPECT_FALSE(said.status) << line << said.err;
  }
}

struct Mentioned {
  const char* command;
  Words words;
};

TEST(Help, NamesArgumentsRangesAndKeys) {
  for (const Mentioned& it : {
           Mentioned{"table", {"JOB", "--even-step", "published|third_order|exact"}},
           Mentioned{"run", {"JOB", "Ctrl-Z"}},
           Mentioned{"goal", {"JOB", "flute_grinder/GrindGoal"}},
           Mentioned{"override", {"PERCENT", "0 to 120"}},
           Mentioned{"confirm-swivel", {"DEG", "-90 to 90"}},
           Mentioned{"offsets", {"--set", "AXIS=VALUE"}},
           Mentioned{"touch-off", {"AXIS", "x|y|z|a"}},
       }) {
    const Said said = parse({it.command, "--help"});
    for (const std::string& word : it.words) EXPECT_NE(said.out.find(word), std::string::npos) << it.command << word;
  }
}

TEST(Help, IsThereForEveryCommand) {
  const std::string all = parse({"--help"}).out;
  for (const char* command :
       {"table",   "plan",      "setup",          "simulate",   "run",     "report",  "history", "wheel",
        "zeros",   "jog",       "probe",          "override",   "status",  "offsets", "enable",  "disable",
        "home",    "lift",      "hold",           "resume",     "retract", "cancel",  "reset",   "spindle",
        "coolant", "touch-off", "confirm-swivel", "completion", "goal"}) {
    EXPECT_NE(all.find("\n  " + std::string(command) + " "), std::string::npos) << command;
    const Said help = parse({command, "--help"});
    EXPECT_EQ(help.status, 0) << command;
    // Its example is right usage.
    const std::string before = "\nExample:\n  rosrun flute_grinder grind ";
    const std::size_t at = help.out.find(before);
    ASSERT_NE(at, std::string::npos) << command;
    Words words = wordsOf(help.out.substr(at + before.size()));
    words.erase(std::find(words.begin(), words.end(), ">"), words.end());  // of the shell
    // The machine's files are otherwise those of the package, which ROS has to find.
    for (const char* file : {"--machine", "--urdf"}) {
      if (help.out.find(file) != std::string::npos) words.insert(words.end(), {file, "f"});
    }
    const Said said = parse(words);
    EXPECT_FALSE(said.status) << command << said.err;
  }
}

TEST(Version, IsThePackages) {
  const Said said = parse({"--version"});
  EXPECT_EQ(said.status, 0);
  const std::string package = test_support::readFile("package.xml"), before = "<version>";
  const std::size_t at = package.find(before) + before.size();
  EXPECT_EQ(said.out, "flute_grinder " + package.substr(at, package.find('<', at) - at) + "\n");
}

}  // namespace test_usage
}  // namespace grinder
