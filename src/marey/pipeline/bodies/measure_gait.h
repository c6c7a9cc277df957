// A walk's markers into joint angles, gait events, cycles and a report.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "marey/analyse/gait/foot_forces.h"
#include "marey/analyse/gait/gait_cycles.h"
#include "marey/analyse/gait/gait_profile.h"
#include "marey/analyse/gait/joint_angles.h"
#include "marey/core/hooks.h"
#include "marey/format/format.h"
#include "marey/pipeline/bodies/gait_kinetics.h"
#include "marey/pipeline/bodies/gait_quality.h"
#include "marey/pipeline/bodies/gait_reference.h"

namespace marey::pipeline::bodies {

struct GaitOptions {
  std::string static_trial = {};  ///< the same person, standing; empty: the feet's neutral position is not known
  std::string plates = {};        ///< a C3D file of the same walk with its force plates; empty: the walk's own
  std::optional<format::UpAxis> up = {};
  analyse::gait::GaitSubject subject = {};  ///< given measures; a C3D file's own measures (PROCESSING) fill in the rest
  analyse::gait::GaitEventOptions events = {};
  analyse::gait::GaitCycleOptions cycles = {};
  std::optional<double> mass_kg = {};           ///< the person's; a C3D file's own (PROCESSING) where it is not given
  std::vector<std::string> joint_moments = {};  ///< tables of joint moments and powers; empty: the C3D file's own
  std::string reference = {};                   ///< a folder of a control group; empty: none
  std::string before = {};                      ///< a walk of the same person at an earlier session; empty: none
  std::string before_static = {};               ///< its static trial
};

struct GaitOutput {
  std::string cycles;       ///< CSV: curve, percent, mean, deviation
  std::string angles;       ///< CSV: a row an instant
  std::string report;       ///< HTML
  std::string c3d = {};     ///< the recording again, with angles and events
  std::string forces = {};  ///< the ground's forces: .mot with an .xml beside it, or .csv
};

struct GaitMeasure {
  bool lies = false;  ///< the person's up is across the recording's, as far as was said which that is
  std::int64_t frames = 0;
  double rate_hz = 0;
  double begin_s = 0;            ///< the recording's time of the first row
  std::int64_t first_index = 0;  ///< the recording's index of it
  analyse::gait::GaitSubject subject;
  std::vector<analyse::gait::AngleCurve> angles;
  std::vector<analyse::gait::GaitEvent> events;
  analyse::gait::GaitCycles cycles;
  analyse::gait::FootForces forces;                 ///< of force plates; empty if it has no plates
  double forces_begin_s = 0;                        ///< the recording's time of their first sample
  analyse::gait::PreferredEvents by_force;          ///< how events by force differ from those by kinematics, which they replace
  std::vector<analyse::gait::SignalCurve> muscles;  ///< over the cycles
  std::vector<analyse::gait::SignalCurve> ground;   ///< the ground's force, N, or % of the body's weight where its mass is known
  GaitKinetics kinetics;
  std::optional<double> mass_kg;
  GaitQuality quality;
  std::optional<GaitReference> reference;
  std::optional<analyse::gait::GaitProfile> profile;  ///< against the reference
  std::string before_name;                            ///< the earlier session's file
  std::shared_ptr<const GaitMeasure> before;          ///< the earlier session; null if there is none
  std::vector<std::string> warnings;
};

/// Throws Error if the recording lacks the markers of the pelvis or of both feet, if the reference has no walk, or if the earlier
/// session has no whole cycle.
GaitMeasure measure_gait(const std::string& recording, const GaitOptions& options, const Hooks& hooks = {});
/// The same, written. Throws Error if cycles or a report are wanted and no angle is known over a whole cycle; the angles of
/// every frame are written all the same.
GaitMeasure measure_gait(const std::string& recording, const GaitOutput& output, const GaitOptions& options,
                         const Hooks& hooks = {});

}  // namespace marey::pipeline::bodies
