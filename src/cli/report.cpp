#include "cli/report.h"

#include "cli/history.h"
#include "cli/json_output.h"
#include "cli/recorded_run.h"
#include "cli/tool_output.h"
#include "cli/working.h"
#include "flute_grinder/base/file_error.h"
#include "flute_grinder/report/findings.h"
#include "flute_grinder/tool/pass_removal.h"
#include "flute_grinder/tool/z_law.h"

#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

namespace grinder {

namespace {

std::filesystem::path ownPath() {
  std::error_code error;
  std::filesystem::path self = std::filesystem::read_symlink("/proc/self/exe", error);
  if (error) throw FileError("/proc/self/exe: cannot be read: " + error.message());
  return self;
}

/// The path of the report program, which is beside this one both in the build and installed.
std::filesystem::path programPath() { return ownPath().parent_path() / "report"; }

std::vector<char*> pointersTo(std::vector<std::string>& arguments) {
  std::vector<char*> argv;
  argv.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) argv.push_back(argument.data());
  argv.push_back(nullptr);
  return argv;
}

/// A temporary file with a text, positioned at its beginning. @throw FileError
std::unique_ptr<std::FILE, int (*)(std::FILE*)> temporaryFile(const std::string& text) {
  std::unique_ptr<std::FILE, int (*)(std::FILE*)> file(std::tmpfile(), std::fclose);
  if (!file || std::fputs(text.c_str(), file.get()) < 0 || std::fseek(file.get(), 0, SEEK_SET) != 0)
    throw FileError(std::string("a temporary file cannot be written: ") + std::strerror(errno));
  return file;
}

/// Carries out an action. @return why it failed, for the reader; empty if it did not.
template <typename Action>
std::string reasonWhyNot(const Action& action) {
  try {
    action();
    return "";
  } catch (const std::invalid_argument& error) {
    return error.what();
  }
}

/// Measures the tool of a run.
void measureTool(const RunStrokes& strokes, const std::string& place, ReportContext& context) {
  context.tool.emplace(measure(context.file + place, strokes, evenSections(*strokes.job(), kJudgedSections)));
  context.tool_json = toJson(*context.tool);
}

/// Goes through the rows of a bag for the report, and for the tool if the bag has the job and the positions read.
/// @param job job of the run, with its laws.
void addRows(const std::string& path, const BagRun& run, const std::optional<ValidJob>& job, RunFindings& findings,
             ReportContext& context) {
  std::optional<RunStrokes> strokes;
  std::string& why = context.no_tool;
  if (job) why = reasonWhyNot([&] { strokes.emplace(*job, recordedBefore(path, run)); });
  run.visit([&](const RunRow& row) {
    findings.add(row);
    if (strokes && why.empty()) why = reasonWhyNot([&] { strokes->add(row.setpoint, row.actual); });
  });
  if (!strokes || !why.empty()) return;
  why = reasonWhyNot([&] {
    strokes->finish();
    measureTool(*strokes, ", " + run.place() + recordedBeforeText(run), context);
  });
}

/// The contents of a report on a job in a bag, with the points of its pictures if `draws`.
Json documentOfBag(const std::string& path, int job, bool draws, ReportContext& context) {
  const Working working("reading " + context.file + " and computing the ground tool");
  const BagRun run(path, job);
  std::optional<ValidJob> asked;
  if (run.job()) {
    context.no_tool = reasonWhyNot([&] { asked = withLaws(*run.job()); });
  } else {
    context.no_tool = "the bag does not have the goal of " + run.place();
  }
  RunFindings findings(run, asked, draws);
  addRows(path, run, asked, findings, context);
  Json document = findings.json(context);
  if (context.tool) document["removal"] = toJson(removalOfPasses(*asked));
  if (draws) document["plots"] = findings.plots();
  return document;
}

Json documentOfRecord(const std::string& path, ReportContext& context) {
  const Working working("reading the records of the tool and computing it");
  const ToolRecords tool(path);
  context.no_tool = reasonWhyNot([&] { measureTool(tool.strokes(tool.last()), "", context); });
  return findingsOfTool(tool, context);
}

Json documentOf(const std::string& path, const ReportOptions& options, bool draws, ReportContext& context) {
  if (isBag(path)) return documentOfBag(path, options.job, draws, context);
  if (options.job != 0) {
    throw FileError(path + ": job " + std::to_string(options.job) + ": only a bag has several jobs");
  }
  return documentOfRecord(path, context);
}

/// Runs a program that draws. @param words the program and its arguments. @param document its standard input.
/// @return its exit status, with the reason on stderr.
int drawBy(std::vector<std::string> words, const std::string& document) {
  // Through a file, because a pipe could block.
  const auto input = temporaryFile(document);
  const Working working("drawing");
  words.insert(words.begin(), PYTHON_EXECUTABLE);
  const std::vector<char*> argv = pointersTo(words);
  posix_spawn_file_actions_t actions;
  posix_spawn_file_actions_init(&actions);
  posix_spawn_file_actions_adddup2(&actions, ::fileno(input.get()), STDIN_FILENO);
  pid_t child = 0;
  const int error = ::posix_spawn(&child, argv[0], &actions, nullptr, argv.data(), environ);
  posix_spawn_file_actions_destroy(&actions);
  if (error != 0) throw FileError(words[0] + ": cannot be started: " + std::strerror(error));
  int status = 0;
  while (::waitpid(child, &status, 0) < 0 && errno == EINTR) continue;
  if (WIFEXITED(status)) return WEXITSTATUS(status);
  throw FileError(words[1] + ": was ended by signal " + std::to_string(WTERMSIG(status)));
}

/// The files of a report.
struct ReportFiles {
  std::unique_ptr<OutputFile> html, pdf;
};

/// Draws a report into its files. @return the exit status.
int draw(const Json& document, const ReportFiles& files) {
  std::vector<std::string> words{programPath()};
  if (files.html) words.push_back("--output=" + files.html->forProgram());
  if (files.pdf) words.push_back("--pdf=" + files.pdf->forProgram());
  const int status = drawBy(words, text(document));
  if (status != 0) return status;
  for (OutputFile* file : {files.html.get(), files.pdf.get()}) {
    if (file) file->close();
  }
  return 0;
}

}  // namespace

