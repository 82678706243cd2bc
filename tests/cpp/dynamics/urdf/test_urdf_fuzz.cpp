// Mutated URDFs: each is either refused with a UrdfError or gives a model that can be computed
// with. Deterministic. Environment: CODESIGN_FUZZ_RUNS, number of mutants (default: a short run);
// CODESIGN_FUZZ_SEEDS, a folder of URDF files to mutate besides the built-in ones.
// benchmarks/robustness/fuzz_urdf.sh runs it at length under the sanitizers.

#include <gtest/gtest.h>

#include <algorithm>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iostream>
#include <iterator>
#include <random>
#include <string>
#include <utility>
#include <vector>

#include "errors.hpp"
#include "sample.hpp"

namespace codesign::dynamics {
namespace {

using namespace testing;

constexpr int kShortRun = 3000;

std::string read(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  return {std::istreambuf_iterator<char>(file), {}};
}

std::vector<std::string> seeds() {
  std::vector<std::string> all = {small_robot(), random_robot(5, 1), random_robot(14, 2)};
  all.push_back(
      "\xEF\xBB\xBF<?xml version=\"1.0\" encoding=\"utf-8\"?><!-- c --><robot "
      "name='&lt;r&#233;&gt;'>"
      "<material name=\"m\"><color rgba=\"0 0 0 1\"/></material>" +
      link("base", inertial(1.0) + "<visual><geometry><box size=\"1 1 1\"/></geometry></visual>") +
      link("arm") + joint("turn", "continuous", "base", "arm", "<mimic joint=\"turn\"/>") +
      "<gazebo reference=\"base\"><![CDATA[<x>]]></gazebo></robot>");
  if (const char* folder = std::getenv("CODESIGN_FUZZ_SEEDS")) {
    std::vector<std::filesystem::path> files;
    for (const auto& entry : std::filesystem::directory_iterator(folder)) files.push_back(entry);
    std::sort(files.begin(), files.end());
    for (const auto& file : files) all.push_back(read(file));
  }
  return all;
}

class Mutator {
 public:
  Mutator(const std::vector<std::string>& seeds, unsigned seed) : seeds_(seeds), generator_(seed) {}

  std::string mutant() {
    std::string text = pick(seeds_);
    const bool well_formed = below(2) == 0;  // reaches the checks behind the XML reader
    const int times = 1 + below(below(4) == 0 ? 12 : 3);
    for (int i = 0; i < times && !text.empty(); ++i) {
      mutate(text, well_formed ? below(4) : below(14));
    }
    return text;
  }

  int below(std::size_t limit) {
    return static_cast<int>(std::uniform_int_distribution<std::size_t>(0, limit - 1)(generator_));
  }

 private:
  template <typename Item>
  const Item& pick(const std::vector<Item>& list) {
    return list[static_cast<std::size_t>(below(list.size()))];
  }
  std::size_t place(const std::string& text) {
    return static_cast<std::size_t>(below(text.size()));
  }
  std::size_t length(const std::string& text) {
    return static_cast<std::size_t>(below(std::min(text.size(), pick(kLengths)))) + 1;
  }

  void mutate(std::string& text, int kind) {
    const std::string value = between(text, '"', '"');
    const auto [from, to] = find_between(text, '<', '>');
    const bool empty_element = from < to && text[to - 1] == '/';
    switch (kind) {
      case 0:
        return replace_between(text, '"', '"', pick(kValues));
      case 1:
        return replace_between(text, '"', '"', value);
      case 2:  // <a/> goes, or comes twice
        if (empty_element) text.erase(from - 1, to - from + 2);
        return;
      case 3:
        if (empty_element && below(4) == 0)
          text.insert(to + 1, text.substr(from - 1, to - from + 2));
        return;
      case 4:
        text[place(text)] = static_cast<char>(below(256));
        return;
      case 5:
        text[place(text)] ^= static_cast<char>(1 << below(8));
        return;
      case 6:
        text.erase(place(text), length(text));
        return;
      case 7:
        text.insert(place(text), text.substr(place(text), length(text)));
        return;
      case 8:
        text.insert(place(text), pick(kTokens));
        return;
      case 9:
        text.resize(place(text));
        return;
      case 10: {  // a piece of another robot
        const std::string& other = pick(seeds_);
        text.insert(place(text), other.substr(place(other), length(other)));
        return;
      }
      case 11:
        return replace_between(text, '<', '>', "");
      case 12:
        text.insert(place(text), between(text, '<', '>'));
        return;
      default:
        return replace_between(text, ' ', '=', pick(kAttributes));
    }
  }

