#include "flute_grinder/core/grind_job.h"

#include "flute_grinder/core/units.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

namespace flute_grinder {

namespace {

/// Room for the rounding of a unit conversion at the ends of a range.
constexpr double kRangeRounding = 1e-12;

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.10g", value);
  return text;
}

JobField mm(const char* path, const char* file_key, double min, double max, double& (*at)(GrindJob&)) {
  return {path, file_key, "m", "mm", units::kMillimetre, min, max, at};
}

JobField degrees(const char* path, const char* file_key, double min, double max, double& (*at)(GrindJob&)) {
  return {path, file_key, "rad", "deg", units::kDegree, min, max, at};
}

/// Collects errors, told in one system of units.
class Checker {
 public:
  Checker(const GrindJob& job, UnitSystem units) : job_(job), units_(units) {}

  void range(const JobField& f) {
    const double value = f.get(job_);
    const double min = f.min * f.shop_scale;
    const double max = f.max * f.shop_scale;
    if (!(value >= min - kRangeRounding * std::abs(min) && value <= max + kRangeRounding * std::abs(max))) {
      errors_.push_back({f.name(units_), f.format(value, units_), f.range(units_)});
    }
  }

  /// The field must be less than `limit` for the reason given.
  void below(const char* name, double limit, const char* why) {
    const JobField& f = jobField(name);
    const double value = f.get(job_);
    if (!(value < limit)) {
      errors_.push_back({f.name(units_), f.format(value, units_), "less than " + f.format(limit, units_) + ", " + why});
    }
  }

  void require(bool good, const std::string& name, const std::string& value, const std::string& allowed) {
    if (!good) errors_.push_back({name, value, allowed});
  }

  void require(bool good, const JobField& f, const std::string& allowed) {
    require(good, f.name(units_), f.format(f.get(job_), units_), allowed);
  }

  bool good() const { return errors_.empty(); }
  UnitSystem units() const { return units_; }
  std::vector<JobError> take() { return std::move(errors_); }

 private:
  const GrindJob& job_;
  UnitSystem units_;
  std::vector<JobError> errors_;
};

void checkTeeth(Checker& checker, const GrindJob& job) {
  const auto& angles = job.tooth_angles;
  checker.require(!angles.empty() && angles.size() <= kMaxTeeth, "cutter.teeth", std::to_string(angles.size()),
                  "1 to " + std::to_string(kMaxTeeth));
  const bool shop = checker.units() == UnitSystem::kShop;
  const double unit = shop ? units::kDegree : 1;
  for (std::size_t i = 0; i < angles.size(); ++i) {
    const bool good = i == 0 ? angles[i] == 0 : angles[i] > angles[i - 1] && angles[i] < 2 * units::kPi;
    if (good) continue;
    checker.require(false, shop ? "cutter.tooth_angles_deg" : "cutter.tooth_angles",
                    number(angles[i] / unit) + (shop ? " deg" : " rad"),
                    shop ? "0 first, then ascending, below 360 deg" : "0 first, then ascending, below 2 pi rad");
    return;
  }
}

/// What the figures, each within its range, must be to one another.
void checkTogether(Checker& checker, const GrindJob& job) {
  const CutterGeometry& c = job.cutter;
  const GrindProcess& p = job.process;
  const double growth = std::tan(c.cone_angle);
  const auto radius = [&](double x) { return c.end_diameter / 2 + x * growth; };
  const double apex = -c.end_diameter / 2 / growth;  // where the cone closes
  if (growth < 0) {
    checker.below("cutter.flute_length", apex, "where the cone closes");
    if (!checker.good()) return;  // what else there would be to say follows from it
    checker.below("process.overtravel_shank", apex - c.flute_length, "where the cone closes");
  } else if (growth > 0) {
    checker.below("process.overtravel_end", -apex, "where the cone closes");
  }
  checker.below("process.depth", std::min(radius(0), radius(c.flute_length)), "the cutter's smallest radius");
  checker.below("process.wheel_wear", p.wheel_diameter / 2, "the wheel's radius");
  checker.require(p.finish_infeed <= p.depth, jobField("process.finish_infeed"),
                  "up to the depth, " + jobField("process.depth").format(p.depth, checker.units()));
  const int allowed_passes = std::min(kMaxPasses, kMaxPassesOfAll / static_cast<int>(job.tooth_angles.size()));
  checker.require(p.depth / p.infeed + p.spark_out + 2 <= allowed_passes, jobField("process.infeed"),
                  "enough for the depth in " + std::to_string(allowed_passes) + " passes per tooth, " +
                      std::to_string(kMaxPassesOfAll) + " of all teeth");
  if (!checker.good()) return;
  const auto passes = static_cast<double>(job.tooth_angles.size() * passDepths(p).size());
  checker.below("process.wheel_wear_per_pass", (p.wheel_diameter / 2 - p.wheel_wear) / passes,
                "what is left of the wheel's radius, over the passes of all teeth");
}

template <typename Enum>
void checkChoice(Checker& checker, const char* path, Enum value) {
  const int v = static_cast<int>(value);
  constexpr int count = countOf<Enum>();
  checker.require(v >= 0 && v < count, path, std::to_string(v), "0 to " + std::to_string(count - 1));
}

}  // namespace

