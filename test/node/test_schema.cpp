#include "drive/hal_parameters.h"
#include "drive/simulated_drive.h"
#include "flute_grinder/control/machine_config.h"
#include "flute_grinder/job/yaml_text.h"
#include "node/node_files.h"

#include "yaml_parameters.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

/// @file
/// Holds docs/schema.yaml against what reads parameters: each is refused where it is missing, of the wrong type or beyond
/// its range, in the very words that the schema's figures make; each end of a range is taken; and there is no parameter
/// that the schema does not know.

namespace grinder {
namespace test_schema {

using Names = std::set<std::string>;

YAML::Node schema(const std::string& section) {
  static const YAML::Node all = YAML::LoadFile("docs/schema.yaml");
  return all[section];
}

/// The way to a key: 'process.overtravel_mm[0]' or 'joint_limits/axis_x/max_jerk' as a list.
std::vector<std::string> steps(const std::string& path) {
  std::vector<std::string> list;
  std::istringstream words(std::regex_replace(path, std::regex(R"([./\[\]]+)"), " "));
  for (std::string word; words >> word;) list.push_back(word);
  return list;
}

YAML::Node child(YAML::Node tree, const std::string& step) {
  return tree.IsSequence() ? tree[std::stoul(step)] : tree[step];
}

/// The node of a key, made if it is missing.
YAML::Node at(YAML::Node tree, const std::string& path) {
  for (const std::string& step : steps(path)) tree.reset(child(tree, step));
  return tree;
}

template <typename Value>
YAML::Node with(const YAML::Node& tree, const std::string& path, const Value& value) {
  YAML::Node copy = YAML::Clone(tree);
  at(copy, path) = value;
  return copy;
}

YAML::Node without(const YAML::Node& tree, const std::string& path) {
  YAML::Node copy = YAML::Clone(tree), parent = copy;
  std::vector<std::string> way = steps(path);
  const std::string last = way.back();
  way.pop_back();
  for (const std::string& step : way) parent.reset(child(parent, step));
  if (parent.IsSequence() ? parent.remove(std::stoul(last)) : parent.remove(last)) return copy;
  throw std::out_of_range(path);
}

std::string text(double value, int digits) {
  std::ostringstream stream;
  stream.precision(digits);
  stream << value;
  return stream.str();
}

bool begins(const std::string& text, const std::string& with) { return text.compare(0, with.size(), with) == 0; }
bool ends(const std::string& text, const std::string& with) {
  return text.size() >= with.size() && text.compare(text.size() - with.size(), with.size(), with) == 0;
}

struct Range {
  double low, high;
  /// A number below and one above, short ones, since they are read again in the refusal.
  std::vector<double> beyond() const { return {low > 0 ? low / 2 : low < 0 ? low * 2 : -1, high * 2}; }
};

/// @param tree has the figure of an end that is the name of another key.
Range rangeOf(const YAML::Node& entry, const YAML::Node& tree, const std::string& joint = "") {
  const auto end = [&](const YAML::Node& node) {
    double number = 0;
    if (YAML::convert<double>::decode(node, number)) return number;
    return at(tree, std::regex_replace(node.as<std::string>(), std::regex("<joint>"), joint)).as<double>();
  };
  return {end(entry["range"][0]), end(entry["range"][1])};
}

// ---------------------------------------------------------------------------------------------------------------------
// Parameters

struct Section {
  const char* name;
  /// @param root,hardware all parameters, and those of the drive.
  void (*read)(const ParameterReader& root, const ParameterReader& hardware);
};

void readNode(const ParameterReader& p, const ParameterReader& /*hardware*/) {
  static const MachineModel model(readTextFile("urdf/grinder.urdf", 1'000'000));
  readMachineConfig(model, p, "a text");
  readNodeFiles(p, "/grinder");
}

const Section kSections[]{
    {"machine", readNode},
    {"node", readNode},
    {"simulated_drive",
     [](const ParameterReader& p, const ParameterReader& hardware) { SimulatedDrive::readSimulation(p, hardware); }},
    {"hal", [](const ParameterReader& p, const ParameterReader& hardware) { readHalParameters(p, hardware); }},
};

/// The shipped parameters, and those that may be left out.
YAML::Node goodParameters(bool with_hal) {
  YAML::Node p = YAML::LoadFile("config/grinder.yaml");
  if (with_hal) p["hardware"] = YAML::LoadFile("config/hal.yaml")["hardware"];
  for (const char* file : {"journal", "offsets", "history", "tolerances"}) p[file] = "/tmp/";
  for (const char* joint : kJointNames) {
    YAML::Node limits = p["joint_limits"][joint];
    limits["has_position_limits"] = true;
    limits["has_velocity_limits"] = true;
    limits["min_position"] = -2;
    limits["max_position"] = 2;
    limits["max_velocity"] = 1;
  }
  if (with_hal) return p;
  p["hardware"]["blank"] = YAML::Load("{end_face: 0, diameter: 0.01, run_out: 0, rake_face: {height: 0, angle: 0}}");
  p["hardware"]["swivel"] = 0;
  return p;
}

class SchemaOfParameters : public ::testing::TestWithParam<Section> {
 protected:
  std::string refusal(const YAML::Node& tree) const {
    const XmlRpc::XmlRpcValue p = test_support::toXmlRpc(tree);
    try {
      GetParam().read(ParameterReader(p, "/grinder"), ParameterReader(p["hardware"], "/grinder/hardware"));
    } catch (const ParameterError& error) {
      return error.what();
    }
    return "";
  }

