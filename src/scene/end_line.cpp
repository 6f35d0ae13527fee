#include "flute_grinder/scene/end_line.h"

#include <Eigen/Geometry>

#include <algorithm>
#include <cmath>
#include <utility>

namespace grinder {

namespace {

using Eigen::Vector3d;

Vector3d turned(const Vector3d& place, double a) { return Eigen::AngleAxisd(a, Vector3d::UnitX()) * place; }

/// The edge before a flank: a place on it, and the way from there to its inner end.
struct Edge {
  OnTooth outer, way;
};

Edge edgeOf(const GrindJob& job) {
  const CutterGeometry& c = job.cutter;
  const EndPlane plane = endPlaneOf(job);
  const bool chamfer = job.process().kind == OperationKind::kChamfer;
  const OnTooth surface = chamfer ? OnTooth(-std::sin(c.chamfer_angle), std::cos(c.chamfer_angle), 0)
                                  : OnTooth(-std::cos(c.end_dish), -std::sin(c.end_dish), 0);
  const OnTooth along = surface.cross(plane.normal);
  return {plane.through, (chamfer ? c.chamfer_width : plane.through[1]) / -along[1] * along};
}

}  // namespace

EndLine::EndLine(const ValidJob& job, int tooth, double depth, double wear)
    : is_gash_(job->process().kind == OperationKind::kGash) {
  const FaceStroke stroke = job.faceStroke(tooth, depth, wear);
  const FaceWheel wheel = job.faceWheel(wear);
  a_ = stroke.to[kA];
  rim_ = job->comesAlongX() ? 0 : wheel.radius;
  spindle_ = {-std::sin(stroke.swivel), 0, std::cos(stroke.swivel)};
  const double up = is_gash_ && job->cutter.cut == CutDirection::kRightHand ? 1 : -1;
  zero_ = Vector3d(0, job->cutter.end_diameter / 2 + wheel.nominal_radius, wheel.height) +
          up * (wheel.width / 2 - wheel.face_wear) * spindle_;
  if (is_gash_) {
    takeBottom(job, depth, stroke);
  } else {
    takeEdge(job, tooth, stroke);
  }
}

void EndLine::takeBottom(const ValidJob& job, double depth, const FaceStroke& stroke) {
  const Vector3d out = (stroke.from - stroke.to).head<3>().matrix().normalized();
  outward_ = spindle_.cross(out);
  zero_ -= rim_ * outward_;
  to_ = inWork(stroke.to);
  const Vector3d deepest = inWork(stroke.to - (job.deepest() - depth) * stroke.per_stock);
  const Eigen::Vector2d at = deepest.tail<2>(), way = out.tail<2>();
  const double radius = job->cutter.end_diameter / 2, toward = at.dot(way), square = way.squaredNorm();
  const double root = std::sqrt(std::max(0.0, toward * toward + square * (radius * radius - at.squaredNorm())));
  from_ = to_ + (root - toward) / square * out;
}

void EndLine::takeEdge(const ValidJob& job, int tooth, const FaceStroke& stroke) {
  outward_ = spindle_;
  const Edge edge = edgeOf(*job);
  const double behind = job->cutter.cut == CutDirection::kRightHand ? 1 : -1;
  const auto i = static_cast<std::size_t>(tooth);
  const double angle = job->tooth_angles[i] + job.edges()[i].at_end;
  const Vector3d face = inWork(stroke.to);
  const auto on_face = [&](const OnTooth& place) {
    const Vector3d at = turned({place[0], place[1], behind * place[2]}, angle - a_);
    return Vector3d(at - (at - face).dot(spindle_) * spindle_);
  };
  from_ = on_face(edge.outer);
  to_ = on_face(edge.outer + edge.way);
  // The wheel comes from above.
  if (from_[1] < to_[1]) std::swap(from_, to_);
  const std::optional<Place> last = placeOf(stroke.to);
  if (last && last->part < 1) to_ = at(last->part);
}

Vector3d EndLine::inWork(const Axes& position) const { return zero_ + position.head<3>().matrix(); }

std::optional<EndLine::Place> EndLine::placeOf(const Axes& position) const {
  const Vector3d way = to_ - from_, from = from_ - inWork(position);
  Place place;
  if (is_gash_) {
    place.part = -from.dot(way) / way.squaredNorm();
    place.at = from_ - from;
  } else {
    const double high = from.dot(spindle_), toward = from.dot(way), square = way.squaredNorm();
    const double root = toward * toward - square * (from.squaredNorm() - high * high - rim_ * rim_);
    if (!(rim_ > 0 && root >= 0)) return std::nullopt;
    place.part = (std::sqrt(root) - toward) / square;
    place.at = at(place.part) - high * spindle_;
  }
  const Vector3d off = turned(place.at, position[kA] - a_) - at(place.part);
  place.error = is_gash_ ? off.cross(way.normalized()).norm() : std::abs(off.dot(spindle_));
  return place;
}

std::vector<EndLine> deepestLines(const ValidJob& job) {
  std::vector<EndLine> lines;
  for (int tooth = 0; tooth < job.teeth() && job.isStraight(); ++tooth) {
    lines.emplace_back(job, tooth, job.deepest(), job.wearOfTeeth()[static_cast<std::size_t>(tooth)]);
  }
  return lines;
}

}  // namespace grinder
