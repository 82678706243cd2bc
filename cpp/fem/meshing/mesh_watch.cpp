#include "fem/meshing/mesh_watch.hpp"

#include <pthread.h>
#include <time.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <condition_variable>
#include <cstdio>
#include <map>
#include <mutex>
#include <numeric>
#include <string>

#include "errors.hpp"
#include "interrupt.hpp"

namespace codesign::fem {
namespace {

using Eigen::Vector3d;

// So many points within one edge length are no mesh of that edge length: a regular one has two, one
// that follows a small hole or fillet some dozens. Of all points it must be a share, too: else the
// mesh is too large as a whole.
constexpr std::size_t kCrowd = 100;
constexpr double kCrowdShare = 0.02;

// Vertices in a cube of one edge length; meshes have 0.9 deep inside and more at the surface.
constexpr double kLeastVertices = 0.5;

// Vertices in a square of the mean wall on the surface: with sides three times as long as a wall is
// thick, the balls on its edges reach through it several times over.
constexpr double kLeastOnWalls = 0.1;

// Protecting balls set within one smallest edge length, counting those that are set again. Fine
// ledges take many: those of 5 µm of the published forearm 450, with edges of 12 mm 1900.
constexpr int kMostBalls = 10'000;

// Elements are small in one place if they are smaller there than this share of the base.
constexpr double kSmallShare = 0.7;

constexpr std::chrono::milliseconds kAlarmPeriod{20};

struct Crowd {
  std::size_t count = 0;
  Vector3d sum = Vector3d::Zero();
  double size = 0.0;  // m
};

// The cell of about one edge length that holds most points.
Crowd thickest_crowd(const std::vector<Vector3d>& points, const SizeField& size) {
  std::map<std::array<long, 4>, Crowd> cells;
  Crowd thickest;
  for (const Vector3d& p : points) {
    const double wanted = size_at(size, p);
    const int level = static_cast<int>(std::floor(std::log2(wanted)));
    const double edge = std::exp2(level);
    Crowd& cell = cells[{level, std::lround(p.x() / edge), std::lround(p.y() / edge),
                         std::lround(p.z() / edge)}];
    ++cell.count;
    cell.sum += p;
    cell.size = wanted;
    if (cell.count > thickest.count) thickest = cell;
  }
  return thickest;
}

template <class... Values>
std::string format(const char* pattern, Values... values) {
  std::array<char, 320> text{};
  std::snprintf(text.data(), text.size(), pattern, values...);
  return text.data();
}

// What to do about a mesh that is too large everywhere, and where its elements are smallest.
std::string too_fine(const std::vector<Vector3d>& points, const SizeField& size) {
  double smallest = kSmallShare * size.base;
  const Vector3d* place = nullptr;
  for (const Vector3d& p : points)
    if (const double wanted = size_at(size, p); wanted < smallest) {
      smallest = wanted;
      place = &p;
    }
  std::string text = format(", at %zu points", points.size());
  if (place != nullptr)
    text += format(
        "; thin walls and gaps or refined places want elements of %.3g mm near (%.6g, %.6g, %.6g) "
        "mm, of %.3g mm elsewhere",
        smallest * 1e3, place->x() * 1e3, place->y() * 1e3, place->z() * 1e3, size.base * 1e3);
  return text + ": a larger edge length is needed";
}

double seconds_of(clockid_t clock) {
  timespec t;
  clock_gettime(clock, &t);
  return static_cast<double>(t.tv_sec) + 1e-9 * static_cast<double>(t.tv_nsec);
}

}  // namespace

double thread_seconds() { return seconds_of(CLOCK_THREAD_CPUTIME_ID); }

MeshWatch::MeshWatch(const MeshOptions& options)
    : deadline_(thread_seconds() + options.time_limit),
      time_limit_(options.time_limit),
      most_vertices_(options.max_vertices),
      most_questions_(options.max_questions) {}

void MeshWatch::require_affordable(const SurfaceMesh& surface, const SizeField& size) const {
  const double volume = enclosed_volume(surface), most = static_cast<double>(most_vertices_);
  if (const double least = std::cbrt(kLeastVertices * volume / most); size.base < least)
    throw MeshLimitError(
        format("elements of %.4g mm fill the part with more than %zu vertices (max_vertices): an "
               "edge length of at least %.4g mm is needed",
               size.base * 1e3, most_vertices_, least * 1e3));
  const std::vector<double> areas = face_areas(surface);
  const double area = std::accumulate(areas.begin(), areas.end(), 0.0), wall = 2.0 * volume / area;
  if (kLeastOnWalls * area > most * wall * wall)
    throw MeshLimitError(
        format("the part is too thin: elements as large as its mean wall of %.4g mm cover its "
               "surface of %.4g mm² with more than %zu vertices (max_vertices)",
               wall * 1e3, area * 1e6, most_vertices_));
}

MeshWatch::Alarm::Alarm(const MeshWatch& watch) {
  clockid_t thread;
  if (pthread_getcpuclockid(pthread_self(), &thread) != 0) return;
  clock_ = std::jthread([this, thread, deadline = watch.deadline_](const std::stop_token& ended) {
    std::mutex mutex;
    std::condition_variable_any wake;
    std::unique_lock lock(mutex);
    while (!rung_ && !wake.wait_for(lock, ended, kAlarmPeriod, [] { return false; }) &&
           !ended.stop_requested())
      rung_ = seconds_of(thread) > deadline;
  });
}

void MeshWatch::tick() {
  check_interrupt();
  if (thread_seconds() > deadline_) stop(Limit::time);
}

void MeshWatch::start_balls(const SizeField& size) {
  balls_.clear();
  // Of the first mesh: where refining only brings more balls, cells that shrink never fill.
  if (cell_ == 0.0) cell_ = smallest_size(size);
}

void MeshWatch::ball(const Vector3d& center) {
  const std::array<long, 3> cell{std::lround(center.x() / cell_), std::lround(center.y() / cell_),
                                 std::lround(center.z() / cell_)};
  if (++balls_[cell] > kMostBalls) stop(Limit::crowd);
}

void MeshWatch::step(const char* stage) {
  if ((++steps_ & 0x0F) != 0) return;
  check_interrupt();
  if (thread_seconds() > deadline_)
    throw MeshLimitError(
        format("meshing was stopped after %g s (time_limit) while %s: a larger "
               "edge length or a larger time_limit is needed",
               time_limit_, stage));
}

void MeshWatch::report(Limit limit, const SizeField& size,
                       const std::vector<Vector3d>& points) const {
  std::string text;
  if (limit == Limit::time)
    text = format("meshing was stopped after %g s (time_limit)", time_limit_);
  if (limit == Limit::work)
    text = format("meshing was stopped after %zu questions about the solid (max_questions)",
                  most_questions_);
  if (limit == Limit::vertices)
    text = format("the mesh would need more than %zu vertices (max_vertices)", most_vertices_);
  if (limit == Limit::crowd) text = "sharp edges ask for ever more points in one place";
  const Crowd crowd = thickest_crowd(points, size);
  if (crowd.count < kCrowd ||
      static_cast<double>(crowd.count) < kCrowdShare * static_cast<double>(points.size()))
    throw MeshLimitError(text + too_fine(points, size));
  const Vector3d place = crowd.sum / static_cast<double>(crowd.count);
  throw MeshLimitError(
      text +
      format(": %zu of %zu points lie within one edge length, %.3g mm, of (%.6g, %.6g, %.6g) "
             "mm; edges or faces meet there at a tiny angle or nearly touch, so the surface "
             "must be mended there, a larger edge length does not help",
             crowd.count, points.size(), crowd.size * 1e3, place.x() * 1e3, place.y() * 1e3,
             place.z() * 1e3));
}

}  // namespace codesign::fem
