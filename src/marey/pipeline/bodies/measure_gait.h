// A walk's markers into joint angles, gait events, cycles and a report.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "marey/analyse/gait/emg_envelope.h"
#include "marey/analyse/gait/foot_forces.h"
#include "marey/analyse/gait/gait_cycles.h"
#include "marey/analyse/gait/joint_angles.h"
#include "marey/core/hooks.h"
#include "marey/format/format.h"

namespace marey::pipeline::bodies {

struct GaitOptions {
  std::string static_trial = {};  ///< the same person, standing; empty: the feet's neutral position is not known
  std::string plates = {};        ///< a C3D file of the same walk with its force plates; empty: the walk's own
  std::optional<format::UpAxis> up = {};
  analyse::gait::GaitSubject subject = {};  ///< given measures; a C3D file's own measures (PROCESSING) fill in the rest
  analyse::gait::GaitEventOptions events = {};
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
  analyse::gait::FootForces forces;              ///< of force plates; empty if it has no plates
  double forces_begin_s = 0;                     ///< the recording's time of their first sample
  analyse::gait::PreferredEvents by_force;       ///< how events by force differ from those by kinematics, which they replace
  std::vector<analyse::gait::EmgCurve> muscles;  ///< over the cycles
  std::vector<std::string> warnings;
};

/// Throws Error if the recording lacks the markers of the pelvis or of both feet.
GaitMeasure measure_gait(const std::string& recording, const GaitOptions& options, const Hooks& hooks = {});
/// The same, written. Throws Error if cycles or a report are wanted and no angle is known over a whole cycle; the angles of
/// every frame are written all the same.
GaitMeasure measure_gait(const std::string& recording, const GaitOutput& output, const GaitOptions& options,
                         const Hooks& hooks = {});

}  // namespace marey::pipeline::bodies
