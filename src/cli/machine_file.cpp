#include "cli/machine_file.h"

#include "flute_grinder/base/file_error.h"
#include "flute_grinder/base/read_file.h"
#include "flute_grinder/job/yaml_text.h"

#include <ros/package.h>
#include <unistd.h>

#include <cerrno>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <filesystem>
#include <limits>
#include <regex>

namespace grinder {

namespace {

/// Types the values of a file as rosparam does, and refuses values that readers of YAML type differently.
class Parameters {
 public:
  explicit Parameters(std::string name) : name_(std::move(name)) {}

  /// Adds a file's values, which override the values of earlier files.
  void addTo(XmlRpc::XmlRpcValue& value, const YAML::Node& node, const std::string& key) const {
    if (node.IsMap()) return addMap(value, node, key);
    if (node.IsSequence()) {
      value.clear();
      value.setSize(static_cast<int>(node.size()));
      for (std::size_t i = 0; i < node.size(); ++i) addTo(value[static_cast<int>(i)], node[i], key);
      return;
    }
    value = scalar(node, key);
  }

 private:
  void addMap(XmlRpc::XmlRpcValue& value, const YAML::Node& node, const std::string& key) const {
    if (value.getType() != XmlRpc::XmlRpcValue::TypeStruct) value.clear();
    XmlRpc::XmlRpcValue own;
    for (const auto& item : node) {
      if (!item.first.IsScalar()) refuse(item.first, "a name of a parameter is no word");
      const std::string& word = item.first.Scalar();
      const std::string path = key + (key.empty() ? "" : "/") + word;
      if (own.getType() == XmlRpc::XmlRpcValue::TypeStruct && own.hasMember(word)) {
        refuse(item.first, path + " appears twice");
      }
      own[word] = true;
      if (item.second.IsNull()) refuse(item.first, path + " has no value");
      addTo(value[word], item.second, path);
    }
  }

  XmlRpc::XmlRpcValue scalar(const YAML::Node& node, const std::string& key) const {
    const std::string& text = node.Scalar();
    static const std::regex whole("[-+]?(0|[1-9][0-9]*)"), decimal("[-+]?[0-9]+\\.[0-9]*([eE][-+][0-9]+)?"),
        doubtful("[-+]?\\.?[0-9][0-9_.:]*([eE][-+]?[0-9]+)?|[-+]?0[xob][0-9a-fA-F_]+");
    const bool quoted = node.Tag() == "!";
    if (quoted) return XmlRpc::XmlRpcValue(text);
    if (std::regex_match(text, decimal)) return XmlRpc::XmlRpcValue(node.as<double>());
    if (std::regex_match(text, whole)) {
      int value = 0;
      if (YAML::convert<int>::decode(node, value)) return XmlRpc::XmlRpcValue(value);
      refuse(node, key + " = " + text + "; allowed: whole numbers up to " +
                       std::to_string(std::numeric_limits<int>::max()) + ", or one with a point");
    }
    if (std::regex_match(text, doubtful)) {
      refuse(node, key + " = " + text + "; allowed: a decimal number, as 100, 0.002 or 2.0e-3, or a text in quotes");
    }
    bool flag = false;
    if (YAML::convert<bool>::decode(node, flag)) return XmlRpc::XmlRpcValue(flag);
    return XmlRpc::XmlRpcValue(text);
  }

  [[noreturn]] void refuse(const YAML::Node& node, const std::string& what) const {
    throw FileError(name_ + ":" + std::to_string(node.Mark().line + 1) + ": " + what);
  }

  std::string name_;
};

/// Refuses a bag that exists: rosbag would overwrite it. Checked here because rosbag fails only after it has started.
void requireNewBag(const std::string& path) {
  const std::filesystem::path bag(path);
  if (!bag.is_absolute()) throw FileError("bag = " + path + "; allowed: an absolute path, or one that begins with ~/");
  for (const std::string& file : {path, path + ".active"}) {
    if (std::filesystem::exists(std::filesystem::symlink_status(file))) {
      throw FileError(file + ": is already there; allowed: a bag of another name, or move this one elsewhere");
    }
  }
  if (::access(bag.parent_path().c_str(), W_OK | X_OK) != 0) {
    throw FileError(path + ": cannot be written: " + std::strerror(errno));
  }
}

}  // namespace

MachineFiles readMachineFiles(const std::vector<std::string>& parameters, const std::string& urdf) {
  const MachineModel model(readTextFile(urdf, kMaxUrdfFile), urdf);
  XmlRpc::XmlRpcValue values;
  std::string name;
  for (const std::string& file : parameters) {
    const YAML::Node root = parseYaml(readTextFile(file), file);
    if (!root.IsMap()) throw FileError(file + ":1: not a map of parameters");
    Parameters(file).addTo(values, root, "");
    name += (name.empty() ? "" : ", ") + file;
  }
  const std::string drives = "a drive, as flute_grinder/SimulatedDrive";
  return {model, readMachineConfig(model, ParameterReader(values, name), drives)};
}

int runMachine(const MachineOptions& options) {
  if (!options.bag.empty()) requireNewBag(options.bag);
  const MachineFiles files = readMachineFiles(options.parameters, options.urdf);
  std::string names;
  for (const std::string& file : options.parameters) names += std::filesystem::absolute(file).string() + ", ";
  names += std::filesystem::absolute(options.urdf).string();
  std::printf("%s\n", names.c_str());
  return 0;
}

std::string packageFile(const std::string& path) {
  const std::string package = ros::package::getPath("flute_grinder");
  if (package.empty()) {
    throw FileError("the package flute_grinder is not found, nor its " + path +
                    "; source build/devel/setup.bash of the clone in this shell");
  }
  return package + "/" + path;
}

}  // namespace grinder
