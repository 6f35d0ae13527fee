#include "flute_grinder/job/flat_file.h"

#include "flute_grinder/base/did_you_mean.h"
#include "flute_grinder/base/file_error.h"
#include "flute_grinder/base/format.h"
#include "flute_grinder/job/yaml_text.h"

#include <set>
#include <utility>

namespace grinder {

std::string element(const std::string& key, std::size_t i) { return key + "[" + std::to_string(i) + "]"; }

namespace {

template <typename T>
bool decode(const YAML::Node& node, T& value) {
  return node.IsScalar() && YAML::convert<T>::decode(node, value);
}

/// The key of an element's list, e.g. "points_mm" for "points_mm[2][0]"; any other key unchanged.
std::string listOf(std::string key) {
  while (!key.empty() && key.back() == ']') key.erase(key.rfind('['));
  return key;
}

/// Whether a text is a decimal number of any size.
bool isNumber(const std::string& text) {
  char* end = nullptr;
  parseNumber(text.c_str(), &end);
  return !text.empty() && *end == '\0' && text.find_first_not_of("0123456789.eE+-") == std::string::npos;
}

}  // namespace

std::string readValue(const YAML::Node& node, double& value) {
  if (decode(node, value)) return "";
  return node.IsScalar() && isNumber(node.Scalar()) ? " is out of range" : " is not a number";
}

std::string readValue(const YAML::Node& node, int& value) {
  std::string digits = node.IsScalar() ? node.Scalar() : "";
  if (!digits.empty() && (digits[0] == '-' || digits[0] == '+')) digits.erase(0, 1);
  if (digits.size() > 1 && digits[0] == '0' && std::isalnum(static_cast<unsigned char>(digits[1])) != 0) {
    return " has a leading 0, which YAML reads as octal or hexadecimal";
  }
  if (digits.empty() || digits.find_first_not_of("0123456789") != std::string::npos) return " is not a whole number";
  return decode(node, value) ? "" : " is out of range";
}

std::string readValue(const YAML::Node& node, bool& value) {
  return decode(node, value) ? "" : " is neither true nor false";
}

std::string readValue(const YAML::Node& node, std::string& value) {
  return decode(node, value) ? "" : " is not a word";
}

FlatFile::FlatFile(const std::string& text, std::string name, std::string kind, const std::string& content)
    : name_(std::move(name)), kind_(std::move(kind)) {
  const YAML::Node root = parseYaml(text, name_);
  if (root.IsMap()) {
    flatten(root, "", 1, 0);
  } else {
    fail(1, "not a map of " + content);
  }
  throwErrors();
}

void FlatFile::fail(int line, std::string what) {
  if (what.size() > kMaxError) what.replace(kMaxError, std::string::npos, "...");
  add(name_ + ":" + std::to_string(line) + ": " + escaped(what));
}

void FlatFile::add(const std::string& errors) {
  if (error_count_++ < kMaxReported) errors_ += (errors_.empty() ? "" : "\n") + errors;
}

void FlatFile::throwErrors() const {
  if (error_count_ == 0) return;
  const int unreported = error_count_ - kMaxReported;
  throw FileError(errors_ + (unreported > 0 ? "\n" + name_ + ": and " + std::to_string(unreported) + " more" : ""));
}

void FlatFile::drop(const std::string& key) {
  entries_.erase(key);
  for (std::size_t i = 0; entries_.erase(element(key, i)) > 0; ++i) {
  }
}

bool FlatFile::mentionsPart(const std::string& key) const {
  const std::string stem = listOf(key);
  return mentions(stem) || mentions(element(stem, 1));
}

void FlatFile::takeList(const std::string& key, const std::string& allowed, double scale, std::vector<double>& values) {
  double value = 0;
  if (!has(element(key, 0))) {
    take(key, allowed, value);
    return;
  }
  for (std::size_t i = 0; has(element(key, i)); ++i) {
    take(element(key, i), allowed, value);
    values.push_back(value * scale);
  }
}

bool FlatFile::refuseBoth(const std::string& key, const std::string& other) {
  if (!hasAny(key) || !has(other)) return false;
  fail(line(other), other + " stands beside " + key + "; allowed: one of the two");
  drop(other);
  return true;
}

void FlatFile::refuseBeside(const std::string& key, const std::string& section, const std::string& allowed) {
  std::set<std::string> refused;
  for (auto it = entries_.lower_bound(section);
       it != entries_.end() && it->first.compare(0, section.size(), section) == 0;) {
    refused.insert(listOf(it->first));
    it = entries_.erase(it);
  }
  for (const std::string& other : refused) {
    std::string text = other;
    text.append(" stands beside ").append(key).append("; allowed beside it: ").append(allowed);
    fail(line(other), text);
  }
}

bool FlatFile::mentionsSection(const std::string& section) const {
  const auto it = lines_.lower_bound(section);
  return it != lines_.end() && it->first.compare(0, section.size(), section) == 0;
}

void FlatFile::dropSection(const std::string& section) {
  for (auto it = entries_.lower_bound(section);
       it != entries_.end() && it->first.compare(0, section.size(), section) == 0;) {
    it = entries_.erase(it);
  }
}

void FlatFile::refuseTheRest() {
  for (const auto& entry : entries_) {
    const std::string& key = entry.first;
    const std::string suggestion = error_count_ < kMaxReported ? didYouMean(key, known_) : "";
    if (!suggestion.empty()) {
      std::string text = key + " is not a key of a ";
      fail(line(key), text.append(kind_).append(suggestion));
      continue;
    }
    const std::string section = key.substr(0, key.find('.') + 1);
    std::string allowed;
    for (const std::string& known : known_) {
      if (known.compare(0, section.size(), section) == 0) allowed += (allowed.empty() ? "" : ", ") + known;
    }
    refuseKey(line(key), key, allowed);
  }
}

int FlatFile::line(const std::string& key) const {
  const auto it = findLine(key);
  return it == lines_.end() ? 1 : it->second;
}

std::map<std::string, int>::const_iterator FlatFile::findLine(const std::string& key) const {
  auto it = lines_.end();
  for (const std::string& name : {key, element(key, 0), element(element(key, 0), 0)}) {
    if (it == lines_.end()) it = lines_.find(name);
  }
  return it;
}

void FlatFile::flatten(const YAML::Node& node, const std::string& path, int line, int depth) {
  if (depth > kDeepest) return fail(line, path + " goes too deep");
  if (node.IsMap() && node.size() > 0) {
    flattenMap(node, path, depth);
  } else if (node.IsSequence() && node.size() > 0) {
    for (std::size_t i = 0; i < node.size(); ++i) {
      flatten(node[i], path + "[" + std::to_string(i) + "]", node[i].Mark().line + 1, depth + 1);
    }
  } else {
    entries_.emplace(path, node);
    lines_.emplace(path, line);
  }
}

void FlatFile::flattenMap(const YAML::Node& map, const std::string& path, int depth) {
  std::set<std::string> keys;
  for (const auto& item : map) {
    const int line = item.first.Mark().line + 1;
    const std::string key = item.first.IsScalar() ? item.first.Scalar() : "(not a word)";
    std::string full = path;
    full.append(path.empty() ? "" : ".").append(key);
    if (key.find_first_of(".[(") != std::string::npos) {
      refuseKey(line, full, "words without dots and brackets");
    } else if (!keys.insert(key).second) {
      fail(line, full + " appears twice");
    } else {
      flatten(item.second, full, line, depth + 1);
    }
  }
}

void FlatFile::refuseKey(int line, const std::string& key, const std::string& allowed) {
  std::string text = key;
  fail(line, text.append(" is not a key of a ").append(kind_).append("; allowed: ").append(allowed));
}

}  // namespace grinder
