#include "cli/progress_bar.h"

#include "cli/working.h"
#include "flute_grinder/base/escaped.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/base/units.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstring>
#include <vector>

namespace grinder {

namespace {

constexpr std::size_t kMinBar = 12, kMaxBar = 32;  ///< width of the bar with its brackets
constexpr std::size_t kAnyWidth = 1000;            ///< width of a line in a file
constexpr const char* kSeparator = "  ";

std::string timeLeft(double seconds) {
  const long all = std::lround(std::clamp(seconds, 0.0, 1e7));
  if (all < 3600) return format("%ld:%02ld left", all / 60, all % 60);
  return format("%ld:%02ld:%02ld left", all / 3600, all / 60 % 60, all % 60);
}

std::string bar(double fraction, std::size_t width) {
  std::string text(width - 2, '.');
  const auto done = static_cast<std::size_t>(std::clamp(fraction, 0.0, 1.0) * static_cast<double>(text.size()));
  text.replace(0, done, done, '#');
  return "[" + text + "]";
}

/// A part of the line; if they do not all fit, the one of highest rank is dropped first.
struct Part {
  int rank;
  std::string text;
};

std::size_t length(const std::vector<Part>& parts) {
  std::size_t sum = 0;
  for (const Part& part : parts) sum += (sum > 0 ? std::strlen(kSeparator) : 0) + part.text.size();
  return sum;
}

bool planning(const flute_grinder::GrindFeedback& f) { return f.state == "planning"; }

/// The fraction shown by the bar: ground or, before that, planned.
double fraction(const flute_grinder::GrindFeedback& f) { return planning(f) ? f.planned : f.job_fraction; }

constexpr int kBarRank = 5;

std::vector<Part> partsOf(const flute_grinder::GrindFeedback& f, int teeth, int passes) {
  const Part room_for_bar{kBarRank, std::string(kMinBar, ' ')};
  if (planning(f)) return {room_for_bar, {0, format("planning %.0f %%", f.planned * 100)}};
  return {room_for_bar,
          {0, format("%3.0f %%", f.job_fraction * 100)},
          {1, escaped(f.state)},
          {2, format("tooth %d/%d", f.tooth + 1, teeth)},
          {3, format("pass %d/%d", f.pass + 1, passes)},
          {6, format("X %7.3f mm", f.x / units::kMillimetre)},
          {7, format("%.0f mm/min", f.feed / units::kMillimetrePerMinute)},
          {4, timeLeft(f.remaining_time)}};
}

std::string progressLine(const flute_grinder::GrindFeedback& f, int teeth, int passes, std::size_t width) {
  std::vector<Part> parts = partsOf(f, teeth, passes);
  const auto lower = [](const Part& a, const Part& b) { return a.rank < b.rank; };
  while (length(parts) > width && parts.size() > 1) parts.erase(std::max_element(parts.begin(), parts.end(), lower));
  if (parts.front().rank == kBarRank) {
    const std::size_t room = width - length(parts) + kMinBar;
    parts.front().text = bar(fraction(f), std::min(room, kMaxBar));
  }
  std::string line;
  for (const Part& part : parts) line += (line.empty() ? "" : kSeparator) + part.text;
  return line.substr(0, width);
}

}  // namespace

ProgressBar::ProgressBar(int teeth, int passes) : terminal_(isTerminal()), teeth_(teeth), passes_(passes) {}

ProgressBar::~ProgressBar() { end(); }

void ProgressBar::show(const flute_grinder::GrindFeedback& feedback) {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (ended_) return;
  // Tenths of the percentage as shown, rounded, so that no tenth has two lines.
  const int tenths = static_cast<int>(std::nearbyint(fraction(feedback) * 100)) / 10;
  const bool changed = tenths != tenths_ || feedback.state != last_.state;
  tenths_ = tenths;
  last_ = feedback;
  begun_ = true;
  if (terminal_) {
    draw();
  } else if (changed) {
    std::fprintf(stderr, "%s\n", progressLine(last_, teeth_, passes_, kAnyWidth).c_str());
  }
}

void ProgressBar::draw() {
  std::fprintf(stderr, "%s%s", kClearLine, progressLine(last_, teeth_, passes_, terminalWidth()).c_str());
}

void ProgressBar::printLine(const std::string& text) {
  const std::lock_guard<std::mutex> lock(mutex_);
  const bool drawn = terminal_ && begun_ && !ended_;
  std::fprintf(stderr, "%s%s\n", drawn ? kClearLine : "", escaped(text).c_str());
  if (drawn) draw();
}

bool ProgressBar::complete() {
  const std::lock_guard<std::mutex> lock(mutex_);
  return !begun_ || planning(last_) || last_.job_fraction >= 1;
}

void ProgressBar::end() {
  const std::lock_guard<std::mutex> lock(mutex_);
  if (terminal_ && begun_ && !ended_) std::fprintf(stderr, "\n");
  ended_ = true;
}

}  // namespace grinder
