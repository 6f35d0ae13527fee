#pragma once

#include "flute_grinder/base/enum_table.h"

#include <cstdint>
#include <string>
#include <vector>

namespace grinder {

/// What the grinder must be told before it does what was asked.
enum class NeedKind : std::uint8_t {
  kUnfinishedJob,  ///< what becomes of the job in the journal
  kWheel,          ///< whether the job's wheel is on the spindle
  kOffsets,        ///< whether the work offsets fit the job
  kSwivel,         ///< whether the swivel is at the job's angle
  kLargeChange,    ///< whether a work offset is to change by that much
};

struct NeedRow : EnumRow<NeedKind> {
  const char* question = "";  ///< for people
};

/// Each need with its name in messages.
inline constexpr NeedRow kNeeds[]{
    {{NeedKind::kUnfinishedJob, "unfinished_job"}, "That job cannot be continued once this one starts."},
    {{NeedKind::kWheel, "wheel"}, "Is the wheel of the job on the spindle?"},
    {{NeedKind::kOffsets, "offsets"}, "These zero points are not of this job:"},
    {{NeedKind::kSwivel, "swivel"}, "Is the swivel set to this angle and clamped?"},
    {{NeedKind::kLargeChange, "large_change"}, "Is the new work offset right?"},
};
constexpr auto& rowsOf(NeedKind) noexcept { return kNeeds; }

/// An answer to a need.
enum class NeedAnswer : std::uint8_t {
  kDiscard,
  kConfirmWheel,
  kFitOffsets,
  kIgnoreOffsets,
  kConfirmSwivel,
  kSetOffset,
};

struct NeedAnswerRow : EnumRow<NeedAnswer> {
  const char* text = "";      ///< on a button
  const char* help = "";      ///< what it does
  bool is_danger = false;     ///< given by mistake, it costs a wheel or a tool
  bool changes_plan = false;  ///< the job is to be planned with it before it starts: where the axes go depends on it
};

/// Each answer with its name in goals, in requests and on the command line.
inline constexpr NeedAnswerRow kNeedAnswers[]{
    {{NeedAnswer::kDiscard, "discard"}, "Discard that job", "give up the job that the journal keeps", true, false},
    {{NeedAnswer::kConfirmWheel, "confirm-wheel"},
     "It is mounted",
     "the wheel of the job is on the spindle",
     false,
     true},
    {{NeedAnswer::kFitOffsets, "fit-offsets"},
     "Fit them",
     "compute work offsets from what they were set for: the wheel and the swivel are the same",
     false,
     true},
    {{NeedAnswer::kIgnoreOffsets, "ignore-offsets"},
     "Ignore and grind",
     "grind with wheel and work offsets as they are",
     true,
     false},
    {{NeedAnswer::kConfirmSwivel, "confirm-swivel"},
     "It is set",
     "the swivel is at the angle of the job and clamped",
     false,
     false},
    {{NeedAnswer::kSetOffset, "set-offset"}, "Set it", "change the work offset by that much", true, false},
};
constexpr auto& rowsOf(NeedAnswer) noexcept { return kNeedAnswers; }

/// Figures of a need, side by side, as texts for people.
struct NeedFigure {
  std::string what, asked, set, difference;  ///< any but `what` may be empty
};

/// Something that the grinder must be told, with what it can be told.
struct Need {
  NeedKind kind{};
  std::string text;  ///< what is missing, for people
  std::vector<NeedFigure> figures{};
  std::vector<NeedAnswer> answers{};  ///< none: it cannot be answered, only mended
};

/// The answer as a goal or a request has it: its name, and a digest of the need that was shown, so that it cannot
/// answer a need with other figures: "discard#1a2b3c4d".
std::string answerId(const Need& need, NeedAnswer answer);

/// Whether a need is answered in this way: by the id of the answer, or beforehand by its name alone, whatever the
/// figures. @param given answers of a goal or a request.
bool isAnswered(const Need& need, NeedAnswer answer, const std::vector<std::string>& given);

/// Whether a need is answered in any of its ways. Wheel and work offsets are both ignored by the same answer.
bool isAnswered(const Need& need, const std::vector<std::string>& given);

/// Those needs that are not answered.
std::vector<Need> unanswered(const std::vector<Need>& needs, const std::vector<std::string>& given);

/// Whether an answer of this name is given, to whatever need.
bool gives(const std::vector<std::string>& given, NeedAnswer answer);

/// Why the answers of a goal or a request cannot be any; empty if they can.
std::string answersRefusal(const std::vector<std::string>& given);

/// The needs with the names of their answers, for people.
std::string text(const std::vector<Need>& needs);

}  // namespace grinder
