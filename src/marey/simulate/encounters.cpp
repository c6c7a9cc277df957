// Each person has waypoints: where they are at which time. Between waypoints they go straight at a constant speed; the whole is
// smoothed by a Gaussian in time, so that who turns or stops does so as people do. A meeting is given by four waypoints of each of
// the two: before it, its begin, its end and after it.
#include "marey/simulate/encounters.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <utility>

#include "marey/simulate/random.h"

namespace marey::simulate {
namespace {

constexpr double ptz = 0.25;   // s, standard deviation: how long it takes to change one's velocity
constexpr double apart = 1.5;  // s: from a meeting's begin or end to being on one's own
constexpr double between = 4;  // s, on one's own

struct Waypoint {
  double time = 0;
  Vector<2> location = Vector<2>::Zero();
};
using Path = std::vector<Waypoint>;

Vector<2> direction(double angle) {
  return {std::cos(angle), std::sin(angle)};
}

/// Appends one meeting to the paths of two people and returns when it is over. It begins at `time` at the earliest.
double meet(Random& random, double time, const EncounterOptions& options, Path& a, Path& b) {
  constexpr std::array kinds{Encounter::cross, Encounter::alongside, Encounter::stop};
  const Encounter drawn = kinds[static_cast<std::size_t>(random.integer(0, 2))];
  const Encounter kind = options.kind.value_or(drawn);
  const double side = options.side;
  const Vector<2> centre = random.uniform_pair(0.3 * side, 0.7 * side, 0.3 * side, 0.7 * side);
  const double heading = random.uniform(0, 2 * std::numbers::pi);
  const double lasts = kind == Encounter::cross ? 0.0 : random.uniform(0.7, 2.5);
  const double spacing = kind == Encounter::cross ? random.uniform(0, 0.5) : random.uniform(0.7, 1.2);
  const Vector<2> ahead =
      kind == Encounter::alongside ? Vector<2>(random.uniform(2, 5) * lasts * direction(heading)) : Vector<2>(0, 0);
  const Vector<2> across = spacing * direction(heading + std::numbers::pi / 2);
  const double begin = time + between + apart;
  const double end = begin + lasts;
  double first_sign = 1;
  for (Path* path : {&a, &b}) {
    const double from = kind == Encounter::alongside ? heading + random.uniform(-1, 1) : random.uniform(0, 2 * std::numbers::pi);
    const double to = kind == Encounter::cross ? from + random.uniform(-0.2, 0.2) : random.uniform(0, 2 * std::numbers::pi);
    const double side_of = first_sign / 2;
    const Vector<2> meets = centre + side_of * across;
    const double speed = random.uniform(2, 6);
    path->push_back({begin - apart, meets - speed * apart * direction(from)});
    path->push_back({begin, meets});
    if (lasts > 0) path->push_back({end, centre + ahead + side_of * across});
    const double leaving = kind == Encounter::cross ? speed : random.uniform(2, 5);
    path->push_back({end + apart, path->back().location + leaving * apart * direction(to)});
    first_sign = -1;
  }
  return end + apart;
}

/// Where the path is at `time`, without smoothing.
Vector<2> position_at(const Path& path, double time) {
  const auto after = std::lower_bound(path.begin(), path.end(), time, [](const Waypoint& one, double t) { return one.time < t; });
  if (after == path.begin()) return path.front().location;
  if (after == path.end()) return path.back().location;
  const Waypoint& before = *(after - 1);
  return before.location + (time - before.time) / (after->time - before.time) * (after->location - before.location);
}

Vector<2> smooth_position_at(const Path& path, double time) {
  Vector<2> sum = Vector<2>::Zero();
  double weights = 0;
  for (int i = -12; i <= 12; ++i) {
    const double sigmas = i / 4.0;
    const double weight = std::exp(-sigmas * sigmas / 2);
    sum += weight * position_at(path, time + sigmas * ptz);
    weights += weight;
  }
  return sum / weights;
}

/// Who is nearer than `merged` to another is seen with it as one: groups by chains of such.
std::vector<Vector<2>> blend(const std::vector<Vector<2>>& locations, double merged) {
  std::vector<Vector<2>> blended;
  std::vector<char> done(locations.size(), 0);
  for (std::size_t i = 0; i < locations.size(); ++i) {
    if (done[i]) continue;
    std::vector<std::size_t> group{i};
    done[i] = 1;
    Vector<2> sum = Vector<2>::Zero();
    for (std::size_t next = 0; next < group.size(); ++next) {
      sum += locations[group[next]];
      for (std::size_t j = 0; j < locations.size(); ++j) {
        if (done[j] || (locations[j] - locations[group[next]]).norm() >= merged) continue;
        done[j] = 1;
        group.push_back(j);
      }
    }
    blended.push_back(sum / static_cast<double>(group.size()));
  }
  return blended;
}

std::vector<Observation<2>> observe(Random& random, const std::vector<Vector<2>>& locations, double noise,
                                    const EncounterOptions& options) {
  std::vector<Observation<2>> detected;
  const auto add = [&](const Vector<2>& location) {
    Observation<2>& one = detected.emplace_back();
    one.value = location;
    one.covariance = noise * noise * Matrix<2>::Identity();
    one.score = 0.9;
  };
  for (const Vector<2>& location : blend(locations, options.merged)) {
    const Vector<2> error = random.gaussian_pair(noise);
    if (!random.chance(options.missed)) add(location + error);
  }
  double rest = options.clutter;
  for (; rest > 0; --rest) {
    if (random.chance(rest)) add({random.uniform(0, options.side), random.uniform(0, options.side)});
  }
  for (std::size_t i = detected.size(); i > 1; --i)
    std::swap(detected[i - 1], detected[random.integer(0, static_cast<int>(i) - 1)]);
  return detected;
}

}  // namespace

EncounterScene simulate_encounters(std::uint64_t seed, const EncounterOptions& options) {
  Random random(seed);
  EncounterScene scene{options, random.uniform(options.min_noise, options.max_noise), {}, {}};
  std::vector<Path> paths(2 * static_cast<std::size_t>(options.pairs));
  double end = 0;
  for (std::size_t i = 0; i < paths.size(); i += 2) {
    double time = random.uniform(-1, 1);
    for (int close_encounter = 0; close_encounter < options.close_encounters; ++close_encounter)
      time = meet(random, time, options, paths[i], paths[i + 1]);
    end = std::max(end, time);
  }
  const int frames = static_cast<int>(end * options.rate_hz);
  for (int frame = 0; frame < frames; ++frame) {
    std::vector<Vector<2>>& locations = scene.truth.emplace_back();
    for (const Path& path : paths) locations.push_back(smooth_position_at(path, frame / options.rate_hz));
    scene.detected.push_back(observe(random, locations, scene.noise, options));
  }
  return scene;
}

}  // namespace marey::simulate