int writeReport(const std::string& node, const ReportOptions& options) {
  if (options.file.empty() && !options.last) throw std::invalid_argument("FILE is missing; allowed: a file, or --last");
  const bool draws = !options.html.empty() || !options.pdf.empty();
  if (!draws && !options.json) throw std::invalid_argument("nothing to write; allowed: --output, --pdf, --json");
  ReportContext context;
  context.tolerances = readTolerances(tolerancesFile(options.tolerances));
  context.words = Json::object();
  const auto add = [&](const char* key, const std::string& value) {
    if (!value.empty()) context.words[key] = value;
  };
  add("note", options.note);
  add("operator", options.operator_name);
  add("serial", options.serial);
  const std::string path = options.last ? lastRecord(node, options.folder) : options.file;
  context.file = std::filesystem::path(path).filename();
  isBag(path);  // before the output files are opened, none of which may be this file
  const ReportFiles files{openOutput(options.html), openOutput(options.pdf)};
  Json document = documentOf(path, options, draws, context);
  if (options.json) {
    Json data = document;
    data.erase("plots");
    print(data);
    if (std::fflush(stdout) != 0) return 1;  // main() reports the error
  }
  return draws ? draw(document, files) : 0;
}

int drawPicture(const char* program, const Json& document, OutputFile& svg) {
  const int status = drawBy({programPath() / program, svg.forProgram()}, text(document));
  if (status == 0) svg.close();
  return status;
}

}  // namespace grinder
