#include "marey/analyse/measure.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "marey/core/stop.h"

namespace marey::analyse {
namespace {

/// Where `fast(i)` holds without a break for at least `least` steps: the first, and one past the last.
template <typename Fast>
std::vector<std::pair<std::size_t, std::size_t>> bouts(std::size_t count, double minimum, Fast&& fast) {
  std::vector<std::pair<std::size_t, std::size_t>> found;
  std::size_t length = 0;
  for (std::size_t i = 0; i <= count; ++i) {
    if (i < count && fast(i)) {
      ++length;
      continue;
    }
    if (length > 0 && static_cast<double>(length) >= minimum) found.emplace_back(i - length, i);
    length = 0;
  }
  return found;
}

/// Change of speed, not of direction: a person who turns does not brake. m/s².
double along(const Vector<2>& acceleration, const Vector<2>& velocity) {
  const double speed = velocity.norm();
  return speed > 0.1 ? acceleration.dot(velocity) / speed : acceleration.norm();
}

HeatMap empty_map(const MeasureOptions& options) {
  HeatMap heat;
  heat.cell_m = options.cell_m;
  heat.columns = static_cast<int>(std::ceil(options.pitch.length / options.cell_m));
  heat.rows = static_cast<int>(std::ceil(options.pitch.width / options.cell_m));
  heat.seconds.assign(static_cast<std::size_t>(heat.columns * heat.rows), 0);
  return heat;
}

void add_path(const Path& path, const MeasureOptions& options, PersonMeasure& person) {
  const auto fast = [&](std::size_t i) { return path.velocity[i].norm(); };
  for (std::size_t i = 0; i < path.location.size(); ++i) {
    const double speed = fast(i);
    // The fastest of which that is sure: else the least certain of many speeds would be the greatest.
    if (path.detected[i] && (!person.top_mps || speed - path.speed_sigma[i] > *person.top_mps - *person.top_sigma_mps))
      person.top_mps = speed, person.top_sigma_mps = path.speed_sigma[i];
    person.average_position += path.location[i] * path.step_s;
    const int column = static_cast<int>(std::floor(path.location[i].x() / options.cell_m));
    const int row = static_cast<int>(std::floor(path.location[i].y() / options.cell_m));
    if (column >= 0 && row >= 0 && column < person.heat.columns && row < person.heat.rows)
      person.heat.at(column, row) += path.step_s;
    if (i == 0) continue;
    const double step = (path.location[i] - path.location[i - 1]).norm();
    const auto zone =
        std::upper_bound(options.zones.begin(), options.zones.end(), (speed + fast(i - 1)) / 2) - options.zones.begin();
    person.distance_m += step;
    if (!path.detected[i]) continue;
    person.observed_s += path.step_s;
    person.zone_s[static_cast<std::size_t>(zone)] += path.step_s;
    person.zone_m[static_cast<std::size_t>(zone)] += step;
  }
  person.seconds += path.seconds();
  const std::size_t count = path.location.size();
  const auto time = [&](std::size_t i) { return path.start_s + path.step_s * static_cast<double>(i); };
  for (const auto& [first, end] : bouts(count, options.sprint_s / path.step_s,
                                        [&](std::size_t i) { return path.detected[i] && fast(i) >= options.sprint_mps; }))
    person.sprint_times.emplace_back(time(first), time(end - 1));
  person.sprints = static_cast<int>(person.sprint_times.size());
  const double effort = options.effort_s / path.step_s;
  const auto change = [&](std::size_t i) { return along(path.acceleration[i], path.velocity[i]); };
  const auto count_of = [&](const auto& fast_enough) { return static_cast<int>(bouts(count, effort, fast_enough).size()); };
  person.accelerations += count_of([&](std::size_t i) { return path.detected[i] && change(i) >= options.effort_mps2; });
  person.decelerations += count_of([&](std::size_t i) { return path.detected[i] && change(i) <= -options.effort_mps2; });
}

/// Area of the convex hull (Andrew's monotone chain), m².
double hull_area(std::vector<Vector<2>> points) {
  std::sort(points.begin(), points.end(),
            [](const auto& a, const auto& b) { return std::pair(a.x(), a.y()) < std::pair(b.x(), b.y()); });
  std::vector<Vector<2>> hull;
  const auto cross = [](const Vector<2>& o, const Vector<2>& a, const Vector<2>& b) {
    return (a.x() - o.x()) * (b.y() - o.y()) - (a.y() - o.y()) * (b.x() - o.x());
  };
  for (int side = 0; side < 2; ++side) {
    const std::size_t start = hull.size();
    for (const Vector<2>& point : points) {
      while (hull.size() >= start + 2 && cross(hull[hull.size() - 2], hull.back(), point) <= 0) hull.pop_back();
      hull.push_back(point);
    }
    hull.pop_back();
    std::reverse(points.begin(), points.end());
  }
  double twice = 0;
  for (std::size_t i = 0; i < hull.size(); ++i) {
    const Vector<2>&a = hull[i], &b = hull[(i + 1) % hull.size()];
    twice += a.x() * b.y() - b.x() * a.y();
  }
  return twice / 2;
}

std::vector<TeamMeasure> measure_teams(const Recording& recording, const std::vector<PersonMeasure>& people) {
  constexpr std::size_t min_positions = 3;
  std::map<std::string, TeamMeasure> teams;
  for (const PersonMeasure& person : people) {
    if (person.team.empty()) continue;
    TeamMeasure& team = teams[person.team];
    team.team = person.team;
    ++team.people;
    team.distance_m += person.distance_m;
  }
  std::map<std::string, std::vector<Vector<2>>> standing;
  const auto close_instant = [&] {
    for (auto& [name, locations] : standing) {
      if (locations.size() >= min_positions) {
        TeamMeasure& team = teams[name];
        Vector<2> low = locations.front(), high = low, sum = Vector<2>::Zero();
        for (const Vector<2>& location : locations) low = low.cwiseMin(location), high = high.cwiseMax(location), sum += location;
        team.length_m += high.x() - low.x();
        team.width_m += high.y() - low.y();
        team.hull_m2 += hull_area(locations);
        team.average_position += sum / static_cast<double>(locations.size());
        ++team.instants;
      }
      locations.clear();
    }
  };
  InstantRows rows(recording);
  for (std::size_t instant = 0; instant < recording.instants().size(); ++instant) {
    for (const auto& [index, row] : rows.at(instant)) {
      const TrackColumns& track = recording.tracks()[index];
      if (teams.contains(track.name.team)) standing[track.name.team].push_back(track.location(row));
    }
    close_instant();
  }
  std::vector<TeamMeasure> result;
  for (auto& [name, team] : teams) {
    const double instants = std::max(1, team.instants);
    team.length_m /= instants, team.width_m /= instants, team.hull_m2 /= instants, team.average_position /= instants;
    result.push_back(team);
  }
  return result;
}

}  // namespace

Measurement measure(const Recording& recording, const MeasureOptions& options) {
  require_ground(recording, "measuring");
  Measurement result;
  for (const TrackColumns& track : recording.tracks()) {
    stop_point();
    if (track.name.kind == TrackKind::ball) continue;
    PersonMeasure person;
    person.id = number(track.id()), person.label = track.name.label, person.team = track.name.team;
    person.zone_s.assign(options.zones.size() + 1, 0);
    person.zone_m = person.zone_s;
    person.heat = empty_map(options);
    PersonPaths found = paths_of(recording, track, options.path);
    person.paths = std::move(found.paths), person.impossible = std::move(found.impossible);
    double weight = 0;
    for (const Path& path : person.paths) {
      add_path(path, options, person);
      weight += path.step_s * static_cast<double>(path.location.size());
    }
    if (person.paths.empty() || !found.measured) continue;
    person.average_position /= weight;
    person.mean_mps = person.seconds > 0 ? person.distance_m / person.seconds : 0;
    // Then the fastest was where speeds are not known.
    if (person.top_mps && *person.top_mps + 2 * *person.top_sigma_mps < person.mean_mps)
      person.top_mps.reset(), person.top_sigma_mps.reset();
    result.people.push_back(std::move(person));
  }
  result.teams = measure_teams(recording, result.people);
  PossessionOptions possession;
  possession.pitch = options.pitch;
  result.ball = measure_ball(recording, possession);
  return result;
}

}  // namespace marey::analyse
