// Inverse dynamics: a model's motion and the ground's forces into joint moments and powers.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/core/hooks.h"
#include "marey/format/format.h"
#include "marey/solve/skeleton/inverse_dynamics.h"

namespace marey::pipeline::bodies {

struct MomentOptions {
  /// A C3D file with force plates, whose loads act on the foot that is found, or OpenSim's external loads (.xml); empty: none.
  std::string loads = {};
  std::optional<format::UpAxis> up = {};                      ///< of the C3D file
  double cutoff_hz = 6;                                       ///< of coordinates, and of the plates' forces; 0: none
  std::string left_foot = "calcn_l", right_foot = "calcn_r";  ///< the model's bodies, for force plates
};

struct JointMoments {
  struct Coordinate {
    std::string name;
    bool is_rotation = true;
    std::vector<double> forces;  ///< N m of an angle, N of a shift
    std::vector<double> powers;  ///< W
  };
  double rate_hz = 0, mass_kg = 0;
  std::vector<double> times;  ///< s
  std::vector<Coordinate> coordinates;
  std::optional<double> residual_n;            ///< RMS of what the root's shifts lack: loads, masses and motion disagree by it
  std::optional<double> unexplained_fraction;  ///< of the frames: more than a tenth of the weight is missing: a foot is on no plate
  std::vector<std::string> warnings;
};

/// `model` is an .osim file, `motion` a .mot or .sto of its coordinates. Columns NAME/speed and NAME/acceleration beside NAME are
/// used as they are; else the coordinates are low-passed and differentiated. Throws Error if the model has no masses, a body for a
/// load is not in it, or the motion's times are uneven.
JointMoments joint_moments(const std::string& model, const std::string& motion, const MomentOptions& options,
                           const Hooks& hooks = {});

/// .sto, as OpenSim names them: hip_flexion_r_moment, pelvis_tx_force; powers: hip_flexion_r_power.
void write_moments(const std::string& path, const JointMoments& moments);
void write_powers(const std::string& path, const JointMoments& moments);

}  // namespace marey::pipeline::bodies
