#include "flute_grinder/drive/parameters.h"

#include "flute_grinder/base/axes.h"
#include "flute_grinder/base/did_you_mean.h"
#include "flute_grinder/base/format.h"

#include <ros/node_handle.h>

#include <boost/algorithm/string/join.hpp>
#include <boost/algorithm/string/replace.hpp>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <sstream>
#include <utility>

namespace grinder {

namespace {

/// A value as written in a YAML file, with a text in quotes.
std::string shown(const XmlRpc::XmlRpcValue& value) {
  if (value.getType() == XmlRpc::XmlRpcValue::TypeBoolean) return static_cast<bool>(value) ? "true" : "false";
  std::ostringstream text;
  const char* quote = value.getType() == XmlRpc::XmlRpcValue::TypeString ? "\"" : "";
  text << quote << value << quote;
  return text.str();
}

}  // namespace

std::optional<double> numberOf(XmlRpc::XmlRpcValue value) {
  if (value.getType() == XmlRpc::XmlRpcValue::TypeInt) return static_cast<int>(value);
  if (value.getType() == XmlRpc::XmlRpcValue::TypeDouble) return static_cast<double>(value);
  return std::nullopt;
}

ParameterReader::ParameterReader(const XmlRpc::XmlRpcValue& parameters, std::string ns)
    : parameters_(parameters), ns_(std::move(ns)) {}

ParameterReader::ParameterReader(const ros::NodeHandle& nh) : ns_(nh.getNamespace()) { nh.getParam("", parameters_); }

XmlRpc::XmlRpcValue ParameterReader::find(const std::string& path) const {
  asked_->paths.insert(path);
  const XmlRpc::XmlRpcValue* at = &parameters_;
  std::istringstream names(path);
  for (std::string name; std::getline(names, name, '/');) {
    if (at->getType() != XmlRpc::XmlRpcValue::TypeStruct || !at->hasMember(name)) return {};
    at = &(*at)[name];
  }
  return *at;
}

void ParameterReader::note(const std::string& path, const std::string& allowed, const About& about) const {
  if (!about.meaning) return;
  AskedParameter asked{path, about.allowed ? about.allowed : allowed, about};
  for (const char* joint : kJointNames) boost::algorithm::replace_first(asked.name, joint, "<joint>");
  const auto same = [&](const AskedParameter& other) { return other.name == asked.name; };
  auto& list = asked_->reference;
  if (std::none_of(list.begin(), list.end(), same)) list.push_back(std::move(asked));
}

bool ParameterReader::has(const std::string& path) const { return find(path).valid(); }

XmlRpc::XmlRpcValue ParameterReader::require(const std::string& path, const std::string& what) const {
  XmlRpc::XmlRpcValue value = find(path);
  if (!value.valid()) throw ParameterError("parameter " + name(path) + " is missing; allowed: " + what);
  return value;
}

void ParameterReader::refuseUnknown(const std::vector<std::string>& others) const {
  asked_->paths.insert(others.begin(), others.end());
  refuseUnknown(parameters_, "", others);
}

void ParameterReader::refuseUnknown(const XmlRpc::XmlRpcValue& group, const std::string& begin,
                                    const std::vector<std::string>& others) const {
  if (group.getType() != XmlRpc::XmlRpcValue::TypeStruct) return;
  for (const auto& [word, value] : group) {
    const std::string path = begin + word;
    if (std::find(others.begin(), others.end(), path) != others.end()) continue;
    const bool is_group = value.getType() == XmlRpc::XmlRpcValue::TypeStruct && !asked(path + "/").empty();
    if (is_group) {
      refuseUnknown(value, path + "/", others);
    } else if (asked_->paths.count(path) == 0) {
      const std::vector<std::string> known = asked(begin);
      std::string text = "parameter " + name(path) + " is not known";
      const std::string near = didYouMean(word, known);
      throw ParameterError(text + (near.empty() ? "; allowed: " + boost::algorithm::join(known, ", ") : near));
    }
  }
}

std::vector<std::string> ParameterReader::asked(const std::string& begin) const {
  std::vector<std::string> words;
  for (auto at = asked_->paths.lower_bound(begin);
       at != asked_->paths.end() && at->compare(0, begin.size(), begin) == 0; ++at) {
    const std::string word = at->substr(begin.size(), at->find('/', begin.size()) - begin.size());
    if (words.empty() || words.back() != word) words.push_back(word);
  }
  return words;
}

double ParameterReader::number(const std::string& path, double min, double max, const About& about) const {
  const std::string range = format("%g to %g", min, max);
  note(path, range, about);
  const XmlRpc::XmlRpcValue value = require(path, "a number");
  const std::optional<double> result = numberOf(value);
  if (!result) throw ParameterError("parameter " + name(path) + " = " + shown(value) + "; allowed: a number");
  if (!(*result >= min && *result <= max)) {
    throw ParameterError(format("parameter %s = %g; allowed: ", name(path).c_str(), *result) + range);
  }
  return *result;
}

int ParameterReader::whole(const std::string& path, int min, int max, const About& about) const {
  note(path, std::to_string(min) + " to " + std::to_string(max) + ", whole", about);
  const double value = number(path, min, max);
  if (value == std::floor(value)) return static_cast<int>(value);
  throw ParameterError(format("parameter %s = %g; allowed: a whole number", name(path).c_str(), value));
}

bool ParameterReader::flag(const std::string& path, const About& about) const {
  note(path, "true or false", about);
  XmlRpc::XmlRpcValue value = require(path, "true or false");
  if (value.getType() != XmlRpc::XmlRpcValue::TypeBoolean) {
    throw ParameterError("parameter " + name(path) + " = " + shown(value) + "; allowed: true or false");
  }
  return static_cast<bool>(value);
}

std::string ParameterReader::text(const std::string& path, const std::string& what, const About& about) const {
  note(path, what, about);
  XmlRpc::XmlRpcValue value = require(path, what);
  if (value.getType() != XmlRpc::XmlRpcValue::TypeString || static_cast<std::string>(value).empty()) {
    throw ParameterError("parameter " + name(path) + " = " + shown(value) + "; allowed: " + what);
  }
  return static_cast<std::string>(value);
}

std::optional<std::string> pathOf(const std::string& parameter) {
  if (parameter.compare(0, 1, "/") == 0) return parameter;
  const char* home = std::getenv("HOME");
  const bool of_home = parameter == "~" || parameter.compare(0, 2, "~/") == 0;
  return of_home && home && *home == '/' ? std::optional(home + parameter.substr(1)) : std::nullopt;
}

std::string pathOfNode(const std::string& parameter, const std::string& node, const char* suffix) {
  return parameter.back() == '/' ? parameter + node.substr(1) + suffix : parameter;
}

std::string ParameterReader::path(const std::string& path, const About& about) const {
  const std::string what = "an absolute path, or one that begins with ~/", given = text(path, what, about);
  if (auto found = pathOf(given)) return *found;
  throw ParameterError("parameter " + name(path) + " = \"" + given + "\"; allowed: " + what);
}

}  // namespace grinder
