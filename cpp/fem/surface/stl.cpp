#include "fem/surface/stl.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <numeric>
#include <stdexcept>
#include <unordered_map>
#include <unordered_set>

#include "errors.hpp"
#include "fem/surface/foreign_format.hpp"

namespace codesign::fem {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL is read in place");

constexpr std::size_t kBinaryHeader = 84;  // 80 bytes of text, then the number of triangles
constexpr std::size_t kBinaryRecord = 50;  // normal, three corners, two bytes of attributes

constexpr std::uintmax_t kMaxFileSize = std::uintmax_t{1} << 30;

using Corners = std::vector<Eigen::Vector3d>;  // three per triangle

std::uint32_t binary_count(std::string_view bytes) {
  std::uint32_t count = 0;
  std::memcpy(&count, bytes.data() + 80, sizeof count);
  return count;
}

void require_count(std::size_t triangles) {
  if (triangles == 0) throw MeshError("the file holds no triangle");
  if (triangles > kMaxTriangles)
    throw MeshError("the file holds " + std::to_string(triangles) + " triangles; the limit is " +
                    std::to_string(kMaxTriangles));
}

Corners parse_binary(std::string_view bytes) {
  const std::size_t count = binary_count(bytes);
  const std::size_t held = (bytes.size() - kBinaryHeader) / kBinaryRecord;
  if (held < count)
    throw MeshError("binary STL is truncated: the header promises " + std::to_string(count) +
                    " triangles, the file holds " + std::to_string(held));
  require_count(count);
  Corners corners;
  corners.reserve(3 * count);
  for (std::size_t t = 0; t < count; ++t) {
    std::array<float, 9> xyz;
    std::memcpy(xyz.data(), bytes.data() + kBinaryHeader + t * kBinaryRecord + 12, sizeof xyz);
    for (std::size_t k = 0; k < 3; ++k) {
      const Eigen::Vector3d p(xyz[3 * k], xyz[3 * k + 1], xyz[3 * k + 2]);
      if (!p.allFinite())
        throw MeshError("triangle " + std::to_string(t) + " has a coordinate that is not finite");
      corners.push_back(p);
    }
  }
  return corners;
}

// Words of an ASCII file with the line they stand on.
class Words {
 public:
  explicit Words(std::string_view text) : rest_(text) {}

  // Next word, empty at the end of the file.
  std::string_view next() {
    skip_space();
    std::size_t n = 0;
    while (n < rest_.size() && !is_space(rest_[n])) ++n;
    return take(n);
  }

  // Rest of the current line.
  void skip_line() { take(std::min(rest_.find_first_of("\r\n"), rest_.size())); }

  int line() const { return line_; }

 private:
  static bool is_space(char c) { return c == ' ' || (c >= '\t' && c <= '\r'); }

  void skip_space() {
    std::size_t n = 0;
    for (; n < rest_.size() && is_space(rest_[n]); ++n)
      if (rest_[n] == '\n') ++line_;
    take(n);
  }

  std::string_view take(std::size_t n) {
    const std::string_view word = rest_.substr(0, n);
    rest_.remove_prefix(n);
    return word;
  }

  std::string_view rest_;
  int line_ = 1;
};

bool equal_ignoring_case(std::string_view a, std::string_view b) {
  const auto lower = [](char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; };
  return a.size() == b.size() && std::equal(a.begin(), a.end(), b.begin(),
                                            [&](char x, char y) { return lower(x) == lower(y); });
}

[[noreturn]] void fail_at(const Words& words, const std::string& what) {
  throw MeshError("line " + std::to_string(words.line()) + ": " + what);
}

// A word of the file for a message: short and printable, whatever the file holds.
std::string quoted(std::string_view word) {
  std::string text = "'";
  for (const char c : word.substr(0, 24)) text += (c >= ' ' && c <= '~') ? c : '?';
  return text + (word.size() > 24 ? "...'" : "'");
}

void expect(Words& words, std::string_view keyword) {
  const std::string_view word = words.next();
  if (word.empty())
    throw MeshError("ASCII STL is truncated: '" + std::string(keyword) + "' is missing at the end");
  if (!equal_ignoring_case(word, keyword))
    fail_at(words, "expected '" + std::string(keyword) + "', found " + quoted(word));
}

// Independent of the locale: a decimal comma is refused.
double number(Words& words) {
  std::string_view word = words.next();
  if (word.empty()) throw MeshError("ASCII STL is truncated: a coordinate is missing at the end");
  if (word.front() == '+') word.remove_prefix(1);
  double value = 0.0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), value);
  if (error == std::errc::result_out_of_range && end == word.data() + word.size()) {
    // Underflow is harmless, overflow is not.
    if (word.find("e-") != word.npos || word.find("E-") != word.npos) return 0.0;
    fail_at(words, quoted(word) + " is too large");
  }
  if (error != std::errc{} || end != word.data() + word.size())
    fail_at(words, quoted(word) + " is not a number");
  if (!std::isfinite(value)) fail_at(words, "a coordinate is not finite");
  return value;
}

