#include "machine/strict_urdf.h"

#include "flute_grinder/base/did_you_mean.h"

#include <tinyxml2.h>
#include <urdf_parser/urdf_parser.h>

#include <algorithm>
#include <cmath>
#include <locale>
#include <map>
#include <set>
#include <sstream>
#include <stdexcept>
#include <vector>

namespace grinder {

namespace {

using tinyxml2::XMLAttribute;
using tinyxml2::XMLElement;

constexpr int kText = 0;  ///< marks an attribute with any text instead of numbers

/// The content that an element of a URDF may have.
struct Rule {
  struct Attribute {
    std::string name;
    int numbers;  ///< number of values; kText: any text
    bool required;
  };
  std::vector<Attribute> attributes;
  std::vector<std::string> once, often;  ///< elements that may occur once, or often
};

/// Rules by element, from http://wiki.ros.org/urdf/XML; urdfdom takes no material without a name.
const std::map<std::string, Rule>& rules() {
  static const Rule::Attribute kName{"name", kText, false}, kNeedsName{"name", kText, true};
  static const std::map<std::string, Rule> kRules{
      {"robot", {{kNeedsName, {"version", kText, false}}, {}, {"link", "joint", "material", "gazebo", "transmission"}}},
      {"link", {{kNeedsName, {"type", kText, false}}, {"inertial"}, {"visual", "collision"}}},
      {"visual", {{kName}, {"origin", "geometry", "material"}, {}}},
      {"collision", {{kName}, {"origin", "geometry"}, {}}},
      {"inertial", {{}, {"origin", "mass", "inertia"}, {}}},
      {"origin", {{{"xyz", 3, false}, {"rpy", 3, false}}, {}, {}}},
      {"mass", {{{"value", 1, true}}, {}, {}}},
      {"inertia",
       {{{"ixx", 1, true}, {"ixy", 1, true}, {"ixz", 1, true}, {"iyy", 1, true}, {"iyz", 1, true}, {"izz", 1, true}},
        {},
        {}}},
      {"geometry", {{}, {"box", "cylinder", "sphere", "mesh"}, {}}},
      {"box", {{{"size", 3, true}}, {}, {}}},
      {"cylinder", {{{"radius", 1, true}, {"length", 1, true}}, {}, {}}},
      {"sphere", {{{"radius", 1, true}}, {}, {}}},
      {"mesh", {{{"filename", kText, true}, {"scale", 3, false}}, {}, {}}},
      {"material", {{kNeedsName}, {"color", "texture"}, {}}},
      {"color", {{{"rgba", 4, true}}, {}, {}}},
      {"texture", {{{"filename", kText, true}}, {}, {}}},
      {"joint",
       {{kNeedsName, {"type", kText, true}},
        {"origin", "parent", "child", "axis", "limit", "dynamics", "calibration", "mimic", "safety_controller"},
        {}}},
      {"parent", {{{"link", kText, true}}, {}, {}}},
      {"child", {{{"link", kText, true}}, {}, {}}},
      {"axis", {{{"xyz", 3, true}}, {}, {}}},
      {"limit", {{{"lower", 1, false}, {"upper", 1, false}, {"velocity", 1, true}, {"effort", 1, true}}, {}, {}}},
      {"dynamics", {{{"damping", 1, false}, {"friction", 1, false}}, {}, {}}},
      {"calibration", {{{"rising", 1, false}, {"falling", 1, false}}, {}, {}}},
      {"mimic", {{{"joint", kText, true}, {"multiplier", 1, false}, {"offset", 1, false}}, {}, {}}},
      {"safety_controller",
       {{{"soft_lower_limit", 1, false},
         {"soft_upper_limit", 1, false},
         {"k_position", 1, false},
         {"k_velocity", 1, true}},
        {},
        {}}}};
  return kRules;
}

bool areNumbers(const char* text, int count) {
  std::istringstream words(text);
  words.imbue(std::locale::classic());
  for (double number; count > 0 && words >> number && std::isfinite(number);) --count;
  return count == 0 && (words >> std::ws).eof();
}

std::string listed(const std::vector<std::string>& words) {
  std::string text;
  for (const std::string& word : words) text += (text.empty() ? "" : ", ") + word;
  return text.empty() ? "nothing" : text;
}

/// Walks the elements of a URDF. The content of <gazebo> and <transmission> is left to other programs.
class StrictUrdf {
 public:
  explicit StrictUrdf(std::string name) : name_(std::move(name)) {}

