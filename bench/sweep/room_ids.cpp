// IDs of markers that live cameras observe in a simulated room whose images are played to and fro, so that every motion turns back
// within one frame, as `sim://room?drawn=S` plays them.
//
//   room_ids [--space] [--blobs] [--motion NAME] [--rate HZ] [--markers N] [--drawn S] [--seconds S] [--seeds N] [--list]
//
// One camera's image, or with --space four cameras. For each kind of scene: markers that are visible at any time; IDs that are
// reported; of these, IDs that leap by more than 60 px (0.3 m) from one frame to the next; samples outside the image; the share of
// samples of each ID that lie on the marker on which most of them lie; the share of visible markers that have a measured sample;
// of predicted samples, the median and the 95th percentile of the error, px (mm).
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <deque>
#include <map>
#include <set>
#include <string>
#include <vector>

#include <CLI/CLI.hpp>

#include "marey/detect/markers/marker_detector.h"
#include "marey/pipeline/markers/markers_in_space.h"
#include "marey/simulate/random.h"
#include "marey/simulate/room/room.h"
#include "marey/simulate/room/room_video.h"
#include "marey/track/roster/roster_tracker.h"

namespace {

using namespace marey;
using simulate::room::RoomScene;

struct Kind {
  std::string motion;
  double rate_hz;
  int markers;
};

struct Setup {
  bool space = false, blobs = false, list = false;
  double drawn_s = 1, seconds = 10;
};

/// What is reported of one track at one instant.
struct Reported {
  int id = 0;
  Vector<3> location = Vector<3>::Zero();
  bool measured = false;
};

/// True places of the markers at one instant, those that can be seen.
struct Truth {
  std::vector<Vector<3>> locations;
  std::vector<bool> visible;
};

class Assessor {
 public:
  Assessor(double reach, double leap) : reach_(reach), leap_(leap) {}

  void observe_frame(const Truth& truth, const std::vector<Reported>& reported, const cv::Size& image, bool list) {
    visible_.resize(truth.locations.size(), 0);
    std::set<std::size_t> found;
    for (std::size_t m = 0; m < truth.locations.size(); ++m) visible_[m] += truth.visible[m];
    std::map<int, Reported> now;
    for (const Reported& one : reported) {
      now[one.id] = one;
      ids_.insert(one.id);
      const auto before = before_.find(one.id);
      if (before != before_.end() && (before->second.location - one.location).norm() > leap_) {
        leapt_.insert(one.id);
        ++leaps_;
        if (list)
          std::printf("    frame %d: %d leaps by %.1f, %s to %s\n", frame_, one.id, (before->second.location - one.location).norm(),
                      before->second.measured ? "measured" : "predicted", one.measured ? "measured" : "predicted");
      }
      if (!image.empty() && !cv::Rect2d(-0.5, -0.5, image.width, image.height).contains({one.location.x(), one.location.y()}))
        ++outside_;
      std::size_t nearest = 0;
      for (std::size_t m = 1; m < truth.locations.size(); ++m) {
        if ((truth.locations[m] - one.location).squaredNorm() < (truth.locations[nearest] - one.location).squaredNorm())
          nearest = m;
      }
      if (one.measured) {
        if ((truth.locations[nearest] - one.location).norm() > reach_) continue;
        ++on_[one.id][nearest];
        if (truth.visible[nearest]) found.insert(nearest);
        home_[one.id] = nearest;
      } else {
        ++predicted_;
        if (home_.contains(one.id)) errors_.push_back((truth.locations[home_[one.id]] - one.location).norm());
      }
    }
    reported_ += std::ssize(found);
    before_ = std::move(now);
    ++frame_;
  }

  void print(const Kind& kind) const {
    std::int64_t visible = 0, all = 0, maximum = 0;
    int markers = 0;
    for (const int frames : visible_) visible += frames, markers += frames > 2;
    for (const auto& [id, on] : on_) {
      int best = 0;
      for (const auto& [marker, frames] : on) all += frames, best = std::max(best, frames);
      maximum += best;
    }
    auto errors = errors_;
    std::sort(errors.begin(), errors.end());
    const auto quantile = [&](double q) {
      return errors.empty() ? 0 : errors[static_cast<std::size_t>(q * (std::ssize(errors) - 1.0))];
    };
    std::printf("%-7s %4.0f Hz %3d %7d %5zu %6zu %6d %8d %8.3f %8.3f %8d %8.1f %8.1f\n", kind.motion.c_str(), kind.rate_hz,
                kind.markers, markers, ids_.size(), leapt_.size(), leaps_, outside_,
                all > 0 ? static_cast<double>(maximum) / static_cast<double>(all) : 0,
                visible > 0 ? static_cast<double>(reported_) / static_cast<double>(visible) : 0, predicted_, quantile(0.5),
                quantile(0.95));
    std::fflush(stdout);
  }

