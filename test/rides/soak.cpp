// Grinds the same tool again and again, for hours of the machine's time: control loop, simulated drive, records on disk
// and journal in one process, in simulated time. Nothing may grow, drift or be lost.

#include "control/fixtures.h"
#include "flute_grinder/control/control_loop.h"
#include "flute_grinder/job/job_digest.h"
#include "flute_grinder/job/job_file.h"
#include "flute_grinder/record/record_file.h"
#include "node/job_recorder.h"
#include "node/progress_tracker.h"
#include "temp_folder.h"

#include <unistd.h>

#include <CLI/CLI.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <memory>
#include <stdexcept>
#include <string>

namespace grinder::test_support {

namespace {

constexpr double kStart = 1.75e9;            ///< since the epoch [s]
constexpr double kSameTime = 1e-6;           ///< what a double leaves of a stamp [s]
constexpr std::uint64_t kHistory = 1 << 18;  ///< limit of the records, of which some hours reach it [bytes]
constexpr std::uintmax_t kOneRecord = 1 << 16;
constexpr double kMaxGrowth = 512 << 10;                 ///< of the memory, after the first look [bytes]
constexpr std::uint64_t kPast = (1ULL << 32) - 1000000;  ///< counters of the drive pass 2^32 in the first hour
constexpr int kCyclesPerPoll = 20;                       ///< as *goals* polls the loop
constexpr long kBeingWritten = 4;                        ///< files that are open for a moment
constexpr double kHour = 3600;

void require(bool fact, const std::string& otherwise) {
  if (!fact) throw std::runtime_error(otherwise);
}

/// The simulated drive as it is after many hours.
class LongRunningDrive : public SimulatedDrive {
 public:
  void read(const DriveCycle& cycle, DriveFeedback& feedback) override {
    SimulatedDrive::read(cycle, feedback);
    feedback.status.feedback_count += kPast;
    feedback.status.underruns += kPast;
  }
};

struct Footprint {
  double memory = 0;  ///< resident [bytes]
  long files = 0;     ///< open
};

Footprint footprint() {
  long pages = 0, resident = 0;
  std::ifstream("/proc/self/statm") >> pages >> resident;
  const std::filesystem::directory_iterator open("/proc/self/fd");
  return {static_cast<double>(resident * sysconf(_SC_PAGESIZE)), std::distance(begin(open), end(open))};
}

class Soak {
 public:
  explicit Soak(const std::string& job)
      : config_(machineConfig()),
        job_(readJobFile(job)),
        history_(folder_.path() / "history", kHistory),
        recorder_("/grinder", machineInfo(config_, "simulated"), readTolerances("config/tolerances.yaml"), history_),
        journal_(folder_.path() / "journal", "soak"),
        tracker_(journal_) {
    static_cast<JobPlan&>(plan_) = planJob(job_, config_.machine, RunStart(config_.machine.park));
    require(plan_.good(), job + " has no plan");
    drive_.init(driveModel(config_), equipment());
    loop_ = std::make_unique<ControlLoop>(drive_, config_);
    loop_->postSwivel(job_->process().setup_swivel);
    loop_->post(MachineEvent::kEnable);
    while (loop_->status().state != MachineState::kReady) cycle();
  }

  double hours() const { return static_cast<double>(cycles_) * config_.machine.period / kHour; }
  std::uint64_t setpoints() const { return setpoints_; }
  std::uint64_t jobs() const { return jobs_; }

  void grindOne() {
    SetpointStream stream(plan_.program);
    ++jobs_;
    recorder_.announce(jobs_, std::make_shared<JobRecord>(plan_, JobNames{"soak.yaml", "", ""}, WorkOffsets{}, false));
    OffsetBasis job;
    job.job_name = "soak.yaml";
    tracker_.begin(*plan_.program, plan_.program->job().digest(), job, jobs_, {});
    require(loop_->startJob({&stream, wheelOf(stream.program())}), "the loop has not answered the start before");
    std::uint64_t setpoints = 0;
    while (loop_->status().jobs_ended < jobs_) {
      cycle();
      JobRecord& record = recorder_.of(jobs_);
      if (sample_.job == jobs_) record.addCycle(sample_);
      if (sample_.job == jobs_ && sample_.has_setpoint) {
        require(sample_.setpoint.cycle == setpoints, "setpoint " + std::to_string(setpoints) + " was lost");
        record.addSetpoint(sample_.setpoint, sample_);
        ++setpoints;
      }
      if (cycles_ % kCyclesPerPoll == 0) tracker_.update(loop_->status());
    }
    loop_->startJobReply();
    const LoopStatus status = loop_->status();
    require(status.end == JobEnd::kDone, "job " + std::to_string(jobs_) + ": " + sample_.fault.text());
    require(setpoints == plan_.statistics.setpoints && setpoints == status.setpoints_written,
            "job " + std::to_string(jobs_) + " has " + std::to_string(setpoints) + " setpoints");
    setpoints_ += setpoints;
    tracker_.end(status, "done");
    recorder_.end(jobs_);
    recorder_.conclude(jobs_, {"done", "", status.setpoints_written});
  }

