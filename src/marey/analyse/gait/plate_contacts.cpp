#include "marey/analyse/gait/plate_contacts.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "marey/geometry/median.h"

namespace marey::analyse::gait {
namespace {

constexpr double kMinForceN = 5;  // centres of pressure of less are noise; unswept
constexpr double kWindowS = 0.1;
constexpr double kQuietN = 4;                 // deviation within a window in which nothing is on the plate
constexpr double kFreeN = 60;                 // farther from zero nothing is free: the lightest child stands with more on one foot
constexpr double kReportedN = 5;              // what is worth a warning; unswept
constexpr double kOverEdgeM = 0.02;           // a marker beyond the edge by more: the foot is not on the plate as a whole
constexpr double kNearFootM = 0.1;            // corners are in order where the centre of pressure is so near
constexpr double kReorderedNearFootM = 0.05;  // another order must bring it so near: between two feet it is nearer to none
constexpr double kStandsM_s = 0.3;            // heel or toe slower than that: the foot stands
constexpr double kBothFraction = 0.1;         // of a contact in which the other foot stands on the plate too
constexpr double kCheckedEveryS = 0.01;       // numerical

/// Means of the windows in which nothing is on the plate.
struct FreeWindow {
  double middle = 0;  // sample
  PlateLoad mean;
};

std::vector<FreeWindow> free_windows(const ForcePlate& plate) {
  const auto length = std::max<std::size_t>(4, static_cast<std::size_t>(std::lround(kWindowS * plate.rate_hz)));
  std::vector<FreeWindow> windows;
  for (std::size_t begin = 0; begin + length <= plate.loads.size(); begin += length) {
    FreeWindow window{.middle = static_cast<double>(begin) + 0.5 * static_cast<double>(length - 1), .mean = {}};
    double squares = 0;
    bool saturated = false;
    for (std::size_t s = begin; s < begin + length; ++s) {
      window.mean.force += plate.loads[s].force / static_cast<double>(length);
      window.mean.moment += plate.loads[s].moment / static_cast<double>(length);
      saturated = saturated || (!plate.saturated.empty() && plate.saturated[s] != 0);
    }
    for (std::size_t s = begin; s < begin + length; ++s) squares += std::pow(plate.loads[s].force.z() - window.mean.force.z(), 2);
    const bool quiet = std::sqrt(squares / static_cast<double>(length - 1)) < kQuietN;
    if (quiet && !saturated && std::abs(window.mean.force.z()) < kFreeN) windows.push_back(window);
  }
  return windows;
}

/// Half a turn about one of the plate's axes: how its loads read if its corners were in that order.
void turn_half(ForcePlate& plate, const Vector<3>& axis) {
  const Matrix<3> turn = 2 * axis * axis.transpose() - Matrix<3>::Identity();
  for (PlateLoad& load : plate.loads) load = {turn * load.force, turn * load.moment};
}

void reverse(ForcePlate& plate) {
  for (PlateLoad& load : plate.loads) load = {-load.force, -load.moment};
}

/// Mean vertical force where there is any, N.
double push_of(const ForcePlate& plate, double threshold) {
  double sum = 0, count = 0;
  for (const PlateLoad& load : plate.loads) {
    if (std::abs(load.force.z()) <= threshold) continue;
    sum += load.force.z();
    ++count;
  }
  return count > 0 ? sum / count : 0;
}

/// A foot of which heel or toe barely moves over the ground.
bool stands(const FeetOnGround& ground, Side side, double time_s) {
  constexpr double kStepS = 0.02;  // numerical
  const auto before = ground.at(side, time_s - kStepS), after = ground.at(side, time_s + kStepS);
  if (!before || !after) return false;
  const double heel = (after->first - before->first).norm(), toe = (after->second - before->second).norm();
  return std::min(heel, toe) < 2 * kStepS * kStandsM_s;
}

/// Samples in which something is on the plate, without a break: first and last.
std::vector<std::pair<std::size_t, std::size_t>> loaded_spans(const ForcePlate& plate, double threshold) {
  std::vector<std::pair<std::size_t, std::size_t>> spans;
  const auto on = [&](std::size_t s) { return plate.loads[s].force.z() > threshold; };
  for (std::size_t s = 0; s < plate.loads.size();) {
    if (!on(s)) {
      ++s;
      continue;
    }
    const std::size_t first = s;
    while (s < plate.loads.size() && on(s)) ++s;
    spans.emplace_back(first, s - 1);
  }
  return spans;
}

/// The mean distance between centres of pressure and where the nearer foot that stands has them: from heel to toe in a contact's
/// time.
std::optional<double> distance_from_feet(const ForcePlate& plate, const FeetOnGround& ground, double threshold) {
  const auto step = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(kCheckedEveryS * plate.rate_hz)));
  double sum = 0, count = 0;
  for (const auto& [first, last] : loaded_spans(plate, threshold)) {
    for (std::size_t s = first; s <= last; s += step) {
      const auto load = foot_load(plate, s);
      const double time = plate.begin_s + static_cast<double>(s) / plate.rate_hz;
      const double fraction = static_cast<double>(s - first) / static_cast<double>(std::max<std::size_t>(1, last - first));
      std::optional<double> nearest;
      for (const Side side : kSides) {
        const auto foot = ground.at(side, time);
        if (!load || !foot || !stands(ground, side, time)) continue;
        const Vector<3> expected = foot->first + fraction * (foot->second - foot->first);
        const double distance = (load->pressure - expected).head<2>().norm();
        if (!nearest || distance < *nearest) nearest = distance;
      }
      if (!nearest) continue;
      sum += *nearest;
      ++count;
    }
  }
  return count > 0 ? std::optional(sum / count) : std::nullopt;
}

