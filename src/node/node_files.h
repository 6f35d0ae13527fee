#pragma once

#include "flute_grinder/drive/parameters.h"

#include <string>

namespace grinder {

/// What the node keeps on disk, and reads from there.
struct NodeFiles {
  std::string journal, offsets;
  std::string history;     ///< the folder of records
  std::string tolerances;  ///< the file by which jobs are judged
};

/// Reads the parameters journal, offsets, history and tolerances.
/// @param node the node's full name, after which files are named where only their folder is given.
/// @throw ParameterError
NodeFiles readNodeFiles(const ParameterReader& parameters, const std::string& node);

}  // namespace grinder
