#include "marey/analyse/gait/foot_forces.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

#include <fmt/format.h>

#include "marey/analyse/gait/plate_contacts.h"
#include "marey/core/error.h"

namespace marey::analyse::gait {
namespace {

constexpr double kReplacedWithinS = 0.15;   // a third of the shortest stance: the same event; unswept
constexpr double kForceDeviationS = 0.002;  // by definition: of an event by force: the threshold's crossing, two samples of 1 kHz

/// Sums of one foot's loads on several plates at one sample.
FootLoad sum_of(std::span<const FootLoad> loads) {
  if (loads.size() == 1) return loads.front();
  FootLoad sum;
  double weight = 0;
  for (const FootLoad& load : loads) {
    sum.force += load.force;
    sum.pressure += load.force.z() * load.pressure;
    weight += load.force.z();
  }
  sum.pressure /= weight;
  for (const FootLoad& load : loads) {
    const Vector<3> arm = load.pressure - sum.pressure;
    sum.free_moment += load.free_moment + arm.x() * load.force.y() - arm.y() * load.force.x();
  }
  return sum;
}

void add_loads(std::span<const ForcePlate> plates, FootForces& forces) {
  const std::size_t samples = plates.empty() ? 0 : plates.front().loads.size();
  for (const Side side : kSides) {
    auto& foot = forces.feet[static_cast<std::size_t>(side)];
    foot.resize(samples);
    std::vector<FootLoad> here;
    for (std::size_t s = 0; s < samples; ++s) {
      here.clear();
      for (const PlateContact& contact : forces.contacts) {
        if (contact.side != side || s < contact.first || s > contact.last) continue;
        if (const auto load = foot_load(plates[contact.plate], s)) here.push_back(*load);
      }
      if (!here.empty()) foot[s] = sum_of(here);
    }
  }
}

/// A foot that goes from plate to plate strikes with the first and leaves with the last.
void add_force_events(FootForces& forces) {
  for (const Side side : kSides) {
    std::vector<const PlateContact*> own;
    for (const PlateContact& contact : forces.contacts) {
      if (contact.side == side) own.push_back(&contact);
    }
    std::sort(own.begin(), own.end(), [](const auto* a, const auto* b) { return a->first < b->first; });
    for (std::size_t i = 0; i < own.size();) {
      const PlateContact* latest = own[i];
      const std::optional<double> strike = own[i]->strike_s;
      for (++i; i < own.size() && own[i]->first <= latest->last; ++i) {
        if (own[i]->last > latest->last) latest = own[i];
      }
      if (strike) forces.events.push_back({side, true, *strike, kForceDeviationS});
      if (latest->off_s) forces.events.push_back({side, false, *latest->off_s, kForceDeviationS});
    }
  }
  std::stable_sort(forces.events.begin(), forces.events.end(), [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
}

PreferredEvents::Difference difference_of(std::span<const double> all) {
  PreferredEvents::Difference difference{.count = all.size()};
  if (all.empty()) return difference;
  for (const double one : all) difference.mean_s += one / static_cast<double>(all.size());
  double squares = 0;
  for (const double one : all) squares += (one - difference.mean_s) * (one - difference.mean_s);
  difference.deviation_s = all.size() > 1 ? std::sqrt(squares / static_cast<double>(all.size() - 1)) : 0;
  return difference;
}

}  // namespace

FootForces foot_forces(std::span<const ForcePlate> plates, const FeetPaths& feet, double feet_rate_hz, double begin_s,
                       const FootForceOptions& options) {
  FootForces forces;
  if (plates.empty()) return forces;
  std::vector<ForcePlate> zeroed(plates.begin(), plates.end());
  forces.rate_hz = plates.front().rate_hz;
  for (const ForcePlate& plate : plates) {
    if (plate.rate_hz != forces.rate_hz || plate.begin_s != plates.front().begin_s ||
        plate.loads.size() != plates.front().loads.size())
      throw Error("{}: its rate, beginning or length differ from those of {}", plate.name, plates.front().name);
  }
  const FeetOnGround ground{feet, feet_rate_hz, begin_s};
  for (std::size_t p = 0; p < zeroed.size(); ++p) {
    if (auto removed = remove_offset(zeroed[p])) forces.warnings.push_back(std::move(*removed));
    if (auto turned = orient(zeroed[p], ground, options)) forces.warnings.push_back(std::move(*turned));
    for (PlateContact& contact : contacts_of(zeroed[p], p, ground, options)) {
      if (!contact.reason.empty())
        forces.warnings.push_back(fmt::format("{}, {:.2f} to {:.2f} s: {}; not used", zeroed[p].name,
                                              zeroed[p].begin_s + static_cast<double>(contact.first) / forces.rate_hz,
                                              zeroed[p].begin_s + static_cast<double>(contact.last) / forces.rate_hz,
                                              contact.reason));
      forces.contacts.push_back(std::move(contact));
    }
  }
  add_loads(zeroed, forces);
  add_force_events(forces);
  return forces;
}

PreferredEvents prefer_forces(std::span<const GaitEvent> kinematic, std::span<const GaitEvent> forces) {
  PreferredEvents preferred;
  preferred.events.assign(kinematic.begin(), kinematic.end());
  std::vector<bool> replaced(kinematic.size(), false);
  std::array<std::vector<double>, 2> differences;
  for (const GaitEvent& force : forces) {
    std::optional<std::size_t> nearest;
    double least = kReplacedWithinS;
    for (std::size_t i = 0; i < kinematic.size(); ++i) {
      const GaitEvent& one = kinematic[i];
      const double apart = std::abs(one.time_s - force.time_s);
      if (one.side != force.side || one.strike != force.strike || replaced[i] || apart > least) continue;
      nearest = i;
      least = apart;
    }
    if (nearest) {
      differences[force.strike ? 0 : 1].push_back(kinematic[*nearest].time_s - force.time_s);
      preferred.events[*nearest] = force;
      replaced[*nearest] = true;
    } else {
      preferred.events.push_back(force);
      ++preferred.added;
    }
  }
  std::stable_sort(preferred.events.begin(), preferred.events.end(),
                   [](const auto& a, const auto& b) { return a.time_s < b.time_s; });
  preferred.strikes = difference_of(differences[0]);
  preferred.offs = difference_of(differences[1]);
  return preferred;
}

}  // namespace marey::analyse::gait
