#include "marey/solve/bodies/define_body.h"

#include <algorithm>
#include <cmath>

#include <fmt/ranges.h>

#include "marey/core/error.h"
#include "marey/geometry/layout.h"
#include "marey/geometry/median.h"
#include "marey/solve/bodies/pose_fit.h"

namespace marey::solve::bodies {
namespace {

constexpr std::size_t kMaxInstants = 2000;  // evenly spread
constexpr std::size_t kMinInstantCount = 3;
constexpr int kRounds = 12;
// Of the median distance; by definition: 95 % efficient on normal noise (Beaton & Tukey 1974).
constexpr double kTukey = 4.685 * 1.4826;

constexpr double kMinLoose = 0.001;  // m: what varies less is not loose, however still the others are

using Locations = std::vector<std::optional<Vector<3>>>;  // of one instant, by marker

std::vector<const TrackColumns*> tracks_of(const Recording& recording, const std::vector<std::string>& labels) {
  std::vector<const TrackColumns*> tracks;
  std::vector<std::string> missing;
  for (const std::string& label : labels) {
    const TrackColumns* found = nullptr;
    for (const TrackColumns& track : recording.tracks()) {
      if (track.name.label != label || track.empty()) continue;
      if (found != nullptr)
        throw Error("{}: two tracks are called \"{}\"; give one of them another name", recording.header.name, label);
      found = &track;
    }
    if (found == nullptr) missing.push_back(label);
    tracks.push_back(found);
  }
  if (missing.empty()) return tracks;
  std::vector<std::string> there;
  for (const TrackColumns& track : recording.tracks()) {
    if (!track.name.label.empty()) there.push_back(track.name.label);
  }
  throw Error("{}: has no marker \"{}\"; it has {}", recording.header.name, fmt::join(missing, "\", \""),
              there.empty() ? "none with a name" : fmt::format("{}", fmt::join(there, ", ")));
}

/// Instants at which at least `fewest` of the markers are measured, evenly spread where there are many.
std::vector<Locations> instants_with(const std::vector<const TrackColumns*>& tracks, std::size_t instants,
                                     std::size_t min_detected) {
  std::vector<Locations> found;
  for (std::size_t i = 0; i < instants; ++i) {
    Locations locations(tracks.size());
    std::size_t detected = 0;
    for (std::size_t m = 0; m < tracks.size(); ++m) {
      const auto row = tracks[m]->row_at(static_cast<std::int32_t>(i));
      if (!row || !tracks[m]->measured(*row)) continue;
      locations[m] = tracks[m]->position(*row);
      ++detected;
    }
    if (detected >= min_detected) found.push_back(std::move(locations));
  }
  if (found.size() <= kMaxInstants) return found;
  std::vector<Locations> spread;
  for (std::size_t i = 0; i < kMaxInstants; ++i) spread.push_back(std::move(found[i * found.size() / kMaxInstants]));
  return spread;
}

/// The mean shape of those markers that count, and how each varies about it.
class MeanShape {
 public:
  MeanShape(const std::vector<Locations>& instants, std::vector<bool> counts) : instants_(instants), counts_(std::move(counts)) {
    const auto maximum = std::max_element(instants_.begin(), instants_.end(),
                                          [&](const Locations& a, const Locations& b) { return detected(a) < detected(b); });
    shape_ = *maximum;
    for (int round = 0; round < kRounds; ++round) advance();
  }

  const Locations& shape() const { return shape_; }
  double deviation(std::size_t marker) const { return deviations_[marker]; }

 private:
  std::int64_t detected(const Locations& locations) const {
    std::int64_t count = 0;
    for (std::size_t m = 0; m < locations.size(); ++m) count += locations[m].has_value() && counts_[m];
    return count;
  }

  void advance() {
    std::vector<std::vector<Vector<3>>> brought(shape_.size());
    for (const Locations& locations : instants_) {
      std::vector<Vector<3>> from, to;
      for (std::size_t m = 0; m < locations.size(); ++m) {
        if (locations[m] && shape_[m] && counts_[m]) from.push_back(*locations[m]), to.push_back(*shape_[m]);
      }
      if (from.size() < 3) continue;
      const Rigid3 shape_from_world = geometry::rigid_fit(from, to);
      for (std::size_t m = 0; m < locations.size(); ++m) {
        if (locations[m]) brought[m].push_back(shape_from_world * *locations[m]);
      }
    }
    deviations_.assign(shape_.size(), 0);
    for (std::size_t m = 0; m < shape_.size(); ++m) {
      if (!brought[m].empty()) shape_[m] = robust_mean(brought[m], shape_[m].value_or(brought[m].front()), deviations_[m]);
    }
  }

  static Vector<3> robust_mean(const std::vector<Vector<3>>& locations, const Vector<3>& about, double& deviation) {
    std::vector<double> distances;
    double squares = 0;
    for (const Vector<3>& location : locations) {
      distances.push_back((location - about).norm());
      squares += distances.back() * distances.back();
    }
    deviation = std::sqrt(squares / (3 * static_cast<double>(locations.size())));
    const double limit = std::max(kTukey * geometry::median_or(std::vector(distances), 0), 1e-9);
    Vector<3> sum = Vector<3>::Zero();
    double weights = 0;
    for (std::size_t i = 0; i < locations.size(); ++i) {
      const double fraction = std::min(distances[i] / limit, 1.0), weight = (1 - fraction * fraction) * (1 - fraction * fraction);
      sum += weight * locations[i];
      weights += weight;
    }
    return weights > 0 ? Vector<3>(sum / weights) : about;
  }

