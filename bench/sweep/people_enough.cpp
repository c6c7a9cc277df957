// When people who walk were seen enough: the criterion of calibrate/people/people_coverage.h on simulated rooms, by what results
// from the calibration at that instant beside one by a whole minute. Arguments: cameras (4), trials (6), first seed (1), and then
// durations in s: what results from a walk that is so short.
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include <fmt/core.h>

#include "marey/calibrate/people/people_coverage.h"
#include "marey/calibrate/people/people_rig.h"
#include "marey/core/error.h"
#include "marey/geometry/median.h"
#include "marey/simulate/room/room_keypoints.h"

namespace {

using namespace marey;
using calibrate::people::PeopleCoverage;

constexpr double kWhole = 60, kWatch = 8, kRate = 25;  // s; Hz of the network that watches; Hz

struct Walked {
  calibrate::people::PeopleInput input;
  calibrate::people::PeopleOptions how;
  Rig truth;
};

double apart(const Rig& rig, std::size_t a, std::size_t b) {
  return (rig.cameras[a].camera_from_world->inverse().translation - rig.cameras[b].camera_from_world->inverse().translation).norm();
}

Walked walked(int cameras, std::uint64_t seed) {
  simulate::room::RoomOptions room;
  room.cameras = cameras;
  room.actors = 1;
  room.rate_hz = kRate;
  room.frames = static_cast<std::int64_t>(kWhole * kRate);
  room.seed = seed;
  const simulate::room::RoomScene scene(room);
  Walked all{.input = {}, .how = {}, .truth = scene.rig()};
  for (std::size_t c = 0; c < scene.rig().cameras.size(); ++c) {
    RigCamera& unknown = all.input.rig.cameras.emplace_back();
    unknown.name = scene.rig().cameras[c].name, unknown.size = scene.rig().cameras[c].size, unknown.offset_s = 0;
    all.input.cameras.push_back({keypoints_of_camera(scene, static_cast<int>(c)), kRate, {}});
  }
  all.how.distance =
      calibrate::wand::KnownDistance{scene.rig().cameras[0].name, scene.rig().cameras[1].name, apart(scene.rig(), 0, 1)};
  return all;
}

/// When it is said to be enough, s.
double enough_after(const Walked& all) {
  PeopleCoverage coverage(all.input.cameras.size());
  for (int k = 0; k < kWhole * kWatch; ++k) {
    const auto frame = static_cast<std::size_t>(k / kWatch * kRate);
    std::vector<PeopleCoverage::View> seen;
    for (std::size_t c = 0; c < all.input.cameras.size(); ++c) {
      const auto& frames = all.input.cameras[c].sequence.frames;
      seen.push_back({frame < frames.size() ? std::span<const Keypoints<2>>(frames[frame]) : std::span<const Keypoints<2>>(),
                      *all.input.rig.cameras[c].size});
    }
    coverage.add(seen);
    if (coverage.images().is_enough()) return (k + 1) / kWatch;
  }
  return kWhole;
}

/// The worst distance between two cameras, relative; nothing, and why, where no rig results.
std::optional<double> off(const Walked& all, double seconds, std::string& why) {
  calibrate::people::PeopleInput input = all.input;
  for (auto& camera : input.cameras)
    camera.sequence.frames.resize(std::min(camera.sequence.frames.size(), static_cast<std::size_t>(seconds * kRate)));
  try {
    const Rig found = calibrate::people::calibrate_people(input, all.how).rig;
    double worst = 0;
    for (std::size_t a = 0; a < found.cameras.size(); ++a) {
      for (std::size_t b = a + 1; b < found.cameras.size(); ++b)
        worst = std::max(worst, std::abs(apart(found, a, b) / apart(all.truth, a, b) - 1));
    }
    return worst;
  } catch (const Error& error) {
    why = error.what();
    return std::nullopt;
  }
}

}  // namespace

int main(int count, char** arguments) {
  const auto number = [&](int at, int typical) { return count > at ? std::atoi(arguments[at]) : typical; };
  const int cameras = number(1, 4), trials = number(2, 6), first = number(3, 1);
  std::vector<double> after, then, whole;
  std::map<double, std::vector<double>> walks;  // by duration
  for (int at = 4; at < count; ++at) walks[std::atof(arguments[at])];
  for (int seed = first; seed < first + trials; ++seed) {
    const Walked all = walked(cameras, static_cast<std::uint64_t>(seed));
    const double seconds = enough_after(all);
    std::string why;
    const auto early = off(all, seconds, why), late = off(all, kWhole, why);
    fmt::print("seed {:>3}: enough after {:>3.0f} s; distances off by {:.1f} % then, {:.1f} % after {:g} s {}\n", seed, seconds,
               100 * early.value_or(NAN), 100 * late.value_or(NAN), kWhole, why);
    std::fflush(stdout);
    after.push_back(seconds);
    if (early) then.push_back(*early);
    if (late) whole.push_back(*late);
    for (auto& [lasts, distances] : walks) {
      std::string reason;
      distances.push_back(off(all, lasts, reason).value_or(NAN));
      fmt::print("          after {:g} s: {:.1f} % {}\n", lasts, 100 * distances.back(), reason);
      std::fflush(stdout);
    }
  }
  fmt::print("medians: {:.0f} s; {:.1f} %, {:.1f} %\n", geometry::median_or(after, NAN), 100 * geometry::median_or(then, NAN),
             100 * geometry::median_or(whole, NAN));
  for (auto& [lasts, distances] : walks) {
    const auto refused = std::erase_if(distances, [](double d) { return std::isnan(d); });
    fmt::print("{:g} s: median {:.1f} %, worst {:.1f} %, {} of {} without a rig\n", lasts,
               100 * geometry::median_or(distances, NAN),
               100 * (distances.empty() ? NAN : *std::max_element(distances.begin(), distances.end())), refused, trials);
  }
}