/// How far a point is beyond the plate's edges, seen from above; negative within.
double beyond_edge(const ForcePlate& plate, const Vector<3>& point) {
  const Matrix<3> axes = plate.axes();
  const Vector<3> at = axes.transpose() * (point - plate.centre());
  const double half_x = 0.5 * (plate.corners[0] - plate.corners[1]).norm(),
               half_y = 0.5 * (plate.corners[0] - plate.corners[3]).norm();
  return std::max(std::abs(at.x()) - half_x, std::abs(at.y()) - half_y);
}

/// One foot during a contact.
struct FootDuring {
  double distance = 0, standing_on_plate = 0, over_edge = 0;  // mean m; fractions of the checked instants
  std::size_t checked = 0;
};

FootDuring foot_during(const ForcePlate& plate, const PlateContact& contact, const FeetOnGround& ground, Side side) {
  FootDuring during;
  const auto step = std::max<std::size_t>(1, static_cast<std::size_t>(std::lround(kCheckedEveryS * plate.rate_hz)));
  for (std::size_t s = contact.first; s <= contact.last; s += step) {
    const double time = plate.begin_s + static_cast<double>(s) / plate.rate_hz;
    const auto foot = ground.at(side, time);
    const auto load = foot_load(plate, s);
    if (!foot || !load) continue;
    ++during.checked;
    during.distance += *ground.distance(side, time, load->pressure);
    if (!stands(ground, side, time)) continue;
    const double heel = beyond_edge(plate, foot->first), toe = beyond_edge(plate, foot->second);
    if (std::min(heel, toe) < 0) during.standing_on_plate += 1;
    if (std::max(heel, toe) > kOverEdgeM) during.over_edge += 1;
  }
  if (during.checked == 0) return during;
  for (double* sum : {&during.distance, &during.standing_on_plate, &during.over_edge}) *sum /= static_cast<double>(during.checked);
  return during;
}

