#pragma once

#include "flute_grinder/base/axes.h"
#include "flute_grinder/machine/first_view.h"
#include "flute_grinder/machine/machine_model.h"
#include "flute_grinder/motion/grind_program.h"
#include "flute_grinder/scene/end_line.h"
#include "flute_grinder/tool/ground_edge.h"

#include <tf2_ros/static_transform_broadcaster.h>
#include <tf2_ros/transform_broadcaster.h>
#include <Eigen/Geometry>

#include <memory>
#include <optional>
#include <vector>

namespace grinder {

/// Publishes to tf the frames that depend on the job and the work offsets, but not on the axes. They are latched on
/// `tf_static`, and published again with every change:
/// - `work` in the axis_x table: the cutter's small end, not turning. Here the wheel's centre is at X, D1/2 + Dw/2 + Y,
///   and the height of the set-up + Z, in work coordinates.
/// - `cutter` in the chuck: it turns in `work` by -A.
/// - the child links of the robot description's joints y_zero, z_zero and wheel_swivel, the last of which is `wheel`.
/// And, on `tf`, `contact` in `work`: where the wheel forms the edge, at the X of the axes, with X along the edge and Y
/// away from the cutter; on the end, where its rim is along the line of the tooth's deepest stroke (EndLine).
/// Not thread safe; not for the control thread.
class Frames {
 public:
  /// @param first_view blank and wheel shown until there is a job.
  Frames(const MachineModel& model, const FirstView& first_view);

  /// Shows the frames of a job. Without a job the frames show the blank and wheel of the first view, not swivelled and
  /// without a contact.
  /// @param edges edges of the teeth; a tooth with an empty edge has no contact.
  void show(std::shared_ptr<const GrindProgram> program, std::vector<GroundEdge> edges);

  /// Publishes what has changed, and the contact.
  /// @param position positions of the axes in machine coordinates [m], A [rad].
  /// @param offset work offsets; an unknown one, NaN, counts as 0 [m], A [rad].
  /// @param tooth the tooth being ground, or else any of the job's teeth.
  /// @param stamp time of the position.
  void publish(const Axes& position, const Axes& offset, int tooth, const ros::Time& stamp);

 private:
  /// The values on which the frames on `tf_static` depend.
  struct SetUp {
    double wheel_y = 0;  ///< Y of the wheel's centre in `work` at Y = 0 [m]
    double height = 0;   ///< Z of the wheel's centre in `work` at Z = 0 [m]
    double swivel = 0;   ///< angle of the swivel [rad]
    Axes offset = Axes::Zero();

    bool operator==(const SetUp& other) const;
  };

  SetUp setUpFor(const Axes& offset) const;
  void publishSetUp(const ros::Time& stamp);
  std::optional<Eigen::Isometry3d> contactAt(const Axes& position, int tooth) const;
  void publishContact(const Axes& position, int tooth, const ros::Time& stamp);

  const MachineModel model_;
  const FirstView first_view_;
  tf2_ros::StaticTransformBroadcaster set_up_frames_;
  tf2_ros::TransformBroadcaster moving_frames_;
  std::shared_ptr<const GrindProgram> program_;
  std::vector<GroundEdge> edges_;
  std::vector<EndLine> lines_;  ///< of the teeth, for an operation on the end
  std::optional<SetUp> published_;
  ros::Time contact_stamp_;  ///< stamp of the latest contact published
};

}  // namespace grinder