  /// @param use called with a parameter's name, where each joint is one of the axes', its full name in a refusal, its
  ///        entry and its range.
  template <typename Use>
  void forEach(const Use& use) const {
    for (const auto& item : schema(GetParam().name)) {
      const std::string name = item.first.as<std::string>();
      const std::regex placeholder("<joint>");
      for (const std::string joint : kJointNames) {
        const std::string path = std::regex_replace(name, placeholder, joint);
        SCOPED_TRACE(path);
        use(path, "parameter /grinder/" + path, item.second,
            item.second["range"] ? rangeOf(item.second, good_, joint) : Range{});
        if (path == name) break;
      }
    }
  }

  static std::string type(const YAML::Node& entry) { return entry["type"] ? entry["type"].as<std::string>() : ""; }

  /// What is allowed of a type, as messages have it.
  static std::string words(const YAML::Node& entry) {
    static const std::map<std::string, std::string> words{{"", "a number"},
                                                          {"flag", "true or false"},
                                                          {"text", "a text"},
                                                          {"path", "an absolute path, or one that begins with ~/"}};
    return words.at(type(entry));
  }

  /// Whether the range of another parameter ends at this one.
  static bool isLimit(const std::string& path) {
    const std::string name = std::regex_replace(path, std::regex("axis_[xyza]"), "<joint>");
    for (const Section& section : kSections) {
      for (const auto& item : schema(section.name)) {
        for (const auto& end : item.second["range"]) {
          if (end.as<std::string>() == name) return true;
        }
      }
    }
    return false;
  }