void find_foot(const ForcePlate& plate, PlateContact& contact, const FeetOnGround& ground, const FootForceOptions& options) {
  const FootDuring left = foot_during(plate, contact, ground, Side::left), right = foot_during(plate, contact, ground, Side::right);
  if (left.checked == 0 && right.checked == 0) {
    contact.reason = "the feet's markers are missing";
    return;
  }
  const bool is_left = right.checked == 0 || (left.checked > 0 && left.distance <= right.distance);
  const FootDuring &own = is_left ? left : right, &other = is_left ? right : left;
  const bool whole =
      plate.saturated.empty() || std::count(plate.saturated.begin() + static_cast<std::ptrdiff_t>(contact.first),
                                            plate.saturated.begin() + static_cast<std::ptrdiff_t>(contact.last) + 1, 1) == 0;
  if (other.standing_on_plate > kBothFraction) {
    contact.reason = "both feet are on it";
  } else if (own.distance > options.max_foot_distance_m) {
    contact.reason = fmt::format("no foot is near the centre of pressure ({:.2f} m on the mean)", own.distance);
  } else if (own.over_edge > kBothFraction) {
    contact.reason = fmt::format("the {} foot reaches over its edge", is_left ? "left" : "right");
  } else if (!whole) {
    contact.reason = "it is saturated";
  } else {
    contact.side = is_left ? Side::left : Side::right;
  }
}

/// The time at which the force crosses the threshold between two samples.
double crossing_time(const ForcePlate& plate, std::size_t before, double threshold) {
  const double a = plate.loads[before].force.z(), b = plate.loads[before + 1].force.z();
  const double fraction = a == b ? 0 : std::clamp((threshold - a) / (b - a), 0.0, 1.0);
  return plate.begin_s + (static_cast<double>(before) + fraction) / plate.rate_hz;
}

}  // namespace

std::optional<std::pair<Vector<3>, Vector<3>>> FeetOnGround::at(Side side, double time_s) const {
  const auto i = static_cast<std::size_t>(side);
  const double row = (time_s - begin_s) * rate_hz;
  const auto known = [&](const MarkerPath& path) -> std::optional<Vector<3>> {
    if (path.empty() || row < -0.5 || row > static_cast<double>(path.size()) - 0.5) return std::nullopt;
    const double inside = std::clamp(row, 0.0, static_cast<double>(path.size() - 1));
    const auto below = static_cast<std::size_t>(inside), above = std::min(below + 1, path.size() - 1);
    if (!path[below] || !path[above]) return std::nullopt;
    const double fraction = inside - static_cast<double>(below);
    return Vector<3>((1 - fraction) * *path[below] + fraction * *path[above]);
  };
  const auto heel = known(feet.heel[i]), toe = known(feet.toe[i]);
  return heel && toe ? std::optional(std::pair(*heel, *toe)) : std::nullopt;
}

std::optional<double> FeetOnGround::distance(Side side, double time_s, const Vector<3>& point) const {
  const auto foot = at(side, time_s);
  if (!foot) return std::nullopt;
  const Vector<2> heel = foot->first.head<2>(), line = foot->second.head<2>() - heel, to = point.head<2>() - heel;
  const double along = line.squaredNorm() > 0 ? std::clamp(to.dot(line) / line.squaredNorm(), 0.0, 1.0) : 0;
  return (to - along * line).norm();
}

std::optional<FootLoad> foot_load(const ForcePlate& plate, std::size_t sample) {
  const PlateLoad& load = plate.loads[sample];
  if (!plate.saturated.empty() && plate.saturated[sample] != 0) return std::nullopt;
  Vector<3> up = plate.axes().col(2);
  if (up.z() < 0) up = -up;
  const double push = load.force.dot(up);
  if (!(push > kMinForceN)) return std::nullopt;
  const Vector<3> arm = up.cross(load.moment) / push;
  return FootLoad{load.force, plate.centre() + arm, up.dot(load.moment - arm.cross(load.force))};
}