  const std::vector<Locations>& instants_;
  std::vector<bool> counts_;
  Locations shape_;
  std::vector<double> deviations_;
};

/// The body's own frame within the frame the shape is in.
Rigid3 shape_from_body(const DefineOptions& options, const Body& body) {
  const auto position_of = [&](const std::string& label) {
    for (const BodyMarker& marker : body.markers) {
      if (marker.label == label) return marker.position;
    }
    throw Error("\"{}\" is not one of the body's markers that are fixed to each other; pivot and axes go by those", label);
  };
  Rigid3 frame;
  for (const BodyMarker& marker : body.markers) frame.translation += marker.position / static_cast<double>(body.markers.size());
  if (options.pivot) frame.translation = position_of(*options.pivot);
  if (!options.axes) return frame;
  const auto& [origin, along, side] = *options.axes;
  const Vector<3> x = (position_of(along) - position_of(origin)).normalized();
  const Vector<3> z = x.cross(position_of(side) - position_of(origin));
  if (!(z.norm() > 1e-3 * (position_of(side) - position_of(origin)).norm()))
    throw Error("the markers {}, {} and {} lie in a line and give no axes; name others", origin, along, side);
  frame.rotation << x, z.normalized().cross(x), z.normalized();
  return frame;
}

/// The shape of the markers that are fixed to each other. The one that varies most is evaluated by the shape of the others, which
/// it does not spoil: where it varies more than they do, it is omitted, and the next one is evaluated.
MeanShape fixed_shape(const std::vector<Locations>& instants, double loose, std::vector<bool>& fixed) {
  for (;;) {
    MeanShape shape(instants, fixed);
    std::size_t loosest = fixed.size();
    for (std::size_t m = 0; m < fixed.size(); ++m) {
      if (fixed[m] && (loosest == fixed.size() || shape.deviation(m) > shape.deviation(loosest))) loosest = m;
    }
    if (std::count(fixed.begin(), fixed.end(), true) <= 3) return shape;
    std::vector<bool> others = fixed;
    others[loosest] = false;
    const MeanShape without(instants, others);
    std::vector<double> deviations;
    for (std::size_t m = 0; m < fixed.size(); ++m) {
      if (others[m]) deviations.push_back(without.deviation(m));
    }
    if (without.deviation(loosest) <= std::max(kMinLoose, loose * geometry::median_or(deviations, 0))) return shape;
    fixed = others;
  }
}

}  // namespace

DefinedBody define_body(const Recording& recording, const DefineOptions& options) {
  const std::size_t count = options.markers.size();
  if (count < 3) throw Error("a body takes three markers or more; {} {} named", count, count == 1 ? "is" : "are");
  const auto tracks = tracks_of(recording, options.markers);
  std::vector<Locations> instants = instants_with(tracks, recording.instants().size(), count);
  if (instants.size() < kMinInstantCount) instants = instants_with(tracks, recording.instants().size(), 3);
  if (instants.size() < kMinInstantCount)
    throw Error("{}: the markers {} are seen together in {} frames only; {} are needed", recording.header.name,
                fmt::join(options.markers, ", "), instants.size(), kMinInstantCount);
  std::vector<bool> fixed(count, true);
  const MeanShape shape = fixed_shape(instants, options.loose, fixed);
  DefinedBody defined;
  defined.instants = static_cast<int>(instants.size());
  defined.body.id = BodyId{1};
  defined.body.label = options.name;
  for (std::size_t m = 0; m < count; ++m) {
    const bool in = fixed[m] && shape.shape()[m].has_value();
    defined.markers.push_back({options.markers[m], shape.deviation(m), !in});
    if (in) defined.body.markers.push_back({options.markers[m], *shape.shape()[m]});
  }
  if (defined.body.markers.size() < 3)
    throw Error("{}: the markers {} are not fixed to each other; fewer than three keep their distances", recording.header.name,
                fmt::join(options.markers, ", "));
  const Rigid3 body_from_shape = shape_from_body(options, defined.body).inverse();
  std::vector<Vector<3>> layout;
  for (BodyMarker& marker : defined.body.markers) layout.push_back(marker.position = body_from_shape * marker.position);
  if (!fit_pose(layout, layout, 1e-4))
    throw Error("{}: the markers {} lie in a line, about which a turn cannot be seen; add one away from it", recording.header.name,
                fmt::join(options.markers, ", "));
  defined.symmetries = symmetries(layout, options.tolerance);
  defined.shortest_edge = (layout[0] - layout[1]).norm();
  for (std::size_t a = 0; a < layout.size(); ++a) {
    for (std::size_t b = 0; b < a; ++b) defined.shortest_edge = std::min(defined.shortest_edge, (layout[a] - layout[b]).norm());
  }
  return defined;
}

}  // namespace marey::solve::bodies
