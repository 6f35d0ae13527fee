#pragma once

#include <yaml-cpp/yaml.h>

#include <set>
#include <stdexcept>
#include <string>
#include <type_traits>

/// @file
/// Writes and reads the fields of an atomic file as a map in YAML. `fields` is called with a visitor, and calls that
/// with key and value of every field.
namespace grinder {

template <typename Fields>
std::string toYaml(const char* comment, const Fields& fields) {
  YAML::Emitter text;
  text.SetDoublePrecision(17);
  text << YAML::Comment(comment) << YAML::BeginMap;
  fields([&](const std::string& key, const auto& value) {
    text << YAML::Key << key << YAML::Value << YAML::Flow << YAML::DoubleQuoted << value;
  });
  text << YAML::EndMap;
  return std::string(text.c_str()) + "\n";
}

/// @throw std::exception unless every field is there once, and nothing else.
template <typename Fields>
void fromYaml(const std::string& text, const Fields& fields) {
  const YAML::Node file = YAML::Load(text);
  std::set<std::string> known;
  fields([&](const std::string& key, auto& value) {
    known.insert(key);
    if (!file[key]) throw std::runtime_error(key + " is missing");
    value = file[key].template as<std::decay_t<decltype(value)>>();
  });
  for (const auto& entry : file) {
    const auto key = entry.first.as<std::string>();
    if (known.erase(key) == 0) throw std::runtime_error("key " + key + " is unknown or duplicate");
  }
}

}  // namespace grinder
