#include "cli/run_record.h"

#include "cli/csv.h"
#include "flute_grinder/GrindActionGoal.h"
#include "flute_grinder/SetpointBatch.h"
#include "flute_grinder/curve/units.h"
#include "flute_grinder/job/regular_file.h"
#include "flute_grinder/messages/conversions.h"

#include <rosbag/bag.h>
#include <rosbag/view.h>

#include <algorithm>
#include <cerrno>
#include <cmath>
#include <cstdlib>
#include <cstring>
#include <fstream>
#include <limits>
#include <sstream>
#include <vector>

namespace flute_grinder {

namespace {

using units::kMillimetre;

constexpr char kBagHead[] = "#ROSBAG ";

/// The messages of a type. @throw FileError if the bag has them in another version.
template <typename Message, typename Visit>
void forEach(const rosbag::Bag& bag, const std::string& path, const Visit& visit) {
  rosbag::View view(bag, rosbag::TypeQuery(ros::message_traits::datatype<Message>()));
  for (const rosbag::MessageInstance& instance : view) {
    const auto message = instance.instantiate<Message>();
    if (!message) {
      throw FileError(path + ": " + instance.getTopic() + " has another definition of " + instance.getDataType() +
                      " than this program");
    }
    visit(*message);
  }
}

/// @throw FileError if reading fails.
template <typename Read>
void readBag(const std::string& path, const Read& read) {
  try {
    rosbag::Bag bag(path);
    read(bag);
  } catch (const rosbag::BagUnindexedException&) {
    throw FileError(path + ": the bag was not closed, or is cut off; \"rosbag reindex\" saves what is in it");
  } catch (const rosbag::BagException& error) {
    throw FileError(path + ": cannot be read: " + error.what());
  } catch (const ros::serialization::StreamOverrunException& error) {
    throw FileError(path + ": cannot be read: " + error.what());
  }
}

/// Reads the fields of a line.
class Fields {
 public:
  explicit Fields(const std::string& line) : line_(line + ",") {}

  std::string text() {
    std::string field;
    std::getline(line_, field, ',');
    if (!line_) throw std::invalid_argument("a field is missing");
    return field;
  }
  double number() {
    const std::string field = text();
    char* end = nullptr;
    const double value = std::strtod(field.c_str(), &end);
    if (field.empty() || *end != '\0') throw std::invalid_argument("\"" + field + "\" is not a number");
    return value;
  }
  template <typename Integer>
  Integer integer() {
    const double value = number();
    if (!(value >= 0 && value <= static_cast<double>(std::numeric_limits<Integer>::max()) &&
          value == std::floor(value)))
      throw std::invalid_argument(std::to_string(value) + " is out of range");
    return static_cast<Integer>(value);
  }
  template <typename Enum>
  Enum choice() {
    const std::string field = text();
    const auto value = valueOf<Enum>(field);
    if (!value) throw std::invalid_argument("\"" + field + "\" is not known");
    return *value;
  }
  Axes axes() {
    Axes axes;
    for (const int axis : {kX, kY, kZ}) axes[axis] = number() * kMillimetre;
    axes[kA] = number();
    return axes;
  }

 private:
  std::istringstream line_;
};

}  // namespace

FileKind kindOf(const std::string& path) {
  requireRegularFile(path);
  std::ifstream file(path, std::ios::binary);
  std::string head(sizeof kBagHead - 1, '\0');
  if (!file || file.read(head.data(), static_cast<std::streamsize>(head.size())).bad())
    throw FileError(path + ": cannot be read: " + std::strerror(errno));
  if (head == kBagHead) return FileKind::kBag;
  return head.compare(0, 6, "cycle,") == 0 ? FileKind::kRunCsv : FileKind::kJob;
}

BagRecord::BagRecord(const std::string& path, int run) : path_(path) {
  std::vector<std::string> ids;
  readBag(path, [&](const rosbag::Bag& bag) {
    forEach<SetpointBatch>(bag, path, [&](const SetpointBatch& batch) {
      if (std::find(ids.begin(), ids.end(), batch.goal_id) == ids.end()) ids.push_back(batch.goal_id);
    });
    if (ids.empty()) throw FileError(path + ": the bag has no setpoints: no job ran while it was recorded");
    const std::size_t number = run == 0 ? ids.size() : static_cast<std::size_t>(run);
    if (number > ids.size()) {
      throw FileError(path + ": --run " + std::to_string(run) + "; the bag has " + std::to_string(ids.size()) +
                      " job(s)");
    }
    goal_id_ = ids[number - 1];
    name_ = "job " + std::to_string(number) + " of " + std::to_string(ids.size());
    forEach<GrindActionGoal>(bag, path, [&](const GrindActionGoal& goal) {
      if (goal.goal_id.id == goal_id_) job_ = jobFromGoal(goal.goal);
    });
  });
}

void BagRecord::visit(const RecordVisitor& visitor) const {
  readBag(path_, [&](const rosbag::Bag& bag) {
    forEach<SetpointBatch>(bag, path_, [&](const SetpointBatch& batch) {
      if (batch.goal_id != goal_id_) return;
      for (const WrittenSetpoint& s : batch.setpoints) visitor(fromMessage(s), Axes(s.actual.data()));
    });
  });
}

void visitRunCsv(const std::string& path, const RecordVisitor& visitor) {
  std::ifstream file(path);
  std::string line;
  std::getline(file, line);
  if (line != RunCsv::columns()) {
    throw FileError(path +
                    ": its first line is not that of a file of 'grind run --csv'; without the positions that the "
                    "drive read there is nothing to simulate");
  }
  for (int number = 2; std::getline(file, line); ++number) {
    try {
      Fields fields(line);
      Setpoint s;
      s.cycle = fields.integer<std::uint64_t>();
      fields.number();  // its time
      s.move = fields.choice<MoveKind>();
      s.tooth = fields.integer<std::uint16_t>();
      s.pass = fields.integer<std::uint16_t>();
      s.step = fields.choice<StepKind>();
      s.position = fields.axes();
      s.path_error = fields.number();
      s.feed = fields.number() * units::kMillimetrePerMinute;
      visitor(s, fields.axes());
    } catch (const std::invalid_argument& error) {
      throw FileError(path + ":" + std::to_string(number) + ": " + error.what());
    }
  }
}

}  // namespace flute_grinder
