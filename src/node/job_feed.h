#pragma once

#include "flute_grinder/GrindFeedback.h"
#include "flute_grinder/SetpointBatch.h"
#include "flute_grinder/check/planned_job.h"
#include "flute_grinder/control/cycle_sample.h"
#include "flute_grinder/scene/scene.h"
#include "node/frames.h"
#include "node/job_recorder.h"
#include "node/recorder_watch.h"

#include <ros/ros.h>

#include <atomic>
#include <deque>
#include <functional>
#include <memory>
#include <mutex>
#include <optional>
#include <string>

namespace grinder {

/// What telemetry makes of the cycles of jobs: `~setpoints`, a goal's feedback, the record, and the job or plan in
/// rviz. For the thread of telemetry, except where it says otherwise.
class JobFeed {
 public:
  /// @param private_nh the node's private namespace. @param period control cycle [s]. @param history, frames must
  /// outlive this object. @param on_end called once the setpoints of a job that has ended are published.
  JobFeed(const ros::NodeHandle& private_nh, double period, const MachineInfo& machine, const Tolerances& tolerances,
          History& history, const FirstView& first_view, Frames& frames, std::function<void()> on_end);

  /// Advertises `~setpoints`. @param own the node's private namespace, with the thread's callback queue.
  void advertise(ros::NodeHandle& own, RecorderWatch& watch);
  /// To be called once the thread has stopped, whose queue hears of subscribers.
  void shutDown() { setpoints_.shutdown(); }

  /// Announces a job before it starts; see Telemetry.
  void announce(std::uint64_t number, const std::string& goal_id, const std::string& job_name,
                std::shared_ptr<const PlannedJob> plan, std::shared_ptr<JobRecord> record);
  void withdraw(std::uint64_t number);
  void conclude(std::uint64_t number, const JobConclusion& conclusion) { recorder_.conclude(number, conclusion); }
  bool empty() const { return jobs_.empty(); }  ///< whether no job is announced
  /// The last setpoint of the running job that reached the axes; null without a job.
  const Setpoint* last() const { return jobs_.empty() ? nullptr : &jobs_.front().last; }

  /// Adds the loop's next sample. @param cycle the loop's cycles since its start.
  void add(const CycleSample& sample, std::uint64_t cycle);
  /// Publishes the setpoints since the last call.
  void publishBatch();
  /// Makes the feedback of the running job.
  void makeFeedback(const CycleSample& sample);
  /// The feedback of a job that was made since the last call, if there is one. Thread safe.
  std::optional<flute_grinder::GrindFeedback> takeFeedback(std::uint64_t number);
  /// Number of the last job whose setpoints have all been published. Thread safe.
  std::uint64_t published() const { return published_; }

  /// Shows a plan made with these offsets, unless a job is running. @return whether it is shown.
  bool showPlan(const PlannedJob& plan, const std::string& job_name, const WorkOffsets& offsets);
  /// Shows the running job, if it is not shown yet.
  void showRunning();
  /// Removes the plan from rviz once its zero points or the wheel have changed: it would be shown in the wrong place.
  void discardStalePlan(const WorkOffsets& offsets);
  /// To be called at 10 Hz, once the frames are published.
  void updateScene();
  /// Removes the job from rviz, and shows no other any more.
  void clearScene();

 private:
  /// A setpoint in the drive's buffer.
  struct Buffered {
    std::uint64_t cycle;  ///< the loop's cycle that generated the setpoint
    double period;        ///< measured period of that cycle [s]
    Setpoint setpoint;
  };

  struct Job {
    std::uint64_t number;
    std::string goal_id, name;
    std::shared_ptr<const PlannedJob> plan;
    bool shown = false;
    Setpoint last{};                  ///< the last setpoint that reached the axes
    double max_error = 0;             ///< largest error since the last feedback [rad]
    std::uint64_t next_cycle = 0;     ///< cycle of the next setpoint to publish
    std::deque<Buffered> buffered{};  ///< setpoints written but not yet published

    /// The position read, in the job's work coordinates.
    Axes workPosition(const CycleSample& sample) const { return sample.position - plan->program->run().offset; }
  };

  void show(const PlannedJob& plan, const std::string& name, const char* how);
  void track(Job& job, const CycleSample& sample, std::uint64_t cycle);
  void addToBatch(Job& job, const Buffered& written, const CycleSample& sample);
  void end(Job& job, const CycleSample& sample);

  ros::Publisher setpoints_;
  Scene scene_;
  JobRecorder recorder_;
  Frames& frames_;
  const std::function<void()> on_end_;
  std::deque<Job> jobs_;                   ///< jobs announced; the first may be running
  std::optional<WorkOffsets> shown_with_;  ///< work offsets of the plan shown; nothing if no plan is shown
  bool scene_cleared_ = false;
  flute_grinder::SetpointBatch batch_;
  std::mutex feedback_mutex_;  ///< guards the next two members
  std::uint64_t feedback_number_ = 0;
  std::optional<flute_grinder::GrindFeedback> feedback_;  ///< feedback of job feedback_number_, not taken yet
  std::atomic<std::uint64_t> published_{0};
};

}  // namespace grinder
