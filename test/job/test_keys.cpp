// Every key in the tables of a job file and of a wheel file: refused where it is missing, of the wrong type or beyond
// its range, in the words that the tables give, and taken at either end of the range. There is no key that the tables
// do not have.

#include "flute_grinder/base/file_error.h"
#include "flute_grinder/job/job_fields.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/job/wheel_file.h"

#include <gtest/gtest.h>
#include <yaml-cpp/yaml.h>

#include <algorithm>
#include <regex>
#include <set>
#include <sstream>
#include <string>
#include <vector>

namespace grinder {
namespace test_keys {

using Lines = std::vector<std::string>;

struct File {
  const char* name;
  YAML::Node (*good)();  ///< with every key but the lists and the names of files
  void (*parse)(const std::string& text);
  std::vector<JobField> fields;
  std::vector<OtherKey> others;
};

std::vector<JobField> jobFields() {
  std::vector<JobField> fields;
  visitJobFields([&](const JobField& field, auto) {
    if (field.isOf(OperationKind::kFlute)) fields.push_back(field);
  });
  return fields;
}

YAML::Node goodJob() {
  YAML::Node job = YAML::LoadFile("test/jobs/paper.yaml");
  YAML::Node process = job["process"], wheel = process["wheel"];
  process["depth_end_mm"] = 1.6;
  process["incomplete_ok"] = false;
  wheel["profile"] = "angled";
  wheel["angle_deg"] = 20;
  wheel["side"] = "upper";
  wheel["wear_per_pass_mm"] = 0;
  return job;
}

YAML::Node goodWheel() {
  YAML::Node wheel = YAML::LoadFile("wheels/angled_d100_w10.yaml");
  wheel["measured"] = YAML::Load("{date: 2026-11-20, diameter_mm: 99, width_mm: 9, by: anna}");
  return wheel;
}

const File kFiles[]{
    {"job", goodJob, [](const std::string& text) { parseJob(text, "file"); }, jobFields(), otherJobKeys()},
    {"wheel", goodWheel, [](const std::string& text) { parseWheel(text, "file"); }, wheelFields(), otherWheelKeys()}};

/// The node of a key, e.g. "process.overtravel_mm[0]", made if it is missing.
YAML::Node at(YAML::Node tree, const std::string& key) {
  std::istringstream words(std::regex_replace(key, std::regex(R"([.\[\]]+)"), " "));
  for (std::string word; words >> word;) tree.reset(tree.IsSequence() ? tree[std::stoul(word)] : tree[word]);
  return tree;
}

template <typename Value>
YAML::Node with(const YAML::Node& tree, const std::string& key, const Value& value) {
  YAML::Node copy = YAML::Clone(tree);
  at(copy, key) = value;
  return copy;
}

/// Without a key; of a list without its last element.
YAML::Node without(const YAML::Node& tree, const std::string& key) {
  YAML::Node copy = YAML::Clone(tree);
  const std::string stem = key.substr(0, key.find('[')), leaf = stem.substr(stem.rfind('.') + 1);
  YAML::Node parent = stem == leaf ? copy : at(copy, stem.substr(0, stem.rfind('.')));
  stem == key ? parent.remove(leaf) : parent[leaf].remove(std::size_t{1});
  return copy;
}

class Keys : public ::testing::TestWithParam<File> {
 protected:
  /// What is said of a file, without its name and line.
  Lines refusal(const YAML::Node& tree) const {
    Lines all;
    try {
      GetParam().parse(YAML::Dump(tree));
    } catch (const FileError& error) {
      std::istringstream lines(error.what());
      for (std::string line; std::getline(lines, line);) all.push_back(line.substr(line.find(": ") + 2));
    }
    return all;
  }

  static std::string allowed(const JobField& field) { return text(field.low(), field.high()); }
  static std::string shown(double shop, const JobField& field) {
    return text(Quantity{shop * shopScale(field.unit), field.unit}, 10);
  }

