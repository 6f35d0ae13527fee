#include "goals.h"

#include "flute_grinder/messages/conversions.h"
#include "jobs.h"

namespace flute_grinder {

namespace {

GrindGoal goalOf(const GrindJob& job) {
  GrindGoal goal = goalFromJob(job);
  goal.discard = true;              // whatever the job before has left in the journal
  goal.ignore_offset_check = true;  // nobody has set them
  return goal;
}

}  // namespace

GrindGoal paperGoal() { return goalOf(paperJob(600)); }
GrindGoal wholeToolGoal() { return goalOf(wholeToolJob()); }

}  // namespace flute_grinder
