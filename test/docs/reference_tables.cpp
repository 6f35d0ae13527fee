// Prints the keys of job files and wheel files, and the parameters for which the node and the drives ask, as JSON for
// docs/make_reference.py.

#include "flute_grinder/job/job_fields.h"
#include "flute_grinder/job/wheel_file.h"

#include "node/parameter_sections.h"

#include <nlohmann/json.hpp>

#include <algorithm>
#include <iostream>
#include <set>
#include <string>
#include <vector>

using namespace grinder;
using Json = nlohmann::json;

namespace {

Json row(const std::string& key, const std::string& unit, const std::string& allowed, const char* meaning,
         const char* omitted) {
  return {{"key", key},
          {"unit", unit},
          {"allowed", allowed},
          {"meaning", meaning},
          {"omitted", omitted ? Json(omitted) : Json(nullptr)}};
}

/// The symbol of a unit, without the blank before it.
std::string symbolOf(Unit unit) {
  const std::string nothing = text(Quantity{0, unit});
  return nothing.substr(std::min<std::size_t>(nothing.size(), 2));
}

Json rowOf(const JobField& field) {
  const std::string range = text(Quantity{field.min, Unit::kNone}, Quantity{field.max, Unit::kNone}, 10);
  return row(field.file_key, symbolOf(field.unit), range, field.meaning, field.omitted);
}

Json rowOf(const OtherKey& key) { return row(key.file_key, "", key.allowed, key.meaning, key.omitted); }

Json rowOf(const AskedParameter& p) { return row(p.name, p.about.unit, p.allowed, p.about.meaning, p.about.omitted); }

/// The parameters of each section that none before it has.
Json parameters() {
  Json sections;
  std::set<std::string> known;
  for (const test_support::ParameterSection& section : test_support::kParameterSections) {
    for (const AskedParameter& asked : section.askedIn(test_support::allParameters(section.isHal()))) {
      if (known.insert(asked.name).second) sections[section.name].push_back(rowOf(asked));
    }
  }
  return sections;
}

/// The rows of a file, section by section.
Json tableOf(const std::vector<JobField>& fields, const std::vector<OtherKey>& others) {
  std::vector<Json> rows;
  for (const JobField& field : fields) rows.push_back(rowOf(field));
  for (const OtherKey& key : others) rows.push_back(rowOf(key));
  const auto section = [](const Json& row) {
    const std::string key = row["key"];
    return key.find('.') == std::string::npos ? 0
           : key.rfind("cutter.", 0) == 0     ? 1
           : key.rfind("process.", 0) == 0    ? 2
                                              : 3;
  };
  std::stable_sort(rows.begin(), rows.end(), [&](const Json& a, const Json& b) { return section(a) < section(b); });
  return rows;
}

}  // namespace

int main() {
  std::vector<JobField> fields;
  visitJobFields([&](const JobField& field, auto) { fields.push_back(field); });
  Json all = parameters();
  all["job"] = tableOf(fields, otherJobKeys());
  all["wheel"] = tableOf(wheelFields(), otherWheelKeys());
  std::cout << all.dump(1) << '\n';
}
