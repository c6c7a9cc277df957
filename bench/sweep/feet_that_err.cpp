// A football match seen by six cameras that are known by homographies alone, each off by smooth errors, whose boxes end beside the
// feet for half a second at a time: live tracking against the whole recording, and learned camera properties against
// the truth.
//   feet_that_err [--seeds N] [--first SEED] [--seconds S] [--rate HZ] [--foot-error M] [--along SHARE] [--edges SHARE] [--least M]
//   [--most M] [--length M] [--width M] [--sides] [--only WAY]
#include <cmath>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include "marey/files/whole_file.h"
#include "marey/format/match/ground_file.h"
#include "marey/format/rig/rig_file.h"
#include "marey/pipeline/corridor/clock.h"
#include "marey/pipeline/simulate/match_files.h"
#include "marey/reconstruct/place_people.h"
#include "marey/simulate/match/match_homographies.h"
#include "marey/track/ground/camera_bias.h"

#include "experiments/markdown_table.h"
#include "ground_scene.h"

namespace marey::sweep {
namespace {

constexpr double kMaxDistance = 1.5;     // m from the truth, where a track counts
constexpr double kAlone = 4, kNear = 2;  // m: a person alone within the one owns all detections within the other
constexpr double kLag = 0.1;             // s

struct Scene {
  pipeline::simulate::MatchFilesOptions files;
  double minimum = 0.25, maximum = 0.6;  ///< m, of each camera, root mean square: far more at the corners
};

void write_scene(const Scene& scene, const std::string& folder) {
  pipeline::simulate::write_match(scene.files, folder);
  if (scene.maximum == 0) return;
  const Rig rig = format::rig::read_rig(folder + "/rig.toml");
  WholeFile file(folder + "/rig.toml");
  file.write(format::rig::rig_text(
      simulate::match::known_by_homographies(rig, scene.files.cameras.pitch, scene.minimum, scene.maximum, scene.files.seed)));
  file.finish();
}

/// What the cameras see, placed.
std::vector<track::ground::GroundInstant> instants_of(const std::string& folder) {
  const Rig rig = format::rig::read_rig(folder + "/rig.toml");
  pipeline::corridor::Clock clock(pipeline::corridor::open_feeds(rig, {}));
  std::vector<track::ground::GroundInstant> instants;
  while (const auto frames = clock.next()) {
    std::vector<reconstruct::LocatedPeople> located(frames->cameras.size());
    std::vector<track::ground::CameraObservations> views;
    for (std::size_t i = 0; i < frames->cameras.size(); ++i) {
      if (!frames->cameras[i] || !frames->cameras[i]->detections) continue;
      const CameraId id{static_cast<int>(i)};
      located[i] =
          reconstruct::localise_people(*frames->cameras[i]->detections, rig.cameras[i].ground_view(rig.ground).value(), id);
      views.push_back({id, frames->time, located[i].detected});
    }
    instants.emplace_back(static_cast<std::int32_t>(frames->index), frames->time, views);
  }
  return instants;
}

/// Who is alone at an instant, and what each camera sees of them: by person, then by camera.
using Alone = std::map<int, std::map<int, Vector<2>>>;

Alone alone_at(const track::ground::GroundInstant& instant, const std::vector<Sample>& truth,
               const track::ground::CameraBias& agreement) {
  Alone alone;
  for (const Sample& one : truth) {
    const Vector<2> location = one.position.head<2>();
    bool crowded = false;
    for (const Sample& other : truth)
      crowded = crowded || (other.track != one.track && (other.position.head<2>() - location).norm() < kAlone);
    if (crowded) continue;
    for (const track::ground::CameraObservations& view : instant.cameras) {
      double nearest = kNear;
      for (const Observation<2>& detected : view.detected) {
        const Vector<2> at = agreement.corrected(detected).value;
        if ((at - location).norm() >= nearest) continue;
        nearest = (at - location).norm();
        alone[number(one.track)][number(view.camera)] = at;
      }
    }
  }
  return alone;
}

struct Disagreement {
  double lasting = 0;  ///< m per axis and camera, of what is the same a tenth of a second later
  double whole = 0;    ///< likewise, of single frames
};

/// What cameras truly disagree by once they are corrected, from people who stand alone.
Disagreement true_disagreement(const std::vector<track::ground::GroundInstant>& instants, const Recording& truth,
                               const track::ground::CameraBias& agreement) {
  std::vector<Alone> alone;
  InstantsOf truths(truth);
  for (std::size_t k = 0; k < instants.size(); ++k) {
    const auto now = truths.next();
    if (!now) break;
    alone.push_back(alone_at(instants[k], now->samples, agreement));
  }
  const double step = instants.size() > 1 ? seconds(instants[1].time - instants[0].time) : kLag;
  const auto lag = static_cast<std::size_t>(std::max(1L, std::lround(kLag / step)));
  double lasting = 0, whole = 0, count = 0;
  for (std::size_t k = 0; k + lag < alone.size(); ++k) {
    for (const auto& [person, now] : alone[k]) {
      const auto found = alone[k + lag].find(person);
      if (found == alone[k + lag].end()) continue;
      for (auto a = now.begin(); a != now.end(); ++a) {
        for (auto b = std::next(a); b != now.end(); ++b) {
          const auto later_a = found->second.find(a->first), later_b = found->second.find(b->first);
          if (later_a == found->second.end() || later_b == found->second.end()) continue;
          const Vector<2> first = b->second - a->second, second = later_b->second - later_a->second;
          lasting += first.dot(second), whole += first.squaredNorm(), count += 1;
        }
      }
    }
  }
  // Of two axes and two cameras.
  return {std::sqrt(std::max(0.0, lasting / count / 4)), std::sqrt(whole / count / 4)};
}

pipeline::people::ground::PeopleOnGroundOptions live(const geometry::PitchSize& pitch) {
  pipeline::people::ground::PeopleOnGroundOptions options;
  options.pitch = pitch;
  options.live = true;
  return options;
}

/// As the program has it for boxes.
pipeline::people::ground::PeopleOnGroundOptions offline(const geometry::PitchSize& pitch) {
  pipeline::people::ground::PeopleOnGroundOptions options;
  options.pitch = pitch;
  options.tracker.associate = track::ground::GroundAssociation::mht;
  options.learn.association = true;
  return options;
}

void print_learned(const std::string& folder) {
  const std::vector<track::ground::GroundInstant> instants = instants_of(folder);
  const Recording truth = format::match::read_ground(folder + "/truth.csv");
  const auto agreement = track::ground::CameraBias::learn(instants, 6);
  const Disagreement before = true_disagreement(instants, truth, {}), after = true_disagreement(instants, truth, agreement);
  Observation<2> one;
  one.covariance = Matrix<2>::Identity();
  std::string noise;
  for (int camera = 0; camera < 6; ++camera) {
    one.camera = CameraId{camera};
    noise += fmt::format(" {:.2f}", std::sqrt(agreement.corrected(one).covariance.value()(0, 0)));
  }
  fmt::print(
      "noise{}; lasting disagreement of each camera: learned {:.3f} m, true {:.3f} m (single frames {:.3f}; uncorrected {:.3f}, "
      "{:.3f})\n",
      noise, agreement.disagreement().value_or(0), after.lasting, after.whole, before.lasting, before.whole);
}

void run(Scene scene, int first, int seeds, const std::string& only) {
  print_titles();
  for (int seed = first; seed < first + seeds; ++seed) {
    const ScratchFolder folder;
    scene.files.seed = static_cast<std::uint64_t>(seed);
    write_scene(scene, folder.path());
    const auto row = [&](const std::string& name, const pipeline::people::ground::PeopleOnGroundOptions& options) {
      if (only.empty() || only == name) print_scores(seed, name, run_ours(folder.path(), options, kMaxDistance));
    };
    row("live", live(scene.files.cameras.pitch));
    row("offline", offline(scene.files.cameras.pitch));
    pipeline::people::ground::PeopleOnGroundOptions plain = offline(scene.files.cameras.pitch);
    plain.learn.agreement = false;
    row("offline, cameras not learned", plain);
    if (only.empty() || only == "learned") print_learned(folder.path());
    std::fflush(stdout);
  }
}

}  // namespace
}  // namespace marey::sweep

