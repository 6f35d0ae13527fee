#pragma once

#include "drive/hal_parameters.h"
#include "drive/simulated_drive.h"
#include "flute_grinder/base/read_file.h"
#include "flute_grinder/control/machine_config.h"
#include "node/node_files.h"

#include "yaml_parameters.h"

#include <string>
#include <vector>

/// @file
/// Every parameter of the node and of the drives, as their readers ask for it.
namespace grinder::test_support {

/// The shipped parameters, and those that may be left out.
inline YAML::Node allParameters(bool with_hal) {
  YAML::Node p = YAML::LoadFile("config/grinder.yaml");
  if (with_hal) p["hardware"] = YAML::LoadFile("config/hal.yaml")["hardware"];
  for (const char* file : {"journal", "offsets", "history", "tolerances"}) p[file] = "/tmp/";
  for (const char* joint : kJointNames) {
    YAML::Node limits = p["joint_limits"][joint];
    limits["has_position_limits"] = true;
    limits["has_velocity_limits"] = true;
    limits["min_position"] = -2;
    limits["max_position"] = 2;
    limits["max_velocity"] = 1;
  }
  if (with_hal) return p;
  p["hardware"]["blank"] = YAML::Load("{end_face: 0, diameter: 0.01, run_out: 0, rake_face: {height: 0, angle: 0}}");
  p["hardware"]["swivel"] = 0;
  return p;
}

/// A reader of parameters, and what it asks for below `prefix`.
struct ParameterSection {
  const char* name;
  const char* prefix;
  void (*read)(const ParameterReader& root, const ParameterReader& hardware);

  bool isHal() const { return name == std::string("hal"); }

  /// @throw ParameterError
  std::vector<AskedParameter> askedIn(const YAML::Node& tree) const {
    const XmlRpc::XmlRpcValue p = toXmlRpc(tree);
    const ParameterReader root(p, "/grinder"), hardware(p["hardware"], "/grinder/hardware");
    read(root, hardware);
    std::vector<AskedParameter> asked = (*prefix == '\0' ? root : hardware).reference();
    for (AskedParameter& one : asked) one.name = prefix + one.name;
    return asked;
  }
};

inline const MachineModel& shippedModel() {
  static const MachineModel model(readTextFile("urdf/grinder.urdf", kMaxUrdfFile));
  return model;
}

inline const ParameterSection kParameterSections[]{
    {"machine", "", [](const ParameterReader& p, const ParameterReader&) { readLoopConfig(shippedModel(), p); }},
    {"node", "",
     [](const ParameterReader& p, const ParameterReader&) {
       readNodeFiles(p, "/grinder");
       readMachineConfig(shippedModel(), p, "a text");
     }},
    {"simulated_drive", "hardware/",
     [](const ParameterReader& p, const ParameterReader& own) { SimulatedDrive::readSimulation(p, own); }},
    {"hal", "hardware/", [](const ParameterReader& p, const ParameterReader& own) { readHalParameters(p, own); }},
};

}  // namespace grinder::test_support
