#include "flute_grinder/messages/json.h"

#include "flute_grinder/base/escaped.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_fields.h"
#include "flute_grinder/tool/pass_removal.h"

#include <algorithm>
#include <type_traits>
#include <vector>

namespace grinder {

namespace {

using namespace units;

/// The JSON pointer to a key of a job file, e.g. "process.overtravel_mm[0]".
Json::json_pointer pointerTo(const std::string& key) {
  std::string pointer = "/";
  for (const char c : key) {
    if (c != ']') pointer += c == '.' || c == '[' ? '/' : c;
  }
  return Json::json_pointer(pointer);
}

std::vector<double> degrees(const std::vector<double>& angles) {
  std::vector<double> list(angles.size());
  std::transform(angles.begin(), angles.end(), list.begin(),
                 [](double angle) { return shopNumber(angle, Unit::kRadian); });
  return list;
}

std::vector<double> evenAngles(std::size_t teeth) {
  std::vector<double> angles(teeth);
  for (std::size_t i = 0; i < teeth; ++i) {
    angles[i] = static_cast<double>(i) * 360.0 / static_cast<double>(teeth) * kDegree;
  }
  return angles;
}

template <typename Choice>
Json choiceJson(Choice choice) {
  if constexpr (std::is_enum_v<Choice>)
    return toString(choice);
  else
    return choice;
}

void addTeeth(Json& file, const GrindJob& job) {
  if (job.tooth_angles == evenAngles(job.tooth_angles.size())) {
    file["cutter"]["teeth"] = job.tooth_angles.size();
  } else {
    file["cutter"]["tooth_angles_deg"] = degrees(job.tooth_angles);
  }
  if (job.spiral_angles.empty()) return;
  file["cutter"].erase("spiral_angle_deg");
  file["cutter"]["spiral_angles_deg"] = degrees(job.spiral_angles);
}

/// The numbers and choices of an operation and of the whole job.
Json fieldsOf(const GrindJob& job) {
  Json file = Json::object();
  visitJobFields([&](const JobField& field, auto of) {
    if (field.isOf(job.process().kind)) file[pointerTo(field.file_key)] = shopNumber(of(job), field.unit);
  });
  visitJobChoices(
      [&](const std::string& path, int, auto of) { file[pointerTo(fieldName(path))] = choiceJson(of(job)); });
  Json& process = file["process"];
  process.erase("kind");
  if (!isTapered(job.process().wheel_profile)) process["wheel"].erase("side");
  for (const ProfilePoint& point : job.process().wheel_points) {
    process["wheel"]["points_mm"].push_back(
        {shopNumber(point.w, Unit::kMetre), shopNumber(point.radius, Unit::kMetre)});
  }
  return file;
}

/// An operation as an element of a job file's list.
Json operationOf(const GrindJob& job) {
  Json process = fieldsOf(job)["process"];
  const OperationRow& row = rowOf(job.process().kind);
  process["kind"] = row.kind;
  if (*row.relief != '\0') process["relief"] = row.relief;
  if (row.value == OperationKind::kFlute) return process;
  for (const char* key : {"z_law", "incomplete_ok"}) process.erase(key);
  return process;
}

}  // namespace

Json toJson(const Axes& value, const std::string& per_time) {
  return {{"x_mm" + per_time, value[kX] / kMillimetre},
          {"y_mm" + per_time, value[kY] / kMillimetre},
          {"z_mm" + per_time, value[kZ] / kMillimetre},
          {"a_deg" + per_time, value[kA] / kDegree}};
}

Json toJson(const std::vector<FeedLimit>& limits) {
  Json json = Json::array();
  for (const FeedLimit& limit : limits) {
    json.push_back(
        {{"cause", limit.cause}, {"from_x_mm", limit.from_x / kMillimetre}, {"to_x_mm", limit.to_x / kMillimetre}});
  }
  return json;
}

Json toJson(const std::vector<PassRemoval>& passes) {
  Json json = Json::array();
  for (const auto& [depth, area, rate, volume] : passes) {
    json.push_back({{"depth_mm", depth / kMillimetre},
                    {"area_mm2", area / kMillimetre2},
                    {"rate_mm3_s", rate / kMillimetre3},
                    {"volume_mm3", volume / kMillimetre3}});
  }
  return json;
}

Json toJson(const GrindJob& job) {
  Json file = fieldsOf(job);
  addTeeth(file, job);
  file.erase("process");
  for (const GrindJob& one : job.ofAllOperations()) file["operations"].push_back(operationOf(one));
  file["operation"] = toString(job.process().kind);
  return file;
}

void escapeTexts(Json& json) {
  if (json.is_string()) json = escaped(json.get_ref<const std::string&>());
  if (!json.is_structured()) return;
  for (auto& item : json) escapeTexts(item);
}

std::string text(const Json& json, int indent) { return json.dump(indent, ' ', false, Json::error_handler_t::replace); }

}  // namespace grinder