  const YAML::Node good_ = GetParam().good();
};

INSTANTIATE_TEST_SUITE_P(, Keys, ::testing::ValuesIn(kFiles), [](const auto& info) { return info.param.name; });

TEST_P(Keys, OfAGoodFileAreTaken) { EXPECT_EQ(refusal(good_), Lines{}); }

TEST_P(Keys, AreMissed) {
  const std::string hint = "; or process.setup.file, a file that 'grind setup --write' writes";
  for (const JobField& field : GetParam().fields) {
    if (field.omitted) continue;
    const std::string key = std::regex_replace(field.file_key, std::regex(R"(\[0\])"), "[1]");
    const bool is_of_setup = isOfSetup(field);
    EXPECT_EQ(refusal(without(good_, key)),
              Lines{key + " is missing; allowed: " + allowed(field) + (is_of_setup ? hint : "")});
  }
  for (const OtherKey& key : GetParam().others) {
    const YAML::Node node = at(YAML::Clone(good_), key.file_key);
    if (key.omitted || !node.IsScalar()) continue;
    const Lines said = refusal(without(good_, key.file_key));
    ASSERT_EQ(said.size(), 1u) << key.file_key;
    EXPECT_EQ(said[0].find(std::string(key.file_key) + " is missing; allowed: "), 0u) << said[0];
  }
}

TEST_P(Keys, AreNumbersUpToTheEndsOfTheRange) {
  for (const JobField& field : GetParam().fields) {
    SCOPED_TRACE(field.file_key);
    const std::string key = field.file_key, end = "; allowed: " + allowed(field);
    EXPECT_EQ(refusal(with(good_, key, "fast")), Lines{key + " = fast is not a number" + end});
    for (const double value : {field.min, field.max}) {
      // It may contradict other figures.
      for (const std::string& line : refusal(with(good_, key, value))) {
        EXPECT_FALSE(line.find(key + " = ") == 0 && line.find(end) != std::string::npos) << line;
      }
    }
    const double below = field.min > 0 ? field.min * 0.99 : field.min < 0 ? field.min * 1.01 : -0.01;
    for (const double value : {below, field.max * 1.01}) {
      const Lines lines = refusal(with(good_, key, value));
      EXPECT_EQ(std::count(lines.begin(), lines.end(), key + " = " + shown(value, field) + end), 1)
          << key + " = " + shown(value, field) + end;
    }
  }
}

TEST_P(Keys, AreOneOfTheirChoices) {
  for (const OtherKey& key : GetParam().others) {
    if (!std::regex_match(key.allowed, std::regex("[a-z_]+(, [a-z_]+)+"))) continue;
    SCOPED_TRACE(key.file_key);
    const Lines said = refusal(with(good_, key.file_key, "fast"));
    ASSERT_EQ(said.size(), 1u);
    EXPECT_EQ(said[0].find(std::string(key.file_key) + " = fast"), 0u) << said[0];
    EXPECT_NE(said[0].find("; allowed: " + key.allowed), std::string::npos) << said[0];
    std::istringstream words(std::regex_replace(key.allowed, std::regex(","), ""));
    for (std::string word; words >> word;) {
      for (const std::string& line : refusal(with(good_, key.file_key, word))) {
        EXPECT_NE(line.find(std::string(key.file_key) + " = "), 0u) << line;
      }
    }
  }
}

TEST_P(Keys, AreTheOnlyOnes) {
  const Lines lines = refusal(with(good_, "strange", 1));
  ASSERT_EQ(lines.size(), 1u);
  const std::string refused = std::string("strange is not a key of a ") + GetParam().name + " file; allowed: ";
  ASSERT_EQ(lines[0].find(refused), 0u) << lines[0];
  std::istringstream words(std::regex_replace(lines[0].substr(refused.size()), std::regex(","), ""));
  std::set<std::string> allowed, tables;
  for (std::string word; words >> word;) allowed.insert(word);
  const auto is_list = [](const std::string& key) {
    return key.find("angles_deg") != std::string::npos || key.find("points_mm") != std::string::npos;
  };
  for (const JobField& field : GetParam().fields) tables.insert(field.file_key);
  for (const OtherKey& key : GetParam().others) {
    if (!is_list(key.file_key)) tables.insert(key.file_key);
  }
  EXPECT_EQ(allowed, tables);
}

// Of the drawing and of the machine, so that a slip in the table does not pass for the range.
TEST(Ranges, AreWhatTheMachineAndTheToolsNeed) {
  const auto range = [](const std::string& key) {
    for (const JobField& field : jobFields()) {
      if (key == field.file_key) return text(field.low(), field.high());
    }
    return std::string();
  };
  EXPECT_EQ(range("process.setup.swivel_deg"), "-89 to 89 deg");
  EXPECT_EQ(range("cutter.cone_angle_deg"), "-3 to 30 deg");
  EXPECT_EQ(range("process.feed_mm_min"), "0.1 to 10000 mm/min");
  EXPECT_EQ(range("process.wheel.diameter_mm"), "1 to 500 mm");
  EXPECT_EQ(range("interpolation.tolerance_um"), "1e-09 to 1000 um");
}

}  // namespace test_keys
}  // namespace grinder
