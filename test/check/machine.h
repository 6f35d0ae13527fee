#pragma once

#include "flute_grinder/check/machine_shapes.h"
#include "temp_folder.h"

#include <string>

namespace grinder {

inline std::string shippedUrdf() { return test_support::readFile("urdf/grinder.urdf"); }
inline MachineShapes shapesOf(const std::string& urdf) { return MachineShapes(MachineModel(urdf)); }
inline MachineShapes shippedShapes() { return shapesOf(shippedUrdf()); }

inline std::string replaced(std::string text, const std::string& from, const std::string& to) {
  const std::size_t at = text.find(from);
  return at == std::string::npos ? "" : text.replace(at, from.size(), to);
}

/// The joints of a grinder with shapes of its own.
struct SmallMachine {
  std::string base, table, column, wheel_head, wheel;  ///< <collision> elements of the links
  std::string cutter = cylinder("collet", "0.0735 0 0", "0 1.5707963267948966 0", 0.021, 0.023);

  static std::string cylinder(const std::string& name, const std::string& xyz, const std::string& rpy, double radius,
                              double length) {
    return collision(name, xyz, rpy,
                     "<cylinder radius=\"" + std::to_string(radius) + "\" length=\"" + std::to_string(length) + "\"/>");
  }
  static std::string box(const std::string& name, const std::string& xyz, const std::string& size) {
    return collision(name, xyz, "0 0 0", "<box size=\"" + size + "\"/>");
  }
  static std::string collision(const std::string& name, const std::string& xyz, const std::string& rpy,
                               const std::string& geometry) {
    return "<collision name=\"" + name + "\"><origin xyz=\"" + xyz + "\" rpy=\"" + rpy + "\"/><geometry>" + geometry +
           "</geometry></collision>";
  }

  std::string urdf() const {
    const auto joint = [](const std::string& name, const std::string& type, const std::string& parent,
                          const std::string& child, const std::string& axis) {
      return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent + "\"/><child link=\"" +
             child + "\"/><axis xyz=\"" + axis +
             "\"/><limit lower=\"-1.5\" upper=\"1.5\" velocity=\"1\" effort=\"1\"/></joint>";
    };
    const auto link = [](const std::string& name, const std::string& shapes) {
      return "<link name=\"" + name + "\">" + shapes + "</link>";
    };
    return "<?xml version=\"1.0\"?><robot name=\"small\">" + link("base", base) + link("table", table) +
           link("chuck", cutter) + link("y_datum", "") + link("column", column) + link("z_datum", "") +
           link("wheel_head", wheel_head) + link("wheel", wheel) +
           joint("axis_x", "prismatic", "base", "table", "-1 0 0") +
           joint("axis_a", "revolute", "table", "chuck", "-1 0 0") +
           joint("y_zero", "prismatic", "base", "y_datum", "0 1 0") +
           joint("axis_y", "prismatic", "y_datum", "column", "0 1 0") +
           joint("z_zero", "prismatic", "column", "z_datum", "0 0 1") +
           joint("axis_z", "prismatic", "z_datum", "wheel_head", "0 0 1") +
           joint("wheel_swivel", "revolute", "wheel_head", "wheel", "0 -1 0") + "</robot>";
  }
};

}  // namespace grinder
