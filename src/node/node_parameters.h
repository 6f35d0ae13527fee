#pragma once

#include "flute_grinder/drive/parameters.h"
#include "flute_grinder/job/axes.h"
#include "flute_grinder/scene/first_view.h"
#include "node/diagnostics.h"

#include <cstdint>
#include <string>

namespace grinder {

/// The node's own parameters.
struct NodeParameters {
  std::string journal, offsets;     ///< the files kept on disk
  std::string history;              ///< the folder of records
  std::uint64_t history_limit = 0;  ///< [bytes]
  Axes offset_change_limit;         ///< [m], A [rad]
  DiagnosticThresholds thresholds;
  FirstView first_view;
  std::string drive;  ///< type of the plugin
};

/// Reads journal, offsets, history, history_limit, offset_change_limit/<joint>, diagnostics/..., first_view/... and
/// hardware/type.
/// @param node the node's full name, after which files are named where only their folder is given.
/// @param drives the types of plugins that there are, for a message.
/// @throw ParameterError
NodeParameters readNodeParameters(const ParameterReader& parameters, const std::string& node,
                                  const std::string& drives);

}  // namespace grinder
