#include "flute_grinder/machine/machine_model.h"

#include "refusal.h"
#include "temp_folder.h"

#include <gtest/gtest.h>
#include <tinyxml2.h>

#include <functional>
#include <set>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace grinder {
namespace test_machine_model {

using tinyxml2::XMLElement;

std::string shipped() { return test_support::readFile("urdf/grinder.urdf"); }

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  EXPECT_NE(at, std::string::npos) << from;
  return at == std::string::npos ? text : text.replace(at, from.size(), to);
}

void expectRefused(const std::string& urdf, const std::string& words) {
  const std::string said = test_support::refusalOf<std::invalid_argument>([&] { MachineModel model(urdf); });
  EXPECT_FALSE(said.empty()) << "not refused: " << words;
  EXPECT_NE(said.find(words), std::string::npos) << said << "\nnot: " << words;
}

/// The shipped machine, and beside it a link and a joint with all that a URDF may have.
std::string complete() {
  return replaced(shipped(), "</robot>", R"(
  <link name="box" type="part">
    <inertial>
      <origin xyz="0 0 0" rpy="0 0 0"/>
      <mass value="1"/>
      <inertia ixx="1" ixy="0" ixz="0" iyy="1" iyz="0" izz="1"/>
    </inertial>
    <visual name="seen">
      <geometry><box size="1 1 1"/></geometry>
      <material name="grey"><color rgba="0.5 0.5 0.5 1"/><texture filename="grey.png"/></material>
    </visual>
    <collision name="hit"><geometry><sphere radius="1"/></geometry></collision>
    <collision><geometry><mesh filename="box.stl" scale="1 1 1"/></geometry></collision>
  </link>
  <joint name="to_box" type="revolute">
    <origin xyz="0 0 0" rpy="0 0 0"/>
    <parent link="base"/>
    <child link="box"/>
    <axis xyz="1 0 0"/>
    <limit lower="-1" upper="1" velocity="1" effort="1"/>
    <dynamics damping="0" friction="0"/>
    <calibration rising="0" falling="0"/>
    <mimic joint="axis_a" multiplier="1" offset="0"/>
    <safety_controller soft_lower_limit="-1" soft_upper_limit="1" k_position="1" k_velocity="1"/>
  </joint>
</robot>)");
}

/// complete(), of which one place after the other is changed.
class Changed {
 public:
  Changed() { document_.Parse(complete().c_str()); }

  void forEach(const std::function<void(XMLElement&)>& change) { visit(*document_.RootElement(), change); }

  void expectRefused(const std::string& words) const { test_machine_model::expectRefused(text(), words); }

  std::string text() const {
    tinyxml2::XMLPrinter printed;
    document_.Print(&printed);
    return printed.CStr();
  }

 private:
  void visit(XMLElement& element, const std::function<void(XMLElement&)>& change) {
    change(element);
    for (auto* child = element.FirstChildElement(); child; child = child->NextSiblingElement()) visit(*child, change);
  }

  tinyxml2::XMLDocument document_;
};

/// Of an element, its names first, so that they can be changed.
std::vector<std::pair<std::string, std::string>> attributesOf(const XMLElement& element) {
  std::vector<std::pair<std::string, std::string>> attributes;
  for (const auto* at = element.FirstAttribute(); at; at = at->Next()) attributes.emplace_back(at->Name(), at->Value());
  return attributes;
}

TEST(MachineModel, TakesTheShippedMachine) {
  const MachineModel model(shipped());
  constexpr double kQuarterTurn = 1.57079633;
  EXPECT_NEAR(model.swivel().from, -kQuarterTurn, 1e-7);
  EXPECT_NEAR(model.swivel().to, kQuarterTurn, 1e-7);
  EXPECT_EQ(model.link("wheel").collision_array.size(), 3U);
  // With a byte order mark, as some editors save it.
  EXPECT_EQ(MachineModel("\xEF\xBB\xBF" + shipped()).link("wheel").collision_array.size(), 3U);
}

TEST(MachineModel, RefusesEveryFigureThatIsNoNumber) {
  Changed urdf;
  int count = 0;
  urdf.forEach([&](XMLElement& element) {
    for (const auto& [name, value] : attributesOf(element)) {
      if (value.find_first_not_of("0123456789.- ") != std::string::npos) continue;
      const std::string wrong = value + ",5";
      element.SetAttribute(name.c_str(), wrong.c_str());
      urdf.expectRefused(" " + name + " = \"" + wrong + "\"; allowed: ");
      element.SetAttribute(name.c_str(), value.c_str());
      ++count;
    }
  });
  EXPECT_GT(count, 100);
  for (const char* number : {"nan", "inf", "1e999", "", "0.022 m", "0x1", "1 2"}) {
    expectRefused(replaced(shipped(), "radius=\"0.022\"", std::string("radius=\"") + number + "\""),
                  "allowed: a number");
  }
  expectRefused(replaced(shipped(), "radius=\"0.022\"", "radius=\"0,022\""),
                "link wheel, <visual> flange, <geometry>, <cylinder> radius = \"0,022\"; allowed: a number");
}

