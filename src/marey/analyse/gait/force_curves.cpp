#include "marey/analyse/gait/force_curves.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <optional>
#include <string>

namespace marey::analyse::gait {
namespace {

constexpr double kSameStrikeS = 0.02;  // numerical: an event by force has the contact's own time, but for a frame of the markers

/// Where the walker goes during a contact; nothing if it stays or is not known.
std::optional<Vector<2>> direction_during(const PlateContact& contact, const MarkerPath& sacrum, double rate_hz) {
  if (!contact.strike_s || !contact.off_s) return std::nullopt;
  const auto first = static_cast<std::ptrdiff_t>(std::floor(*contact.strike_s * rate_hz));
  const auto last = std::min(static_cast<std::ptrdiff_t>(std::ceil(*contact.off_s * rate_hz)), std::ssize(sacrum) - 1);
  std::optional<Vector<3>> from, to;
  for (std::ptrdiff_t r = std::max<std::ptrdiff_t>(first, 0); r <= last; ++r) {
    const auto& at = sacrum[static_cast<std::size_t>(r)];
    if (!at) continue;
    if (!from) from = at;
    to = at;
  }
  if (!from) return std::nullopt;
  const Vector<2> way = (*to - *from).head<2>();
  return way.norm() > 1e-6 ? std::optional<Vector<2>>(way.normalized()) : std::nullopt;
}

bool is_stance_of(const PlateContact& contact, const GaitCycles::Cycle& cycle) {
  return contact.side == cycle.side && contact.strike_s && contact.off_s &&
         std::abs(*contact.strike_s - cycle.begin_s) < kSameStrikeS && *contact.off_s < cycle.end_s;
}

}  // namespace

std::vector<GaitCycles::Cycle> cycles_on_plates(const FootForces& forces, std::span<const GaitCycles::Cycle> cycles) {
  std::vector<GaitCycles::Cycle> on_plates;
  for (const GaitCycles::Cycle& cycle : cycles) {
    if (std::any_of(forces.contacts.begin(), forces.contacts.end(), [&](const auto& c) { return is_stance_of(c, cycle); }))
      on_plates.push_back(cycle);
  }
  return on_plates;
}

std::vector<SignalCurve> ground_reaction_curves(const FootForces& forces, double forces_begin_s,
                                                std::span<const GaitCycles::Cycle> cycles, const MarkerPath& sacrum,
                                                double feet_rate_hz) {
  std::vector<SignalCurve> curves;
  const std::vector<GaitCycles::Cycle> on_plates = cycles_on_plates(forces, cycles);
  for (const Side side : kSides) {
    const auto& loads = forces.feet[static_cast<std::size_t>(side)];
    std::array<std::vector<double>, 3> signals;
    for (auto& signal : signals) signal.assign(loads.size(), 0);
    for (const PlateContact& contact : forces.contacts) {
      const auto way = contact.side == side ? direction_during(contact, sacrum, feet_rate_hz) : std::nullopt;
      if (!way) continue;
      const double medial = side == Side::left ? -1 : 1;  // a left foot's medial side is to the right
      for (std::size_t s = contact.first; s <= contact.last && s < loads.size(); ++s) {
        if (!loads[s]) continue;
        const Vector<3>& force = loads[s]->force;
        signals[0][s] = way->dot(force.head<2>());
        signals[1][s] = medial * (way->x() * force.y() - way->y() * force.x());
        signals[2][s] = force.z();
      }
    }
    for (const auto& [name, signal] : {std::pair("ahead", &signals[0]), {"medial", &signals[1]}, {"up", &signals[2]}}) {
      SignalCurve curve = signal_over_cycles(name, side, *signal, forces.rate_hz, forces_begin_s, on_plates);
      curve.unit = "N";
      if (!curve.cycles.empty()) curves.push_back(std::move(curve));
    }
  }
  return curves;
}

}  // namespace marey::analyse::gait
