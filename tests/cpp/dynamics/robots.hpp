#pragma once

#include <cmath>
#include <random>
#include <sstream>
#include <string>
#include <vector>

#include "dynamics/model.hpp"
#include "dynamics/urdf/urdf.hpp"

// Robots written as URDF text for the tests.
namespace codesign::dynamics::testing {

inline std::string inertial(
    double mass, const std::string& xyz = "0 0 0",
    const std::string& tensor = R"(ixx="0.02" ixy="0" ixz="0" iyy="0.02" iyz="0" izz="0.02")") {
  return "<inertial><origin xyz=\"" + xyz + "\" rpy=\"0 0 0\"/><mass value=\"" +
         std::to_string(mass) + "\"/><inertia " + tensor + "/></inertial>";
}

inline std::string link(const std::string& name, const std::string& content = inertial(1.0)) {
  return "<link name=\"" + name + "\">" + content + "</link>\n";
}

inline std::string joint(const std::string& name, const std::string& type,
                         const std::string& parent, const std::string& child,
                         const std::string& content = R"(<axis xyz="0 0 1"/>)") {
  return "<joint name=\"" + name + "\" type=\"" + type + "\"><parent link=\"" + parent +
         "\"/><child link=\"" + child +
         "\"/><limit lower=\"-1\" upper=\"1\" effort=\"5\" velocity=\"2\"/>" + content +
         "</joint>\n";
}

inline std::string robot(const std::string& content) {
  return "<?xml version=\"1.0\"?>\n<robot name=\"test\">\n" + content + "</robot>\n";
}

// Base, one revolute joint, a fixed link behind it.
inline std::string small_robot() {
  return robot(link("base") + link("arm") + link("tool") +
               joint("turn", "revolute", "base", "arm") +
               joint("mount", "fixed", "arm", "tool", R"(<origin xyz="0.1 0 0" rpy="0 0 0"/>)"));
}

// A random tree of links with every kind of joint; the parent of link i is one of the four before
// it. Deterministic. The mirrored robot is its image in the plane y = 0.
inline std::string random_robot(int links, unsigned seed, bool mirrored = false) {
  std::mt19937 generator(seed);
  std::uniform_real_distribution<double> uniform(-1.0, 1.0);
  const double flip = mirrored ? -1.0 : 1.0;
  const auto text_of = [](double x, double y, double z) {
    std::ostringstream text;
    text.precision(17);
    text << x << ' ' << y << ' ' << z;
    return text.str();
  };
  const auto vector = [&](double scale) {  // a place or a direction: y changes sign
    const double x = scale * uniform(generator), y = scale * uniform(generator);
    return text_of(x, flip * y, scale * uniform(generator));
  };
  const auto turn = [&](double scale) {  // a rotation axis or rpy: x and z change sign
    const double x = scale * uniform(generator), y = scale * uniform(generator);
    return text_of(flip * x, y, flip * scale * uniform(generator));
  };
  std::string text;
  for (int i = 0; i < links; ++i) {
    std::ostringstream body;
    body.precision(17);
    const double size = 0.05 * (1.5 + uniform(generator));
    body << "<inertial><origin xyz=\"" << vector(0.1) << "\" rpy=\"" << turn(3.0)
         << "\"/><mass value=\"" << 2.0 + uniform(generator) << "\"/><inertia ixx=\"" << size
         << "\" ixy=\"" << 0.1 * flip * size << "\" ixz=\"0\" iyy=\"" << 1.2 * size << "\" iyz=\""
         << -0.1 * flip * size << "\" izz=\"" << 0.9 * size << "\"/></inertial>";
    text += link("link" + std::to_string(i), body.str());
  }
  const std::vector<std::string> types = {"revolute", "prismatic", "continuous", "fixed"};
  for (int i = 1; i < links; ++i) {
    const auto parent = std::uniform_int_distribution<int>(i > 4 ? i - 4 : 0, i - 1)(generator);
    const std::string& type = types[static_cast<std::size_t>(i % 4)];
    const std::string origin = "<origin xyz=\"" + vector(0.3) + "\" rpy=\"" + turn(3.0) + "\"/>";
    const std::string axis = type == "prismatic" ? vector(1.0) : turn(1.0);
    text += joint("joint" + std::to_string(i), type, "link" + std::to_string(parent),
                  "link" + std::to_string(i), origin + "<axis xyz=\"" + axis + "\"/>");
  }
  return robot(text);
}

}  // namespace codesign::dynamics::testing