std::string toolText(const CutterGeometry& cutter, std::size_t teeth) {
  char text[200];
  std::snprintf(text, sizeof text, "D %g mm, cone %g deg, spiral %g deg, rake %g deg, %zu %s",
                cutter.end_diameter / units::kMillimetre, cutter.cone_angle / units::kDegree,
                cutter.spiral_angle / units::kDegree, cutter.rake_angle / units::kDegree, teeth,
                teeth == 1 ? "tooth" : "teeth");
  return text;
}

std::string JobField::format(double value, UnitSystem system) const {
  return system == UnitSystem::kSi ? number(value) + " " + si_unit : number(value / shop_scale) + " " + shop_unit;
}

std::string JobField::range(UnitSystem system) const {
  const double scale = system == UnitSystem::kSi ? shop_scale : 1;
  return number(min * scale) + " to " + number(max * scale) + " " + (system == UnitSystem::kSi ? si_unit : shop_unit);
}

const std::vector<JobField>& jobFields() {
  using Job = GrindJob;
  static const std::vector<JobField> fields{
      mm("cutter.end_diameter", "cutter.end_diameter_mm", 0.1, 100,
         [](Job& j) -> double& { return j.cutter.end_diameter; }),
      degrees("cutter.cone_angle", "cutter.cone_angle_deg", -3, 30,
              [](Job& j) -> double& { return j.cutter.cone_angle; }),
      degrees("cutter.spiral_angle", "cutter.spiral_angle_deg", -60, 60,
              [](Job& j) -> double& { return j.cutter.spiral_angle; }),
      degrees("cutter.rake_angle", "cutter.rake_angle_deg", -45, 45,
              [](Job& j) -> double& { return j.cutter.rake_angle; }),
      mm("cutter.flute_length", "cutter.flute_length_mm", 0.1, 500,
         [](Job& j) -> double& { return j.cutter.flute_length; }),
      {"process.feed", "process.feed_mm_min", "m/s", "mm/min", units::kMillimetrePerMinute,
       kMinFeed / units::kMillimetrePerMinute, 10000, [](Job& j) -> double& { return j.process.feed; }},
      mm("process.depth", "process.depth_mm", 0.001, 50, [](Job& j) -> double& { return j.process.depth; }),
      mm("process.infeed", "process.infeed_mm", 0.0001, 50, [](Job& j) -> double& { return j.process.infeed; }),
      mm("process.finish_infeed", "process.finish_infeed_mm", 0, 10,
         [](Job& j) -> double& { return j.process.finish_infeed; }),
      mm("process.clearance", "process.clearance_mm", 0.1, 100, [](Job& j) -> double& { return j.process.clearance; }),
      mm("process.overtravel_end", "process.overtravel_mm[0]", 0, 100,
         [](Job& j) -> double& { return j.process.overtravel_end; }),
      mm("process.overtravel_shank", "process.overtravel_mm[1]", 0, 100,
         [](Job& j) -> double& { return j.process.overtravel_shank; }),
      mm("process.wheel_diameter", "process.wheel.diameter_mm", 1, 500,
         [](Job& j) -> double& { return j.process.wheel_diameter; }),
      mm("process.wheel_width", "process.wheel.width_mm", 0.1, 100,
         [](Job& j) -> double& { return j.process.wheel_width; }),
      mm("process.wheel_wear", "process.wheel.wear_mm", 0, 100, [](Job& j) -> double& { return j.process.wheel_wear; }),
      {"process.wheel_wear_per_pass", "process.wheel.wear_per_pass_mm", "m", "mm", units::kMillimetre, 0, 1,
       [](Job& j) -> double& { return j.process.wheel_wear_per_pass; }, true},
      {"interpolation.tolerance", "interpolation.tolerance_um", "m", "um", units::kMicrometre, 1e-9, 1000,
       [](Job& j) -> double& { return j.interpolation.tolerance; }},
      {"interpolation.rotary_scale", "interpolation.rotary_scale_mm_per_rad", "m/rad", "mm/rad",
       units::kMillimetrePerRadian, 1e-3, 1000, [](Job& j) -> double& { return j.interpolation.rotary_scale; }},
  };
  return fields;
}

