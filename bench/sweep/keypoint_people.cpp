// Who is who across cameras (reconstruct/keypoints/people_in_views.h): simulated people whose networks err, two to six of them a
// metre apart before four cameras, at 25 and 50 Hz, walking and running; what each constant does at a quarter to four times its
// value. A row is the sum over all scenes and seeds.
//   keypoint_people [SEEDS]
#include <algorithm>
#include <cstdlib>
#include <map>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "marey/reconstruct/keypoints/people_in_views.h"
#include "marey/simulate/room/room_keypoints.h"

namespace marey::sweep {
namespace {

namespace rk = reconstruct::keypoints;
using simulate::room::KeypointErrors;
using simulate::room::RoomMotion;
using simulate::room::RoomOptions;
using simulate::room::RoomScene;

constexpr double kNoise = 1.4;   // times what is stated, as it is learned of these errors with the slack of the job
constexpr double kSeconds = 6;   // of each scene
constexpr double kWrongM = 0.3;  // mean distance of a person's points from which on they are of no true person

/// A scene's people as the cameras' networks see them, and where they truly are.
struct Scene {
  double rate_hz = 0;
  KeypointSet set;
  int cameras = 0;
  std::vector<std::vector<rk::PersonView>> instants;
  std::vector<std::vector<std::vector<Vector<3>>>> truth;  // by instant, actor, point
};

struct Score {
  long people = 0, located = 0, changes = 0, phantoms = 0, points = 0;
  double error_m = 0;
};

Scene scene_of(int actors, RoomMotion motion, double rate_hz, std::uint64_t seed, const KeypointErrors& errors) {
  RoomOptions options;
  options.motion = motion;
  options.actors = actors;
  options.cameras = 4;
  options.markers = 4;
  options.rate_hz = rate_hz;
  options.frames = static_cast<std::int64_t>(kSeconds * rate_hz);
  options.image = {1080, 1920};
  options.volume = {2.8, 2.8, 2.5};
  options.zoom = 1.3;
  options.seed = seed;
  const RoomScene room(options);
  Scene scene{rate_hz, simulate::room::room_keypoint_set(), options.cameras, {}, {}};
  scene.instants.resize(static_cast<std::size_t>(options.frames));
  for (int c = 0; c < options.cameras; ++c) {
    const Camera camera = *room.rig().cameras[static_cast<std::size_t>(c)].camera();
    const KeypointSequence seen = simulate::room::keypoints_of_camera(room, c, errors);
    for (std::size_t t = 0; t < scene.instants.size(); ++t) {
      for (std::size_t i = 0; i < seen.frames[t].size(); ++i)
        scene.instants[t].push_back(rk::view_of(camera, c, static_cast<int>(i), seen.frames[t][i], kNoise));
    }
  }
  for (std::size_t t = 0; t < scene.instants.size(); ++t)
    scene.truth.push_back(simulate::room::true_keypoints(room, static_cast<double>(t) / rate_hz));
  return scene;
}

double distance_between(const rk::LocatedPerson& person, const std::vector<Vector<3>>& truth) {
  double sum = 0, count = 0;
  for (std::size_t i = 0; i < truth.size(); ++i) {
    if (person.points[i]) sum += std::min(1.0, (person.points[i]->position - truth[i]).norm()), ++count;
  }
  return count > 0 ? sum / count : 1;
}

void run(const Scene& scene, const rk::PeopleOptions& options, Score& score) {
  rk::PeopleInViews people(scene.set, scene.cameras, options);
  std::map<int, std::size_t> actor_of;
  for (std::size_t t = 0; t < scene.instants.size(); ++t) {
    score.people += static_cast<long>(scene.truth[t].size());
    for (const rk::LocatedPerson& person : people.step(t == 0 ? 0 : 1 / scene.rate_hz, scene.instants[t])) {
      std::size_t nearest = 0;
      for (std::size_t a = 1; a < scene.truth[t].size(); ++a) {
        if (distance_between(person, scene.truth[t][a]) < distance_between(person, scene.truth[t][nearest])) nearest = a;
      }
      const double distance = distance_between(person, scene.truth[t][nearest]);
      if (distance > kWrongM) {
        ++score.phantoms;
        continue;
      }
      ++score.located;
      score.error_m += distance;
      const auto [before, is_new] = actor_of.try_emplace(person.id, nearest);
      score.changes += !is_new && before->second != nearest;
      before->second = nearest;
    }
  }
}

struct Varied {
  const char* name;
  double rk::PeopleOptions::* option;
};

void print_row(const char* name, double value, const std::vector<Scene>& scenes, const rk::PeopleOptions& options) {
  Score score;
  for (const Scene& scene : scenes) run(scene, options, score);
  fmt::print("| `{}` | {:.3g} | {:.2f} | {} | {} | {:.1f} |\n", name, value,
             100.0 * static_cast<double>(score.located) / static_cast<double>(score.people), score.changes, score.phantoms,
             1000 * score.error_m / static_cast<double>(std::max(1L, score.located)));
}

int keypoint_people(int seeds) {
  std::vector<Scene> scenes;
  for (int seed = 1; seed <= seeds; ++seed) {
    for (const int actors : {2, 4, 6}) {
      for (const double rate : {25.0, 50.0}) {
        for (const RoomMotion motion : {RoomMotion::walk, RoomMotion::run}) {
          KeypointErrors errors;
          errors.swapped = seed % 2 == 0 ? 0.1 : 0;
          scenes.push_back(scene_of(actors, motion, rate, static_cast<std::uint64_t>(seed), errors));
        }
      }
    }
  }
  fmt::print(
      "| constant | value | placed, % | other person's number | of no person | distance, mm |\n| --- | --- | --- | --- | --- | --- "
      "|\n");
  const Varied all[] = {{"position_m", &rk::PeopleOptions::position_m}, {"position_m_s", &rk::PeopleOptions::position_m_s},
                        {"bound", &rk::PeopleOptions::bound},           {"gate", &rk::PeopleOptions::gate},
                        {"pair_gate", &rk::PeopleOptions::pair_gate},   {"swap_gain", &rk::PeopleOptions::swap_gain},
                        {"settle_s", &rk::PeopleOptions::settle_s}};
  for (const Varied& one : all) {
    for (const double factor : {0.25, 0.5, 0.71, 1.0, 1.41, 2.0, 4.0}) {
      rk::PeopleOptions options;
      options.*one.option *= factor;
      print_row(one.name, options.*one.option, scenes, options);
    }
  }
  return 0;
}

}  // namespace
}  // namespace marey::sweep

int main(int count, char** values) {
  return marey::sweep::keypoint_people(count > 1 ? std::atoi(values[1]) : 2);
}
