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

/// The number that a parameter is; nothing if it is none. YAML reads `0` as a whole number, and `0.0` as another kind.
std::optional<double> numberOf(XmlRpc::XmlRpcValue value);

/// Reads parameters of one namespace; rejects any that are missing, of the wrong type or out of range.
class ParameterReader {
 public:
  /// @param parameters all parameters of the namespace, as a struct.
  /// @param ns the namespace, for messages, e.g. "/grinder".
  ParameterReader(const XmlRpc::XmlRpcValue& parameters, std::string ns);
  /// Of all parameters that the master has of the handle's namespace.
  explicit ParameterReader(const ros::NodeHandle& nh);

  bool has(const std::string& path) const;
  /// @throw ParameterError unless the parameter is a finite number from `min` to `max`.
  double number(const std::string& path, double min, double max) const;
  /// @throw ParameterError unless the parameter is a whole number from `min` to `max`.
  int whole(const std::string& path, int min, int max) const;
  /// @throw ParameterError unless the parameter is a bool.
  bool flag(const std::string& path) const;
  /// @throw ParameterError unless the parameter is a non-empty string.
  std::string text(const std::string& path) const;
  /// The same. @param what the texts that are allowed, for the message.
  std::string text(const std::string& path, const std::string& what) const;
  /// To be called when all have been read: a parameter that nobody has asked for is misspelled.
  /// @param others those that other programs read, with all that is below them.
  /// @throw ParameterError naming the first such parameter, and the nearest that is known.
  void refuseUnknown(const std::vector<std::string>& others = {}) const;
  /// A file or a folder, with a leading `~` replaced by HOME. @throw ParameterError unless the parameter is then an
  /// absolute path: what is relative would depend on where the program was started.
  std::string path(const std::string& path) const;
  /// The parameter's full name.
  std::string name(const std::string& path) const { return ns_ + "/" + path; }

 private:
  XmlRpc::XmlRpcValue find(const std::string& path) const;
  XmlRpc::XmlRpcValue require(const std::string& path, const std::string& what) const;
  void refuseUnknown(const XmlRpc::XmlRpcValue& group, const std::string& begin,
                     const std::vector<std::string>& others) const;
  /// The next words of the paths so far that begin so.
  std::vector<std::string> asked(const std::string& begin) const;

  XmlRpc::XmlRpcValue parameters_;
  std::string ns_;
  std::shared_ptr<std::set<std::string>> asked_ = std::make_shared<std::set<std::string>>();  ///< paths
};

}  // namespace grinder
