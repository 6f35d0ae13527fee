// Every parameter that the readers of the node and of the drives ask for: missed and refused by its name, and never
// overlooked where it is misspelled.

#include "parameter_sections.h"
#include "refusal.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <sstream>
#include <string>

namespace grinder {
namespace test_parameters {

using namespace test_support;

const std::string kAnyJoint = "<joint>";

/// The group of a parameter, and its last word, e.g. "joint_limits/axis_x" and "max_jerk".
YAML::Node groupOf(YAML::Node tree, const std::string& path, std::string& word) {
  std::istringstream words(path);
  std::getline(words, word, '/');
  for (std::string next; std::getline(words, next, '/'); word = next) tree.reset(tree[word]);
  return tree;
}

std::string ofTheFirstAxis(std::string path) {
  const std::size_t joint = path.find(kAnyJoint);
  if (joint != std::string::npos) path.replace(joint, kAnyJoint.size(), kJointNames[0]);
  return path;
}

class Parameters : public ::testing::TestWithParam<ParameterSection> {
 protected:
  std::string refusal(const YAML::Node& tree) const {
    return refusalOf<ParameterError>([&] { GetParam().askedIn(tree); });
  }

  /// What is said with a group of parameters changed. @param change gets the group and the last word of the path.
  template <typename Change>
  std::string refusalChanged(const std::string& path, const Change& change) const {
    YAML::Node tree = YAML::Clone(good_);
    std::string word;
    YAML::Node group = groupOf(tree, path, word);
    change(group, word);
    return refusal(tree);
  }
  std::string refusalWith(const std::string& path, const std::string& value, const std::string& suffix = "") const {
    return refusalChanged(path, [&](YAML::Node& group, const std::string& word) { group[word + suffix] = value; });
  }

  /// @param use called with each parameter of the first axis, and with its full name.
  template <typename Use>
  void forEach(const Use& use) const {
    for (const AskedParameter& asked : GetParam().askedIn(good_)) {
      const std::string path = ofTheFirstAxis(asked.name);
      SCOPED_TRACE(path);
      use(asked, path, "parameter /grinder/" + path);
    }
  }

  /// Of an end of a range, which may name another parameter.
  std::string figureOf(const std::string& words) const {
    if (words.front() != '`') return words;
    std::string word;
    const YAML::Node group = groupOf(YAML::Clone(good_), ofTheFirstAxis(words.substr(1, words.size() - 2)), word);
    std::ostringstream shown;
    shown << group[word].as<double>();
    return shown.str();
  }

  static bool isPath(const AskedParameter& asked) { return asked.allowed.find("~/") != std::string::npos; }
  static bool isNumber(const AskedParameter& asked) { return asked.allowed.find(" to ") != std::string::npos; }

