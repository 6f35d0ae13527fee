#pragma once

#include "flute_grinder/drive/drive.h"
#include "flute_grinder/drive/parameters.h"
#include "node/end_signals.h"

#include <pluginlib/class_loader.hpp>

#include <functional>
#include <string>

namespace grinder {

/// A drive's plugin, with all calls of the drive outside the threads of the control loop. If such a call throws, the
/// error names the function; if it hangs, a signal can still end the process.
class DrivePlugin {
 public:
  /// @param signals must outlive this object.
  explicit DrivePlugin(const EndSignals& signals);
  /// Destroys the drive. If the drive's destructor does not return in time, the process ends all the same.
  ~DrivePlugin();

  /// The classes that load() accepts, for messages.
  std::string declared();

  /// Loads a plugin and makes its drive, once.
  /// @param type the plugin's class. @param parameters parameters of the node.
  /// @throw ParameterError with the reason, if the drive cannot be made.
  void load(const std::string& type, const ParameterReader& parameters);

  /// Makes a call that runs a function of the drive; a signal ends the process meanwhile.
  /// @param function name of the function, for messages.
  /// @throw ParameterError for any exception of the call, except a pluginlib::PluginlibException.
  void call(const char* function, const std::function<void()>& call) const;

  Drive& drive() { return *drive_; }  ///< the loaded drive

 private:
  std::string named(const char* function) const { return "the " + std::string(function) + " of the drive " + type_; }

  const EndSignals& signals_;
  pluginlib::ClassLoader<Drive> loader_;
  std::string type_;
  pluginlib::UniquePtr<Drive> drive_;
};

}  // namespace grinder