const JobField& jobField(const std::string& path) {
  const auto& fields = jobFields();
  return *std::find_if(fields.begin(), fields.end(), [&](const JobField& f) { return f.path == path; });
}

std::vector<JobError> validate(const GrindJob& job, UnitSystem units) {
  Checker checker(job, units);
  for (const JobField& f : jobFields()) checker.range(f);
  checkTeeth(checker, job);
  checker.require(job.process.spark_out >= 0 && job.process.spark_out <= kMaxSparkOut, "process.spark_out",
                  std::to_string(job.process.spark_out), "0 to " + std::to_string(kMaxSparkOut));
  checkChoice(checker, "process.order", job.process.order);
  checkChoice(checker, "process.direction", job.process.direction);
  checkChoice(checker, "interpolation.even_step", job.interpolation.even_step);
  if (checker.good()) checkTogether(checker, job);
  return checker.take();
}

std::vector<double> passDepths(const GrindProcess& process) {
  // Lets a depth that is a multiple of the infeed but for rounding take no pass of its own for the rest.
  constexpr double rounding = 1e-9;
  const double rough = process.depth - process.finish_infeed;
  const int rough_passes = static_cast<int>(std::ceil(rough / process.infeed - rounding));
  std::vector<double> depths;
  for (int i = 1; i <= rough_passes; ++i) depths.push_back(i == rough_passes ? rough : i * process.infeed);
  if (process.finish_infeed > 0 || depths.empty()) depths.push_back(process.depth);
  depths.insert(depths.end(), static_cast<std::size_t>(process.spark_out), process.depth);
  return depths;
}

std::vector<ToothPass> passOrder(const GrindJob& job) {
  const int teeth = static_cast<int>(job.tooth_angles.size());
  const int passes = static_cast<int>(passDepths(job.process).size());
  const bool tooth_major = job.process.order == GrindOrder::kToothMajor;
  std::vector<ToothPass> order;
  order.reserve(static_cast<std::size_t>(teeth) * static_cast<std::size_t>(passes));
  for (int i = 0; i < teeth * passes; ++i) {
    order.push_back(tooth_major ? ToothPass{i / passes, i % passes} : ToothPass{i % teeth, i / teeth});
  }
  return order;
}

}  // namespace flute_grinder
