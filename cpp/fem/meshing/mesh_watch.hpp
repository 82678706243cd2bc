#pragma once

#include <Eigen/Core>
#include <array>
#include <atomic>
#include <cstddef>
#include <map>
#include <thread>
#include <vector>

#include "fem/meshing/mesh_options.hpp"
#include "fem/meshing/size_field.hpp"
#include "fem/surface/surface_mesh.hpp"

namespace codesign::fem {

// Processor time of the calling thread. [s]
double thread_seconds();

// What stops the mesher. The outcome is decided by work, which is the same on every machine: the
// questions about the solid and the wanted size, of which each inserted point takes some hundreds.
// The time limit is a safety net behind it; Ctrl-C ends it too.
class MeshWatch {
 public:
  enum class Limit { work, time, vertices, crowd };

  struct Stop {  // thrown through the refinement
    Limit limit;
  };

  // The limits count from here.
  explicit MeshWatch(const MeshOptions& options);

  // Throws MeshLimitError if a solid cannot be filled within the limit of vertices by elements of
  // the largest wanted size, whatever its shape, or its surface not be covered by elements that
  // are three times as large as its mean wall (volume over half of the area).
  void require_affordable(const SurfaceMesh& surface, const SizeField& size) const;

  // A question of the refinement. Throws Stop, Interrupted.
  void question() {
    if (++questions_ > most_questions_) stop(Limit::work);
    if ((questions_ & 0x3F) == 0) tick();
  }

  // The protecting balls on feature lines are counted from here, for a mesh of this size.
  void start_balls(const SizeField& size);

  // A ball is set. Each takes longer the more there are around it, so lines that ask for ever more
  // of them in one place (they meet at a tiny angle) are stopped before the questions are used up.
  // Throws Stop.
  void ball(const Eigen::Vector3d& center);

  // A step of a later stage, named for the message. Throws MeshLimitError, Interrupted.
  void step(const char* stage);

  // Throws the MeshLimitError that says why the refinement was stopped: a place where points crowd,
  // or a mesh that is too large as a whole. `points`: those inserted so far.
  [[noreturn]] void report(Limit limit, const SizeField& size,
                           const std::vector<Eigen::Vector3d>& points) const;

  std::size_t questions() const { return questions_; }

  // While it lives, tells a stage that asks no questions when the time of the thread that made it
  // is up: CGAL looks at the flag in its loops.
  class Alarm {
   public:
    explicit Alarm(const MeshWatch& watch);
    std::atomic<bool>* flag() { return &rung_; }

   private:
    std::atomic<bool> rung_{false};
    std::jthread clock_;
  };

 private:
  void tick();
  [[noreturn]] static void stop(Limit limit) { throw Stop{limit}; }

  double deadline_, time_limit_;
  std::size_t most_vertices_, most_questions_, questions_ = 0;
  unsigned steps_ = 0;
  double cell_ = 0.0;  // in which balls are counted, m; 0 before the first mesh
  std::map<std::array<long, 3>, int> balls_;
};

}  // namespace codesign::fem
