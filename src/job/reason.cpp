#include "flute_grinder/job/reason.h"

#include "flute_grinder/base/axes.h"
#include "flute_grinder/job/job_fields.h"

#include <algorithm>
#include <cmath>
#include <stdexcept>

namespace grinder {

namespace {

constexpr int kFieldDigits = 10;  ///< digits of a job's numbers, so that they appear as entered

/// Converts a reason to words.
class Writer {
 public:
  explicit Writer(const Reason& reason) : r_(reason) {}

  std::string what() const {
    switch (r_.kind) {
      case ReasonKind::kOutOfRange: return refused(range() + (r_.detail.empty() ? "" : ", " + r_.detail));
      case ReasonKind::kNotBelow: return refused("less than " + digits(r_.limit) + ", " + r_.detail);
      case ReasonKind::kAbove: return refused("up to " + r_.detail + ", " + digits(r_.limit));
      case ReasonKind::kNotAllowed: return refused(r_.detail + (r_.limit == 0 ? "" : " " + digits(r_.limit)));
      case ReasonKind::kFeedTooLow:
        return name("process.feed") + ": " + r_.detail + " allows " + value() + " at X = " + x() +
               "; the slowest feed is " + limit();
      case ReasonKind::kParkInWork:
        return "park position " + axis() + " = " + value() + "; allowed for this job: at least " + limit() +
               ", clear of the work";
      case ReasonKind::kTolerance:
        return name("interpolation.tolerance") + " = " + limit() + ": the path deviates by " + value() +
               " at the maximum feed override" + place() + "; lower " + name("process.feed") +
               ", or set interpolation.even_step to exact";
      case ReasonKind::kCoreSize:
        return name("cutter.core_diameter") + ", " + name("cutter.core_diameter_end") + ": the core is " + value() +
               " at X = " + x() + "; allowed: within " + low() + " of " + limit() + "; change " +
               (r_.detail.empty() ? name("process.depth") + " or " + name("process.depth_end") : r_.detail);
      case ReasonKind::kIncomplete:
        return name("process.overtravel_end") + ", " + name("process.overtravel_shank") + ": the flutes are complete " +
               (r_.value > r_.low ? "from X = " + low() + " to " + value() : std::string("nowhere")) +
               "; allowed: over the whole flute length, 0 to " + limit() + ", unless process.incomplete_ok is true";
      case ReasonKind::kCollision: return collision();
      case ReasonKind::kSwivel: return name(r_.field) + " = " + digits(r_.limit) + ": " + swivel();
      case ReasonKind::kUnevenRake:
        return name("process.z_law") + " = constant_rake: tooth " + tooth() +
               (r_.low <= r_.value ? " is ground with " + low() + " to " + value() + " at best, asked " + limit() +
                                         "; allowed: within " + grinder::text(Quantity{kEvenRake, r_.unit}) + " of it"
                                   : std::string(" has no rake face over its whole flute")) +
               "; change " + name("process.setup_swivel") + " or " + name("process.setup_height") + ", or raise " +
               name("process.overtravel_end") + " or " + name("process.overtravel_shank");
      case ReasonKind::kTooLong:
        return "max_job_duration = " + limit() + ": the job takes " + (r_.value > 0 ? value() + " or more" : "longer") +
               " for " + std::to_string(r_.count) + (r_.count == 1 ? " pass" : " passes") + " of its teeth; raise " +
               name("process.feed") + " or " + name("process.infeed") + ", or the parameter";
      default: return filled(rowOf(r_.kind).text);
    }
  }

  std::string place() const {
    if (!r_.has_place) return "";
    return std::string(" (") + toString(r_.move) + ", tooth " + tooth() + ", pass " + std::to_string(r_.pass + 1) +
           ", X = " + x() + ")";
  }

  /// Whether place() comes after what(), and not within it.
  bool placeAtEnd() const { return r_.kind != ReasonKind::kTolerance && r_.kind != ReasonKind::kCollision; }

  std::string others() const {
    if (!ofSetpoint() || r_.count < 2) return "";
    return "; the worst of " + std::to_string(r_.count) + " setpoints";
  }

