// Gait Profile Score and Movement Analysis Profile (Baker, McGinley, Schwartz, Beynon, Rozumalski, Graham, Tirosh 2009, "The gait
// profile score and movement analysis profile", Gait & Posture 30:265-269). A gait variable score (GVS) is the RMS difference of
// one variable over a cycle from the mean of a reference group (their equation 1); the GPS of a side is the RMS of its nine GVS
// (equation 2), the overall GPS that of fifteen: both sides' own six, and the pelvis' three of the left cycles. The profile is the
// nine GVS side by side.
//
// Each cycle is scored by itself and the scores are averaged, so that the walk's variability is in the score. Here a cycle has 101
// points, in the paper 51.
#pragma once

#include <array>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include "marey/analyse/gait/gait_cycles.h"

namespace marey::analyse::gait {

/// The nine variables of a side, in the order of the paper's figure; the first three are the pelvis'.
inline constexpr std::array<std::string_view, 9> kProfileVariables = {"pelvis_tilt",  "pelvis_obliquity",   "pelvis_rotation",
                                                                      "hip_flexion",  "hip_adduction",      "hip_rotation",
                                                                      "knee_flexion", "ankle_dorsiflexion", "foot_progression"};
inline constexpr std::size_t kPelvisVariables = 3;  ///< by definition of the score

/// One person of a reference group: all cycles of both sides, from one recording or several.
struct ReferencePerson {
  std::string name;
  std::vector<CycleCurve> curves;
  std::vector<GaitFigure> figures;
  std::vector<SignalCurve> signals =
      {};  ///< ground reactions, of joints moments and powers; of several recordings one behind the other
  std::size_t cycles = 0;
};

/// A variable over the cycle, left and right alike: mean and deviation over people, each person counts once.
struct ReferenceBand {
  std::string name;  ///< without side: "knee_flexion"
  std::size_t people = 0;
  CyclePoints mean{}, deviation{};  ///< rad; deviation 0 for one person
};

/// A signal of forces over the cycle, likewise. Only of units in which people of any weight compare (% of weight, … per kg).
struct ReferenceSignal {
  std::string label, unit;
  std::size_t people = 0;
  CyclePoints mean{}, deviation{};  ///< deviation 0 for one person
};

/// The mean over people of a figure, each person's left and right averaged.
struct ReferenceFigure {
  std::string name, unit;
  std::size_t people = 0;
  double mean = 0;
  std::optional<double> deviation;  ///< of two people or more
};

/// Left and right, rad. Deviation over the cycles, where there are two or more.
struct VariableScore {
  std::string name;
  std::array<std::optional<double>, 2> mean, deviation;
};

struct GaitProfile {
  std::vector<VariableScore> variables;                         ///< of `kProfileVariables`
  std::array<std::optional<double>, 2> score, score_deviation;  ///< GPS of each side; nothing if one of its variables is not known
  std::optional<double> overall;
};

/// What people of the group score against the others of it (no person is compared with themselves), rad: the score of a person like
/// them. Nothing for fewer than three people.
struct ReferenceScore {
  std::string name;  ///< of `kProfileVariables`, or "GPS"
  double mean = 0, deviation = 0;
};

/// Of the curves that at least one person has. `omitted` is an index of one who is not counted.
std::vector<ReferenceBand> reference_bands(std::span<const ReferencePerson> people, std::optional<std::size_t> omitted = {});
std::vector<ReferenceSignal> reference_signals(std::span<const ReferencePerson> people);
std::vector<ReferenceFigure> reference_figures(std::span<const ReferencePerson> people);
std::vector<ReferenceScore> reference_scores(std::span<const ReferencePerson> people);

GaitProfile gait_profile(std::span<const CycleCurve> curves, std::span<const ReferenceBand> reference);

/// RMS of a difference over the cycle; whole turns between them do not count.
double rms_difference(const CyclePoints& a, const CyclePoints& b);

}  // namespace marey::analyse::gait
