#include "flute_grinder/geometry/recorded_strokes.h"

#include "flute_grinder/geometry/ground_job.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <string>

namespace flute_grinder {

namespace {

/// Of X, over which samples are averaged: the sawtooth of odd and even points would turn the wall that is measured [m].
constexpr double kCell = 0.2e-3;

PathDeviation between(const PathDeviation& a, const PathDeviation& b, double part) {
  return {a.y + part * (b.y - a.y), a.z + part * (b.z - a.z), a.a + part * (b.a - a.a)};
}

}  // namespace

RecordedStrokes::RecordedStrokes(const GrindJob& job)
    : job_(job), order_(passOrder(job)), wear_(wearOfPasses(job)), depths_(passDepths(job.process)) {}

std::size_t RecordedStrokes::placeInOrder(const ToothPass& place) const {
  return static_cast<std::size_t>(std::find(order_.begin(), order_.end(), place) - order_.begin());
}

void RecordedStrokes::add(const Setpoint& setpoint, const Axes& actual) {
  const ToothPass place{setpoint.tooth, setpoint.pass};
  if (!(place.tooth < static_cast<int>(job_.tooth_angles.size()) && place.pass < static_cast<int>(depths_.size()))) {
    throw std::invalid_argument("cycle " + std::to_string(setpoint.cycle) + " grinds tooth " +
                                std::to_string(place.tooth + 1) + ", pass " + std::to_string(place.pass + 1) +
                                "; the job has " + std::to_string(job_.tooth_angles.size()) + " teeth and " +
                                std::to_string(depths_.size()) + " passes");
  }
  if (!actual.isFinite().all()) {
    throw std::invalid_argument("cycle " + std::to_string(setpoint.cycle) + ": the position read is not finite");
  }
  const bool stroke = setpoint.move == MoveKind::kStroke;
  if (stroke && !(reading_ && reading_->place == place)) {
    endStroke();
    reading_.emplace(Reading(job_, place, wear_[placeInOrder(place)]));
  }
  // What was read belongs to the setpoint before: a stroke begins at the end of its infeed, and ends one cycle later.
  const bool last = reading_ && in_stroke_ && setpoint.cycle == cycle_ + 1;
  if (stroke || last) sample(actual);
  in_stroke_ = stroke;
  cycle_ = setpoint.cycle;
}

void RecordedStrokes::finish() { endStroke(); }

RecordedStrokes::Reading::Reading(const GrindJob& job, const ToothPass& tooth_pass, double wear)
    : place(tooth_pass),
      cutter(cutterOf(job, tooth_pass.tooth)),
      curve(cutter),
      path(strokeOf(job, tooth_pass.tooth, job.process.deepest(), wear)),
      angle(job.tooth_angles[static_cast<std::size_t>(tooth_pass.tooth)]) {}

void RecordedStrokes::sample(const Axes& actual) {
  const double x = actual[kX];
  const GrindStroke& path = reading_->path;
  const PathDeviation off{actual[kY] - (path.y + reading_->cutter.y(x) + x * path.y_per_x),
                          actual[kZ] - (reading_->cutter.z(x) + path.z_correction.at(x).z),
                          actual[kA] - reading_->angle - reading_->curve.a(x)};
  reading_->range.from = std::min(reading_->range.from, x);
  reading_->range.to = std::max(reading_->range.to, x);
  Sample& cell = samples_[std::lround(x / kCell)];
  ++cell.count;
  cell.x += (x - cell.x) / cell.count;
  cell.off = between(cell.off, off, 1.0 / cell.count);
}

std::vector<PathDeviation> RecordedStrokes::deviations(const Range& range) const {
  const double length = range.to - range.from;
  const auto parts = std::max(1L, std::lround(length / kCell));
  std::vector<PathDeviation> deviations;
  auto right = std::next(samples_.begin());
  for (long i = 0; i <= parts; ++i) {
    const double x = range.from + length * static_cast<double>(i) / static_cast<double>(parts);
    while (right->second.x < x && std::next(right) != samples_.end()) ++right;
    const Sample &a = std::prev(right)->second, &b = right->second;
    deviations.push_back(between(a.off, b.off, std::clamp((x - a.x) / (b.x - a.x), 0.0, 1.0)));
  }
  return deviations;
}

void RecordedStrokes::endStroke() {
  if (samples_.size() > 1) {
    RecordedStroke stroke{reading_->place, reading_->range, deviations(reading_->range)};
    const auto covering = [&](const RecordedStroke& other) { return covers(other, stroke); };
    const auto covered = [&](const RecordedStroke& other) { return covers(stroke, other); };
    if (std::none_of(strokes_.begin(), strokes_.end(), covering)) {
      strokes_.erase(std::remove_if(strokes_.begin(), strokes_.end(), covered), strokes_.end());
      strokes_.push_back(std::move(stroke));
    }
  }
  samples_.clear();
  reading_.reset();
}

bool RecordedStrokes::covers(const RecordedStroke& deep, const RecordedStroke& shallow) const {
  const auto depth = [&](const RecordedStroke& s) { return depths_[static_cast<std::size_t>(s.place.pass)]; };
  return deep.place.tooth == shallow.place.tooth && depth(deep) >= depth(shallow) &&
         deep.range.from <= shallow.range.from + kCell && deep.range.to >= shallow.range.to - kCell;
}

GroundCutter RecordedStrokes::cutter() const {
  std::vector<Flute> flutes;
  std::vector<GroundTooth> teeth;
  for (std::size_t i = 0; i < job_.tooth_angles.size(); ++i) {
    const int tooth = static_cast<int>(i);
    Flute flute;
    for (const RecordedStroke& recorded : strokes_) {
      if (recorded.place.tooth != tooth) continue;
      const double wear = wear_[placeInOrder(recorded.place)];
      GrindStroke stroke = strokeOf(job_, tooth, job_.process.deepest(), wear);
      stroke.from = recorded.range.from;
      stroke.to = recorded.range.to;
      stroke.deviations = recorded.deviations;
      flute.push_back(sweepOf(job_, tooth, wear, stroke));
    }
    // A stroke without a length removes nothing.
    if (flute.empty()) flute.push_back(sweepOf(job_, tooth, 0, GrindStroke{}));
    teeth.push_back({job_.tooth_angles[i], flutes.size()});
    flutes.push_back(std::move(flute));
  }
  return GroundCutter(ConicalCutter(job_.cutter), std::move(flutes), std::move(teeth));
}

}  // namespace flute_grinder
