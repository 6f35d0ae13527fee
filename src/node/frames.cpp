#include "node/frames.h"

#include "flute_grinder/check/joint_pose.h"
#include "flute_grinder/job/grind_job.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace grinder {

namespace {

constexpr const char* kWork = "work";
constexpr const char* kCutter = "cutter";
constexpr const char* kContact = "contact";

geometry_msgs::TransformStamped transformMessage(const std::string& parent, const std::string& frame,
                                                 const Eigen::Isometry3d& pose, const ros::Time& stamp) {
  geometry_msgs::TransformStamped message;
  message.header.stamp = stamp;
  message.header.frame_id = parent;
  message.child_frame_id = frame;
  const Eigen::Vector3d at = pose.translation();
  const Eigen::Quaterniond turned(pose.linear());
  message.transform.translation.x = at.x();
  message.transform.translation.y = at.y();
  message.transform.translation.z = at.z();
  message.transform.rotation.x = turned.x();
  message.transform.rotation.y = turned.y();
  message.transform.rotation.z = turned.z();
  message.transform.rotation.w = turned.w();
  return message;
}

}  // namespace

bool Frames::SetUp::operator==(const SetUp& other) const {
  return wheel_y == other.wheel_y && height == other.height && swivel == other.swivel && (offset == other.offset).all();
}

Frames::Frames(const MachineModel& model, const FirstView& first_view) : model_(model), first_view_(first_view) {}

void Frames::show(std::shared_ptr<const GrindProgram> program, std::vector<GroundEdge> edges) {
  program_ = std::move(program);
  edges_ = std::move(edges);
  lines_ = deepestLines(program_->job());
}

void Frames::publish(const Axes& position, const Axes& offset, int tooth, const ros::Time& stamp) {
  const SetUp set_up = setUpFor(offset.isFinite().select(offset, 0));
  if (!published_ || !(*published_ == set_up)) {
    published_ = set_up;
    publishSetUp(stamp);
  }
  if (program_) publishContact(position - set_up.offset, tooth, stamp);
}

Frames::SetUp Frames::setUpFor(const Axes& offset) const {
  SetUp set_up;
  set_up.offset = offset;
  set_up.wheel_y = (first_view_.blank_diameter + first_view_.wheel_diameter) / 2;
  if (!program_) return set_up;
  const GrindJob& job = *program_->job();
  set_up.wheel_y = job.cutter.end_diameter / 2 + job.process().wheel_diameter / 2;
  set_up.height = job.process().setup_height;
  set_up.swivel = job.process().setup_swivel;
  return set_up;
}

void Frames::publishSetUp(const ros::Time& stamp) {
  const SetUp& set_up = *published_;
  std::vector<geometry_msgs::TransformStamped> frames;
  const urdf::Joint& axis_a = model_.joint(kJointNames[kA]);
  const Eigen::Translation3d end(set_up.offset[kX], 0, 0);
  frames.push_back(transformMessage(axis_a.parent_link_name, kWork, childPose(axis_a, 0) * end, stamp));
  frames.push_back(transformMessage(axis_a.child_link_name, kCutter,
                                    end * Eigen::AngleAxisd(set_up.offset[kA], Eigen::Vector3d::UnitX()), stamp));
  const auto add_child = [&](const char* name, double at) {
    const urdf::Joint& joint = model_.joint(name);
    frames.push_back(transformMessage(joint.parent_link_name, joint.child_link_name, childPose(joint, at), stamp));
  };
  // The joints of the axes have machine positions.
  add_child("y_zero", set_up.wheel_y - set_up.offset[kY]);
  add_child("z_zero", set_up.height - set_up.offset[kZ]);
  add_child("wheel_swivel", set_up.swivel);
  set_up_frames_.sendTransform(frames);
}

std::optional<Eigen::Isometry3d> Frames::contactAt(const Axes& position, int tooth) const {
  const auto i = static_cast<std::size_t>(tooth);
  Eigen::Isometry3d pose = Eigen::Isometry3d::Identity();
  const auto turn = [&pose](const Eigen::Vector3d& along, const Eigen::Vector3d& outward) {
    Eigen::Matrix3d axes;
    axes << along, outward, along.cross(outward);
    pose.rotate(axes);
  };
  if (!lines_.empty()) {
    const EndLine& line = lines_[i];
    const std::optional<EndLine::Place> place = line.placeOf(position);
    if (!place || !std::isfinite(place->part)) return std::nullopt;
    pose.translate(line.at(std::clamp(place->part, 0.0, 1.0)));
    turn((line.at(0) - line.at(1)).normalized(), line.outward());
    return pose;
  }
  const double x = position[kX];
  if (edges_.empty() || edges_[i].empty() || !std::isfinite(x)) return std::nullopt;
  const GroundEdge& edge = edges_[i];
  const GroundEdge::Place at = edge.at(std::clamp(edge.formedAt(x).x, edge.from(), edge.to()));
  const ConicalCutter& cutter = program_->cutter(tooth);
  pose = Eigen::AngleAxisd(at.turn, Eigen::Vector3d::UnitX()) * Eigen::Translation3d(at.x, cutter.radius(at.x), 0);
  turn(Eigen::Vector3d(1, cutter.tanCone(), cutter.tanSpiral()).normalized(),
       Eigen::Vector3d(-cutter.tanCone(), 1, 0).normalized());
  return pose;
}

void Frames::publishContact(const Axes& position, int tooth, const ros::Time& stamp) {
  // A faulty drive may report NaN. tf warns of a repeated stamp, which a stalled loop gives.
  if (stamp == contact_stamp_) return;
  const std::optional<Eigen::Isometry3d> pose = contactAt(position, tooth);
  if (!pose) return;
  contact_stamp_ = stamp;
  moving_frames_.sendTransform(transformMessage(kWork, kContact, *pose, stamp));
}

}  // namespace grinder