int main(int count, char** words) {
  int seeds = 2, first = 1;
  double edges = 0.05;
  std::string only;
  marey::sweep::Scene scene;
  scene.files.seconds = 90;
  scene.files.detector.foot_error = 0.25;
  CLI::App app("A match, by cameras that are known by homographies, with boxes that err for a while");
  app.add_option("--seeds", seeds, "how many")->capture_default_str();
  app.add_option("--first", first, "the first of them")->capture_default_str();
  app.add_option("--seconds", scene.files.seconds)->capture_default_str();
  app.add_option("--rate", scene.files.cameras.rate_hz, "Hz")->capture_default_str();
  app.add_option("--foot-error", scene.files.detector.foot_error, "m")->capture_default_str();
  app.add_option("--along", scene.files.detector.foot_along, "share of its variance along the view")->capture_default_str();
  app.add_option("--edges", edges, "noise of each edge of a box, of its height or width")->capture_default_str();
  app.add_option("--least", scene.minimum, "m, that a camera is off, at least")->capture_default_str();
  app.add_option("--most", scene.maximum, "m, at most; 0: cameras are exact")->capture_default_str();
  bool sides = false;
  app.add_flag("--sides", sides, "cameras behind both touchlines in place of round the pitch");
  app.add_option("--length", scene.files.cameras.pitch.length, "of the pitch, m")->capture_default_str();
  app.add_option("--width", scene.files.cameras.pitch.width, "m")->capture_default_str();
  app.add_option("--only", only, "what is compared");
  CLI11_PARSE(app, count, words);
  if (sides) scene.files.cameras.stand = marey::simulate::match::MatchStand::sides;
  scene.files.detector.size_noise = edges * std::sqrt(2.0);
  marey::sweep::run(scene, first, seeds, only);
}
