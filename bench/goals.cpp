#include "goals.h"

#include "flute_grinder/messages/conversions.h"
#include "jobs.h"

namespace grinder {

namespace {

flute_grinder::GrindGoal goalOf(const GrindJob& job) {
  flute_grinder::GrindGoal goal = goalFromJob(job);
  // Whatever the job before has left in the journal, and though nobody has set the offsets.
  goal.answers = {"discard", "ignore-offsets"};
  return goal;
}

}  // namespace

flute_grinder::GrindGoal paperGoal() { return goalOf(paperJob(600)); }
flute_grinder::GrindGoal wholeToolGoal() { return goalOf(wholeToolJob()); }

}  // namespace grinder