  const YAML::Node good_ = allParameters(GetParam().isHal());
};

INSTANTIATE_TEST_SUITE_P(, Parameters, ::testing::ValuesIn(kParameterSections),
                         [](const auto& info) { return std::string(info.param.name); });

TEST_P(Parameters, ThatAreGoodAreTaken) {
  EXPECT_EQ(refusal(good_), "");
  EXPECT_GE(GetParam().askedIn(good_).size(), 3u);
}

TEST_P(Parameters, EachIsMissedAndRefusedOfTheWrongType) {
  forEach([&](const AskedParameter& asked, const std::string& path, const std::string& full) {
    const bool number = isNumber(asked);
    const std::string wrong = refusalWith(path, number ? "fast" : "7");
    EXPECT_EQ(wrong.find(full + (number ? " = \"fast\"; allowed: " : " = 7; allowed: ")), 0u) << wrong;
    // These may be left out alone.
    if (path == "hardware/swivel" || path == "hardware/pace") return;
    const std::string missed =
        refusalChanged(path, [](YAML::Node& group, const std::string& word) { group.remove(word); });
    EXPECT_EQ(missed.find(full + " is missing"), 0u) << missed;
  });
}

TEST_P(Parameters, NumbersAreRefusedBeyondTheirRangeInTheWordsOfTheReference) {
  forEach([&](const AskedParameter& asked, const std::string& path, const std::string& full) {
    if (!isNumber(asked) || path == "hardware/buffer") return;  // of which the reference says more
    std::istringstream words(asked.allowed);
    std::string lowest, to, highest, whole;
    words >> lowest >> to >> highest >> whole;
    if (!whole.empty()) highest.pop_back();
    ASSERT_EQ(asked.allowed, lowest + " to " + highest + (whole.empty() ? "" : ", whole"));
    for (const std::string& end : {lowest, highest}) {
      if (end != figureOf(end)) continue;
      const std::string said = refusalWith(path, end);
      EXPECT_NE(said.find(full + " = " + end + "; allowed: "), 0u) << said;
    }
    lowest = figureOf(lowest);
    // Beyond late_cycle/fault it is that which is refused.
    highest = path == "late_cycle/slow_down" ? "1e+09" : figureOf(highest);
    const double low = std::stod(lowest), high = std::stod(highest);
    for (const double beyond : {low > 0 ? low * 0.99 : low < 0 ? low * 1.01 : -0.01, high * 1.01}) {
      std::ostringstream shown;
      shown << beyond;
      EXPECT_EQ(refusalWith(path, shown.str()), full + " = " + shown.str() + "; allowed: " + lowest + " to " + highest);
    }
  });
}

TEST_P(Parameters, AMisspelledOneIsNamedWithTheRightOne) {
  // A file of HAL lies over one with another drive's parameters; the machine's reader leaves those of the node to
  // others.
  if (GetParam().isHal() || GetParam().name == std::string("machine")) return;
  forEach([&](const AskedParameter&, const std::string& path, const std::string& full) {
    if (path == "hardware/type") return;
    const std::string word = path.substr(path.rfind('/') + 1);
    EXPECT_EQ(refusalWith(path, "1", "s"), full + "s is not known; did you mean '" + word + "'?");
  });
}

TEST_P(Parameters, APathDoesNotDependOnWhereTheNodeWasStarted) {
  forEach([&](const AskedParameter& asked, const std::string& path, const std::string& full) {
    if (!isPath(asked)) return;
    for (const char* relative : {"fg/", "./fg/", "../fg", "~other/fg/", "$HOME/fg"}) {
      EXPECT_EQ(refusalWith(path, relative),
                full + " = \"" + relative + "\"; allowed: an absolute path, or one that begins with ~/");
    }
    EXPECT_EQ(refusalWith(path, "~/fg/"), "");
  });
}

TEST(NodeFilesOfPaths, AreBelowTheHomeFolder) {
  YAML::Node good = allParameters(false);
  good["journal"] = "~/fg/";
  good["offsets"] = "~/offsets";
  const std::string home = std::getenv("HOME");
  const NodeFiles own = readNodeFiles(ParameterReader(toXmlRpc(good), "/a"), "/a/b");
  EXPECT_EQ(own.journal, home + "/fg/a/b.journal");
  EXPECT_EQ(own.offsets, home + "/offsets");
}

/// The parameters of a file, with <joint> for each axis.
void addLeaves(const YAML::Node& tree, const std::string& path, std::set<std::string>& names) {
  for (const auto& item : tree) {
    const auto key = item.first.as<std::string>();
    const bool joint = std::find(std::begin(kJointNames), std::end(kJointNames), key) != std::end(kJointNames);
    const std::string name = path + (joint ? kAnyJoint : key);
    if (item.second.IsMap()) {
      addLeaves(item.second, name + "/", names);
    } else {
      names.insert(name);
    }
  }
}

TEST(ShippedParameters, AreInTheReferenceAndLackNone) {
  std::set<std::string> shipped, known, needed;
  for (const char* file : {"config/grinder.yaml", "config/hal.yaml"}) addLeaves(YAML::LoadFile(file), "", shipped);
  for (const ParameterSection& section : kParameterSections) {
    for (const AskedParameter& asked : section.askedIn(allParameters(section.isHal()))) {
      known.insert(asked.name);
      if (!asked.about.omitted) needed.insert(asked.name);
    }
  }
  for (const std::string& name : shipped) EXPECT_TRUE(known.count(name)) << name;
  // The launch file sets these.
  for (const char* name : {"journal", "offsets", "history", "tolerances"}) EXPECT_EQ(needed.erase(name), 1U) << name;
  for (const std::string& name : needed) EXPECT_TRUE(shipped.count(name)) << name;
}

}  // namespace test_parameters
}  // namespace grinder
