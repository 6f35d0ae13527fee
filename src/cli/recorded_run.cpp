#include "cli/recorded_run.h"

#include "flute_grinder/tool/z_law.h"

#include <utility>

namespace grinder {

std::optional<GroundCutter> recordedBefore(const std::string& path, const BagRun& run) {
  std::optional<GroundCutter> ground;
  for (const std::vector<int>& parts : run.before()) {
    std::optional<RunStrokes> strokes;
    for (const int number : parts) {
      const BagRun part(path, number);
      if (!strokes) strokes.emplace(withLaws(*part.job()), std::exchange(ground, std::nullopt));
      part.visit([&](const RunRow& row) { strokes->add(row.setpoint, row.actual); });
    }
    strokes->finish();
    ground = strokes->cutter();
  }
  return ground;
}

std::string recordedBeforeText(const BagRun& run) {
  if (!run.job() || (*run.job())->operation == 0) return "";
  if (run.before().empty()) return ", what is ahead of it as planned";
  std::string numbers;
  for (const std::vector<int>& parts : run.before()) {
    for (const int number : parts) numbers += (numbers.empty() ? "" : ", ") + std::to_string(number);
  }
  return ", what is ahead of it by job " + numbers;
}

}  // namespace grinder