Corners parse_ascii(std::string_view text) {
  Words words(text);
  Corners corners;
  expect(words, "solid");
  words.skip_line();
  for (std::string_view word = words.next(); !word.empty(); word = words.next()) {
    if (equal_ignoring_case(word, "endsolid") || equal_ignoring_case(word, "solid")) {
      words.skip_line();  // a name may follow; several solids of one file become one surface
      continue;
    }
    if (!equal_ignoring_case(word, "facet"))
      fail_at(words, "expected 'facet' or 'endsolid', found " + quoted(word));
    expect(words, "normal");
    for (int k = 0; k < 3; ++k) words.next();  // normals follow from the corners
    expect(words, "outer");
    expect(words, "loop");
    for (int k = 0; k < 3; ++k) {
      expect(words, "vertex");
      const double x = number(words), y = number(words), z = number(words);
      corners.emplace_back(x, y, z);
    }
    expect(words, "endloop");
    expect(words, "endfacet");
    if (corners.size() / 3 > kMaxTriangles) require_count(corners.size() / 3);
  }
  require_count(corners.size() / 3);
  return corners;
}

// Printable ASCII throughout, as no binary file of some length is.
bool is_text(std::string_view bytes) {
  return bytes.size() >= kBinaryHeader && std::all_of(bytes.begin(), bytes.end(), [](char c) {
           return (c >= ' ' && c <= '~') || (c >= '\t' && c <= '\r');
         });
}

struct CoordinateHash {
  std::size_t operator()(const std::array<double, 3>& p) const {
    std::uint64_t h = 0;
    for (const double x : p) h = (h ^ std::bit_cast<std::uint64_t>(x)) * 0x9E3779B97F4A7C15ull;
    return static_cast<std::size_t>(h ^ (h >> 32));
  }
};

SurfaceMesh merge_equal_corners(const Corners& corners, double scale) {
  SurfaceMesh surface;
  std::unordered_map<std::array<double, 3>, int, CoordinateHash> index;
  index.reserve(corners.size());
  std::vector<int> of_corner(corners.size());
  std::vector<Eigen::Vector3d> points;
  for (std::size_t c = 0; c < corners.size(); ++c) {
    const Eigen::Vector3d p = corners[c] * scale + Eigen::Vector3d::Zero();  // -0 becomes 0
    const auto [at, fresh] =
        index.try_emplace({p.x(), p.y(), p.z()}, static_cast<int>(points.size()));
    if (fresh) points.push_back(p);
    of_corner[c] = at->second;
  }
  surface.points.resize(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i)
    surface.points.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
  surface.triangles.resize(static_cast<Eigen::Index>(corners.size() / 3), 3);
  for (std::size_t c = 0; c < corners.size(); ++c)
    surface.triangles(static_cast<Eigen::Index>(c / 3), static_cast<Eigen::Index>(c % 3)) =
        of_corner[c];
  return surface;
}

bool has_open_edge(const Triangles& triangles) {
  std::unordered_set<std::uint64_t> open;  // directed edges whose opposite was not met yet
  for (Eigen::Index t = 0; t < triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k) {
      const auto a = static_cast<std::uint64_t>(triangles(t, k));
      const auto b = static_cast<std::uint64_t>(triangles(t, (k + 1) % 3));
      if (a == b) continue;
      if (open.erase(b << 32 | a) == 0) open.insert(a << 32 | b);
    }
  return !open.empty();
}

int find_root(std::vector<int>& parent, int i) {
  while (parent[static_cast<std::size_t>(i)] != i) {
    const int grandparent = parent[static_cast<std::size_t>(parent[static_cast<std::size_t>(i)])];
    parent[static_cast<std::size_t>(i)] = grandparent;
    i = grandparent;
  }
  return i;
}

// Merges points closer than `tolerance`: sorted along x, each compared with its neighbors within
// the tolerance. Bounded: a point looks at 64 neighbors at most.
void merge_close_points(SurfaceMesh& surface, double tolerance) {
  const int n = static_cast<int>(surface.points.rows());
  std::vector<int> order(static_cast<std::size_t>(n)), parent(static_cast<std::size_t>(n));
  std::iota(order.begin(), order.end(), 0);
  std::iota(parent.begin(), parent.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int a, int b) {
    return std::array{surface.points(a, 0), surface.points(a, 1), surface.points(a, 2)} <
           std::array{surface.points(b, 0), surface.points(b, 1), surface.points(b, 2)};
  });
  for (std::size_t i = 0; i < order.size(); ++i)
    for (std::size_t j = i + 1; j < std::min(order.size(), i + 65); ++j) {
      const Eigen::RowVector3d d = surface.points.row(order[j]) - surface.points.row(order[i]);
      if (d.x() > tolerance) break;
      if (d.norm() > tolerance) continue;
      const int a = find_root(parent, order[i]), b = find_root(parent, order[j]);
      parent[static_cast<std::size_t>(std::max(a, b))] = std::min(a, b);
    }
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t)
    for (int k = 0; k < 3; ++k)
      surface.triangles(t, k) = find_root(parent, surface.triangles(t, k));
}

