#pragma once

#include "flute_grinder/drive/drive.h"
#include "flute_grinder/drive/parameters.h"
#include "node/end_signals.h"

#include <pluginlib/class_loader.hpp>

#include <functional>
#include <string>

namespace grinder {

/// A drive's plugin, with all calls of the drive outside the threads of the control loop. Whatever the drive does in
/// them, it is named, and the process can be ended.
class DrivePlugin {
 public:
  /// @param signals must outlive this object.
  explicit DrivePlugin(const EndSignals& signals);
  /// Destroys the drive. The process ends without it if it does not return in time.
  ~DrivePlugin();

  /// The classes that load() takes, for messages.
  std::string declared();

  /// Loads a plugin and makes its drive, once.
  /// @param type the plugin's class. @param parameters the node's.
  /// @throw ParameterError with the reason, if it cannot be had.
  void load(const std::string& type, const ParameterReader& parameters);

  /// Calls a function of the drive, or what does; a signal ends the process meanwhile.
  /// @param function its name, for messages.
  /// @throw ParameterError for what it throws, except a pluginlib::PluginlibException.
  void call(const char* function, const std::function<void()>& call) const;

  Drive& drive() { return *drive_; }  ///< that was loaded

 private:
  std::string named(const char* function) const { return "the " + std::string(function) + " of the drive " + type_; }

  const EndSignals& signals_;
  pluginlib::ClassLoader<Drive> loader_;
  std::string type_;
  pluginlib::UniquePtr<Drive> drive_;
};

}  // namespace grinder
