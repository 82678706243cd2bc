#pragma once

#include <Eigen/Core>
#include <array>
#include <vector>

#include "dynamics/kinematics.hpp"
#include "dynamics/paired/lanes.hpp"

namespace codesign::dynamics {

// Forward dynamics of a floating tree for plants, by articulated bodies as in forward_dynamics.hpp,
// with two bodies of equal depth at a time in the lanes of one vector register: left and right
// limbs go together. Rotors add to what their joints move. Nothing allocates but the constructor.
//
//   bodies.move(state) ; bodies.push(...) as often as wanted ; bodies.accelerate(tau, nu_dot)
class PairedBodies {
 public:
  // rotor_inertia: (joints) at the joints [kg m²]; empty: none. The model has a floating base and
  // no bodies that share a joint.
  PairedBodies(const Model& model, const Eigen::VectorXd& rotor_inertia);

  void set_inertia(int body, const RigidInertia& inertia);  // body axes

  // Poses, velocities and inertias at a state; no force but gravity acts. nu: (6+n,), world axes.
  void move(const Eigen::Matrix3d& world_R_base, const Eigen::Ref<const Eigen::VectorXd>& joints,
            const Eigen::Ref<const Eigen::VectorXd>& nu);

  // The same at the state to which another moved last: of the same tree, with other inertias.
  void move_with(const PairedBodies& other);

  // World axes, origins from the base's origin.
  Eigen::Matrix3d rotation(int body) const;
  Eigen::Vector3d origin(int body) const;
  Eigen::Vector3d linear_velocity(int body) const;  // of the origin
  Eigen::Vector3d angular_velocity(int body) const;
  Eigen::Vector3d center_of_mass() const;

  // A force on a body and a moment about its origin, world axes.
  void push(int body, const Eigen::Vector3d& force, const Eigen::Vector3d& moment);

  // Terms of all bodies at the state of the last move(), which pushes leave alone. M (6+n, 6+n),
  // rotors included, and C (6, 6+n) as in robot_terms.hpp: entries are written that are not zero at
  // every state. Bodies as kinematics.hpp has them. The robot as one body, from the base's origin.
  void write_mass_matrix(Eigen::MatrixXd& M, Matrix6Xd& C, RigidInertia& robot);
  void write_poses(std::vector<BodyPose>& poses) const;

  // f (6+n,) of M ν̇ = (0; tau) + f: gravity, Coriolis and centrifugal forces, and the pushes.
  void generalized_forces(Eigen::Ref<Eigen::VectorXd> forces);

  // ν̇ (6+n,) under joint torques or forces tau (n,). False if it is not finite, as at a singular
  // mass matrix.
  bool accelerate(const Eigen::Ref<const Eigen::VectorXd>& tau, Eigen::Ref<Eigen::VectorXd> nu_dot);

 private:
  // Where a body is.
  struct Place {
    int row = 0, lane = 0;
  };
  // Moves with the parent's: pose, and velocity and acceleration for ν̇ = 0 of the origin.
  struct Motion {
    LaneMatrix R;  // columns
    LaneVector p, v, w, a, alpha;
  };
  // (force; moment) = [linear coupling; couplingᵀ angular] (linear; angular acceleration) + bias.
  struct Articulated {
    LaneSymmetric linear, angular;
    LaneMatrix coupling;  // rows
    LaneVector force, moment;
  };
  struct Acceleration {
    LaneVector linear, angular;
  };
  // Inertia about the base's origin: mass, mass times center, moments.
  struct Composite {
    Lanes mass;
    LaneVector first;
    LaneSymmetric second;
  };
  // Motion per unit of a joint, or momentum, about the base's origin.
  struct Twist {
    LaneVector linear, angular;
  };
  // A row below another on the way to the base, and the lanes that its own two lanes lead to.
  struct Ancestor {
    int row = 0;
    std::array<int, 2> lane = {0, 1};
    bool straight = false;  // lane for lane
  };
  // Two bodies, or one in both lanes.
  struct Row {
    std::array<int, 2> body = {0, 0}, joint = {0, 0};
    std::array<Place, 2> parent;
    bool single = true;
    bool reads_straight = false;  // parents are one row, lane for lane
    bool adds_straight = false;
    bool prismatic = false;  // one of the joints is
    Lanes turns, slides;     // 1 and 0 for a revolute joint, 0 and 1 for a prismatic one
    LaneMatrix parent_R_body;
    LaneVector parent_p_body;
    Lanes mass, rotor;
    LaneVector com;         // body axes
    LaneSymmetric inertia;  // about the center of mass, body axes
    Motion motion;
    LaneVector offset;
    LaneVector arm;               // to the center of mass, world axes
    LaneSymmetric world_inertia;  // about the center of mass, world axes
    Articulated articulated;
    LaneVector carried_force, carried_moment;  // of the subtree
    LaneVector joint_force, joint_moment;
    Lanes per_joint_inertia, force_left;
    Acceleration acceleration;
    std::vector<Ancestor> ancestors;  // with the row itself, without the base
    Composite composite;
    Twist twist;
  };

  void place_bodies(const Model& model);
  void find_ancestors(int row);
  void start_composites();
  void write_column(const Row& row, const Eigen::Vector3d& com, Eigen::MatrixXd& M, Matrix6Xd& C);
  void add_row(const Model& model, int first, int second);
  void move_row(Row& row, const double* joints, const double* rates);
  static void start_row(Row& row);
  void hand_down(Row& row, const double* tau);
  void accelerate_base(Eigen::Ref<Eigen::VectorXd> nu_dot);
  template <class T>
  T of_parents(const Row& row, const T& first, const T& second) const;

  std::vector<Row> rows_;
  std::vector<Place> places_;  // of the bodies
};

}  // namespace codesign::dynamics
