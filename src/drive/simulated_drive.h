#pragma once

#include "flute_grinder/InjectFault.h"
#include "flute_grinder/drive/drive.h"
#include "flute_grinder/drive/parameters.h"

#include <atomic>
#include <limits>
#include <optional>

namespace grinder {

/// A simulated tool grinder. Each axis follows its command with a first-order lag and is read through an encoder; an
/// incremental encoder reads 0 at the start position until the axis is homed. Homing moves the axes one at a time to
/// their home positions, in the order Y, X, Z, A. The spindle reaches its speed in a given time; coolant flows at once.
/// The measuring probe touches a blank, if there is one. The service ~hardware/inject_fault injects faults.
///
/// Parameters, in the drive's namespace: for each joint `<joint>/time_constant` [s], `<joint>/counts_per_unit` [1/m or
/// 1/rad], `<joint>/start_position` and `<joint>/home_position` [m or rad], `<joint>/homing_velocity` [m/s or rad/s];
/// `absolute_encoders`, `spindle_run_up_time` [s]; `pace` if the simulated time is to run faster than the clock;
/// `swivel` [rad] if the swivel has an encoder; and `blank/...` with the members of Blank if the probe is to find one,
/// together with the machine's parameters geometry/probe and geometry/work_axis.
class SimulatedDrive : public Drive {
 public:
  /// Model of one axis.
  struct AxisModel {
    double time_constant = 0;    ///< [s]
    double counts_per_unit = 1;  ///< of the encoder [1/m or 1/rad]
    double start_position = 0;   ///< [m or rad]
    double home_position = 0;    ///< [m or rad]
    double homing_velocity = 1;  ///< [m/s or rad/s]
  };
  using Model = std::array<AxisModel, kAxisCount>;

  /// Model of encoders, spindle and swivel.
  struct Equipment {
    bool absolute_encoders = true;   ///< homed from the start
    double spindle_run_up_time = 0;  ///< [s]
    /// Angle that the swivel's encoder reads; NaN for none [rad]
    double swivel = std::numeric_limits<double>::quiet_NaN();
    /// Simulated time over the clock's, as far as half a core allows. Unless it is 1, every cycle takes exactly its
    /// period, however late it begins.
    double pace = 1;
  };

  /// A plane that a blank is ground down to, over its whole length: what is below it, with A at `angle`, is gone.
  struct RakeFace {
    double height = 0;  ///< above the work spindle's axis [m]
    double angle = 0;   ///< [rad]
  };
  /// What the measuring probe touches: a cylinder in the work spindle.
  struct Blank {
    double end_face = 0;  ///< X in machine coordinates [m]
    double diameter = 0;  ///< [m]
    double run_out = 0;   ///< total [m]
    std::optional<RakeFace> rake_face;
    double ball_diameter = 0;             ///< of the probe [m]
    std::array<double, 3> ball_centre{};  ///< X in machine coordinates, Y and Z from the axis, the axes at zero [m]
  };

  /// What the parameters describe.
  struct Simulation {
    Model model;
    Equipment equipment;
    std::optional<Blank> blank;
  };
  /// @param root,parameters those of the machine and of the drive.
  /// @throw ParameterError
  static Simulation readSimulation(const ParameterReader& root, const ParameterReader& parameters);

  enum class Fault : std::uint8_t {
    kNone,
    kEmergencyStop,
    kStuckAxis,
    kStaleFeedback,
    kNanFeedback,
    kDriveFault,
    kReferenceLost,
    kSpindleLost,
    kCoolantLost,
    kSwivelSlipped,
    kProbeFlickers,
    kHang  ///< read() does not return
  };

  void init(ros::NodeHandle& node_nh, ros::NodeHandle& drive_nh) override;
  DriveCapabilities capabilities() const override;
  void read(const DriveCycle& cycle, DriveFeedback& feedback) override;
  void write(const DriveCycle& cycle, const DriveCommand& command) override;
  ros::Duration wait(const ros::Duration& nominal) override;
  bool powerOff() override { return power_off_ = true; }

  /// Initialises the drive without ROS.
  void init(const Model& model, const Equipment& equipment);
  /// Puts a blank into the work spindle, before the first cycle.
  void clamp(const Blank& blank) { blank_ = blank; }

  /// Injects a fault from the next read() on, or removes all faults (kNone); a drive fault stays until it is reset.
  /// Thread safe.
  /// @param axis for kStuckAxis and kNanFeedback.
  void inject(Fault fault, int axis = kX);

 private:
  void readSwitches(Fault fault);
  void readEquipment(Fault fault, double dt);
  bool touches(const Blank& blank) const;
  bool readProbe(const Blank& blank, Fault fault);
  void moveMotors(Fault fault, int failing_axis, double dt);
  void home(double dt);
  bool onInjectFault(flute_grinder::InjectFault::Request& request, flute_grinder::InjectFault::Response& response);

  Model model_;
  Equipment equipment_;
  std::optional<Blank> blank_;
  std::atomic<bool> power_off_{false};      ///< by powerOff(), until `enable` is false
  std::atomic<std::uint16_t> injected_{0};  ///< fault and axis in one word
  ros::ServiceServer inject_service_;

  Axes time_constant_ = Axes::Zero();    ///< of the model [s]
  Axes counts_per_unit_ = Axes::Zero();  ///< of the model [1/m], A [1/rad]
  Axes motor_ = Axes::Zero();            ///< true positions of the axes
  Axes offset_ = Axes::Zero();           ///< of the encoders' readings
  bool probe_near_ = false;              ///< as near to the blank as a contact that flickers is made
  bool home_was_commanded_ = false;
  double spindle_speed_ = 0;       ///< fraction of full speed
  ros::Duration ahead_;            ///< time of the clock that the cycles since the last rest are to take
  std::int64_t processor_ns_ = 0;  ///< time that the thread had used at the last rest
  DriveStatus status_;
  DriveCommand command_;  ///< as last written
};

}  // namespace grinder
