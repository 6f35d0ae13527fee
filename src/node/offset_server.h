#pragma once

#include "flute_grinder/ConfirmWheel.h"
#include "flute_grinder/ProbeGoal.h"
#include "flute_grinder/Reclamped.h"
#include "flute_grinder/SetOffsets.h"
#include "flute_grinder/TouchOff.h"
#include "flute_grinder/control/control_loop.h"
#include "flute_grinder/machine/offset_limits.h"
#include "node/job_gate.h"
#include "node/journal.h"
#include "node/offset_store.h"
#include "node/served_queue.h"

#include <ros/ros.h>

#include <functional>
#include <future>
#include <map>
#include <string>
#include <vector>

namespace grinder {

/// Serves `~set_offsets`, `~touch_off`, `~confirm_wheel` and `~reclamped`, and publishes the work offsets with the
/// wheel on the spindle and the tool in the collet on `~offsets`. Runs in its own thread, which waits for the disk.
class OffsetServer {
 public:
  /// @param loop,gate,store must outlive this object.
  OffsetServer(const ros::NodeHandle& private_nh, const ControlLoop& loop, JobGate& gate, OffsetStore& store,
               const OffsetLimits& limits);

  /// The work offsets. Thread safe; never waits for the disk.
  WorkOffsets offsets() const { return store_.offsets(); }
  /// Why the offsets of some axes are unknown, see OffsetStore::unknown().
  std::string unknown() const { return store_.unknown(); }

  // Notes of what happens to the tool in the collet. They are in force at once and on the disk soon. Thread safe; they
  // never wait.

  /// Notes that the axes are being homed: A may get another reference.
  void noteHoming();
  /// Notes that a job has begun. @param whole whether it began at its first pass.
  void noteGrinding(const OffsetBasis& job, bool whole);
  /// Notes a job that the journal has as finished. To be repeated at the start, in case the process ended before the
  /// note was on the disk.
  void noteFinished(const Progress& last);

  /// Carries out an answer of a goal, while the goal keeps other changes out. Thread safe; never waits.
  /// @param answer kConfirmWheel or kFitOffsets. @param job the goal's job. @param by who gives the answer, for people.
  /// @return why it was not carried out; empty if it was.
  std::future<std::string> carryOut(NeedAnswer answer, const OffsetBasis& job, const std::string& by);

  /// Sets a work offset that was probed, while the caller locks jobs out. Waits for this object's thread, so it is to
  /// be called from another one.
  /// @param value [m], A [rad]. @param before the offsets when the cycle began; the value is refused if it was computed
  /// with an offset that has changed since. @param goal by whom and for what the offset is set, and its answers.
  /// @param needs what must be answered first.
  /// @return why it was not set; empty if it was.
  std::string setProbed(int axis, double value, const WorkOffsets& before, const flute_grinder::ProbeGoal& goal,
                        std::vector<Need>& needs);

 private:
  /// Offsets to be set, by their axes, without their mounting and found_at.
  using NewOffsets = std::map<int, WorkOffset>;
  /// Computes offsets from the positions of the axes [m], A [rad].
  using OffsetsAt = std::function<OffsetValues(const Axes& position)>;

  bool onSet(flute_grinder::SetOffsets::Request& request, flute_grinder::SetOffsets::Response& response);
  bool onTouchOff(flute_grinder::TouchOff::Request& request, flute_grinder::TouchOff::Response& response);
  bool onConfirmWheel(flute_grinder::ConfirmWheel::Request& request, flute_grinder::ConfirmWheel::Response& response);
  bool onReclamped(flute_grinder::Reclamped::Request& request, flute_grinder::Reclamped::Response& response);
  template <typename Response>
  void withoutJob(const std::function<std::string()>& act, Response& response);
  std::string changed(const OffsetStore::Change& change, const std::string& done);
  void note(const OffsetStore::Change& change);
  void saveNotes();
  template <typename Request, typename Response>
  void set(const Request& request, OffsetMethod method, const OffsetsAt& offsets_at, Response& response);
  std::string setWithoutJob(WorkOffset offset, const OffsetsAt& offsets_at, const std::vector<std::string>& answers,
                            std::vector<Need>& needs);
  std::string mount(const OffsetBasis& job, const std::string& by);
  std::string fit(const OffsetBasis& job, const std::string& by);
  std::string setAll(const NewOffsets& fresh);
  void publish();

  const ControlLoop& loop_;
  JobGate& gate_;
  OffsetStore& store_;
  const OffsetLimits limits_;
  bool unsaved_ = false;  ///< some notes are not on the disk; used by the thread alone
  bool said_ = false;     ///< the log says that the notes cannot be saved
  ServedQueue thread_;
  ros::Publisher offsets_;
  std::vector<ros::ServiceServer> services_;
};

}  // namespace grinder