std::optional<std::string> remove_offset(ForcePlate& plate) {
  const std::vector<FreeWindow> windows = free_windows(plate);
  if (plate.loads.empty()) return std::nullopt;
  if (windows.empty()) return fmt::format("{}: something is on it throughout, so that its offset is not known", plate.name);
  double largest = 0, least = 0;
  std::size_t next = 0;
  for (std::size_t s = 0; s < plate.loads.size(); ++s) {
    const auto at = static_cast<double>(s);
    while (next + 1 < windows.size() && windows[next + 1].middle <= at) ++next;
    PlateLoad offset = windows[next].mean;
    if (next + 1 < windows.size() && at > windows[next].middle) {
      const double fraction = (at - windows[next].middle) / (windows[next + 1].middle - windows[next].middle);
      offset.force += fraction * (windows[next + 1].mean.force - offset.force);
      offset.moment += fraction * (windows[next + 1].mean.moment - offset.moment);
    }
    plate.loads[s].force -= offset.force;
    plate.loads[s].moment -= offset.moment;
    largest = s == 0 ? offset.force.z() : std::max(largest, offset.force.z());
    least = s == 0 ? offset.force.z() : std::min(least, offset.force.z());
  }
  if (std::max(std::abs(largest), std::abs(least)) < kReportedN) return std::nullopt;
  return fmt::format("{}: reads {:.1f} to {:.1f} N while nothing is on it; removed", plate.name, least, largest);
}

std::optional<std::string> orient(ForcePlate& plate, const FeetOnGround& ground, const FootForceOptions& options) {
  const double push = push_of(plate, options.threshold_n);
  const Matrix<3> axes = plate.axes();
  const bool pulls = push < 0, upside_down = axes.col(2).z() > 0;
  if (push == 0) return std::nullopt;
  if (pulls) reverse(plate);
  const auto as_written = distance_from_feet(plate, ground, options.threshold_n);
  std::optional<double> least = as_written;
  std::optional<ForcePlate> best;
  // Other orders of the corners: half a turn about one of the plate's axes.
  for (Eigen::Index a = 0; a < 3 && as_written && (upside_down || *as_written > kNearFootM); ++a) {
    ForcePlate turned = plate;
    turn_half(turned, axes.col(a));
    if (push_of(turned, options.threshold_n) < 0) reverse(turned);
    const double distance = distance_from_feet(turned, ground, options.threshold_n).value_or(*least);
    if (distance >= (upside_down ? *least : std::min(kReorderedNearFootM, 0.5 * *least))) continue;
    least = distance;
    best = std::move(turned);
  }
  if (best) {
    plate = std::move(*best);
    return fmt::format("{}: its corners are {}; read in the order that puts its centre of pressure under a foot", plate.name,
                       upside_down ? "upside down" : "in another order than C3D specifies");
  }
  if (upside_down && (!least || *least > kNearFootM))
    return fmt::format(
        "{}: its corners are upside down, and no foot shows in which order they belong; centres of pressure may be "
        "mirrored",
        plate.name);
  if (!pulls) return std::nullopt;
  return fmt::format("{}: its forces pull on the person; reversed", plate.name);
}

std::vector<PlateContact> contacts_of(const ForcePlate& plate, std::size_t index, const FeetOnGround& ground,
                                      const FootForceOptions& options) {
  std::vector<PlateContact> contacts;
  const auto least = static_cast<std::size_t>(std::ceil(options.min_contact_s * plate.rate_hz));
  for (const auto& [first, last] : loaded_spans(plate, options.threshold_n)) {
    if (last - first + 1 < least) continue;
    PlateContact contact{.plate = index, .first = first, .last = last, .strike_s = {}, .off_s = {}, .side = {}, .reason = {}};
    if (first > 0) contact.strike_s = crossing_time(plate, first - 1, options.threshold_n) - ground.begin_s;
    if (last + 1 < plate.loads.size()) contact.off_s = crossing_time(plate, contact.last, options.threshold_n) - ground.begin_s;
    find_foot(plate, contact, ground, options);
    contacts.push_back(std::move(contact));
  }
  return contacts;
}

}  // namespace marey::analyse::gait
