#include "cli/simulate.h"

#include "cli/history.h"
#include "cli/output_file.h"
#include "cli/recorded_run.h"
#include "cli/report.h"
#include "cli/tool_output.h"
#include "cli/working.h"
#include "flute_grinder/base/file_error.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/record/record_file.h"
#include "flute_grinder/record/tool_records.h"
#include "flute_grinder/report/bag_run.h"
#include "flute_grinder/tool/cutter_solid.h"
#include "flute_grinder/tool/run_strokes.h"
#include "flute_grinder/tool/stl.h"
#include "flute_grinder/tool/z_law.h"

#include <cerrno>
#include <cmath>
#include <cstdio>
#include <filesystem>
#include <optional>
#include <stdexcept>
#include <utility>

namespace grinder {

namespace {

using units::kMillimetre;

/// The range of X in which the wheel can have touched the cutter.
Range reach(const GrindJob& job) {
  const GrindProcess& p = job.process();
  double to = job.cutter.flute_length + p.overtravel_shank + p.wheel_diameter / 2;
  const double rise = std::tan(job.cutter.cone_angle);
  if (rise < 0) to = std::min(to, job.cutter.end_diameter / 2 / -rise);
  return {0, to};
}

/// The X of the sections asked for. @throw std::out_of_range for one off the cutter.
std::vector<double> sectionsOf(const SimulateOptions& options, const GrindJob& job) {
  std::vector<double> at;
  const Range range = reach(job);
  for (const double x_mm : options.at_mm) {
    const double x = x_mm * kMillimetre;
    if (!(x >= range.from && x <= range.to && ConicalCutter(job.cutter).radius(x) > 0)) {
      throw std::out_of_range(
          format("--at %g mm is not on the cutter; allowed: 0 to %g mm", x_mm, range.to / kMillimetre));
    }
    at.push_back(x);
  }
  return at.empty() ? evenSections(job, options.sections) : at;
}

/// Writes the cutter as a solid, with the part of the shank into which the flutes run out and one diameter more.
void writeStlFile(const GroundTool& tool, OutputFile& file) {
  const Working working("computing the solid");
  const GrindJob& job = *tool.job;
  const SolidExtent extent{tool.end.blank_x, job.cutter.flute_length, job.cutter.shank_diameter,
                           groundTo(job) + job.cutter.shank_diameter};
  const std::string bytes = stlOf(cutterSolid(tool.cutter, extent, {}, tool.end.removed));
  const bool good = std::fwrite(bytes.data(), 1, bytes.size(), file.stream()) == bytes.size();
  file.close(good ? 0 : errno);
}

/// The source of a simulation: a job alone, or a run of it.
struct Source {
  ValidJob job;
  std::string name;  ///< name for the reader
  std::string file;
  std::optional<BagRun> bag;
  std::optional<ToolRecords> records;
};

/// @throw FileError
Source sourceOfBag(const SimulateOptions& options, const std::string& name) {
  BagRun run(options.file, options.run);
  if (!run.job() && options.job.empty()) {
    throw FileError(options.file + ": the bag does not have the goal of " + run.place() +
                    "; give its job file with --job");
  }
  const ValidJob job = options.job.empty() ? *run.job() : ValidJob(readJobFile(options.job, options.operation));
  const std::string place = name + ", " + run.place() + recordedBeforeText(run);
  return {job, place, options.file, std::move(run), {}};
}

/// @throw FileError
Source sourceOf(const std::string& node, const SimulateOptions& options) {
  const std::string file = options.last ? lastRecord(node, options.folder) : options.file;
  const std::string name = std::filesystem::path(file).filename();
  if (isBag(file)) return sourceOfBag(options, name);
  if (!isRecord(file)) return {ValidJob(readJobFile(file, options.operation)), name, file, {}, {}};
  ToolRecords records(file);
  const ValidJob job = *records.last().job;
  return {job, name, file, {}, std::move(records)};
}

/// Measures the tool of a source. @throw std::invalid_argument if it cannot be ground, or does not belong to this job.
GroundTool simulate(const Source& source, const std::vector<double>& at) {
  const Working working("computing the ground tool");
  if (source.records) return measure(source.name, source.records->strokes(source.records->last()), at);
  const ValidJob job = withLaws(source.job);
  if (!source.bag) return measure(job, source.name, groundCutterOf(job), at);
  RunStrokes strokes(job, recordedBefore(source.file, *source.bag));
  source.bag->visit([&](const RunRow& row) { strokes.add(row.setpoint, row.actual); });
  strokes.finish();
  return measure(source.name, strokes, at);
}

/// Prints a measured tool. @return the exit status.
/// @param document the tool's, for JSON.
int show(const GroundTool& tool, const Json* document) {
  if (document != nullptr) {
    print(*document);
  } else {
    printText(tool);
  }
  for (const Reason& reason : tool.check.reasons) {
    std::fprintf(stderr, "%s\n", text(reason).c_str());
  }
  return tool.check.reasons.empty() ? 0 : 1;
}

}  // namespace

int runSimulate(const std::string& node, const SimulateOptions& options) {
  if (options.file.empty() && !options.last) throw std::invalid_argument("FILE is missing; allowed: a file, or --last");
  const Source source = sourceOf(node, options);
  const std::vector<double> at = sectionsOf(options, *source.job);
  std::optional<GroundToolCsv> csv;
  if (!options.csv.empty()) csv.emplace(options.csv, source.job);
  const auto stl = openOutput(options.stl), svg = openOutput(options.svg);
  try {
    const GroundTool tool = simulate(source, at);
    if (csv) csv->write(tool);
    if (csv) csv->close();
    const Json document = options.json || svg ? toJson(tool) : Json();
    const int status = show(tool, options.json ? &document : nullptr);
    if (stl) writeStlFile(tool, *stl);
    const int drawn = svg ? drawPicture("tool.py", document, *svg) : 0;
    return drawn != 0 ? drawn : status;
  } catch (const std::invalid_argument& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
}

}  // namespace grinder
