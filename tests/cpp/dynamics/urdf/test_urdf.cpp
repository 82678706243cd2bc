#include <gtest/gtest.h>

#include <cstdio>
#include <filesystem>
#include <fstream>
#include <locale>

#include "dynamics/urdf/urdf.hpp"
#include "errors.hpp"
#include "robots.hpp"

namespace codesign::dynamics {
namespace {

using namespace testing;

// The message of the UrdfError that loading gives; empty if it loads.
std::string refusal(const std::string& text, const UrdfOptions& options = {}) {
  try {
    load_urdf(text, options);
  } catch (const UrdfError& e) {
    return e.what();
  }
  return {};
}

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  const std::size_t found = text.find(what);
  EXPECT_NE(found, std::string::npos) << what;
  return text.replace(found, what.size(), by);
}

void expect_refused(const std::string& text, const std::vector<std::string>& words,
                    const UrdfOptions& options = {}) {
  const std::string message = refusal(text, options);
  EXPECT_FALSE(message.empty()) << "loaded:\n" << text.substr(0, 1000);
  for (const std::string& word : words) {
    EXPECT_NE(message.find(word), std::string::npos) << "no \"" << word << "\" in: " << message;
  }
}

std::string tensor(const std::string& xx, const std::string& yy, const std::string& zz) {
  return "ixx=\"" + xx + "\" ixy=\"0\" ixz=\"0\" iyy=\"" + yy + "\" iyz=\"0\" izz=\"" + zz + "\"";
}

std::string with_arm(const std::string& inertial) {
  return robot(link("base") + link("arm", inertial) + joint("turn", "revolute", "base", "arm"));
}

TEST(Urdf, LoadsASmallRobot) {
  const Model model = load_urdf(small_robot());
  EXPECT_EQ(model.name, "test");
  ASSERT_EQ(model.joint_count(), 1);
  EXPECT_EQ(model.joints[0].name, "turn");
  EXPECT_EQ(model.joints[0].lower, -1.0);
  EXPECT_EQ(model.joints[0].effort, 5.0);
  EXPECT_EQ(model.body_count(), 2);
  EXPECT_EQ(model.dofs(), 7);
  EXPECT_DOUBLE_EQ(model.total_mass, 3.0);
  ASSERT_EQ(model.frames.size(), 3U);
  EXPECT_EQ(model.frames[2].name, "tool");
  EXPECT_EQ(model.frames[2].body, 1);
}

TEST(Urdf, JointsKeepTheOrderOfTheTextOrTheWantedOne) {
  const std::string text =
      robot(link("base") + link("b") + link("a") + link("c") + joint("z", "revolute", "base", "b") +
            joint("m", "fixed", "b", "c") + joint("k", "prismatic", "b", "a"));
  const Model all = load_urdf(text);
  ASSERT_EQ(all.joint_count(), 2);
  EXPECT_EQ(all.joints[0].name, "z");
  EXPECT_EQ(all.joints[1].name, "k");
  EXPECT_EQ(all.joints[1].type, JointType::kPrismatic);
  const Model turned = load_urdf(text, {.joints = {{"k", "z"}}});
  EXPECT_EQ(turned.joints[0].name, "k");
  EXPECT_EQ(turned.joints[1].name, "z");
  EXPECT_EQ(turned.bodies[1].name, "b");
  EXPECT_EQ(turned.bodies[1].joint, 1);
}

TEST(Urdf, LockedJointsAreLumped) {
  const Model model = load_urdf(small_robot(), {.joints = std::vector<std::string>{}});
  EXPECT_EQ(model.body_count(), 1);
  EXPECT_DOUBLE_EQ(model.bodies[0].inertia.mass, 3.0);
  EXPECT_NEAR(model.bodies[0].inertia.com.x(), 0.1 / 3.0, 1e-15);
}

TEST(Urdf, AxesAreNormalized) {
  const Model model = load_urdf(replaced(small_robot(), "0 0 1", "0 3 4"));
  const Eigen::Vector3d axis = model.bodies[1].parent_T_body.R.col(2);
  EXPECT_LT((axis - Eigen::Vector3d(0.0, 0.6, 0.8)).norm(), 1e-15);
}

TEST(Urdf, ReadsFilesAndNamesThemInErrors) {
  const auto path = std::filesystem::temp_directory_path() / "codesign_test_robot.urdf";
  std::ofstream(path) << "\xEF\xBB\xBF" << small_robot();
  EXPECT_EQ(load_urdf(path.string()).joint_count(), 1);
  std::ofstream(path) << small_robot().substr(0, 200);
  EXPECT_NE(refusal(path.string()).find("codesign_test_robot.urdf"), std::string::npos);
  std::filesystem::remove(path);
  expect_refused(path.string(), {"cannot be read", "codesign_test_robot.urdf"});
  expect_refused("/", {"cannot be read"});
  expect_refused("/dev/zero", {"cannot be read"});
  expect_refused("", {"cannot be read"});
}

TEST(Urdf, RefusesWhatIsNotWellFormed) {
  const std::string good = small_robot();
  for (std::size_t length = good.find("<robot"); length + 2 < good.size(); length += 7) {
    expect_refused(good.substr(0, length), {"line"});
  }
  expect_refused(replaced(good, "</robot>", "</robot><robot name=\"b\"/>"),
                 {"line 8", "junk after document element at `<robot name=\"b\"/>`"});
  expect_refused(replaced(good, "</robot>", "</robot> text"), {"junk after document element"});
  expect_refused(replaced(good, "</link>", "</lin>"),
                 {"line 3", "mismatched tag at `lin>` inside <link>"});
  expect_refused(replaced(good, "<link name=", "<link name"),
                 {"line 3", "not well-formed", "at `"});
  expect_refused(replaced(good, "name=\"base\"", "name=base"), {"not well-formed", "`base><"});
  expect_refused(replaced(good, "name=\"base\"", "name=\"base\" name=\"b\""),
                 {"duplicate attribute", "`name=\"b\""});
  expect_refused(replaced(good, "name=\"base\"", "name=\"ba<se\""), {"not well-formed", "`<se"});
  expect_refused(replaced(good, "name=\"base\"", "name=\"ba&se\""), {"not well-formed"});
  expect_refused(replaced(good, "name=\"base\"", "name=\"ba&#xD800;\""),
                 {"invalid character number"});
  expect_refused(replaced(good, "name=\"base\"", "name=\"ba&#x110000;\""),
                 {"invalid character number"});
  expect_refused(replaced(good, "name=\"base\"", "name=\"ba&#10;se\""), {"character"});
  expect_refused(replaced(good, "name=\"base\"", "name=\"ba\xC3(se\""),
                 {"line 3", "not well-formed", "`?(se"});
  expect_refused(replaced(good, "name=\"base\"", "name=\"\""), {"without a name"});
  expect_refused(replaced(good, "<link name=\"base\">", "<link>"), {"without a name"});
  std::string zero = good;
  zero[30] = '\0';
  expect_refused(zero, {"not well-formed"});
  expect_refused("<a></a>", {"<robot>"});
  expect_refused("<!-- nothing -->", {"no element"});
}

TEST(Urdf, AcceptsEveryWellFormedSpelling) {
  const std::string good = small_robot();
  EXPECT_EQ(load_urdf(replaced(good, "<link", "<!-- a > b - --><?p ?>\n<link")).joint_count(), 1);
  EXPECT_EQ(load_urdf(replaced(good, "0 0 1", "\n +0\t0.\r\n 1e0 ")).joint_count(), 1);
  EXPECT_EQ(load_urdf(replaced(good, "name=\"base\"", "name = 'base'")).frames[0].name, "base");
  const Model model = load_urdf(
      robot(link("&#66;&lt;&amp;&quot;&#xe9;\xE2\x82\xAC&#x1F916;")));  // B<&"é€ and a robot face
  EXPECT_EQ(model.frames[0].name, "B<&\"\xC3\xA9\xE2\x82\xAC\xF0\x9F\xA4\x96");
}

// e with acute accent in the encoding that the declaration names, or in the one of the file.
TEST(Urdf, FilesAreReadInTheEncodingThatTheyDeclareAndTextsAsUtf8) {
  const auto path = std::filesystem::temp_directory_path() / "codesign_test_encoding.urdf";
  const auto first_link = [&](const std::string& declared, const std::string& name) {
    const std::string text = replaced(robot(link(name)), "?>", " encoding=\"" + declared + "\"?>");
    std::ofstream(path) << text;
    return load_urdf(path.string()).frames[0].name;
  };
  EXPECT_EQ(first_link("UTF-8", "\xC3\xA9"), "\xC3\xA9");
  EXPECT_EQ(first_link("utf8", "\xC3\xA9"), "\xC3\xA9");  // not the name of any encoding
  EXPECT_EQ(first_link("ISO-8859-1", "\xE9"), "\xC3\xA9");
  EXPECT_THROW(first_link("UTF-8", "\xE9"), UrdfError);
  std::filesystem::remove(path);
  const std::string text = robot(link("\xC3\xA9"));
  const std::string declared = replaced(text, "?>", " encoding=\"ISO-8859-1\"?>");
  EXPECT_EQ(load_urdf(declared).frames[0].name, "\xC3\xA9");
}

TEST(Urdf, LinesAreCountedFromTheFirstOfTheText) {
  EXPECT_EQ(load_urdf("\n\n  " + small_robot()).joint_count(), 1);
  expect_refused("\n\n" + replaced(small_robot(), "</link>", "</lin>"), {"line 5"});
}

TEST(Urdf, RefusesEntityBombsAndDoctypes) {
  std::string bomb = "<?xml version=\"1.0\"?><!DOCTYPE robot [<!ENTITY a \"aaaaaaaaaa\">";
  for (char c = 'b'; c <= 'j'; ++c) {
    bomb += std::string("<!ENTITY ") + c + " \"";
    for (int i = 0; i < 10; ++i) bomb += std::string("&") + static_cast<char>(c - 1) + ";";
    bomb += "\">";
  }
  expect_refused(bomb + "]>" + replaced(small_robot(), "<?xml version=\"1.0\"?>", ""),
                 {"document type"});
  expect_refused(replaced(small_robot(), "name=\"base\"", "name=\"&j;\""),
                 {"line 3", "undefined entity"});
}

TEST(Urdf, RefusesHugeAndDeepInput) {
  expect_refused("<robot name=\"r\"><!--" + std::string(65U << 20U, 'x') + "--></robot>",
                 {"64 MiB"});
  std::string deep, links;
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  expect_refused("<robot name=\"r\">" + deep, {"nested"});
  for (int i = 0; i < 5001; ++i) links += "<link name=\"l" + std::to_string(i) + "\"/>";
  expect_refused(robot(links), {"more than 5000"});
}

TEST(Urdf, ALongChainLoads) {
  std::string text = link("l0");
  for (int i = 1; i < 2500; ++i) {
    const std::string name = "l" + std::to_string(i);
    text += link(name) + joint("j" + name, "revolute", "l" + std::to_string(i - 1), name);
  }
  EXPECT_EQ(load_urdf(robot(text)).joint_count(), 2499);
  // The same chain with a second root: refused, and taken down, inside of the parser.
  expect_refused(robot(text + link("other")), {"root", "other"});
}

TEST(Urdf, RefusesNumbersThatAreNone) {
  const std::string good = small_robot();
  for (const char* bad : {"nan", "inf", "-inf", "1e999", "1,5", "0x10", "1.0f", "--1", "+-1",
                          "1.2.3", "abc", "1e", "."}) {
    expect_refused(replaced(good, "0.1 0 0", std::string(bad) + " 0 0"), {"joint \"mount\"", bad});
  }
  expect_refused(replaced(good, "0.1 0 0", "0.1 0"),
                 {"joint \"mount\"", "origin xyz", "2 numbers"});
  expect_refused(replaced(good, "0.1 0 0", "0.1 0 0 0"), {"4 numbers"});
  expect_refused(replaced(good, "ixx=\"0.02\"", "ixx=\"\""), {"link \"base\"", "ixx"});
  expect_refused(replaced(good, "value=\"1.000000\"", "value=\"1 2\""), {"link \"base\"", "mass"});
  expect_refused(replaced(good, "value=\"1.000000\"", "value=\"1e30\""),
                 {"above the limit of 1e+09"});
  expect_refused(replaced(good, "0.1 0 0", "1e10 0 0"),
                 {"joint \"mount\"", "above the limit of 1e+09"});
  EXPECT_EQ(refusal(replaced(good, "rpy=\"0 0 0\"", "quat_xyzw=\"0 0 0 1\"")), "");
  expect_refused(replaced(good, "rpy=\"0 0 0\"", "quat_xyzw=\"0 0 0 0\""), {"quat_xyzw", "length"});
  expect_refused(replaced(good, "rpy=\"0 0 0\"", "quat_xyzw=\"0 0 1\""),
                 {"quat_xyzw", "3 numbers"});
}

TEST(Urdf, RefusesDuplicates) {
  const std::string good = small_robot();
  expect_refused(replaced(good, "name=\"tool\"", "name=\"arm\""), {"arm", "defined twice"});
  expect_refused(replaced(good, "name=\"mount\"", "name=\"turn\""), {"turn", "defined twice"});
  expect_refused(
      replaced(good, "<mass value=\"1.000000\"/>", "<mass value=\"1.0\"/><mass value=\"2.0\"/>"),
      {"link \"base\"", "more than one <mass>"});
  expect_refused(robot(link("base", inertial(1.0) + inertial(2.0))),
                 {"link \"base\"", "more than one <inertial>"});
}

TEST(Urdf, RefusesBrokenTrees) {
  const std::string links = link("a") + link("b") + link("c");
  expect_refused(robot(""), {"no links"});
  expect_refused(robot(links + joint("j", "revolute", "a", "b")),
                 {"link \"c\"", "second root", "\"a\""});
  expect_refused(robot(links + joint("j", "revolute", "a", "b") + joint("k", "revolute", "a", "c") +
                       joint("l", "fixed", "b", "c")),
                 {"link \"c\"", "two joints", "\"k\"", "\"l\""});
  expect_refused(robot(links + joint("j", "revolute", "b", "c") + joint("k", "fixed", "c", "b")),
                 {"loop", "link \"b\""});
  expect_refused(robot(links + joint("j", "revolute", "a", "b") + joint("k", "fixed", "b", "c") +
                       joint("l", "fixed", "c", "a")),
                 {"loop", "link \"a\""});
  expect_refused(robot(link("a") + joint("j", "revolute", "a", "a")), {"loop", "link \"a\""});
  expect_refused(robot(links + joint("j", "revolute", "a", "nowhere")), {"nowhere", "joint \"j\""});
  expect_refused(robot(links + joint("j", "revolute", "nowhere", "a")), {"nowhere", "joint \"j\""});
}

TEST(Urdf, RefusesJointsThatCannotMove) {
  const std::string good = small_robot();
  for (const char* type : {"floating", "planar"}) {
    const std::string text = replaced(good, "revolute", type);
    expect_refused(text, {"joint \"turn\"", type});
    EXPECT_EQ(load_urdf(text, {.joints = std::vector<std::string>{}}).body_count(), 1);
  }
  expect_refused(replaced(good, "revolute", "helical"),
                 {"joint \"turn\"", "\"helical\"", "prismatic"});
  expect_refused(replaced(good, " type=\"revolute\"", ""), {"joint \"turn\"", "no type"});
  expect_refused(replaced(good, "0 0 1", "0 0 0"), {"joint \"turn\"", "axis"});
  expect_refused(replaced(good, "0 0 1", "0 0 1e-9"), {"joint \"turn\"", "axis"});
  const std::string mimic =
      replaced(good, "<axis xyz=\"0 0 1\"/>", "<axis xyz=\"0 0 1\"/><mimic joint=\"other\"/>");
  expect_refused(mimic, {"joint \"turn\"", "mimics", "other", "does not exist"});
  expect_refused(replaced(mimic, "joint=\"other\"", "joint=\"turn\""), {"turn", "in turn"});
  expect_refused(replaced(mimic, "joint=\"other\"", "joint=\"turn\""),
                 {"joint \"turn\"", "name that one"}, {.joints = {{"turn"}}});
  expect_refused(good, {"joint \"mount\"", "fixed"}, {.joints = {{"mount"}}});
  expect_refused(good, {"joint \"turn\"", "twice"}, {.joints = {{"turn", "turn"}}});
  EXPECT_THROW(load_urdf(good, {.joints = {{"none"}}}), UnknownNameError);
}

TEST(Urdf, RefusesBodiesWithoutMass) {
  const std::vector<std::string> words = {"joint \"turn\"",
                                          "can move without anything that has mass"};
  expect_refused(with_arm(""), words);
  expect_refused(with_arm(inertial(0.0, "0 0 0", tensor("0", "0", "0"))), words);
  const std::string massless_base =
      robot(link("base", "") + link("arm") + joint("turn", "revolute", "base", "arm"));
  expect_refused(massless_base, {"link \"base\"", "can move without", "fixed_base=True"});
  EXPECT_EQ(load_urdf(massless_base, {.fixed_base = true}).dofs(), 1);
  expect_refused(robot(link("base", "")), {"no mass"}, {.fixed_base = true});
  // Nothing of this is waived.
  expect_refused(with_arm(""), words, {.as_published = true});
  expect_refused(with_arm(inertial(-1.0)), {"link \"arm\"", "negative mass"},
                 {.as_published = true});
}

TEST(Urdf, RefusesIncompleteInertials) {
  const std::string whole = tensor("1", "1", "1");
  const auto fixed_tool = [](const std::string& inertial) {
    return robot(link("base") + link("tool", "<inertial>" + inertial + "</inertial>") +
                 joint("mount", "fixed", "base", "tool"));
  };
  expect_refused(fixed_tool(""), {"link \"tool\"", "mass"});
  expect_refused(fixed_tool("<inertia " + whole + "/>"), {"link \"tool\"", "<mass>"});
  expect_refused(fixed_tool("<mass/><inertia " + whole + "/>"), {"link \"tool\"", "value"});
  expect_refused(fixed_tool("<mass value=\"1\"/>"), {"link \"tool\"", "<inertia>"});
  expect_refused(fixed_tool("<mass value=\"1\"/><inertia ixx=\"1\"/>"), {"link \"tool\"", "ixy"});
}

TEST(Urdf, MasslessFixedLinksAreFrames) {
  const std::string text =
      robot(link("base") + link("sensor", "") +
            link("zero", inertial(0.0, "0 0 0", tensor("0", "0", "0"))) +
            joint("s", "fixed", "base", "sensor") + joint("z", "fixed", "base", "zero"));
  const Model model = load_urdf(text);
  EXPECT_EQ(model.frames.size(), 3U);
  EXPECT_DOUBLE_EQ(model.total_mass, 1.0);
}

TEST(Urdf, RefusesInertiaThatNoBodyCanHave) {
  const UrdfOptions published{.as_published = true};
  for (const std::string& bad :
       {tensor("-0.01", "0.02", "0.02"), tensor("0.01", "0.01", "0.03"),
        std::string(R"(ixx="0.01" ixy="0.02" ixz="0" iyy="0.01" iyz="0" izz="0.01")")}) {
    const std::string text = with_arm(inertial(1.0, "0.3 0 0", bad));
    expect_refused(text, {"link \"arm\"", "non-physical inertia", "kg m2"});
    EXPECT_EQ(refusal(text, published), "");
  }
  // A point mass is the limit of a body: fine on a body, not as one that turns.
  const std::string point = inertial(1.0, "0 0 0", tensor("0", "0", "0"));
  expect_refused(with_arm(point), {"joint \"turn\"", "can move without"});
  EXPECT_EQ(refusal(robot(link("base") + link("arm", point) + joint("f", "fixed", "base", "arm"))),
            "");
  expect_refused(with_arm(inertial(0.0, "0 0 0", tensor("0.1", "0.1", "0.1"))), {"without mass"});
  // Rounded to two digits, as exporters do: 0.0101 + 0.0101 < 0.0204 by 1 %.
  EXPECT_EQ(refusal(with_arm(inertial(1.0, "0 0 0", tensor("0.0101", "0.0101", "0.0204")))), "");
}

TEST(Urdf, RefusesIncompleteJoints) {
  const std::string good = small_robot();
  expect_refused(
      replaced(good, "<limit lower=\"-1\" upper=\"1\" effort=\"5\" velocity=\"2\"/>", ""),
      {"joint \"turn\"", "a revolute joint needs limits"});
  expect_refused(replaced(good, "lower=\"-1\"", "lower=\"2\""),
                 {"joint \"turn\"", "2 is above its upper limit 1"});
  expect_refused(replaced(good, " effort=\"5\"", ""), {"joint \"turn\"", "no effort"});
  expect_refused(replaced(good, "<child link=\"arm\"/>", ""), {"turn"});
  expect_refused(replaced(good, "<parent link=\"base\"/>", ""), {"turn"});
}

TEST(Urdf, IgnoresWhatDynamicsDoesNotNeed) {
  const std::string text = replaced(
      small_robot(), "</robot>",
      "<gazebo><link name=\"base\"/></gazebo><transmission name=\"t\"><joint "
      "name=\"turn\"/></transmission>"
      "<link name=\"extra\"><visual><origin xyz=\"nan\"/><geometry><mesh filename=\"../../../x\"/>"
      "</geometry></visual></link>" +
          joint("e", "fixed", "base", "extra", "<dynamics damping=\"two\"/>") + "</robot>");
  EXPECT_EQ(load_urdf(text).frames.size(), 4U);
}

class DecimalComma : public std::numpunct<char> {
  char do_decimal_point() const override { return ','; }
  char do_thousands_sep() const override { return '.'; }
  std::string do_grouping() const override { return "\3"; }
};

TEST(Urdf, ReadsTheSameNumbersUnderADecimalCommaLocale) {
  const std::string text = replaced(small_robot(), "0.1 0 0", "0.125 -1.5e-1 1234.5");
  const std::locale before = std::locale::global(
      std::locale(std::locale::classic(), new DecimalComma));  // NOLINT: the locale owns it
  const Model model = load_urdf(text);
  const std::string message = refusal(replaced(text, "ixx=\"0.02\"", "ixx=\"-0.02\""));
  std::locale::global(before);
  EXPECT_EQ(model.frames[2].body_T_frame.p, Eigen::Vector3d(0.125, -0.15, 1234.5));
  EXPECT_NE(message.find("-0.02,"), std::string::npos) << message;
}

TEST(Urdf, PrintsNothing) {
  ::testing::internal::CaptureStderr();
  ::testing::internal::CaptureStdout();
  EXPECT_NE(refusal(robot("<link name=\"a\"/><link name=\"a\"/>")), "");
  EXPECT_NE(refusal(robot(link("a") + link("b"))), "");
  EXPECT_EQ(::testing::internal::GetCapturedStderr(), "");
  EXPECT_EQ(::testing::internal::GetCapturedStdout(), "");
}

}  // namespace
}  // namespace codesign::dynamics