  const YAML::Node good_ = goodParameters(GetParam().name == std::string("hal"));
};

INSTANTIATE_TEST_SUITE_P(, SchemaOfParameters, ::testing::ValuesIn(kSections),
                         [](const auto& info) { return std::string(info.param.name); });

TEST_P(SchemaOfParameters, TheGoodOnesAreTaken) { EXPECT_EQ(refusal(good_), ""); }

TEST_P(SchemaOfParameters, EachIsMissed) {
  forEach([&](const std::string& path, const std::string& full, const YAML::Node& entry, Range) {
    // The others may be left out with what belongs to them alone.
    if (path == "hardware/swivel" || path == "hardware/pace") return;
    const std::string missing = full + " is missing";
    const std::string error = refusal(without(good_, path));
    if (type(entry) == "flag") {
      EXPECT_TRUE(begins(error, missing)) << error;
    } else {
      EXPECT_EQ(error, missing + "; allowed: " + words(entry));
    }
  });
}

TEST_P(SchemaOfParameters, AMisspelledOneIsNamedWithTheRightOne) {
  // The file of HAL lies over one with another drive's parameters, and all of its own are needed.
  if (GetParam().name == std::string("hal")) return;
  forEach([&](const std::string& path, const std::string& full, const YAML::Node&, Range) {
    const bool of_drive = begins(path, "hardware/");
    if (of_drive != begins(GetParam().name, "simulated") || path == "hardware/type") return;
    const std::string word = path.substr(path.rfind('/') + 1);
    EXPECT_EQ(refusal(with(good_, path + "s", 1)), full + "s is not known; did you mean '" + word + "'?");
  });
}

TEST_P(SchemaOfParameters, APathDoesNotDependOnWhereTheNodeWasStarted) {
  forEach([&](const std::string& path, const std::string& full, const YAML::Node& entry, Range) {
    if (type(entry) != "path") return;
    for (const char* relative : {"fg/", "./fg/", "../fg", "~other/fg/", "$HOME/fg"}) {
      EXPECT_EQ(refusal(with(good_, path, relative)),
                full + " = \"" + relative + "\"; allowed: an absolute path, or one that begins with ~/");
    }
    EXPECT_EQ(refusal(with(good_, path, "~/fg/")), "");
  });
}

TEST(NodeFilesOfPaths, AreBelowTheHomeFolder) {
  YAML::Node good = goodParameters(false);
  good["journal"] = "~/fg/";
  good["offsets"] = "~/offsets";
  const std::string home = std::getenv("HOME");
  const NodeFiles own = readNodeFiles(ParameterReader(test_support::toXmlRpc(good), "/a"), "/a/b");
  EXPECT_EQ(own.journal, home + "/fg/a/b.journal");
  EXPECT_EQ(own.offsets, home + "/offsets");
}

TEST_P(SchemaOfParameters, TheWrongTypeIsRefused) {
  forEach([&](const std::string& path, const std::string& full, const YAML::Node& entry, Range) {
    const std::string wrong = type(entry).empty() ? "fast" : "7";
    const std::string allowed = words(entry);
    const std::string shown = wrong == "fast" ? "\"fast\"" : wrong;
    EXPECT_EQ(refusal(with(good_, path, wrong)), full + " = " + shown + "; allowed: " + allowed);
  });
}

TEST_P(SchemaOfParameters, NumbersAreTakenUpToTheEndsOfTheRange) {
  forEach([&](const std::string& path, const std::string& full, const YAML::Node& entry, const Range& range) {
    if (!type(entry).empty()) return;
    for (const double value : {range.low, range.high}) {
      const std::string error = refusal(with(good_, path, value));
      EXPECT_TRUE(isLimit(path) ? !begins(error, full + " = ") : error.empty()) << error;
    }
    const std::string allowed = "; allowed: " + text(range.low, 6) + " to " + text(range.high, 6);
    for (const double value : range.beyond()) {
      EXPECT_EQ(refusal(with(good_, path, value)), full + " = " + text(value, 6) + allowed);
    }
    if (!entry["integer"]) return;
    const double broken = range.low + 0.5;
    EXPECT_EQ(refusal(with(good_, path, broken)), full + " = " + text(broken, 6) + "; allowed: a whole number");
  });
}

TEST_P(SchemaOfParameters, AFlagOfALimitIsTrue) {
  forEach([&](const std::string& path, const std::string& full, const YAML::Node& entry, Range) {
    if (type(entry) != "flag") return;
    const std::string error = refusal(with(good_, path, false));
    if (entry["allowed"]) {
      EXPECT_EQ(entry["allowed"].as<std::string>(), "true");
      EXPECT_TRUE(begins(error, full + " = false; allowed: true")) << error;
    } else {
      EXPECT_EQ(error, "");
    }
  });
}

/// The parameters of a file, with <joint> for each axis.
void addLeaves(const YAML::Node& tree, const std::string& path, Names& names) {
  for (const auto& item : tree) {
    const std::string name = path + item.first.as<std::string>();
    if (item.second.IsMap()) {
      addLeaves(item.second, name + "/", names);
    } else {
      names.insert(std::regex_replace(name, std::regex("/axis_[xyza](?=/|$)"), "/<joint>"));
    }
  }
}

TEST(Schema, KnowsEveryParameterOfTheShippedFilesWhichLackNone) {
  Names shipped, known, needed;
  for (const char* file : {"config/grinder.yaml", "config/hal.yaml"}) addLeaves(YAML::LoadFile(file), "", shipped);
  for (const Section& section : kSections) {
    for (const auto& item : schema(section.name)) {
      known.insert(item.first.as<std::string>());
      if (!item.second["default"]) needed.insert(item.first.as<std::string>());
    }
  }
  for (const std::string& name : shipped) EXPECT_TRUE(known.count(name)) << name;
  // The launch file sets these.
  for (const char* name : {"journal", "offsets", "history", "tolerances"}) EXPECT_EQ(needed.erase(name), 1U) << name;
  for (const std::string& name : needed) EXPECT_TRUE(shipped.count(name)) << name;
}

}  // namespace test_schema
}  // namespace grinder
