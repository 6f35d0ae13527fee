#include "report/plots.h"

#include <algorithm>

namespace grinder {

namespace {

constexpr std::size_t kEnlarged = 10;        ///< points at either end, like the rows of the paper's Table 1
constexpr std::size_t kMaxShown = 600;       ///< points of the whole curve
constexpr std::size_t kMaxCounts = 1 << 16;  ///< limit far beyond what the picture shows
constexpr double kCountsPerPeriod = 50;

Envelope overTime(const BagRun& run, std::size_t curves) {
  return {run.summary().begin, run.summary().end, run.summary().count, curves};
}

Envelope overX(const BagRun& run) { return {run.summary().min_x, run.summary().max_x, run.summary().count}; }

Json pointsJson(const std::vector<Setpoint>& points) {
  Json x = Json::array(), a = Json::array(), error = Json::array(), odd = Json::array();
  for (const Setpoint& point : points) {
    x.push_back(point.position[kX]);
    a.push_back(point.position[kA]);
    error.push_back(point.path_error);
    odd.push_back(point.step == StepKind::kOdd);
  }
  return {{"x", x}, {"a", a}, {"error", error}, {"odd", odd}};
}

}  // namespace

Plots::OfAxes::OfAxes(const BagRun& run) : stroke(overTime(run, kAxisCount)), rapid(stroke) {}

void Plots::OfAxes::add(const RunRow& row, const std::optional<Axes>& value) {
  if (value) (row.setpoint.step != StepKind::kNone ? stroke : rapid).add(row.time, value->data());
}

Json Plots::OfAxes::json() const { return {{"stroke", stroke.json()}, {"rapid", rapid.json()}}; }

Plots::Curve::Curve(const BagRun& run) : worst(*run.summary().worst), odd(overX(run)), even(overX(run)) {}

void Plots::Curve::add(const Setpoint& setpoint) {
  (setpoint.step == StepKind::kOdd ? odd : even).add(setpoint.position[kX], &setpoint.path_error);
  if (ToothPass{setpoint.tooth, setpoint.pass} != worst) return;
  if (count++ % every == 0) whole.push_back(setpoint);
  if (whole.size() > kMaxShown) {
    // Thinned whenever there are too many points, so that a long stroke needs no more memory.
    for (std::size_t i = 0; 3 * i < whole.size(); ++i) whole[i] = whole[3 * i];
    whole.resize((whole.size() + 2) / 3);
    every *= 3;
  }
  if (start.size() < kEnlarged) start.push_back(setpoint);
  if (end.size() == kEnlarged) end.erase(end.begin());
  end.push_back(setpoint);
}

Json Plots::Curve::json() const {
  return {{"tooth", worst.tooth},   {"pass", worst.pass},         {"count", count},
          {"every", every},         {"whole", pointsJson(whole)}, {"start", pointsJson(start)},
          {"end", pointsJson(end)}, {"odd", odd.json()},          {"even", even.json()}};
}

Plots::Timing::Timing(double period) : width(period / kCountsPerPeriod), counts(kMaxCounts) {}

void Plots::Timing::add(double period) {
  ++counts[static_cast<std::size_t>(std::clamp(period / width, 0.0, static_cast<double>(kMaxCounts - 1)))];
}

Json Plots::Timing::json() const {
  const auto last = std::find_if(counts.rbegin(), counts.rend(), [](std::uint64_t count) { return count > 0; });
  return {{"width", width}, {"counts", std::vector<std::uint64_t>(counts.begin(), last.base())}};
}

Plots::Plots(const BagRun& run)
    : begin_(run.summary().begin),
      end_(run.summary().end),
      period_(run.period()),
      speed_(run),
      acceleration_(run),
      following_(run),
      timing_(run.period()) {
  if (!run.summary().worst) return;
  curve_.emplace(run);
  feed_.emplace(overTime(run, 1));
}

void Plots::add(const RunRow& row, const AxisMotion& motion) {
  const Setpoint& setpoint = row.setpoint;
  const bool in_stroke = setpoint.step != StepKind::kNone;
  if (curve_ && in_stroke) curve_->add(setpoint);
  if (feed_ && in_stroke) feed_->add(row.time, &setpoint.feed);
  speed_.add(row, motion.speed);
  acceleration_.add(row, motion.acceleration);
  following_.add(row, motion.following_error);
  timing_.add(row.cycle_period);
}

Json Plots::json() const {
  Json json{{"clock", {{"from", begin_}, {"to", end_}, {"period", period_}}}};
  if (feed_) json["feed"] = feed_->json();
  json["speed"] = speed_.json();
  json["acceleration"] = acceleration_.json();
  json["following"] = following_.json();
  json["timing"] = timing_.json();
  if (curve_) json["curve"] = curve_->json();
  return json;
}

}  // namespace grinder
