#include "flute_grinder/drive/parameters.h"

#include <sstream>
#include <utility>

namespace flute_grinder {

ParameterReader::ParameterReader(const XmlRpc::XmlRpcValue& parameters, std::string ns)
    : parameters_(parameters), ns_(std::move(ns)) {}

XmlRpc::XmlRpcValue ParameterReader::find(const std::string& path) const {
  XmlRpc::XmlRpcValue at = parameters_;
  std::istringstream names(path);
  for (std::string name; std::getline(names, name, '/');) {
    if (at.getType() != XmlRpc::XmlRpcValue::TypeStruct || !at.hasMember(name)) return {};
    const XmlRpc::XmlRpcValue next = at[name];
    at = next;
  }
  return at;
}

bool ParameterReader::has(const std::string& path) const { return find(path).valid(); }

XmlRpc::XmlRpcValue ParameterReader::require(const std::string& path, const char* what) const {
  XmlRpc::XmlRpcValue value = find(path);
  if (!value.valid()) throw ParameterError("parameter " + name(path) + " is missing; allowed: " + what);
  return value;
}

double ParameterReader::number(const std::string& path, double min, double max) const {
  XmlRpc::XmlRpcValue value = require(path, "a number");
  std::ostringstream text;
  text << "parameter " << name(path) << " = ";
  double result;
  if (value.getType() == XmlRpc::XmlRpcValue::TypeInt) {
    result = static_cast<int>(value);
  } else if (value.getType() == XmlRpc::XmlRpcValue::TypeDouble) {
    result = static_cast<double>(value);
  } else {
    text << value.toXml() << "; allowed: a number";
    throw ParameterError(text.str());
  }
  if (!(result >= min && result <= max)) {
    text << result << "; allowed: " << min << " to " << max;
    throw ParameterError(text.str());
  }
  return result;
}

bool ParameterReader::flag(const std::string& path) const {
  XmlRpc::XmlRpcValue value = require(path, "true or false");
  if (value.getType() != XmlRpc::XmlRpcValue::TypeBoolean) {
    throw ParameterError("parameter " + name(path) + " = " + value.toXml() + "; allowed: true or false");
  }
  return static_cast<bool>(value);
}

std::string ParameterReader::text(const std::string& path) const {
  XmlRpc::XmlRpcValue value = require(path, "a text");
  if (value.getType() != XmlRpc::XmlRpcValue::TypeString || static_cast<std::string>(value).empty()) {
    throw ParameterError("parameter " + name(path) + " = " + value.toXml() + "; allowed: a text");
  }
  return static_cast<std::string>(value);
}

}  // namespace flute_grinder