 private:
  double reach_, leap_;
  int frame_ = 0, leaps_ = 0, outside_ = 0, predicted_ = 0;
  std::vector<int> visible_;
  std::set<int> ids_, leapt_;
  std::map<int, Reported> before_;
  std::map<int, std::map<std::size_t, int>> on_;
  std::map<int, std::size_t> home_;
  std::vector<double> errors_;
  std::int64_t reported_ = 0;
};

/// What every camera detects at one of the instants that are drawn.
struct Drawn {
  double time_s = 0;
  std::vector<cv::Mat> images;  // none for blobs
};

std::vector<Detection> blobs_of(const RoomScene& scene, int camera, double t, std::uint64_t draw) {
  std::vector<Detection> detections;
  for (const auto& blob : scene.observed_by(camera, t, draw)) {
    Detection& detection = detections.emplace_back();
    detection.centre = blob.pixel;
  }
  return detections;
}

class Run {
 public:
  Run(const Kind& kind, std::uint64_t seed, const Setup& setup)
      : setup_(setup), scene_(options_of(kind, seed, setup)), kind_(kind) {
    const int count = static_cast<int>(std::lround(setup.drawn_s * kind.rate_hz));
    for (int i = 0; i < count; ++i) {
      Drawn& one = drawn_.emplace_back();
      one.time_s = i / kind.rate_hz;
      for (int c = 0; !setup.blobs && c < cameras(); ++c) {
        const auto draw = static_cast<std::uint64_t>(i);
        one.images.push_back(
            draw_room(scene_, static_cast<std::size_t>(c), one.time_s, scene_.observed_by(c, one.time_s, draw), draw));
      }
    }
  }

  void print() {
    Assessor assess(setup_.space ? 0.03 : 5.0, setup_.space ? 0.3 : 60.0);
    setup_.space ? track_in_space(assess) : track_in_image(assess);
    assess.print(kind_);
  }

 private:
  static simulate::room::RoomOptions options_of(const Kind& kind, std::uint64_t seed, const Setup& setup) {
    simulate::room::RoomOptions options;
    options.image = {640, 480};
    options.cameras = 4;
    options.markers = kind.markers;
    options.rate_hz = kind.rate_hz;
    options.seed = seed;
    for (const auto& each : simulate::room::room_motions()) {
      if (each.name == kind.motion) options.motion = each.motion;
    }
    if (!setup.blobs) options.noise_px = 0;
    return options;
  }

  int cameras() const { return setup_.space ? 4 : 1; }
  std::int64_t frames() const { return std::llround(setup_.seconds * kind_.rate_hz); }

  std::size_t at(std::int64_t frame) const {
    const auto count = std::ssize(drawn_), turn = std::max<std::int64_t>(1, 2 * count - 2), at = frame % turn;
    return static_cast<std::size_t>(at < count ? at : turn - at);
  }

  void track_in_image(Assessor& assess) {
    detect::markers::MarkerDetector detector{detect::markers::MarkerOptions{}};
    track::roster::RosterTrackerOptions options;
    const cv::Size size = scene_.options().image;
    options.image = Box{-0.5, -0.5, static_cast<double>(size.width), static_cast<double>(size.height)};
    const auto tracker = track::roster::make_roster_tracker<2>(options);
    const auto camera = scene_.rig().cameras[0].camera();
    for (std::int64_t i = 0; i < frames(); ++i) {
      const Drawn& drawn = drawn_[at(i)];
      const Timestamp now = timestamp_from_seconds(static_cast<double>(i) / kind_.rate_hz);
      std::vector<Observation<2>> detected;
      if (setup_.blobs) {
        for (const Detection& one : blobs_of(scene_, 0, drawn.time_s, static_cast<std::uint64_t>(i)))
          detected.push_back(observation_of(one));
      } else {
        std::vector<Expected> expected;
        for (const Track<2>& track : tracker->expected(now)) {
          if (track.box) expected.push_back({*track.box});
        }
        const Frame frame{CameraId{}, i, now, Image(drawn.images[0])};
        for (const Detection& one : detector.detect(frame, expected).detections) detected.push_back(observation_of(one));
      }
      std::vector<Reported> reported;
      for (const Track<2>& track : tracker->step(now, detected)) {
        if (!track.confirmed) continue;
        const Vector<2> location =
            track.observation ? detected[static_cast<std::size_t>(*track.observation)].value : track.position;
        reported.push_back({number(track.id), {location.x(), location.y(), 0}, track.observation.has_value()});
      }
      Truth truth;
      const auto points = scene_.points(drawn.time_s);
      truth.visible = scene_.visible(0, drawn.time_s, points);
      for (const Vector<3>& point : points) {
        const auto pixel = camera->project(point);
        truth.locations.push_back(pixel ? Vector<3>(pixel->x(), pixel->y(), 0) : Vector<3>::Constant(1e6));
      }
      assess.observe_frame(truth, reported, size, setup_.list);
    }
  }

