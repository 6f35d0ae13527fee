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
    double time_constant = 0;    ///< time constant of the lag [s]
    double counts_per_unit = 1;  ///< resolution of the encoder [1/m or 1/rad]
    double start_position = 0;   ///< true position at the start [m or rad]
    double home_position = 0;    ///< position at which homing ends [m or rad]
    double homing_velocity = 1;  ///< speed of homing [m/s or rad/s]
  };
  using Model = std::array<AxisModel, kAxisCount>;

  /// Model of encoders, spindle and swivel.
  struct Equipment {
    bool absolute_encoders = true;   ///< the axes are homed from the start
    double spindle_run_up_time = 0;  ///< time to full speed [s]
    /// Angle that the swivel's encoder reads; NaN for none [rad]
    double swivel = std::numeric_limits<double>::quiet_NaN();
    /// Ratio of simulated time to the clock's, limited by the use of half a core. Unless it is 1, every cycle reports
    /// exactly its nominal period, however late it begins.
    double pace = 1;
  };

  /// A plane down to which the blank is ground over its whole length.
  struct RakeFace {
    double height = 0;  ///< height of the plane above the work spindle's axis [m]
    double angle = 0;   ///< position of A at which the plane is level [rad]
  };
  /// What the measuring probe touches: a cylinder in the work spindle.
  struct Blank {
    double end_face = 0;  ///< X of the end face in machine coordinates [m]
    double diameter = 0;  ///< diameter of the cylinder [m]
    double run_out = 0;   ///< total run-out [m]
    std::optional<RakeFace> rake_face;
    double ball_diameter = 0;  ///< diameter of the probe's ball [m]
    /// Centre of the ball with the axes at zero: X in machine coordinates, Y and Z from the work axis [m].
    std::array<double, 3> ball_centre{};
  };

  /// The simulation that the parameters describe.
  struct Simulation {
    Model model;
    Equipment equipment;
    std::optional<Blank> blank;
  };
  /// @param root parameters of the machine. @param parameters parameters of the drive.
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
  /// @param axis axis of kStuckAxis and kNanFeedback.
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
  std::atomic<bool> power_off_{false};      ///< powerOff() was called, and `enable` has not been false since
  std::atomic<std::uint16_t> injected_{0};  ///< fault and axis in one word
  ros::ServiceServer inject_service_;

  Axes time_constant_ = Axes::Zero();    ///< time constants of the axes [s]
  Axes counts_per_unit_ = Axes::Zero();  ///< resolution of the encoders [1/m], A [1/rad]
  Axes motor_ = Axes::Zero();            ///< true positions of the axes
  Axes offset_ = Axes::Zero();           ///< true positions less the encoders' readings
  bool probe_near_ = false;              ///< the probe is so near to the blank that its contact may flicker
  bool home_was_commanded_ = false;
  double spindle_speed_ = 0;       ///< fraction of full speed
  ros::Duration ahead_;            ///< time by the clock for the cycles since the last rest
  std::int64_t processor_ns_ = 0;  ///< processor time of the thread at the last rest
  DriveStatus status_;
  DriveCommand command_;  ///< last command written
};

}  // namespace grinder
