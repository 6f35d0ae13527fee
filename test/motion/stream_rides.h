#pragma once

#include "stream_checks.h"

#include <algorithm>
#include <cstdint>
#include <map>
#include <random>
#include <vector>

// Streams gone through while they are held, retracted and given other feeds.
namespace grinder::test_support {

/// What somebody got from a stream of whom things were asked on the way.
struct Ride {
  struct Given {
    Setpoint p;
    bool on_path;
  };
  std::vector<Given> given;
  std::vector<Setpoint> seen_by_machine;  ///< with those of the rests, which hold the last position
  int requests_in_strokes = 0;

  std::vector<Setpoint> setpoints() const {
    std::vector<Setpoint> all;
    for (const Given& g : given) all.push_back(g.p);
    return all;
  }
};

/// Takes setpoints from a stream, and keeps them.
class Rider {
 public:
  Rider(const Work& work, std::uint64_t seed) : work_(work), stream_(work.program()), random_(seed) {}

  SetpointStream& stream() { return stream_; }
  Ride& ride() { return ride_; }
  const Setpoint& last() const { return last_; }
  double fraction() { return std::uniform_real_distribution<double>(0, 1)(random_); }
  bool flip(double chance) { return fraction() < chance; }

  /// @return false at a rest, of which the machine then sees some cycles.
  bool next() {
    const Setpoint before = last_;
    if (stream_.next(last_)) {
      ride_.given.push_back({last_, stream_.onPath()});
      ride_.seen_by_machine.push_back(last_);
      return true;
    }
    RC_ASSERT(last_.cycle == before.cycle);
    RC_ASSERT((last_.position == before.position).all());
    RC_ASSERT(last_.cycle % 2 == 0u);
    RC_ASSERT(last_.feed <= 1e-12);  // by its own account too
    const auto cycles = 2 * static_cast<std::size_t>(fraction() * 5);
    if (!ride_.given.empty()) ride_.seen_by_machine.insert(ride_.seen_by_machine.end(), cycles, last_);
    return false;
  }

  void runToRest() {
    for (std::size_t i = 0; next(); ++i) RC_ASSERT(i < 1000000u);
  }

  /// A few cycles, or up to a rest.
  void runSome(int most) {
    for (int i = static_cast<int>(fraction() * most); i > 0 && next();) --i;
  }

