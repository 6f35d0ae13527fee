#pragma once

#include "flute_grinder/drive/parameters.h"

#include <string>

namespace grinder {

/// The paths of the files that the node keeps on disk.
struct NodeFiles {
  std::string journal, offsets;
  std::string history;     ///< folder of the records
  std::string tolerances;  ///< file of the tolerances by which jobs are judged
};

/// Reads the parameters journal, offsets, history and tolerances.
/// @param node full name of the node, which names the files if only their folder is given.
/// @throw ParameterError
NodeFiles readNodeFiles(const ParameterReader& parameters, const std::string& node);

}  // namespace grinder
