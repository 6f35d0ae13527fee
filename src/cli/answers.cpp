#include "cli/answers.h"

#include "cli/interrupt.h"
#include "flute_grinder/base/escaped.h"

#include <poll.h>
#include <termios.h>
#include <unistd.h>

#include <cstdio>

namespace grinder {

namespace {

constexpr int kGlance = 100;  ///< time between glances at Ctrl-C [ms]

/// A line from the terminal, without blanks; empty after its end, and after Ctrl-C.
std::string readLine() {
  const int before = interrupts();
  std::string line;
  for (;;) {
    pollfd input{STDIN_FILENO, POLLIN, 0};
    const int ready = ::poll(&input, 1, kGlance);
    if (interrupts() != before) return "";
    if (ready <= 0) continue;
    char c = 0;
    if (::read(STDIN_FILENO, &c, 1) != 1 || c == '\n') return line;
    if (c != ' ' && c != '\r') line += c;
  }
}

/// @return false if it cannot be asked.
bool put(const flute_grinder::Need& need) {
  const auto say = [](const std::string& text) { std::fprintf(stderr, "%s\n", escaped(text).c_str()); };
  say(need.text);
  say(need.question);
  for (const flute_grinder::NeedFigure& figure : need.figures) {
    std::string row = "  " + figure.what;
    for (const auto& [name, cell] :
         {std::pair("asked", &figure.asked), std::pair("set", &figure.set), std::pair("off by", &figure.difference)}) {
      if (!cell->empty()) row += std::string("; ") + name + ": " + *cell;
    }
    say(row);
  }
  int number = 0;
  for (const flute_grinder::NeedAnswer& answer : need.answers) {
    say("  " + std::to_string(++number) + "  " + answer.text + ": " + answer.help);
  }
  // What was typed ahead is no answer.
  if (tcflush(STDIN_FILENO, TCIFLUSH) != 0) return false;
  std::fprintf(stderr, "Number of the answer, or Enter for none: ");
  return true;
}

}  // namespace

bool addAnswers(const std::vector<flute_grinder::Need>& needs, std::vector<std::string>& answers) {
  if (needs.empty() || isatty(STDIN_FILENO) == 0) return false;
  std::vector<std::string> given;
  for (const flute_grinder::Need& need : needs) {
    if (need.answers.empty() || !put(need)) return false;
    const std::string line = readLine();
    const std::size_t number = line.size() == 1 ? static_cast<std::size_t>(line[0] - '0') : 0;
    if (number < 1 || number > need.answers.size()) return false;
    given.push_back(need.answers[number - 1].id);
  }
  answers.insert(answers.end(), given.begin(), given.end());
  return true;
}

}  // namespace grinder
