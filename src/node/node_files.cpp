#include "node/node_files.h"

namespace grinder {

NodeFiles readNodeFiles(const ParameterReader& p, const std::string& node) {
  NodeFiles files;
  files.journal = pathOfNode(
      p.path("journal",
             {"file that records the progress of the job, for one node only; or, ending in `/`, a folder in which "
              "the file is named after the node. Set by the launch file"}),
      node, ".journal");
  files.offsets = pathOfNode(
      p.path("offsets",
             {"file that keeps the work offsets, for one node only; or, ending in `/`, a folder in which the file "
              "is named after the node. Set by the launch file: beside the journal"}),
      node, ".offsets");
  files.history = pathOfNode(
      p.path("history",
             {"folder that keeps the records of the last jobs, for one node only; or, ending in `/`, a folder in "
              "which that folder is named after the node. Set by the launch file: beside the journal"}),
      node, "/");
  files.tolerances =
      p.path("tolerances", {"YAML file of the tolerances by which each job is passed or failed when it ends, "
                            "beside the job's own. Set by the launch file: "
                            "`config/tolerances.yaml`"});
  return files;
}

}  // namespace grinder
