#include "marey/pipeline/bodies/gait_markers.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <limits>
#include <map>
#include <set>
#include <span>
#include <string_view>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>
#include <fmt/ranges.h>

#include "marey/core/error.h"
#include "marey/format/mapped_file.h"
#include "marey/format/motion/c3d_parameters.h"
#include "marey/format/recording_file.h"
#include "marey/format/register.h"
#include "marey/geometry/median.h"

namespace marey::pipeline::bodies {
namespace {

constexpr std::int64_t kMaxRows = 10'000'000;  // by definition of the domain: 28 hours at 100 Hz
// Six children, 12 walks: in the worst pair below 6.5 mm at most with the child's own static trial, 28.7 mm at least with
// another's.
constexpr double kSamePersonM = 0.015;
constexpr std::array<std::pair<std::string_view, std::string_view>, 18> kRigidPairs = {{
    {"LASI", "RASI"},
    {"LASI", "SACR"},
    {"RASI", "SACR"},
    {"LASI", "LPSI"},
    {"RASI", "RPSI"},
    {"LPSI", "RPSI"},
    {"LTHI", "LKNE"},
    {"LKNE", "LANK"},
    {"LKNE", "LTIB"},
    {"LTIB", "LANK"},
    {"LANK", "LHEE"},
    {"LHEE", "LTOE"},
    {"RTHI", "RKNE"},
    {"RKNE", "RANK"},
    {"RKNE", "RTIB"},
    {"RTIB", "RANK"},
    {"RANK", "RHEE"},
    {"RHEE", "RTOE"},
}};

std::optional<double> apart(const gait::MarkerPositions& locations, std::string_view a, std::string_view b) {
  const auto at = locations.find(a), there = locations.find(b);
  if (at == locations.end() || there == locations.end()) return std::nullopt;
  return (at->second - there->second).norm();
}

/// The median over the walk.
std::optional<double> predominantly_apart(const GaitMarkers& walk, std::string_view a, std::string_view b) {
  std::vector<double> all;
  for (const gait::MarkerPositions& row : walk.rows) {
    if (const auto distance = apart(row, a, b)) all.push_back(*distance);
  }
  if (all.empty()) return std::nullopt;
  return geometry::median(all);
}

}  // namespace

const gait::BodyMarkerSet& marker_set_of(const std::string& path, const std::string& name) {
  const auto reader = format::open_recording(path, format::format_to_read(path, format::Content::space), {});
  std::set<std::string, std::less<>> labels;
  const auto learn = [&](std::span<const TrackName> named) {
    for (const TrackName& track : named) labels.insert(track.label.substr(track.label.find_last_of(':') + 1));
  };
  learn(reader->tracks());
  while (const auto instant = reader->next()) learn(instant->named);
  try {
    if (name.empty()) return gait::recognised_marker_set(labels);
    const gait::BodyMarkerSet& set = gait::body_marker_set(name);
    const std::vector<std::string> lacking = set.missing(labels);
    if (!lacking.empty()) throw Error("of {} it lacks {}", set.title(), fmt::join(lacking, ", "));
    return set;
  } catch (const Error& error) {
    throw Error("{}: {}", path, error.what());
  }
}

GaitMarkers read_gait_markers(const std::string& path, const std::optional<format::UpAxis>& up, const Hooks& hooks,
                              const gait::BodyMarkerSet& set, const std::optional<std::int64_t>& maximum) {
  format::ReadOptions how;
  how.up = up;
  const auto reader = format::open_recording(path, format::format_to_read(path, format::Content::space), how);
  GaitMarkers markers;
  markers.up = format::up_axis(reader->info(), up);
  markers.rate_hz = reader->header().rate_hz;
  markers.auxiliary = reader->info().auxiliary;
  markers.set = &set;
  std::map<TrackId, std::string> labels;
  const auto learn = [&](std::span<const TrackName> named) {
    for (const TrackName& track : named) {
      if (const auto key = set.key_of(std::string_view(track.label).substr(track.label.find_last_of(':') + 1)))
        labels[track.id] = *key;
    }
  };
  learn(reader->tracks());
  std::optional<std::int64_t> first;
  while (const auto instant = reader->next()) {
    learn(instant->named);
    if (!first) {
      first = markers.first_index = instant->index;
      markers.begin_s = seconds(instant->time);
    }
    const std::int64_t row = instant->index - *first;
    if (maximum && row >= *maximum) break;
    if (row >= kMaxRows) throw Error("{}: frame {} is beyond what one walk has", path, instant->index);
    markers.rows.resize(static_cast<std::size_t>(row) + 1);
    for (const Sample& sample : instant->samples) {
      const auto label = labels.find(sample.track);
      if (label != labels.end() && !sample.position.isZero()) markers.rows.back()[label->second] = sample.position;
    }
    hooks.advance({.step = "reading", .done = row + 1, .total = reader->instant_count()});
  }
  markers.warnings = reader->warnings();
  return markers;
}

gait::MarkerPositions standing_positions(const GaitMarkers& markers, const std::string& name) {
  gait::MarkerPositions means;
  std::map<std::string, int> counts;
  for (const gait::MarkerPositions& row : markers.rows) {
    for (const auto& [label, location] : row) {
      means.try_emplace(label, Vector<3>::Zero()).first->second += location;
      ++counts[label];
    }
  }
  for (auto& [label, location] : means) location /= counts[label];
  for (const gait::MarkerPositions& row : markers.rows) {
    for (const auto& [label, location] : row) {
      const auto segment = *markers.set->segment_of(label);
      const bool held =
          segment == gait::SegmentId::pelvis || label.ends_with("KNE") || label.ends_with("ANK") || label.ends_with("HEE");
      const double off = (location - means.at(label)).norm();
      if (held && off > kStandsStillM)
        throw Error("{}: {} moves by {:.0f} mm; a static trial is of a person who stands still", name, label, 1000 * off);
    }
  }
  return means;
}

namespace {

/// Mean speed of the markers of a row, m/s, between the rows `step` before and after it; nothing if it has too few on both
/// sides.
std::optional<double> speed_at(const GaitMarkers& markers, std::size_t row, std::size_t step) {
  if (row < step || row + step >= markers.rows.size()) return std::nullopt;
  const gait::MarkerPositions &before = markers.rows[row - step], &after = markers.rows[row + step];
  double sum = 0;
  std::size_t count = 0;
  for (const auto& [label, location] : markers.rows[row]) {
    const auto from = before.find(label), to = after.find(label);
    if (from == before.end() || to == after.end()) continue;
    sum += (to->second - from->second).norm();
    ++count;
  }
  if (2 * count < markers.rows[row].size()) return std::nullopt;
  return sum / static_cast<double>(count) * markers.rate_hz / static_cast<double>(2 * step);
}

/// The means over a second about a row, where nothing moves in it; else nothing.
std::optional<gait::MarkerPositions> standing_about(const GaitMarkers& markers, std::size_t row, const std::string& name) {
  const auto half = static_cast<std::size_t>(std::lround(0.5 * markers.rate_hz));
  if (row < half || row + half >= markers.rows.size()) return std::nullopt;
  GaitMarkers second;
  second.set = markers.set;
  second.rows.assign(markers.rows.begin() + static_cast<std::ptrdiff_t>(row - half),
                     markers.rows.begin() + static_cast<std::ptrdiff_t>(row + half + 1));
  try {
    return standing_positions(second, name);
  } catch (const Error&) {
    return std::nullopt;  // it moves
  }
}

}  // namespace

QuietTimeStep quietest_time_step(const GaitMarkers& markers, const std::string& name) {
  std::size_t maximum = 0;
  for (const gait::MarkerPositions& row : markers.rows) maximum = std::max(maximum, row.size());
  if (maximum == 0) throw Error("{}: none of the markers is seen", name);
  const auto step = static_cast<std::size_t>(std::max(1L, std::lround(0.05 * markers.rate_hz)));
  QuietTimeStep time_step;
  std::optional<std::size_t> quietest;
  for (std::size_t row = 0; row < markers.rows.size(); ++row) {
    if (markers.rows[row].size() < maximum) continue;
    const auto speed = speed_at(markers, row, step);
    if (quietest && (!speed || *speed >= time_step.speed_m_s)) continue;
    quietest = row;
    time_step.speed_m_s = speed.value_or(std::numeric_limits<double>::infinity());
  }
  time_step.time_s = static_cast<double>(*quietest) / markers.rate_hz;
  const auto standing = standing_about(markers, *quietest, name);
  time_step.stands = standing.has_value();
  time_step.locations = standing.value_or(markers.rows[*quietest]);
  if (!std::isfinite(time_step.speed_m_s)) time_step.speed_m_s = 0;
  return time_step;
}

std::span<const std::pair<std::string_view, std::string_view>> rigid_marker_pairs() {
  return kRigidPairs;
}

std::optional<std::string> other_person(const gait::MarkerPositions& standing, const GaitMarkers& walk) {
  double worst = kSamePersonM;
  std::optional<std::string> stated;
  for (const auto& [a, b] : kRigidPairs) {
    const auto there = apart(standing, a, b), here = predominantly_apart(walk, a, b);
    if (!there || !here || std::abs(*there - *here) <= worst) continue;
    worst = std::abs(*there - *here);
    stated = fmt::format("{} and {} are {:.0f} mm {} than in the walk", a, b, 1000 * worst,
                         *there > *here ? "farther apart" : "closer together");
  }
  return stated;
}

void take_measures(const std::string& path, gait::GaitSubject& subject) {
  if (format::format_to_read(path, format::Content::space).name != "c3d") return;
  const format::MappedFile file(path);
  const auto head = format::motion::read_c3d_head(file.bytes(), path);
  const auto take = [&](const std::string& name, std::optional<double>& into) {
    const auto value = head.number("PROCESSING:" + name);
    if (!into && value && *value > 0) into = *value / 1000;
  };
  for (const gait::Side side : gait::kSides) {
    const auto i = static_cast<std::size_t>(side);
    const std::string letter = side == gait::Side::left ? "L" : "R";
    take(letter + "LEGLENGTH", subject.leg_length[i]);
    take(letter + "KNEEWIDTH", subject.knee_width[i]);
    take(letter + "ANKLEWIDTH", subject.ankle_width[i]);
    take(letter + "SHOULDEROFFSET", subject.shoulder_offset[i]);
    take(letter + "ELBOWWIDTH", subject.elbow_width[i]);
    take(letter + "WRISTWIDTH", subject.wrist_width[i]);
    take(letter + "HANDTHICKNESS", subject.hand_thickness[i]);
  }
  take("INTERASISDISTANCE", subject.asis_distance);
  if (const auto diameter = head.number("PROCESSING:MARKERDIAMETER"); diameter && *diameter > 0)
    subject.marker_radius = *diameter / 2000;
}

BodySize body_size_in_c3d(const std::string& path) {
  BodySize size;
  if (format::format_to_read(path, format::Content::space).name != "c3d") return size;
  const format::MappedFile file(path);
  const auto head = format::motion::read_c3d_head(file.bytes(), path);
  const auto mass = head.number("PROCESSING:BODYMASS"), height = head.number("PROCESSING:HEIGHT");
  if (mass && *mass > 0) size.mass_kg = mass;
  if (height && *height > 0) size.height_m = *height / 1000;
  return size;
}

void take_soles(const std::string& path, gait::GaitSubject& subject) {
  if (format::format_to_read(path, format::Content::space).name != "c3d") return;
  const format::MappedFile file(path);
  const auto head = format::motion::read_c3d_head(file.bytes(), path);
  for (const gait::Side side : gait::kSides) {
    const auto above =
        head.number(std::string(side == gait::Side::left ? "PROCESSING:L" : "PROCESSING:R").append("STATICPLANTFLEX"));
    if (!above || *above == 0) continue;
    const double inwards =
        head.number(std::string(side == gait::Side::left ? "PROCESSING:L" : "PROCESSING:R").append("STATICROTOFF")).value_or(0);
    subject.sole_from_ankle_toe[static_cast<std::size_t>(side)] =
        (Eigen::AngleAxisd(-*above, Vector<3>::UnitY()) *
         Eigen::AngleAxisd(side == gait::Side::left ? -inwards : inwards, Vector<3>::UnitZ()))
            .toRotationMatrix();
  }
}

}  // namespace marey::pipeline::bodies