 private:
  Work work_;
  SetpointStream stream_;
  std::mt19937_64 random_;
  Ride ride_;
  Setpoint last_;
};

/// For every stroke, by its move, some X in the order of the stroke: those at random cycles of the undisturbed one.
inline std::map<std::uint32_t, std::vector<double>> momentsInStrokes(const std::vector<Setpoint>& undisturbed,
                                                                     int per_stroke) {
  std::map<std::uint32_t, std::vector<double>> strokes;
  for (const Setpoint& p : undisturbed) {
    if (p.step != StepKind::kNone) strokes[p.move_index].push_back(p.position[kX]);
  }
  for (auto& [index, xs] : strokes) {
    std::vector<std::size_t> cycles;
    for (int i = 0; i < per_stroke; ++i) {
      cycles.push_back(static_cast<std::size_t>(static_cast<double>(xs.size() - 1) * *uniform(0, 1)));
    }
    std::sort(cycles.begin(), cycles.end());
    std::vector<double> chosen;
    for (const std::size_t cycle : cycles) chosen.push_back(xs[cycle]);
    xs = chosen;
  }
  return strokes;
}

/// Asks for one thing or another: hold, go on, another feed, no feed, things that are not taken.
inline void askForSomething(Rider& rider) {
  SetpointStream& stream = rider.stream();
  switch (static_cast<int>(rider.fraction() * 8)) {
    case 0:
    case 1: stream.hold(); break;
    case 2: stream.resume(); break;
    case 3: stream.setFeedOverride(std::max(0.05, kMaxFeedOverride * rider.fraction())); break;
    case 4: stream.setFeedOverride(kMaxFeedOverride); break;
    case 5: stream.setFeedOverride(0); break;
    case 6:
      stream.hold();
      stream.resume();
      break;
    default: stream.setFeedOverride(1);
  }
}

/// A ride with holds and feed overrides at the moments given, and at more that follow them by chance.
inline Ride rideWithHoldsAndOverrides(const Work& work, std::map<std::uint32_t, std::vector<double>> moments) {
  Rider rider(work, *rc::gen::arbitrary<std::uint64_t>());
  SetpointStream& stream = rider.stream();
  const double direction = stream.program().strokeTo() < stream.program().strokeFrom() ? -1 : 1;
  int spare_requests = 100;
  int rests = 0;
  while (!stream.finished()) {
    if (!rider.next()) {
      if (stream.finished()) break;
      RC_ASSERT(++rests < 5000);
      if (rider.flip(0.3)) stream.hold();  // though it rests
      if (rider.flip(0.5) || --spare_requests < 0) {
        stream.resume();
        stream.setFeedOverride(rider.flip(0.5) ? 1 : 0.1 + 1.1 * rider.fraction());
      }
      continue;
    }
    const Setpoint& p = rider.last();
    bool ask = spare_requests > 0 && rider.flip(0.01);
    if (ask && --spare_requests == 0) {
      stream.resume();
      stream.setFeedOverride(1);
      ask = false;
    }
    if (p.step != StepKind::kNone) {
      auto& xs = moments[p.move_index];
      while (!xs.empty() && direction * (p.position[kX] - xs.front()) >= 0) {
        xs.erase(xs.begin());
        ask = true;
        ++rider.ride().requests_in_strokes;
      }
    }
    if (ask) askForSomething(rider);
    RC_ASSERT(rider.ride().given.size() < 500000u);
  }
  return rider.ride();
}

/// Lifts the wheel from where it rests, and brings it back on its way; now and then with a rest in the midst of it, or
/// with another lift from the way back.
inline void liftAndComeBack(Rider& rider) {
  SetpointStream& stream = rider.stream();
  stream.retract();
  RC_ASSERT(!stream.onPath());
  RC_ASSERT(!stream.finished());
  const bool to_the_top = rider.flip(0.5);
  if (to_the_top) {
    rider.runToRest();
    RC_ASSERT(!rider.next());
  } else {
    rider.runSome(100);
    if (rider.flip(0.6)) {
      stream.hold();
      rider.runToRest();
      if (rider.flip(0.5)) stream.retract();
    }
  }
  stream.resume();
  if (rider.flip(0.3)) stream.setFeedOverride(0.1 + 1.1 * rider.fraction());
  if (!rider.flip(0.5)) return;
  rider.runSome(rider.flip(0.5) ? 2000 : 100);
  stream.hold();
  rider.runToRest();
  if (!stream.finished() && rider.flip(0.7)) {
    stream.retract();
    rider.runToRest();
  }
  stream.resume();
}

/// A ride with lifts at some random moments of the job, in whatever move.
inline Ride rideWithRetracts(const Work& work, const std::vector<Setpoint>& undisturbed, int count) {
  std::vector<std::size_t> cycles;
  for (int i = 0; i < count; ++i) {
    cycles.push_back(static_cast<std::size_t>(static_cast<double>(undisturbed.size() - 1) * *uniform(0, 1)));
  }
  std::sort(cycles.begin(), cycles.end());
  Rider rider(work, *rc::gen::arbitrary<std::uint64_t>());
  SetpointStream& stream = rider.stream();
  for (const std::size_t cycle : cycles) {
    const Setpoint& moment = undisturbed[cycle];
    const auto before = [&](const Setpoint& p) {
      return p.move_index < moment.move_index ||
             (p.move_index == moment.move_index && p.move_fraction < moment.move_fraction);
    };
    while (rider.ride().given.empty() || before(rider.last())) {
      if (!rider.next()) break;
    }
    if (rider.last().cycle % 2 == 1) {
      const bool on_path = stream.onPath();
      stream.retract();
      RC_ASSERT(stream.onPath() == on_path);
    }
    stream.hold();
    rider.runToRest();
    if (stream.finished()) break;
    liftAndComeBack(rider);
  }
  stream.resume();
  rider.runToRest();
  RC_ASSERT(stream.finished());
  return rider.ride();
}

/// The paper's job, gone through up to a place in its stroke.
class PaperStroke {
 public:
  explicit PaperStroke(double x) : stream_(GrindProgram(ValidJob(paperJob()), plainMachine(), plainMachine().park)) {
    while (p_.move != MoveKind::kStroke || p_.position[kX] < x || p_.cycle % 2 == 1) next();
  }

  SetpointStream& stream() { return stream_; }
  const Setpoint& last() const { return p_; }
  bool next() { return stream_.next(p_); }
  void runToRest() {
    while (next()) {
    }
  }

 private:
  SetpointStream stream_;
  Setpoint p_;
};

}  // namespace grinder::test_support
