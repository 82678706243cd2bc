// Joints that mimic others, and bodies without mass between joints.
#include <gtest/gtest.h>

#include <cmath>

#include "dynamics/urdf/urdf.hpp"
#include "errors.hpp"
#include "robots.hpp"

namespace codesign::dynamics {
namespace {

using namespace testing;

std::string about(const char* axis, const std::string& more = "") {
  return std::string("<axis xyz=\"") + axis + "\"/>" + more;
}

TEST(UrdfJoints, CrossesWithoutMassPassWhereTheMassMatrixIsRegular) {
  const auto universal = [](const char* second) {
    return robot(link("base") + link("cross", "") + link("arm") +
                 joint("roll", "continuous", "base", "cross") +
                 joint("pitch", "continuous", "cross", "arm", about(second)));
  };
  const Model model = load_urdf(universal("0 1 0"));
  EXPECT_EQ(model.body_count(), 3);
  EXPECT_EQ(model.bodies[1].inertia.mass, 0.0);
  try {
    load_urdf(universal("0 0 1"));
    FAIL() << "two joints about one axis with nothing between them";
  } catch (const UrdfError& e) {
    EXPECT_NE(std::string(e.what()).find("joint \"roll\" can move without"), std::string::npos);
  }
}

TEST(UrdfJoints, JointsThatMimicMoveAlong) {
  const auto follower = [](const std::string& name, const std::string& parent,
                           const std::string& mimic) {
    return link(name) +
           joint(name, "continuous", parent, name, about("0 0 1", "<mimic " + mimic + "/>"));
  };
  const std::string text =
      robot(link("base") + link("lead") + joint("lead", "continuous", "base", "lead") +
            follower("second", "lead", R"(joint="lead" multiplier="-2" offset="0.5")") +
            follower("third", "second", R"(joint="second" multiplier="3" offset="1")"));
  const Model model = load_urdf(text);
  ASSERT_EQ(model.joint_count(), 1);
  ASSERT_EQ(model.body_count(), 4);
  EXPECT_TRUE(model.mimics);
  EXPECT_EQ(model.bodies[2].ratio, -2.0);
  EXPECT_EQ(model.bodies[2].offset, 0.5);
  EXPECT_EQ(model.bodies[3].ratio, -6.0);
  EXPECT_EQ(model.bodies[3].offset, 2.5);
  // The lead is locked at zero: its followers stay at their offsets.
  const Model locked = load_urdf(text, {.joints = std::vector<std::string>{}});
  ASSERT_EQ(locked.body_count(), 1);
  const Eigen::Matrix3d turned = locked.frames.back().body_T_frame.R;
  EXPECT_NEAR(turned(1, 0), std::sin(3.0), 1e-15);
}

}  // namespace
}  // namespace codesign::dynamics
