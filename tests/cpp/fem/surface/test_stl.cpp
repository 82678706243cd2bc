#include <gtest/gtest.h>

#include <cstdint>
#include <cstdlib>
#include <limits>
#include <random>
#include <string>
#include <vector>

#include "errors.hpp"
#include "fem/surface/stl.hpp"
#include "fem/surface/surface_check.hpp"

namespace codesign::fem {
namespace {

const char* const kTetrahedron = R"(solid tetrahedron
facet normal 0 0 -1
 outer loop
  vertex 0 0 0
  vertex 0 1 0
  vertex 1 0 0
 endloop
endfacet
facet normal 0 0 0
 OUTER LOOP
  vertex +0.0 0 0
  vertex 1e0 0 0
  vertex 0 0 1.0E+0
 endloop
endfacet
facet normal nan nan nan
 outer loop
  vertex 0 0 0
  vertex 0 0 1
  vertex -0 1 0
 endloop
endfacet
facet normal 1 1 1
 outer loop
  vertex 1 0 0
  vertex 0 1 0
  vertex 0 0 1
 endloop
endfacet
endsolid tetrahedron
)";

std::string binary(std::uint32_t promised, const std::vector<float>& coordinates) {
  std::string bytes = "solid of a program that begins its binary files like a text";
  bytes.resize(80, ' ');
  bytes.append(reinterpret_cast<const char*>(&promised), 4);
  for (std::size_t t = 0; t + 9 <= coordinates.size(); t += 9) {
    bytes.append(12, '\0');
    bytes.append(reinterpret_cast<const char*>(coordinates.data() + t), 36);
    bytes.append(2, '\0');
  }
  return bytes;
}

const std::vector<float> kTriangles = {0, 0, 0, 0, 1, 0, 1, 0, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1,
                                       0, 0, 0, 0, 0, 1, 0, 1, 0, 1, 0, 0, 0, 1, 0, 0, 0, 1};

std::string message(const std::string& bytes) {
  try {
    parse_stl(bytes, 1.0);
  } catch (const MeshError& e) {
    return e.what();
  }
  return "accepted";
}

std::string replaced(std::string text, const std::string& from, const std::string& to) {
  return text.replace(text.find(from), from.size(), to);
}

TEST(Stl, AsciiAndBinaryGiveTheSameClosedSurface) {
  for (const std::string& bytes : {std::string(kTetrahedron), binary(4, kTriangles)}) {
    const SurfaceMesh surface = parse_stl(bytes, 1e-3);
    EXPECT_EQ(surface.points.rows(), 4);
    EXPECT_EQ(surface.triangles.rows(), 4);
    EXPECT_NEAR(check_surface(surface).volume, 1e-9 / 6.0, 1e-22);
  }
}

TEST(Stl, ClosesCracksOfSinglePrecision) {
  const SurfaceMesh surface = parse_stl(
      replaced(kTetrahedron, "vertex 1 0 0\n  vertex 0 1 0", "vertex 1 0 0\n  vertex 1e-7 1 0"), 1);
  EXPECT_EQ(surface.points.rows(), 4);
  EXPECT_NO_THROW(check_surface(surface));
}

TEST(Stl, TextsOfAllKindsOfLineEndAndByteOrderMarkAreTheSame) {
  const SurfaceMesh plain = parse_stl(kTetrahedron, 1.0);
  std::string returns = kTetrahedron;
  std::replace(returns.begin(), returns.end(), '\n', '\r');
  for (const std::string& text : {std::string("\xef\xbb\xbf") + kTetrahedron, returns}) {
    const SurfaceMesh read = parse_stl(text, 1.0);
    EXPECT_EQ(read.points, plain.points);
    EXPECT_EQ(read.triangles, plain.triangles);
  }
}

TEST(Stl, SaysWhatIsWrongAndWhere) {
  EXPECT_EQ(message(""), "the file is empty");
  EXPECT_EQ(message("solid nothing\nendsolid"), "the file holds no triangle");
  EXPECT_EQ(message(binary(0, {})), "the file holds no triangle");
  EXPECT_NE(message("hello").find("neither"), std::string::npos);
  EXPECT_EQ(message(std::string(100, 'a')),
            "a text, but not an ASCII STL, which begins with 'solid'");
  EXPECT_EQ(message(binary(5, kTriangles)),
            "binary STL is truncated: the header promises 5 triangles, the file holds 4");
  EXPECT_EQ(message(replaced(kTetrahedron, "vertex 0 1 0", "vertex 0 1,5 0")),
            "line 5: '1,5' is not a number");
  EXPECT_EQ(message(replaced(kTetrahedron, "vertex 0 1 0", "vertex 0 nan 0")),
            "line 5: a coordinate is not finite");
  EXPECT_EQ(message(replaced(kTetrahedron, "vertex 0 1 0", "vertex 0 1e999 0")),
            "line 5: '1e999' is too large");
  EXPECT_EQ(message(replaced(kTetrahedron, "endloop", "vertex 0 0 9")),
            "line 7: expected 'endloop', found 'vertex'");
  const std::string text = kTetrahedron;
  EXPECT_EQ(message(text.substr(0, text.find("vertex"))),
            "ASCII STL is truncated: 'vertex' is missing at the end");
  std::vector<float> broken = kTriangles;
  broken[10] = std::numeric_limits<float>::infinity();
  EXPECT_EQ(message(binary(4, broken)), "triangle 1 has a coordinate that is not finite");
  EXPECT_THROW(parse_stl(kTetrahedron, 0.0), std::invalid_argument);
  EXPECT_THROW(read_stl("/no/such/file.stl", 1.0), MeshError);
}

// Bytes changed, cut and repeated at random: each result is a surface or a MeshError.
// CODESIGN_FUZZ_RUNS sets the number of files; benchmarks/robustness/fuzz_stl.sh runs many under
// the sanitizers.
TEST(Stl, SurvivesDamagedFiles) {
  std::mt19937 random(7);
  const std::string sources[] = {kTetrahedron, binary(4, kTriangles)};
  const char* wanted = std::getenv("CODESIGN_FUZZ_RUNS");
  const int runs = wanted ? std::atoi(wanted) : 20000;
  int accepted = 0;
  for (int i = 0; i < runs; ++i) {
    std::string bytes = sources[i % 2];
    for (int change = static_cast<int>(random() % 6); change >= 0 && !bytes.empty(); --change) {
      const std::size_t at = random() % bytes.size();
      const std::size_t length = random() % 40 + 1;
      switch (random() % 4) {
        case 0:
          bytes[at] = static_cast<char>(random());
          break;
        case 1:
          bytes.erase(at, length);
          break;
        case 2:
          bytes.insert(at, bytes.substr(random() % bytes.size(), length));
          break;
        default:
          bytes.resize(at);
          break;
      }
    }
    try {
      const SurfaceMesh surface = parse_stl(bytes, 1e-3);
      ++accepted;
      check_surface(surface);
    } catch (const MeshError&) {
    }
  }
  EXPECT_GT(accepted,
            runs / 200);  // the damage is not so heavy that nothing gets past the first lines
}

}  // namespace
}  // namespace codesign::fem