  // Range of the inside of the next open...close after a random place; empty at the end if none.
  std::pair<std::size_t, std::size_t> find_between(const std::string& text, char open, char close) {
    const std::size_t from = text.find(open, place(text));
    const std::size_t to = from == std::string::npos ? from : text.find(close, from + 1);
    if (to == std::string::npos) return {text.size(), text.size()};
    return {from + 1, to};
  }
  std::string between(const std::string& text, char open, char close) {
    const auto [from, to] = find_between(text, open, close);
    return text.substr(from, to - from);
  }
  void replace_between(std::string& text, char open, char close, const std::string& by) {
    const auto [from, to] = find_between(text, open, close);
    text.replace(from, to - from, by);
  }

  static inline const std::vector<std::size_t> kLengths = {4, 40, 400, 4000};
  static inline const std::vector<std::string> kTokens = {"<",
                                                          ">",
                                                          "/>",
                                                          "</",
                                                          "\"",
                                                          "'",
                                                          "&",
                                                          ";",
                                                          "=",
                                                          "<!--",
                                                          "-->",
                                                          "<![CDATA[",
                                                          "]]>",
                                                          "<?",
                                                          "?>",
                                                          "<!DOCTYPE robot [<!ENTITY a \"b\">]>",
                                                          "&a;",
                                                          "&#0;",
                                                          "&#xFFFFFFFF;",
                                                          "&amp;",
                                                          "\xEF\xBB\xBF",
                                                          "\xEF\xBF\xBE",
                                                          "\xFF",
                                                          std::string(1, '\0'),
                                                          std::string(200, 'A'),
                                                          "</robot>",
                                                          "<robot name=\"x\">",
                                                          "<link name=\"base\"/>",
                                                          "<inertial>",
                                                          "</inertial>",
                                                          "</link>",
                                                          "</joint>",
                                                          "<a><a><a><a>"};
  static inline const std::vector<std::string> kValues = {"",
                                                          " ",
                                                          "0",
                                                          "-0",
                                                          "1e308",
                                                          "-1e-308",
                                                          "1e-320",
                                                          "1e999",
                                                          "nan",
                                                          "-inf",
                                                          "1,5",
                                                          "0 0 0",
                                                          "1 2",
                                                          "1e9 1e9 1e9",
                                                          "0 0 1e-3",
                                                          "9999999999999999999999999",
                                                          "0x1p3",
                                                          "base",
                                                          "arm",
                                                          "tool",
                                                          "link1",
                                                          "link2",
                                                          "joint1",
                                                          "floating",
                                                          "planar",
                                                          "fixed",
                                                          "prismatic",
                                                          "\xC3\xA9",
                                                          std::string(2000, '7')};
  static inline const std::vector<std::string> kAttributes = {
      "name", "xyz", "rpy", "value", "ixx", "link", "type", "joint", "quat_xyzw", "a:b", "1"};
  const std::vector<std::string>& seeds_;
  std::mt19937 generator_;
};

// What a caller does with a model that loaded.
void compute(const Model& model) {
  State state{{},
              Eigen::VectorXd::Constant(model.joint_count(), 0.1),
              Eigen::VectorXd::Constant(model.dofs(), 0.1)};
  Sample sample(model, state);
  EXPECT_TRUE(sample.M().allFinite());
  EXPECT_TRUE(sample.bias().allFinite());
  EXPECT_TRUE(std::isfinite(model.total_mass) && model.total_mass > 0.0);
  for (int i = 0; i < static_cast<int>(model.frames.size()); ++i) {
    EXPECT_TRUE(frame_pose(model, sample.kin, i).R.allFinite());
  }
  sample.forward(Eigen::VectorXd::Ones(model.joint_count()));
}

TEST(UrdfFuzz, MutantsLoadOrAreRefusedWithAnUrdfError) {
  const char* wanted = std::getenv("CODESIGN_FUZZ_RUNS");
  const int runs = wanted ? std::atoi(wanted) : kShortRun;
  const std::vector<std::string> originals = seeds();
  int loaded = 0;
  for (int run = 0; run < runs; ++run) {
    Mutator mutator(originals, static_cast<unsigned>(run));
    const std::string text = mutator.mutant();
    const UrdfOptions options{.as_published = mutator.below(2) == 0,
                              .fixed_base = mutator.below(4) == 0};
    try {
      compute(load_urdf(text, options));
      ++loaded;
    } catch (const UrdfError&) {
    } catch (const std::exception& e) {
      ADD_FAILURE() << "run " << run << ": " << e.what() << "\n" << text;
    }
  }
  std::cout << runs << " mutants: " << loaded << " loaded, " << runs - loaded << " refused\n";
  EXPECT_GT(loaded, runs / 50);  // both ways are exercised
  EXPECT_LT(loaded, runs - runs / 50);
}

}  // namespace
}  // namespace codesign::dynamics
