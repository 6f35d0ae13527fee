// Rides random jobs through the control loop, see ride.h, and reports those that went wrong.

#include "ride.h"

#include <CLI/CLI.hpp>

#include <chrono>
#include <cstdio>
#include <exception>
#include <map>

int main(int argc, char** argv) {
  using Clock = std::chrono::steady_clock;
  CLI::App app(
      "Rides random jobs through the control loop, with everything that may happen, and judges every setpoint.");
  std::uint64_t first = 0, count = 1000;
  double seconds = 1e9;
  app.add_option("--from", first, "number of the first ride; each number is always the same ride")
      ->capture_default_str();
  app.add_option("--count", count, "how many rides")->capture_default_str();
  app.add_option("--for", seconds, "for at most this long, e.g. 8h")
      ->transform(CLI::AsNumberWithUnit(std::map<std::string, double>{{"s", 1}, {"min", 60}, {"h", 3600}},
                                        CLI::AsNumberWithUnit::CASE_INSENSITIVE));
  CLI11_PARSE(app, argc, argv);
  const Clock::time_point start = Clock::now();
  const auto elapsed = [&] { return std::chrono::duration<double>(Clock::now() - start).count(); };
  grinder::test_support::RideResult total;
  std::uint64_t number = first, wrong = 0;
  for (; number < first + count && elapsed() < seconds; ++number) {
    try {
      const auto one = grinder::test_support::ride(number);
      total.setpoints += one.setpoints;
      total.cycles += one.cycles;
      total.events += one.events;
      total.runs += one.runs;
      if (one.fault.empty()) continue;
      std::printf("ride %llu: %s\n", static_cast<unsigned long long>(number), one.fault.c_str());
    } catch (const std::exception& error) {
      std::printf("ride %llu: %s\n", static_cast<unsigned long long>(number), error.what());
    }
    ++wrong;
    std::fflush(stdout);
  }
  std::printf("%llu rides (%llu to %llu), %llu setpoints in %llu cycles, %d runs, %d events, %.0f s; wrong: %llu\n",
              static_cast<unsigned long long>(number - first), static_cast<unsigned long long>(first),
              static_cast<unsigned long long>(number - 1), static_cast<unsigned long long>(total.setpoints),
              static_cast<unsigned long long>(total.cycles), total.runs, total.events, elapsed(),
              static_cast<unsigned long long>(wrong));
  return wrong == 0 ? 0 : 1;
}