  /// What is on disk keeps within its limits, and the last record that is there is whole.
  void checkFiles() const {
    std::uintmax_t size = 0;
    for (const auto& file : std::filesystem::recursive_directory_iterator(folder_.path())) {
      std::error_code gone;  // the oldest are removed meanwhile
      const std::uintmax_t one = std::filesystem::file_size(file, gone);
      if (!gone) size += one;
    }
    require(size < kHistory + 2 * kOneRecord, std::to_string(size) + " bytes on disk");
    require(history_.error().empty() && tracker_.error().empty(), history_.error() + tracker_.error());
    const auto records = recordFilesIn(folder_.path() / "history").records;
    if (records.empty()) return;
    const RecordHead head = readRecord(records.back()).head;
    require(head.outcome == "done" && head.strokes == head.passes, text(toJson(head)));
    require(std::abs(head.duration - plan_.statistics.duration) < 1, std::to_string(head.duration) + " s in a record");
  }

 private:
  void cycle() {
    const ros::Duration period(config_.machine.period);
    now_ += period;
    loop_->cycle(now_, period);
    ++cycles_;
    require(loop_->pop(sample_), "a cycle without a sample");
    const double expected = kStart + static_cast<double>(cycles_) * config_.machine.period;
    require(std::abs(sample_.time - expected) < kSameTime,
            "a stamp is off by " + std::to_string(sample_.time - expected));
    require(sample_.state != MachineState::kFault, sample_.fault.text());
  }

  const TempFolder folder_;
  const LoopConfig config_;
  const ValidJob job_;
  PlannedJob plan_;
  LongRunningDrive drive_;
  std::unique_ptr<ControlLoop> loop_;
  History history_;
  JobRecorder recorder_;
  Journal journal_;
  ProgressTracker tracker_;
  CycleSample sample_;
  ros::Time now_{kStart};
  std::uint64_t cycles_ = 0, jobs_ = 0, setpoints_ = 0;
};

void soak(const std::string& job, double hours) {
  Soak machine(job);
  Footprint first, now;
  const double step = std::min(1.0, hours / 4);
  for (double next = step; machine.hours() < hours;) {
    machine.grindOne();
    if (machine.hours() < next) continue;
    next += step;
    machine.checkFiles();
    now = footprint();
    if (first.files == 0) first = now;
    require(now.memory - first.memory < kMaxGrowth, "memory has grown by " + std::to_string(now.memory - first.memory));
    require(now.files <= first.files + kBeingWritten,
            std::to_string(now.files) + " open files, " + std::to_string(first.files) + " at first");
  }
  std::printf(
      "%.1f h of the machine, %llu jobs, %llu setpoints; resident memory %.1f MB, %+.0f KB since the first look\n",
      machine.hours(), static_cast<unsigned long long>(machine.jobs()),
      static_cast<unsigned long long>(machine.setpoints()), now.memory / 1e6, (now.memory - first.memory) / 1e3);
}

}  // namespace

}  // namespace grinder::test_support

int main(int argc, char** argv) {
  CLI::App app("Grinds the same tool again and again in simulated time; nothing may grow, drift or be lost.");
  std::string job = "jobs/taper_d6_t6.yaml";
  double hours = 200;
  app.add_option("--job", job, "which tool")->capture_default_str();
  app.add_option("--hours", hours, "of the machine's time")->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  try {
    grinder::test_support::soak(job, hours);
  } catch (const std::exception& error) {
    std::fprintf(stderr, "%s\n", error.what());
    return 1;
  }
  return 0;
}
