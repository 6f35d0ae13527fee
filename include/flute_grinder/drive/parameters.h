#pragma once

#include <xmlrpcpp/XmlRpcValue.h>

#include <memory>
#include <optional>
#include <set>
#include <stdexcept>
#include <string>
#include <vector>

namespace ros {
class NodeHandle;
}

namespace grinder {

/// A parameter that is missing or not allowed; what() gives its name, its value and the allowed values.
class ParameterError : public std::runtime_error {
 public:
  using std::runtime_error::runtime_error;
};

/// The value of a numeric parameter; nothing for any other type. YAML reads `0` and `0.0` as different types of number.
std::optional<double> numberOf(XmlRpc::XmlRpcValue value);

/// The path that a parameter names: absolute, or one that begins with ~/; nothing for any other text.
std::optional<std::string> pathOf(const std::string& parameter);

/// The path of a node's own file or folder: with a parameter that ends in `/`, the one in there that is named after it.
/// @param node full name of the node.
std::string pathOfNode(const std::string& parameter, const std::string& node, const char* suffix = "");

/// What docs/reference.md says of a parameter beside the range that its reader states.
struct About {
  const char* meaning = nullptr;  ///< in Markdown; null to leave the parameter out
  const char* unit = "";          ///< the second for A, if there are two
  const char* omitted = nullptr;  ///< what it means if the parameter is omitted; null if it is required
  const char* allowed = nullptr;  ///< in place of a range that depends on other parameters
};

/// A parameter for which a reader has asked.
struct AskedParameter {
  std::string name;     ///< below the node's namespace, with `<joint>` for the name of an axis' joint
  std::string allowed;  ///< range or type
  About about;
};

/// Reads parameters of one namespace; rejects any that are missing, of the wrong type or out of range.
class ParameterReader {
 public:
  /// @param parameters all parameters of the namespace, as a struct.
  /// @param ns the namespace, for messages, e.g. "/grinder".
  ParameterReader(const XmlRpc::XmlRpcValue& parameters, std::string ns);
  /// Reads all parameters in the handle's namespace from the master.
  explicit ParameterReader(const ros::NodeHandle& nh);

  bool has(const std::string& path) const;
  /// The parameters asked for so far that have a meaning, in order.
  const std::vector<AskedParameter>& reference() const { return asked_->reference; }
  /// @throw ParameterError unless the parameter is a finite number from `min` to `max`.
  double number(const std::string& path, double min, double max, const About& about = {}) const;
  /// @throw ParameterError unless the parameter is a whole number from `min` to `max`.
  int whole(const std::string& path, int min, int max, const About& about = {}) const;
  /// @throw ParameterError unless the parameter is a bool.
  bool flag(const std::string& path, const About& about = {}) const;
  /// @throw ParameterError unless the parameter is a non-empty string.
  /// @param what the allowed texts, for the message.
  std::string text(const std::string& path, const std::string& what = "a text", const About& about = {}) const;
  /// To be called when all parameters have been read: any other parameter must be misspelled.
  /// @param others parameters and groups that other programs read.
  /// @throw ParameterError naming the first unknown parameter and the most similar known one.
  void refuseUnknown(const std::vector<std::string>& others = {}) const;
  /// The path of a file or folder, with a leading `~` replaced by HOME. @throw ParameterError unless the path is then
  /// absolute: a relative path would depend on where the program was started.
  std::string path(const std::string& path, const About& about = {}) const;
  /// The parameter's full name.
  std::string name(const std::string& path) const { return ns_ + "/" + path; }

 private:
  struct Asked {
    std::set<std::string> paths;
    std::vector<AskedParameter> reference;
  };

  XmlRpc::XmlRpcValue find(const std::string& path) const;
  void note(const std::string& path, const std::string& allowed, const About& about) const;
  XmlRpc::XmlRpcValue require(const std::string& path, const std::string& what) const;
  void refuseUnknown(const XmlRpc::XmlRpcValue& group, const std::string& begin,
                     const std::vector<std::string>& others) const;
  /// The next words of the paths asked for so far that start with `begin`.
  std::vector<std::string> asked(const std::string& begin) const;

  XmlRpc::XmlRpcValue parameters_;
  std::string ns_;
  std::shared_ptr<Asked> asked_ = std::make_shared<Asked>();
};

}  // namespace grinder