 private:
  /// A text of kReasonKinds with the braces replaced.
  std::string filled(const std::string& text) const {
    std::string whole;
    for (std::size_t at = 0; at < text.size();) {
      const std::size_t open = std::min(text.find('{', at), text.size());
      whole += text.substr(at, open - at);
      if (open == text.size()) break;
      const std::size_t close = text.find('}', open);
      whole += member(text.substr(open + 1, close - open - 1));
      at = close + 1;
    }
    return whole;
  }
  std::string member(const std::string& name) const {
    if (name == "axis") return axis();
    if (name == "value") return value();
    if (name == "limit") return limit();
    if (name == "detail") return r_.detail;
    if (name == "low") return low();
    if (name == "tooth") return tooth();
    if (name == "x") return x();
    if (name == "cycle") return std::to_string(r_.cycle);
    if (name == "number") return number();
    if (name == "excess") return excess();
    if (name.find('.') != std::string::npos) return fieldName(name);
    throw std::logic_error("kReasonKinds: no text for {" + name + "}");
  }

  bool ofSetpoint() const {
    return r_.kind == ReasonKind::kTolerance || (ReasonKind::kPosition <= r_.kind && r_.kind <= ReasonKind::kNotFinite);
  }

  std::string digits(double si) const { return grinder::text(Quantity{si, r_.unit}, kFieldDigits); }
  std::string value() const { return grinder::text(Quantity{r_.value, r_.unit}); }
  std::string limit() const { return grinder::text(Quantity{r_.limit, r_.unit}); }
  std::string low() const { return grinder::text(Quantity{r_.low, r_.unit}); }
  std::string x() const { return grinder::text(Quantity{r_.x, Unit::kMetre}); }
  std::string tooth() const { return std::to_string(r_.tooth + 1); }
  std::string number() const { return grinder::text(Quantity{r_.value, Unit::kNone}); }
  std::string range() const {
    return grinder::text(Quantity{r_.low, r_.unit}, Quantity{r_.limit, r_.unit}, kFieldDigits);
  }
  std::string axis() const { return axisName(r_.axis); }
  std::string name(const std::string& path) const { return fieldName(path); }
  std::string refused(const std::string& allowed) const {
    return name(r_.field) + " = " + digits(r_.value) + "; allowed: " + allowed;
  }
  std::string excess() const {
    const double magnitude = r_.kind == ReasonKind::kPosition ? r_.value : std::abs(r_.value);
    const Quantity beyond{std::abs(magnitude - r_.limit), r_.unit};
    return value() + " is " + grinder::text(beyond) + " beyond its limit " + limit();
  }

  std::string collision() const {
    const std::string apart =
        r_.detail + (r_.value > 0 ? " come within " + value() + " of" : std::string(" hit")) + " each other";
    if (r_.field.empty()) return "collision_clearance = " + limit() + ": " + apart + place() + wayOut();
    return name(r_.field) + " = " + low() + ": " + apart + " outside the cut" + place() + "; allowed: " + limit() +
           " or more; raise it";
  }

  /// What to do about a collision of two bodies; the names of the cutter's own bodies come from CollisionCheck.
  std::string wayOut() const {
    const auto is_of = [&](const char* body) { return r_.detail.find(body) != std::string::npos; };
    if (is_of("shank")) {
      return "; change " + name("cutter.shank_diameter") + ", " + name("cutter.neck_length") + " or " +
             name("process.overtravel_shank");
    }
    if (is_of("cutter")) return "; change " + name("process.setup_swivel") + " or " + name("process.wheel_diameter");
    return "; stick the blank out further, and set the zero of X anew";
  }

  /// The swivel as it stands, and what to do about it.
  std::string swivel() const {
    const std::string allowed = "; allowed: within " + low() + " of that; set it to " + digits(r_.limit);
    if (r_.detail == "measured") return "the swivel is at " + digits(r_.value) + allowed;
    const std::string confirm = " and confirm it: grind confirm-swivel " +
                                grinder::text(Quantity{r_.limit / shopScale(r_.unit), Unit::kNone}, kFieldDigits);
    if (r_.detail.empty()) return "the swivel is not confirmed; set it to " + digits(r_.limit) + confirm;
    return "the swivel is confirmed at " + digits(r_.value) + allowed + confirm;
  }

  const Reason& r_;
};

}  // namespace

std::string text(const Reason& reason) {
  const Writer writer(reason);
  return writer.what() + (writer.placeAtEnd() ? writer.place() : "") + writer.others();
}

std::string text(const std::vector<Reason>& reasons) {
  std::string all;
  for (const Reason& reason : reasons) all += (all.empty() ? "" : "; ") + text(reason);
  return all;
}

}  // namespace grinder
