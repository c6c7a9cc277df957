// When a waved wand was seen enough: the criterion of calibrate/wand/wand_coverage.h on simulated rooms, by what results from the
// calibration at that instant beside one by a whole minute. Arguments: cameras (3), trials (40), Hz (60), first seed (1).
#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <optional>
#include <string>
#include <vector>

#include <Eigen/Geometry>
#include <fmt/core.h>

#include "marey/calibrate/wand/wand.h"
#include "marey/calibrate/wand/wand_coverage.h"
#include "marey/core/error.h"
#include "marey/geometry/median.h"
#include "marey/simulate/room/room.h"

namespace {

using namespace marey;
using calibrate::wand::WandCoverage;

constexpr double kWhole = 60, kInspectEvery = 2;  // s

struct Waved {
  calibrate::wand::WandInput input;
  Rig truth;
  double rate_hz = 60;
};

Waved waved(int cameras, double rate_hz, std::uint64_t seed, bool lenses) {
  simulate::room::RoomOptions room;
  room.motion = simulate::room::RoomMotion::wand;
  room.cameras = cameras;
  room.rate_hz = rate_hz;
  room.frames = static_cast<std::int64_t>(kWhole * rate_hz);
  room.seed = seed;
  const simulate::room::RoomScene scene(room);
  Waved all{.input = {}, .truth = scene.rig(), .rate_hz = rate_hz};
  all.input.rig = scene.rig();
  all.input.wand.distances = room.wand;
  for (RigCamera& camera : all.input.rig.cameras) {
    if (!lenses) camera.lens.reset();
    camera.camera_from_world.reset();
    camera.offset_s.reset();
  }
  all.input.detected.resize(all.input.rig.cameras.size());
  for (std::int64_t i = 0; i < room.frames; ++i) {
    const simulate::room::RoomFrame frame = scene.frame(i);
    for (std::size_t c = 0; c < frame.detected.size(); ++c) {
      calibrate::wand::BlobFrame blobs{frame.time_s, {}};
      for (const simulate::room::RoomBlob& blob : frame.detected[c]) blobs.blobs.push_back(blob.pixel);
      all.input.detected[c].push_back(std::move(blobs));
    }
  }
  return all;
}

/// When it is said to be enough, s.
double enough_after(const Waved& all) {
  const bool lenses_known = all.input.rig.cameras.front().lens.has_value();
  WandCoverage coverage(all.input.wand, all.input.detected.size(), lenses_known);
  const auto step = static_cast<std::size_t>(kInspectEvery * all.rate_hz);
  for (std::size_t at = 0; at + step <= all.input.detected.front().size(); at += step) {
    std::vector<WandCoverage::Detected> detected;
    for (std::size_t c = 0; c < all.input.detected.size(); ++c)
      detected.push_back(
          {std::span(all.input.detected[c]).subspan(at, step), all.input.rig.cameras[c].lens, *all.input.rig.cameras[c].size});
    coverage.add(detected, 0.5 / all.rate_hz);
    if (coverage.images().is_enough()) return static_cast<double>(at + step) / all.rate_hz;
  }
  return kWhole;
}

/// The worst camera's place, mm, after the rigs are laid onto each other; nothing, and why, where no rig results from it.
std::optional<double> off_mm(const Waved& all, double seconds, std::string& why) {
  calibrate::wand::WandInput input = all.input;
  for (auto& frames : input.detected) frames.resize(std::min(frames.size(), static_cast<std::size_t>(seconds * all.rate_hz)));
  try {
    const Rig found = calibrate::wand::calibrate_wand(input).rig;
    Eigen::Matrix3Xd a(3, found.cameras.size()), b = a;
    for (std::size_t c = 0; c < found.cameras.size(); ++c) {
      a.col(static_cast<Eigen::Index>(c)) = found.cameras[c].camera_from_world->inverse().translation;
      b.col(static_cast<Eigen::Index>(c)) = all.truth.cameras[c].camera_from_world->inverse().translation;
    }
    const Eigen::Matrix4d motion = Eigen::umeyama(a, b, false);
    const Eigen::Matrix3Xd moved = (motion.topLeftCorner<3, 3>() * a).colwise() + Eigen::Vector3d(motion.topRightCorner<3, 1>());
    return 1000 * (moved - b).colwise().norm().maxCoeff();
  } catch (const Error& error) {
    why = error.what();
    return std::nullopt;
  }
}

void assess(int cameras, int trials, double rate_hz, std::uint64_t first, bool lenses) {
  int failed = 0, much_worse = 0, never = 0;
  std::vector<double> after, then, whole;
  for (int trial = 0; trial < trials; ++trial) {
    const Waved all = waved(cameras, rate_hz, first + static_cast<std::uint64_t>(trial), lenses);
    const double seconds = enough_after(all);
    std::string why, ignored;
    const auto early = off_mm(all, seconds, why), late = off_mm(all, kWhole, ignored);
    const bool worse = early && late && *early > 3 * *late && *early > 1;
    fmt::print("  seed {:>3}  {:>4.0f} s  {:>8.2f} mm  {:>8.2f} mm  {}\n", first + static_cast<std::uint64_t>(trial), seconds,
               early.value_or(NAN), late.value_or(NAN), early ? (worse ? "much worse" : "") : why);
    std::fflush(stdout);
    failed += early ? 0 : 1;
    much_worse += worse ? 1 : 0;
    never += seconds >= kWhole ? 1 : 0;
    after.push_back(seconds);
    if (early) then.push_back(*early);
    if (late) whole.push_back(*late);
  }
  fmt::print(
      "{} cameras, {:g} Hz, lenses {}: {} of {} failed, {} were more than 3 times as far off as after {:g} s (and 1 mm), {} were "
      "never enough; enough after {:.0f} s, off by {:.2f} mm then and {:.2f} mm at last (medians)\n",
      cameras, rate_hz, lenses ? "given" : "not given", failed, trials, much_worse, kWhole, never, geometry::median_or(after, NAN),
      geometry::median_or(then, NAN), geometry::median_or(whole, NAN));
}

}  // namespace

int main(int count, char** arguments) {
  const auto number = [&](int at, int typical) { return count > at ? std::atoi(arguments[at]) : typical; };
  const int cameras = number(1, 3), trials = number(2, 40), rate_hz = number(3, 60), first = number(4, 1);
  for (const bool lenses : {true, false}) assess(cameras, trials, rate_hz, static_cast<std::uint64_t>(first), lenses);
}
