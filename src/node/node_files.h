#pragma once

#include "flute_grinder/drive/parameters.h"

#include <string>

namespace grinder {

/// What the node keeps on disk.
struct NodeFiles {
  std::string journal, offsets;
  std::string history;  ///< the folder of records
};

/// Reads the parameters journal, offsets and history.
/// @param node the node's full name, after which files are named where only their folder is given.
/// @throw ParameterError
NodeFiles readNodeFiles(const ParameterReader& parameters, const std::string& node);

}  // namespace grinder