TEST(MachineModel, RefusesEveryWordThatItDoesNotKnow) {
  Changed urdf;
  int count = 0;
  urdf.forEach([&](XMLElement& element) {
    const std::string name = element.Name(), unknown = name + "x";
    element.SetName(unknown.c_str());
    urdf.expectRefused(name == "robot" ? "the root <robot>" : "is not known; did you mean '" + name);
    element.SetName(name.c_str());
    for (const auto& [attribute, value] : attributesOf(element)) {
      element.DeleteAttribute(attribute.c_str());
      element.SetAttribute((attribute + "x").c_str(), value.c_str());
      urdf.expectRefused(attribute);
      element.DeleteAttribute((attribute + "x").c_str());
      element.SetAttribute(attribute.c_str(), value.c_str());
    }
    ++count;
  });
  EXPECT_GT(count, 100);
  const std::string arbor = "<cylinder radius=\"0.022\" length=\"0.075\"/>";
  expectRefused(replaced(shipped(), arbor, "<cylinder radus=\"0.022\" length=\"0.075\"/>"), "<cylinder> has no radius");
  expectRefused(replaced(shipped(), arbor, arbor + arbor), ", <cylinder> appears twice; allowed: once");
  expectRefused(replaced(shipped(), arbor, ""), "<collision> cannot be read");
  expectRefused(replaced(complete(), "damping=", "dampin="), ": joint to_box, <dynamics> dampin is not known");
  expectRefused(
      replaced(shipped(), "<origin xyz=\"0.05 0.22 -0.6325\"/>", "<origin xzy=\"0.05 0.22 -0.6325\"/>"),
      "line 56: link base, <visual> cabinet, <origin> xzy is not known; did you mean 'xyz'?; allowed: xyz, rpy");
}

/// By http://wiki.ros.org/urdf/XML; but urdfdom needs the name of a material.
TEST(MachineModel, LeavesOutWhatAUrdfMayLeaveOutAndNothingElse) {
  const std::set<std::string> may{"link type",
                                  "visual name",
                                  "collision name",
                                  "origin xyz",
                                  "origin rpy",
                                  "mesh scale",
                                  "limit lower",
                                  "limit upper",
                                  "dynamics damping",
                                  "dynamics friction",
                                  "calibration rising",
                                  "calibration falling",
                                  "mimic multiplier",
                                  "mimic offset",
                                  "safety_controller soft_lower_limit",
                                  "safety_controller soft_upper_limit",
                                  "safety_controller k_position"};
  Changed urdf;
  bool beside_machine = false;  // the box comes last
  std::set<std::string> left_out;
  urdf.forEach([&](XMLElement& element) {
    beside_machine = beside_machine || element.Attribute("name", "box");
    if (!beside_machine) return;
    for (const auto& [name, value] : attributesOf(element)) {
      const std::string attribute = element.Name() + (' ' + name);
      element.DeleteAttribute(name.c_str());
      if (may.count(attribute) == 0) {
        urdf.expectRefused("has no " + name);
      } else if (left_out.insert(attribute).second) {
        EXPECT_NO_THROW(MachineModel(urdf.text())) << attribute;
      }
      element.SetAttribute(name.c_str(), value.c_str());
    }
  });
  EXPECT_EQ(left_out, may);
}

TEST(MachineModel, NeedsTheJointsAndLinksOfAGrinder) {
  for (const char* text : {"no machine", "", "<robot name=\"a\">", "<machine/>", "control_rate: 1000"}) {
    expectRefused(text, "robot_description is not a URDF");
  }
  for (const char* joint : {"axis_x", "axis_y", "axis_z", "axis_a", "y_zero", "z_zero", "wheel_swivel"}) {
    const std::string name = std::string("<joint name=\"") + joint + "\"";
    expectRefused(replaced(shipped(), name, "<joint name=\"other\""), std::string("no joint ") + joint);
    const bool turns = joint == std::string("axis_a") || joint == std::string("wheel_swivel");
    const std::string type = " type=\"" + std::string(turns ? "revolute" : "prismatic") + "\"";
    expectRefused(replaced(shipped(), name + type, name + " type=\"floating\""),
                  std::string("joint ") + joint + " must be " + (turns ? "revolute" : "prismatic"));
  }
  const std::string limit = "<limit lower=\"-1.5707963\" upper=\"1.5707963\"";
  expectRefused(replaced(shipped(), limit, "<limit lower=\"0.5\" upper=\"-0.5\""),
                "limits of joint wheel_swivel: 0.5 to -0.5 rad; allowed: the lower below the upper");
  expectRefused(replaced(shipped(), limit, "<limit lower=\"-1.6\" upper=\"1\""),
                "-1.6 to 1 rad; allowed: the lower below the upper, both within -pi/2 to pi/2");
  std::string taken = shipped();
  for (std::size_t at = 0; (at = taken.find("\"z_datum\"")) != std::string::npos;) taken.replace(at, 9, "\"cutter\"");
  expectRefused(taken, "link cutter; allowed: another name");
}

}  // namespace test_machine_model
}  // namespace grinder
