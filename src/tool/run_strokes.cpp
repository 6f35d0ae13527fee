#include "flute_grinder/tool/run_strokes.h"

#include "flute_grinder/tool/ground_job.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>
#include <utility>

namespace grinder {

namespace {

/// Length in X over which samples are averaged: the sawtooth of odd and even points would tilt the measured wall [m].
constexpr double kCell = 0.2e-3;
constexpr double kApart = 5e-6;           ///< minimum distance of the positions that are kept outside strokes [m]
constexpr std::size_t kPosesOfPart = 32;  ///< as many positions as WheelSweep examines
constexpr double kShortest = 1e-6;        ///< length of a move in which X rests [m]

/// X of a stroke's deviation.
double xOf(const RunStroke& stroke, std::size_t i) {
  const auto parts = static_cast<double>(std::max<std::size_t>(1, stroke.deviations.size() - 1));
  return stroke.range.from + (stroke.range.to - stroke.range.from) * static_cast<double>(i) / parts;
}

bool holds(const Range& range, double x) {
  return x >= range.from - RunStrokes::kSame && x <= range.to + RunStrokes::kSame;
}

/// Direction of a straight stroke in X, Y and Z.
Eigen::Vector3d directionOf(const FaceStroke& stroke) {
  return (stroke.to - stroke.from).head<3>().matrix().normalized();
}

double maxRadius(const ValidJob& job) {
  const ConicalCutter cutter(job->cutter);
  return std::max(cutter.radius(0), cutter.radius(job->cutter.flute_length + job->process().overtravel_shank));
}

}  // namespace

RunStrokes::RunStrokes(const ValidJob& job, std::optional<GroundCutter> before)
    : job_(job), before_(std::move(before)), radius_(maxRadius(job)) {}

RunStrokes::RunStrokes(const ValidJob& job, std::vector<RunStroke> strokes, std::optional<GroundCutter> before)
    : RunStrokes(job, std::move(before)) {
  for (const RunStroke& stroke : strokes) {
    requirePlace(stroke.place, "a stroke");
    if (stroke.deviations.empty()) throw std::invalid_argument("a stroke has no positions");
  }
  strokes_ = std::move(strokes);
}

void RunStrokes::requirePlace(const ToothPass& place, const std::string& what) const {
  const int passes = static_cast<int>(job_.depths().size());
  if (place.tooth >= 0 && place.tooth < job_.teeth() && place.pass >= 0 && place.pass < passes) return;
  throw std::invalid_argument(what + " grinds tooth " + std::to_string(place.tooth + 1) + ", pass " +
                              std::to_string(place.pass + 1) + "; the job has " + std::to_string(job_.teeth()) +
                              " teeth and " + std::to_string(passes) + " passes");
}

double RunStrokes::wearOf(const ToothPass& place) const {
  const std::vector<JobPass>& passes = job_.passes();
  return std::find_if(passes.begin(), passes.end(), [&](const JobPass& pass) { return pass.place == place; })->wear;
}

void RunStrokes::add(const Setpoint& setpoint, const Axes& actual) {
  const Part part{{setpoint.tooth, setpoint.pass}, setpoint.move, setpoint.cycle};
  requirePlace(part.place, "cycle " + std::to_string(setpoint.cycle));
  if (!actual.isFinite().all()) {
    throw std::invalid_argument("cycle " + std::to_string(setpoint.cycle) + ": the position read is not finite");
  }
  // The position that was read belongs to the previous setpoint.
  take(last_ && last_->cycle + 1 == part.cycle ? *last_ : part, actual);
  last_ = part;
}

void RunStrokes::finish() {
  endStroke();
  reading_.reset();
  const std::size_t strokes = strokes_.size();
  for (const Poses& poses : poses_) addOutside(poses, strokes);
  poses_.clear();
}

void RunStrokes::take(const Part& part, const Axes& actual) {
  const bool same = reading_ && reading_->place == part.place && reading_->move == part.move;
  if (!same) endStroke();
  if (part.move == MoveKind::kStroke) {
    if (!same) beginStroke(part.place, actual);
    in_blank_ = false;
    if (!same && fedInBefore(part, actual)) sample(read_);
    sample(actual);
  } else if (!job_.isStraight()) {  // the other moves on the end are in the strokes' planes
    addPose(part, actual);
  }
  reading_ = part;
  read_ = actual;
}

bool RunStrokes::fedInBefore(const Part& part, const Axes& actual) const {
  if (!reading_ || reading_->move != MoveKind::kInfeed || !(reading_->place == part.place) ||
      reading_->cycle + 1 != part.cycle) {
    return false;
  }
  const PathDeviation before = path_->deviation(read_[kX], read_), off = path_->deviation(actual[kX], actual);
  const double turned = radius_ * std::abs(before.a - off.a);
  return std::max({std::abs(read_[kX] - actual[kX]), std::abs(before.y - off.y), std::abs(before.z - off.z), turned}) <
         kApart;
}

void RunStrokes::beginStroke(const ToothPass& place, const Axes& actual) {
  const bool goes_on = !strokes_.empty() && strokes_.back().place == place;
  path_.emplace(pathOf(place));
  if (!goes_on) {
    samples_.clear();
    return;
  }
  // After a lift, the stroke counts up to the lift, and once more with the new positions in place of the repeated ones.
  const double x = path_->placeOf(actual);
  const bool rises = path_->rises();
  const auto repeated = samples_.lower_bound(std::lround(x / kCell));
  samples_.erase(rises ? repeated : samples_.begin(), rises ? samples_.end() : repeated);
  (rises ? range_.to : range_.from) = x;
}

void RunStrokes::sample(const Axes& actual) {
  const double x = path_->placeOf(actual);
  const PathDeviation off = path_->deviation(x, actual);
  range_ = samples_.empty() ? Range{x, x} : Range{std::min(range_.from, x), std::max(range_.to, x)};
  Sample& cell = samples_[std::lround(x / kCell)];
  ++cell.count;
  cell.x += (x - cell.x) / cell.count;
  cell.off = between(cell.off, off, 1.0 / cell.count);
}

std::vector<PathDeviation> RunStrokes::deviations() const {
  if (samples_.size() == 1) return {samples_.begin()->second.off};
  const double length = range_.to - range_.from;
  const auto parts = std::max(1L, std::lround(length / kCell));
  std::vector<PathDeviation> deviations;
  auto right = std::next(samples_.begin());
  for (long i = 0; i <= parts; ++i) {
    const double x = range_.from + length * static_cast<double>(i) / static_cast<double>(parts);
    while (right->second.x < x && std::next(right) != samples_.end()) ++right;
    const Sample &a = std::prev(right)->second, &b = right->second;
    deviations.push_back(between(a.off, b.off, std::clamp((x - a.x) / (b.x - a.x), 0.0, 1.0)));
  }
  return deviations;
}

void RunStrokes::endStroke() {
  if (!reading_ || reading_->move != MoveKind::kStroke) return;
  if (range_.to > range_.from) strokes_.push_back({reading_->place, MoveKind::kStroke, range_, deviations()});
}

RunStrokes::Path::Path(const ValidJob& job, int tooth, double wear)
    : cutter_(job.isStraight() ? job->cutter : job.strokeLaw(tooth).cutter),
      curve_(cutter_, job.isStraight() ? 0 : job.strokeLaw(tooth).x_shift) {
  if (job.isStraight()) {
    straight_ = job.faceStroke(tooth, job.deepest(), wear);
  } else {
    stroke_ = grinder::strokeOf(job, tooth, job.deepest(), wear);
    angle_ = job.strokeLaw(tooth).a;
  }
}

double RunStrokes::Path::placeOf(const Axes& at) const {
  if (!straight_) return at[kX];
  return (at - straight_->from).head<3>().matrix().dot(directionOf(*straight_));
}

PathDeviation RunStrokes::Path::deviation(double place, const Axes& at) const {
  if (straight_) {
    const Eigen::Vector3d off = (at - straight_->from).head<3>().matrix() - place * directionOf(*straight_);
    return {off.y(), off.z(), at[kA] - straight_->from[kA], off.x()};
  }
  return {at[kY] - (stroke_.y + cutter_.y(place) + place * stroke_.y_per_x),
          at[kZ] - (cutter_.z(place) + stroke_.z_correction.at(place).z), at[kA] - angle_ - curve_.a(place)};
}

EndStrokes RunStrokes::straightStrokes() const {
  EndStrokes ground;
  if (!job_.isStraight()) return ground;
  for (const RunStroke& run : strokes_) {
    if (depthOf(run) < job_.deepest()) continue;
    PathDeviation mean;
    double count = 0;
    for (const PathDeviation& off : run.deviations) mean = between(mean, off, 1 / ++count);
    FaceStroke stroke = job_.faceStroke(run.place.tooth, job_.deepest(), wearOf(run.place));
    const Eigen::Vector3d direction = directionOf(stroke);
    Axes off;
    off << mean.x, mean.y, mean.z, mean.a;
    const auto at = [&](double way) {
      Axes place = stroke.from + off;
      place.head<3>() += (way * direction).array();
      return place;
    };
    const Axes from = at(run.range.from), to = at(run.range.to);
    stroke.from = from;
    stroke.to = to;
    ground.emplace(run.place.tooth, stroke);
  }
  return ground;
}

void RunStrokes::addPose(const Part& part, const Axes& actual) {
  const bool goes_on =
      in_blank_ && reading_->place == part.place && reading_->move == part.move && reading_->cycle + 1 == part.cycle;
  in_blank_ = job_->cutter.end_diameter / 2 + actual[kY] < radius_;
  if (!in_blank_) return;
  if (!goes_on) poses_.push_back({part.place, part.move, {}});
  std::vector<Axes>& at = poses_.back().at;
  if (!at.empty()) {
    Axes way = (actual - at.back()).abs();
    way[kA] *= radius_;
    if (way.maxCoeff() < kApart) return;
  }
  at.push_back(actual);
}

bool RunStrokes::covers(const RunStroke& stroke, const ToothPass& place, double x, const PathDeviation& off) const {
  if (!holds(stroke.range, x)) return false;
  const PathDeviation own = deviationAt(stroke.deviations, stroke.range, x);
  // A wheel that is smaller by then is narrower above its lowest point, in proportion to the height.
  const double wear = wearOf(stroke.place);
  const double smaller = std::max(0.0, wear - wearOf(place)) / (job_->process().wheel_diameter / 2 - wear);
  // Along the wheel's radius it only has to be as deep: the part above that the other wheel removes is removed, too.
  return off.y - own.y >= 2 * radius_ * smaller - kSame &&
         std::abs(off.z - own.z) + radius_ * std::abs(off.a - own.a) <= kSame;
}

bool RunStrokes::covers(const RunStroke& stroke, const RunStroke& other) const {
  if (stroke.place.tooth != other.place.tooth) return false;
  const auto at = [&](double x) {
    return covers(stroke, other.place, x, deviationAt(other.deviations, other.range, x));
  };
  // In between, both are linear.
  for (std::size_t i = 0; i < other.deviations.size(); ++i) {
    if (!at(xOf(other, i))) return false;
  }
  for (std::size_t i = 0; i < stroke.deviations.size(); ++i) {
    const double x = xOf(stroke, i);
    if (x > other.range.from && x < other.range.to && !at(x)) return false;
  }
  return at(other.range.from) && at(other.range.to);
}

void RunStrokes::addOutside(const Poses& poses, std::size_t strokes) {
  const Path path = pathOf(poses.place);
  const auto covered = [&](const Axes& at) {
    const PathDeviation off = path.deviation(at[kX], at);
    return std::any_of(strokes_.begin(), strokes_.begin() + static_cast<std::ptrdiff_t>(strokes),
                       [&](const RunStroke& stroke) {
                         return stroke.place.tooth == poses.place.tooth && covers(stroke, poses.place, at[kX], off);
                       });
  };
  std::vector<bool> outside;
  for (const Axes& at : poses.at) outside.push_back(!covered(at));
  // Each part gets a neighbour on either side.
  const std::size_t last = poses.at.size() - 1;
  for (std::size_t i = 0; i <= last; ++i) {
    if (!outside[i]) continue;
    const std::size_t from = std::max<std::size_t>(i, 1) - 1;
    while (i < last && outside[i + 1] && i + 2 < from + kPosesOfPart) ++i;
    strokes_.push_back(strokeOf(poses, from, std::min(i + 1, last)));
  }
}

RunStroke RunStrokes::strokeOf(const Poses& poses, std::size_t from, std::size_t to) const {
  std::vector<Axes> at(poses.at.begin() + static_cast<std::ptrdiff_t>(from),
                       poses.at.begin() + static_cast<std::ptrdiff_t>(to) + 1);
  if (at.front()[kX] > at.back()[kX]) std::reverse(at.begin(), at.end());
  RunStroke stroke{poses.place, poses.move, {at.front()[kX], at.back()[kX]}, {}};
  stroke.range.to = std::max(stroke.range.to, stroke.range.from + kShortest);
  const Path path = pathOf(poses.place);
  stroke.deviations.resize(at.size());
  for (std::size_t i = 0; i < at.size(); ++i) stroke.deviations[i] = path.deviation(xOf(stroke, i), at[i]);
  return stroke;
}

WheelSweep RunStrokes::sweep(const RunStroke& run) const {
  const int tooth = run.place.tooth;
  const double wear = wearOf(run.place);
  GrindStroke stroke = grinder::strokeOf(job_, tooth, job_.deepest(), wear);
  stroke.from = run.range.from;
  stroke.to = run.range.to;
  stroke.deviations = run.deviations;
  return sweepOf(job_, tooth, wear, stroke);
}

GroundCutter RunStrokes::relieved(const std::vector<const RunStroke*>& kept) const {
  const GroundCutter before = before_ ? *before_ : groundBefore(job_);
  std::vector<Flute> flutes;
  std::vector<GroundTooth> teeth;
  std::vector<Reliefs> reliefs;
  for (std::size_t i = 0; i < before.teeth().size(); ++i) {
    flutes.push_back(before.flutes()[before.teeth()[i].flute]);
    teeth.push_back({before.teeth()[i].angle, i});
    reliefs.push_back(before.reliefs(i));
    Relief own;
    for (const RunStroke* stroke : kept) {
      if (stroke->place.tooth == static_cast<int>(i)) own.push_back(sweep(*stroke));
    }
    if (!own.empty()) reliefs.back().push_back(std::move(own));
  }
  return GroundCutter(before.cutter(), std::move(flutes), std::move(teeth), std::move(reliefs),
                      before.chordalRakeDepth());
}

GroundCutter RunStrokes::cutter() const {
  if (job_.isStraight()) return before_ ? *before_ : groundCutterOf(job_);
  std::vector<const RunStroke*> deepest_first;
  for (const RunStroke& stroke : strokes_) deepest_first.push_back(&stroke);
  std::stable_sort(deepest_first.begin(), deepest_first.end(),
                   [&](const RunStroke* a, const RunStroke* b) { return depthOf(*a) > depthOf(*b); });
  std::vector<const RunStroke*> kept;
  for (const RunStroke* stroke : deepest_first) {
    const auto covering = [&](const RunStroke* other) { return covers(*other, *stroke); };
    if (std::none_of(kept.begin(), kept.end(), covering)) kept.push_back(stroke);
  }
  if (job_.relief(0) != nullptr) return relieved(kept);
  std::vector<Flute> flutes(job_->tooth_angles.size());
  for (const RunStroke* stroke : kept) flutes[static_cast<std::size_t>(stroke->place.tooth)].push_back(sweep(*stroke));
  std::vector<GroundTooth> teeth;
  for (std::size_t i = 0; i < flutes.size(); ++i) {
    // A stroke of zero length removes nothing.
    if (flutes[i].empty()) flutes[i].push_back(sweepOf(job_, static_cast<int>(i), 0, GrindStroke{}));
    teeth.push_back({job_->tooth_angles[i], i});
  }
  return GroundCutter(ConicalCutter(job_->cutter), std::move(flutes), std::move(teeth), {},
                      job_->cutter.chordal_rake_depth);
}

}  // namespace grinder