// Drops triangles with two equal corners (their other two edges cancel) and unused points.
void compact(SurfaceMesh& surface) {
  Eigen::Index kept = 0;
  for (Eigen::Index t = 0; t < surface.triangles.rows(); ++t) {
    const Eigen::RowVector3i c = surface.triangles.row(t);
    if (c[0] == c[1] || c[1] == c[2] || c[2] == c[0]) continue;
    surface.triangles.row(kept++) = c;
  }
  surface.triangles.conservativeResize(kept, 3);
  std::vector<int> fresh(static_cast<std::size_t>(surface.points.rows()), -1);
  Eigen::Index used = 0;
  Points points(surface.points.rows(), 3);
  for (Eigen::Index t = 0; t < kept; ++t)
    for (int k = 0; k < 3; ++k) {
      int& to = fresh[static_cast<std::size_t>(surface.triangles(t, k))];
      if (to < 0) {
        to = static_cast<int>(used);
        points.row(used++) = surface.points.row(surface.triangles(t, k));
      }
      surface.triangles(t, k) = to;
    }
  surface.points = points.topRows(used);
}

}  // namespace

SurfaceMesh parse_stl(std::string_view bytes, double scale) {
  if (!(scale > 0.0) || !std::isfinite(scale))
    throw std::invalid_argument("scale: a positive number of meters per unit is needed");
  if (bytes.starts_with("\xef\xbb\xbf")) bytes.remove_prefix(3);  // byte order mark of a text
  if (bytes.empty()) throw MeshError("the file is empty");
  const bool binary_length =
      bytes.size() >= kBinaryHeader &&
      bytes.size() == kBinaryHeader + kBinaryRecord * std::size_t{binary_count(bytes)};
  const std::size_t start = bytes.find_first_not_of(" \t\r\n");
  const bool starts_as_text =
      start != bytes.npos && equal_ignoring_case(bytes.substr(start, 5), "solid");
  const bool has_zero_byte = bytes.substr(0, 1024).find('\0') != bytes.npos;
  if (!binary_length && !starts_as_text && is_text(bytes.substr(0, 1024)) &&
      foreign_format(bytes).empty())
    throw MeshError("a text, but not an ASCII STL, which begins with 'solid'");
  if (!binary_length && !starts_as_text) {
    const std::string foreign = foreign_format(bytes);
    if (!foreign.empty()) throw MeshError("not an STL file but " + foreign);
  }
  Corners corners;
  if (binary_length || (bytes.size() >= kBinaryHeader && (!starts_as_text || has_zero_byte)))
    corners = parse_binary(bytes);
  else if (starts_as_text)
    corners = parse_ascii(bytes);
  else
    throw MeshError("neither a binary STL (too short: " + std::to_string(bytes.size()) +
                    " bytes) nor an ASCII STL (does not begin with 'solid')");

  SurfaceMesh surface = merge_equal_corners(corners, scale);
  if (has_open_edge(surface.triangles)) {
    const double resolution = 4.0 * 1.2e-7 * surface.points.cwiseAbs().maxCoeff();
    merge_close_points(surface, resolution);
  }
  compact(surface);
  surface.face.assign(static_cast<std::size_t>(surface.triangles.rows()), 0);
  surface.face_names = {""};
  return surface;
}

SurfaceMesh read_stl(const std::string& path, double scale) {
  std::error_code error;
  const std::uintmax_t size = std::filesystem::file_size(path, error);
  std::ifstream file(path, std::ios::binary);
  if (error || !file) throw MeshError(path + ": cannot be opened");
  if (size > kMaxFileSize)
    throw MeshError(path + ": " + std::to_string(size >> 20) + " MiB; the limit is " +
                    std::to_string(kMaxFileSize >> 20) + " MiB");
  std::string bytes(static_cast<std::size_t>(size), '\0');
  file.read(bytes.data(), static_cast<std::streamsize>(size));
  if (!file) throw MeshError(path + ": cannot be read");
  try {
    return parse_stl(bytes, scale);
  } catch (const MeshError& e) {
    throw MeshError(path + ": " + e.what());
  }
}

}  // namespace codesign::fem
