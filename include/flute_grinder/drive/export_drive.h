#pragma once

#include <pluginlib/class_list_macros.hpp>

#include <cstdint>

/// @file
/// How the library of a drive plugin exports its drives, and states which version of the drive interface it was built
/// against.
namespace grinder {

/// Binary version of the drive interface: the layout of everything declared in flute_grinder/drive/, and in
/// axes.h and fault_text.h in flute_grinder/job/, and the order of Drive's virtual functions. Increase it whenever one
/// of them changes. The node refuses plugins that were built against another version.
constexpr std::uint32_t kDriveAbi = 4;

}  // namespace grinder

/// Exports a drive, a class derived from grinder::Drive, as a plugin for the node. To be used in place of
/// PLUGINLIB_EXPORT_CLASS, outside of namespaces; in a library with several drives, once for each.
#define FLUTE_GRINDER_EXPORT_DRIVE(Class)                                                          \
  extern "C" {                                                                                     \
  extern const std::uint32_t flute_grinder_drive_abi __attribute__((weak, visibility("default"))); \
  const std::uint32_t flute_grinder_drive_abi = grinder::kDriveAbi;                                \
  }                                                                                                \
  PLUGINLIB_EXPORT_CLASS(Class, grinder::Drive)
