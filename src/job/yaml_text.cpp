#include "flute_grinder/job/yaml_text.h"

#include "flute_grinder/base/file_error.h"

#include <yaml-cpp/eventhandler.h>

#include <sstream>
#include <utility>

namespace grinder {

namespace {

[[noreturn]] void refuse(const std::string& name, const YAML::Mark& mark, const std::string& why) {
  throw FileError(name + ":" + std::to_string(mark.line + 1) + ": " + why);
}

/// Checks the parser's events before any node is built.
class YamlCheck : public YAML::EventHandler {
 public:
  explicit YamlCheck(std::string name) : name_(std::move(name)) {}

  void OnDocumentStart(const YAML::Mark& mark) override {
    if (std::exchange(begun_, true)) refuse(name_, mark, "a second document begins here; allowed: one");
  }
  void OnDocumentEnd() override {}
  void OnNull(const YAML::Mark& mark, YAML::anchor_t anchor) override { check(mark, anchor); }
  void OnAlias(const YAML::Mark& mark, YAML::anchor_t anchor) override { check(mark, anchor); }
  void OnScalar(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor, const std::string&) override {
    check(mark, anchor);
  }
  void OnSequenceStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                       YAML::EmitterStyle::value) override {
    check(mark, anchor);
  }
  void OnSequenceEnd() override {}
  void OnMapStart(const YAML::Mark& mark, const std::string&, YAML::anchor_t anchor,
                  YAML::EmitterStyle::value) override {
    check(mark, anchor);
  }
  void OnMapEnd() override {}

 private:
  void check(const YAML::Mark& mark, YAML::anchor_t anchor) const {
    if (anchor != YAML::NullAnchor) refuse(name_, mark, "has an anchor; allowed: none, and no aliases");
  }

  std::string name_;
  bool begun_ = false;
};

}  // namespace

void checkYaml(const std::string& text, const std::string& name) {
  YamlCheck check(name);
  std::istringstream stream(text);
  try {
    YAML::Parser parser(stream);
    while (parser.HandleNextDocument(check)) {
    }
  } catch (const YAML::Exception& error) {
    refuse(name, error.mark, error.msg);
  }
}

YAML::Node parseYaml(const std::string& text, const std::string& name) {
  checkYaml(text, name);
  try {
    return YAML::Load(text);
  } catch (const YAML::Exception& error) {
    refuse(name, error.mark, error.msg);
  }
}

}  // namespace grinder