  void check(const XMLElement& element, const std::string& place) const {
    const auto rule = rules().find(element.Name());
    if (rule == rules().end()) return;
    checkAttributes(element, rule->second, place);
    std::vector<std::string> known = rule->second.once;
    known.insert(known.end(), rule->second.often.begin(), rule->second.often.end());
    std::set<std::string> seen;
    for (const auto* child = element.FirstChildElement(); child; child = child->NextSiblingElement()) {
      const std::string child_name = child->Name();
      const std::string child_place =
          (element.GetDocument()->RootElement() == &element ? "" : place + ", ") + placeOf(*child);
      if (std::find(known.begin(), known.end(), child_name) == known.end()) {
        fail(*child, child_place, "is not known" + didYouMean(child_name, known) + "; allowed: " + listed(known));
      }
      const bool once = std::find(known.begin(), known.end(), child_name) - known.begin() <
                        static_cast<std::ptrdiff_t>(rule->second.once.size());
      if (!seen.insert(child_name).second && once) fail(*child, child_place, "appears twice; allowed: once");
      check(*child, child_place);
    }
  }

  /// Refuses a link if the parser has left out a part of it.
  void compare(const XMLElement& link, const urdf::Link& parsed) const {
    const auto count = [&](const char* name) {
      std::size_t n = 0;
      for (const auto* e = link.FirstChildElement(name); e; e = e->NextSiblingElement(name)) ++n;
      return n;
    };
    const auto require = [&](const char* name, std::size_t taken) {
      if (count(name) == taken) return;
      const XMLElement& part = *link.FirstChildElement(name);
      fail(part, placeOf(link) + ", <" + name + ">", "cannot be read; the log of urdfdom says why");
    };
    require("inertial", parsed.inertial ? 1 : 0);
    require("visual", parsed.visual_array.size());
    require("collision", parsed.collision_array.size());
  }

 private:
  static std::string placeOf(const XMLElement& element) {
    const char* name = element.Attribute("name");
    const std::string kind = element.Name();
    if (kind == "link" || kind == "joint") return kind + " " + (name ? name : "");
    return "<" + kind + ">" + (name ? std::string(" ") + name : "");
  }

  void checkAttributes(const XMLElement& element, const Rule& rule, const std::string& place) const {
    std::vector<std::string> known;
    for (const Rule::Attribute& attribute : rule.attributes) {
      known.push_back(attribute.name);
      const char* value = element.Attribute(attribute.name.c_str());
      if (!value && attribute.required) fail(element, place, "has no " + attribute.name);
      if (!value || attribute.numbers == kText || areNumbers(value, attribute.numbers)) continue;
      const std::string what = attribute.numbers == 1 ? "a number" : std::to_string(attribute.numbers) + " numbers";
      fail(element, place, attribute.name + " = \"" + value + "\"; allowed: " + what);
    }
    for (const XMLAttribute* at = element.FirstAttribute(); at; at = at->Next()) {
      const std::string attribute = at->Name();
      // An XML namespace, as xacro leaves it, is ignored.
      if (attribute.compare(0, 5, "xmlns") == 0 || std::find(known.begin(), known.end(), attribute) != known.end()) {
        continue;
      }
      fail(element, place, attribute + " is not known" + didYouMean(attribute, known) + "; allowed: " + listed(known));
    }
  }

  [[noreturn]] void fail(const XMLElement& element, const std::string& place, const std::string& what) const {
    throw std::invalid_argument(name_ + ", line " + std::to_string(element.GetLineNum()) + ": " + place + " " + what);
  }

  std::string name_;
};

}  // namespace

std::shared_ptr<const urdf::ModelInterface> parseUrdf(const std::string& urdf, const std::string& name) {
  tinyxml2::XMLDocument document;
  const std::string no_urdf = name + " is not a URDF";
  if (document.Parse(urdf.data(), urdf.size()) != tinyxml2::XML_SUCCESS) {
    throw std::invalid_argument(no_urdf + ", by line " + std::to_string(document.ErrorLineNum()) + " (" +
                                document.ErrorName() + "); allowed: XML with the root <robot>");
  }
  const XMLElement* robot = document.RootElement();
  if (!robot || robot->Name() != std::string("robot")) {
    throw std::invalid_argument(no_urdf + "; allowed: XML with the root <robot>");
  }
  const StrictUrdf strict(name);
  strict.check(*robot, "<robot>");
  const std::shared_ptr<const urdf::ModelInterface> model = urdf::parseURDF(urdf);
  if (!model) throw std::invalid_argument(no_urdf + "; the log of urdfdom says why");
  for (const auto* link = robot->FirstChildElement("link"); link; link = link->NextSiblingElement("link")) {
    strict.compare(*link, *model->getLink(link->Attribute("name")));
  }
  return model;
}

}  // namespace grinder