  void track_in_space(Assessor& assess) {
    pipeline::markers::MarkersInSpaceOptions options;
    options.live = true;
    const auto stage = pipeline::markers::markers_in_space(scene_.rig(), kind_.rate_hz, options);
    std::deque<detect::markers::MarkerDetector> detectors;
    for (int c = 0; c < cameras(); ++c) detectors.emplace_back(detect::markers::MarkerOptions{});
    for (std::int64_t i = 0; i < frames(); ++i) {
      const Drawn& drawn = drawn_[at(i)];
      FrameSet set;
      set.index = i;
      set.time = timestamp_from_seconds(static_cast<double>(i) / kind_.rate_hz);
      for (int c = 0; c < cameras(); ++c) {
        CameraFrame& given = set.cameras.emplace_back().emplace();
        given.frame = {CameraId{c}, i, set.time, {}};
        if (setup_.blobs) {
          given.detections = blobs_of(scene_, c, drawn.time_s, static_cast<std::uint64_t>(i));
        } else {
          Frame frame = given.frame;
          frame.image = Image(drawn.images[static_cast<std::size_t>(c)]);
          given.detections = detectors[static_cast<std::size_t>(c)].detect(frame, {}).detections;
        }
        set.states.push_back(FeedState::live);
      }
      Truth truth;
      truth.locations = scene_.points(drawn.time_s);
      std::vector<int> by(truth.locations.size(), 0);
      for (int c = 0; c < cameras(); ++c) {
        const auto visible = scene_.visible(c, drawn.time_s, truth.locations);
        for (std::size_t m = 0; m < by.size(); ++m) by[m] += visible[m];
      }
      for (const int count : by) truth.visible.push_back(count >= 3);
      for (const Instant& instant : stage->step(set)) {
        std::vector<Reported> reported;
        for (const Sample& sample : instant.samples) reported.push_back({number(sample.track), sample.position, sample.measured()});
        assess.observe_frame(truth, reported, {}, setup_.list);
      }
    }
  }

  Setup setup_;
  RoomScene scene_;
  Kind kind_;
  std::vector<Drawn> drawn_;
};

}  // namespace

int main(int count, char** words) {
  Setup setup;
  std::string motion;
  double rate = 0;
  int markers = 0, seeds = 1;
  CLI::App app("IDs of markers before live cameras whose motion turns back");
  app.add_flag("--space", setup.space);
  app.add_flag("--blobs", setup.blobs);
  app.add_flag("--list", setup.list);
  app.add_option("--motion", motion);
  app.add_option("--rate", rate);
  app.add_option("--markers", markers);
  app.add_option("--drawn", setup.drawn_s);
  app.add_option("--seconds", setup.seconds);
  app.add_option("--seeds", seeds);
  CLI11_PARSE(app, count, words);
  std::vector<Kind> kinds{{"walk", 60, 15},  {"walk", 60, 40}, {"walk", 25, 40},  {"run", 120, 40}, {"wave", 60, 40},
                          {"kneel", 60, 40}, {"roll", 60, 40}, {"cloud", 60, 40}, {"wand", 60, 3}};
  if (!motion.empty() || rate > 0 || markers > 0)
    kinds = {{motion.empty() ? "walk" : motion, rate > 0 ? rate : 60, markers > 0 ? markers : 40}};
  std::printf("%-7s %7s %3s %7s %5s %6s %6s %8s %8s %8s %8s %8s %8s\n", "motion", "rate", "of", "visible", "IDs", "leapt", "leaps",
              "outside", "one", "found", "predict", "median", "p95");
  for (const Kind& kind : kinds) {
    for (int seed = 1; seed <= seeds; ++seed) Run(kind, static_cast<std::uint64_t>(seed), setup).print();
  }
  return 0;
}
