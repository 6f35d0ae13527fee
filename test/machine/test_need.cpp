#include "flute_grinder/machine/need.h"

#include <gtest/gtest.h>

#include <set>

namespace grinder {
namespace test_need {

using Answers = std::vector<std::string>;

const Need kZeros{NeedKind::kOffsets,
                  "Y was set for D 6 mm",
                  {{"Y", "D 10 mm", "D 6 mm", "2 mm"}},
                  {NeedAnswer::kFitOffsets, NeedAnswer::kIgnoreOffsets}};

TEST(Need, IsAnsweredByTheIdOfWhatWasShownAndByNoOther) {
  const std::string id = answerId(kZeros, NeedAnswer::kIgnoreOffsets);
  // printf 'offsets\nY was set for D 6 mm\nY\nD 10 mm\nD 6 mm\n2 mm' | sha256sum
  EXPECT_EQ(id, "ignore-offsets#45efcd4a");
  EXPECT_TRUE(isAnswered(kZeros, {id}));
  EXPECT_TRUE(isAnswered(kZeros, NeedAnswer::kIgnoreOffsets, {"discard", id}));
  EXPECT_FALSE(isAnswered(kZeros, NeedAnswer::kFitOffsets, {id}));
  EXPECT_FALSE(isAnswered(kZeros, {}));
  std::set<std::string> ids{id};
  for (std::string NeedFigure::*cell :
       {&NeedFigure::what, &NeedFigure::asked, &NeedFigure::set, &NeedFigure::difference}) {
    Need other = kZeros;
    other.figures[0].*cell += " more";
    EXPECT_FALSE(isAnswered(other, {id}));
    EXPECT_TRUE(ids.insert(answerId(other, NeedAnswer::kIgnoreOffsets)).second);
  }
  Need other = kZeros;
  other.text = "Y was set for D 6.1 mm";
  EXPECT_FALSE(isAnswered(other, {id}));
  other = kZeros;
  other.answers = {NeedAnswer::kFitOffsets};
  EXPECT_FALSE(isAnswered(other, {id})) << "it is not offered";
}

TEST(Need, IsAnsweredBeforehandByTheNameOfAnAnswer) {
  EXPECT_TRUE(isAnswered(kZeros, {"ignore-offsets"}));
  EXPECT_FALSE(isAnswered(kZeros, {"discard"}));
  EXPECT_FALSE(isAnswered(kZeros, {"ignore"}));
  const Need wheel{NeedKind::kWheel, "no wheel", {}, {NeedAnswer::kConfirmWheel}};
  EXPECT_TRUE(isAnswered(wheel, {"ignore-offsets"})) << "the offsets are the wheel's";
  EXPECT_FALSE(isAnswered(wheel, {answerId(kZeros, NeedAnswer::kIgnoreOffsets)})) << "it was shown for others";
  EXPECT_EQ(unanswered({kZeros, wheel}, {"confirm-wheel"}).size(), 1U);
}

TEST(Need, TakesNoAnswerThatThereIsNot) {
  EXPECT_EQ(answersRefusal({"discard", answerId(kZeros, NeedAnswer::kFitOffsets)}), "");
  EXPECT_EQ(
      answersRefusal({"discard", "yes\x1b"}),
      "answer = yes\\x1b; allowed: discard, confirm-wheel, fit-offsets, ignore-offsets, confirm-swivel, set-offset");
  EXPECT_NE(answersRefusal({""}), "");
}

TEST(Need, IsSaidWithItsAnswers) {
  const Need swivel{NeedKind::kSwivel, "the swivel is measured at 1 deg", {}, {}};
  EXPECT_EQ(text({kZeros, swivel}),
            "Y was set for D 6 mm; answer: fit-offsets or ignore-offsets; the swivel is measured at 1 deg");
}

}  // namespace test_need
}  // namespace grinder
