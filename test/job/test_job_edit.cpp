// Numbers written into job files: of every file and layout, nothing else may change.

#include "flute_grinder/job/job_edit.h"

#include "flute_grinder/job/job_fields.h"

#include "motion/generators.h"
#include "refusal.h"
#include "temp_folder.h"

#include <gtest/gtest.h>
#include <rapidcheck/gtest.h>

#include <array>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

namespace grinder {
namespace test_job_edit {

using Edits = std::vector<JobEdit>;

constexpr const char* kName = "jobs/job.yaml";  // where a wheel file is relative to

/// Those of a single operation.
std::vector<std::string> shippedJobs() {
  std::vector<std::string> texts;
  for (const auto& entry : std::filesystem::directory_iterator("jobs")) {
    const std::string text = test_support::readFile(entry);
    if (text.find("operations:") == std::string::npos) texts.push_back(text);
  }
  return texts;
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  for (std::size_t at = 0; (at = text.find(from, at)) != std::string::npos; at += to.size()) {
    text.replace(at, from.size(), to);
  }
  return text;
}

std::string refusal(const std::string& text, const Edits& edits) {
  return test_support::refusalOf([&] { editJob(text, "job.yaml", edits); });
}

/// With the two overtravels each in a line of its own.
std::string withBlockList(std::string text) {
  const std::size_t at = text.find(" [", text.find("  overtravel_mm:"));
  const std::size_t comma = text.find(", ", at), end = text.find(']', at);
  return text.replace(at, end + 1 - at,
                      "  # list\n  - " + text.substr(at + 2, comma - at - 2) + "  # first\n\n  - " +
                          text.substr(comma + 2, end - comma - 2));
}

/// The shipped files with their setup in flow style become others with the same values.
std::string inLayout(std::string text, int layout) {
  const std::size_t at = text.find("  setup: {swivel_deg: ");
  const std::size_t end = text.find('}', at);
  const std::string inner = text.substr(at + 10, end - at - 10);
  switch (layout) {
    case 1:  // block style, with comments everywhere
      text.replace(at, end + 1 - at,
                   "  setup: # \xC2\xB5m and \xC2\xB0, {braces}: [1]\n      " +
                       replaced(inner, ", ", "   # first\n\n  # between\n      ") + "\n      # after");
      break;
    case 2:  // quoted, with odd spaces
      text.replace(
          at, end + 1 - at,
          "  'setup' :   {  \"" + replaced(replaced(inner, ", ", "' ,\n      \""), ": ", "\" :    '") + "'  }");
      break;
    case 3: text = replaced(text, "\n", "\r\n"); break;
    case 4: text = "\xEF\xBB\xBF# \xC3\xA4\n" + text; break;
    case 5: text = text.substr(0, text.find_last_not_of('\n') + 1); break;  // no end of the last line
    case 6: text = "---\n" + text; break;
    case 7: return withBlockList(text);
    default: break;
  }
  return text;
}

struct Piece {
  std::size_t at, size;
};

/// Where a file has a number of the property below. In a block list, signs stand before the numbers.
Piece numberOf(const std::string& job, std::size_t edit) {
  const std::string key = std::array{"swivel_deg", "height_mm", "  depth_mm", "overtravel_mm", "overtravel_mm"}[edit];
  std::size_t at = job.find_first_of(edit < 3 ? "-0123456789" : "0123456789", job.find(key) + key.size());
  if (edit == 4) at = job.find_first_of("0123456789", job.find_first_of(",\n", at));
  return {at, job.find_first_not_of("-0123456789.", at) - at};
}

/// A number with some decimals, five at most.
std::string anyNumber(double from, double to, int decimals = 0) {
  std::ostringstream text;
  text << std::fixed;
  text.precision(*test_support::whole(decimals, 5));
  text << *test_support::uniform(from, to);
  return text.str();
}

RC_GTEST_PROP(JobEditProperty, ChangesTheNumbersAndNoOtherByte, ()) {
  static const std::vector<std::string> jobs = shippedJobs();
  const std::string text = inLayout(*rc::gen::elementOf(jobs), *test_support::whole(0, 7));
  const Edits edits{{"process.setup.swivel_deg", anyNumber(-60, 60)},
                    {"process.setup.height_mm", anyNumber(-9, 9)},
                    {"process.depth_mm", anyNumber(0.1, 0.15, 2)},
                    {"process.overtravel_mm[0]", anyNumber(0.5, 1)},
                    {"process.overtravel_mm[1]", anyNumber(1, 9)}};
  const GrindJob before = parseJob(text, kName);
  const std::string result = editJob(text, "job.yaml", edits);
  // Put back, the old numbers give the old bytes.
  std::string back = result;
  for (std::size_t i = 0; i < edits.size(); ++i) {
    const Piece old = numberOf(text, i), now = numberOf(back, i);
    RC_ASSERT(std::stod(back.substr(now.at, now.size)) == std::stod(edits[i].value));
    back.replace(now.at, now.size, text, old.at, old.size);
  }
  RC_ASSERT(back == text);
  // What is read: the same job but for these.
  const GrindJob after = parseJob(result, kName);
  visitJobFields([&](const JobField& field, auto of) {
    for (const JobEdit& edit : edits) {
      if (edit.key == field.file_key) return RC_ASSERT(of(after) == std::stod(edit.value) * shopScale(field.unit));
    }
    RC_ASSERT(of(after) == of(before));
  });
}

TEST(JobEdit, LeavesANumberThatHasTheValueAsItIsWritten) {
  for (const std::string& text : shippedJobs()) EXPECT_EQ(editJob(text, "job.yaml", {}), text);
  const std::string text = "process:\n  setup: {swivel_deg: +3.0e1, height_mm: 1.50}\n";
  EXPECT_EQ(editJob(text, "f", {{"process.setup.swivel_deg", "30"}, {"process.setup.height_mm", "1.5"}}), text);
}

const Edits kSetup{{"process.setup.swivel_deg", "31.5"}, {"process.setup.height_mm", "-2"}};

TEST(JobEdit, InsertsIntoItsBlock) {
  const struct {
    const char* name;
    const char* text;
    Edits edits;
    const char* result;
  } rows[]{
      {"AtTheEndOfABlock", "process:\n  a: 1\n  wheel:\n    b: 2  # b\n\n# of c\nc: 3\n", kSetup,
       "process:\n  a: 1\n  wheel:\n    b: 2  # b\n  setup: {swivel_deg: 31.5, height_mm: -2}\n\n# of c\nc: 3\n"},
      {"AtTheEndOfTheFile", "c: 3\nprocess:\n  a: [1,\n    2]\n# end\n", kSetup,
       "c: 3\nprocess:\n  a: [1,\n    2]\n  setup: {swivel_deg: 31.5, height_mm: -2}\n# end\n"},
      {"AfterALineWithoutEnd", "c: 3\nprocess:\n    a: 1", kSetup,
       "c: 3\nprocess:\n    a: 1\n    setup: {swivel_deg: 31.5, height_mm: -2}"},
      {"WithTheFilesLineEnds", "process:\r\n  a: 1\r\nc: 3\r\n", kSetup,
       "process:\r\n  a: 1\r\n  setup: {swivel_deg: 31.5, height_mm: -2}\r\nc: 3\r\n"},
      {"IntoFlowStyle", "{process: {a: 1}, c: 3}\n", kSetup,
       "{process: {setup: {swivel_deg: 31.5, height_mm: -2}, a: 1}, c: 3}\n"},
      {"BesideOneInFlowStyle", "process:\n  setup: { height_mm: 4 } # x\n", kSetup,
       "process:\n  setup: { swivel_deg: 31.5, height_mm: -2 } # x\n"},
      {"BesideOneInBlockStyle", "process:\n  setup:\n      swivel_deg: 4 # x\n  d: 5\n", kSetup,
       "process:\n  setup:\n      swivel_deg: 31.5 # x\n      height_mm: -2\n  d: 5\n"},
      {"AmidABlockList",
       "process:\n  overtravel_mm:\n    - 1  # a\n    # b\n    -   7\n  setup:\n    swivel_deg: 1\n    height_mm: 2\n",
       {{"process.overtravel_mm[0]", "1.5"},
        {"process.overtravel_mm[1]", "8.25"},
        kSetup[0],
        {"process.depth_mm", "3"}},
       "process:\n  overtravel_mm:\n    - 1.5  # a\n    # b\n    -   8.25\n  setup:\n    swivel_deg: 31.5\n    "
       "height_mm: 2\n"
       "  depth_mm: 3\n"},
      {"BesideABlockList",
       "process:\n  overtravel_mm:\n  - 1\n  - 7\n",
       {{"process.overtravel_mm[1]", "8.25"}, kSetup[0], kSetup[1]},
       "process:\n  overtravel_mm:\n  - 1\n  - 8.25\n  setup: {swivel_deg: 31.5, height_mm: -2}\n"},
      {"WithADepth",
       "process:\n  a: 1\nc: 3\n",
       {{"process.depth_mm", "1.25"}, kSetup[0], kSetup[1]},
       "process:\n  a: 1\n  depth_mm: 1.25\n  setup: {swivel_deg: 31.5, height_mm: -2}\nc: 3\n"},
      {"WithoutIndent",
       "process:\n a: \"1\" \n\n \n",
       {{"process.depth_mm", "2"}},
       "process:\n a: \"1\" \n depth_mm: 2\n\n \n"},
  };
  for (const auto& row : rows) {
    SCOPED_TRACE(row.name);
    EXPECT_EQ(editJob(row.text, "job.yaml", row.edits), row.result);
  }
}

TEST(JobEdit, RefusesWhatItCannotEditWithoutRisk) {
  const auto expectRefused = [](const std::string& text, const std::string& why) {
    const std::string said = refusal(text, kSetup);
    EXPECT_NE(said.find(why), std::string::npos) << text << '\n' << said;
  };
  expectRefused("a: &x 1\nprocess:\n  setup: {swivel_deg: 1, height_mm: 2}\n", "job.yaml:1: has an anchor");
  expectRefused("a: &x {swivel_deg: 1, height_mm: 2}\nprocess:\n  setup: *x\n", "job.yaml:1: has an anchor");
  expectRefused("process:\n  <<: {b: 1}\n  setup: {swivel_deg: !!float 1, height_mm: 2}\n", "job.yaml:3: has a value");
  expectRefused("process:\n  setup: {swivel_deg: 1, height_mm: }\n",
                "has a value that is not written as a plain number");
  expectRefused("process:\n  setup: {swivel_deg: \"\\x31\", height_mm: 2}\n", "has a value");
  expectRefused("process:\n  setup: {swivel_deg: 1, height_mm: 2}\n---\na: 1\n", "job.yaml:3: a second document");
  expectRefused("process:\n  setup: {}\n", "job.yaml: cannot be edited");
  expectRefused("process:\n  a: 1\n...\n", "job.yaml: cannot be edited");
  expectRefused("process: |\n  a: 1\n", "process is missing");
  expectRefused("process: [\n", "job.yaml:");
  expectRefused("process:\n  a: 1\n  a: 2\n", "appears twice");
  // UTF-16
  const std::string wide(
      "\xFF\xFEp\0:\0 \0{\0a\0:\0 \0"
      "1\0}\0\n\0",
      22);
  EXPECT_NE(refusal(wide, {{"p.a", "2"}}), "");
}

}  // namespace test_job_edit
}  // namespace grinder
