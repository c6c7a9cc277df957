// Who left the image and came back: simulated people, twelve at a time, go out at the sides of the image for 2 to 10 s, one in
// six permanently, and another person comes instead. Every person wears clothes of their own, or the kits of two teams. Of all who
// come back after 2 to 10 s: the share that has the number from before, and that has a number that was another person's; of
// newcomers, likewise the latter. A visit counts from half a second on, of a person whose number agrees with the truth by half of
// the box, and a number from the sixth frame on for which it is given.
//   returns [--frames 1500] [--seeds 2] [--first-seed 1] [--plain] [--sweep]
#include <algorithm>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <set>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>

#include "marey/core/geometry.h"
#include "marey/detect/appearance.h"
#include "marey/detect/detectors.h"
#include "marey/geometry/box.h"
#include "marey/simulate/people/people_video.h"
#include "marey/track/offline/join.h"
#include "marey/track/offline/tracklet_log.h"
#include "marey/track/tracker.h"

namespace marey {
namespace {

using simulate::people::PeopleSituation;
using simulate::people::PeopleVideo;
using simulate::people::PeopleVideoOptions;

constexpr double kObserved = 0.5;             // of a person within the image, from which on it is there
constexpr double kMinVisit = 0.5;             // s
constexpr double kSoonest = 2, kLatest = 10;  // s away
constexpr int kSlip = 5;                      // frames
constexpr double kOverlap = 0.5;              // intersection over union

struct TrueRow {
  int id = 0;
  Box box;
};

/// A video as the second pass gets it: what the tracker said, and the truth.
struct Recorded {
  track::offline::TrackletLog log;
  std::vector<std::vector<TrueRow>> truth;
  cv::Size size;
  double rate_hz = 25;
};

std::vector<track::image::Clothes> clothes_of(const Frame& frame, const detect::Detections& detected) {
  std::vector<track::image::Clothes> clothes;
  for (std::size_t i = 0; i < detected.detections.size(); ++i) {
    clothes.push_back({detect::upper_body(frame.image, detected.foreground, detected.detections, i),
                       detect::lower_body(frame.image, detected.foreground, detected.detections, i),
                       detect::shanks(frame.image, detected.foreground, detected.detections, i)});
  }
  return clothes;
}

Recorded video(const PeopleVideoOptions& options, PeopleSituation situation, std::uint64_t seed) {
  const PeopleVideo scene(situation, seed, options);
  Recorded result;
  result.size = options.size;
  result.rate_hz = options.rate_hz;
  const auto detector = detect::make_detector(detect::people::PeopleDetectorOptions{});
  std::vector<Frame> before;
  for (int i = 0; i < PeopleVideo::kEarlier; ++i) {
    Frame& frame = before.emplace_back();
    frame.index = i;
    frame.image = scene.render_earlier(i);
  }
  detector->prime(before);
  track::TrackerOptions tracking;
  tracking.stabilised_camera = true;
  const auto tracker = track::make_tracker(tracking);
  for (int k = 0; k < scene.frames(); ++k) {
    const auto rendered = scene.render(k);
    Frame frame;
    frame.index = k;
    frame.time = timestamp_from_seconds(k / options.rate_hz);
    frame.image = rendered.image;
    std::vector<Expected> expected;
    for (const Track<2>& track : tracker->expected(frame.time)) {
      if (track.box) expected.push_back({*track.box});
    }
    const detect::Detections detected = detector->detect(frame, expected);
    std::vector<Observation<2>> observations;
    for (const Detection& one : detected.detections)
      observations.push_back({.value = one.box.centre(),
                              .covariance = one.covariance,
                              .camera = {},
                              .score = one.score,
                              .box = one.box,
                              .shared = one.group.has_value()});
    result.log.add(k, frame.time, tracker->step(frame.time, observations), clothes_of(frame, detected));
    const Box image{0, 0, 1.0 * options.size.width, 1.0 * options.size.height};
    auto& truth = result.truth.emplace_back();
    for (const auto& person : rendered.people) {
      const Box box = geometry::intersection(person.whole.box(), image);
      if (box.area() >= kObserved * person.whole.box().area()) truth.push_back({person.id, box});
    }
  }
  return result;
}

struct Visit {
  int first = 0, last = 0;     // frames
  std::map<int, int> numbers;  // the sixth frame in which each number was given to it, if there is one, or minus how many there are
  int first_number = 0, last_number = 0;  // of those that were given for longer than a slip
};

struct Score {
  int returns = 0, right = 0, wrong = 0, newcomers = 0, taken = 0, numbers = 0, people = 0;
  void add(const Score& other) {
    returns += other.returns;
    right += other.right;
    wrong += other.wrong;
    newcomers += other.newcomers;
    taken += other.taken;
    numbers += other.numbers;
    people += other.people;
  }
};

std::map<int, std::vector<Visit>> visits_of(const Recorded& video, std::span<const track::offline::TrackRow> rows) {
  std::map<int, std::vector<Visit>> visits;
  std::size_t next = 0;
  for (int frame = 0; frame < static_cast<int>(video.truth.size()); ++frame) {
    std::vector<const track::offline::TrackRow*> now;
    for (; next < rows.size() && rows[next].frame <= frame; ++next) {
      if (rows[next].frame == frame) now.push_back(&rows[next]);
    }
    for (const TrueRow& truth : video.truth[static_cast<std::size_t>(frame)]) {
      std::vector<Visit>& of = visits[truth.id];
      if (of.empty() || frame - of.back().last > 0.4 * video.rate_hz) of.push_back({frame, frame, {}, 0, 0});
      Visit& visit = of.back();
      visit.last = frame;
      double best = kOverlap;
      int number = 0;
      for (const track::offline::TrackRow* row : now) {
        const double overlap = geometry::iou({row->left, row->top, row->width, row->height}, truth.box);
        if (overlap > best) best = overlap, number = row->id;
      }
      if (number == 0) continue;
      int& given = visit.numbers[number];
      if (given <= 0 && --given < -kSlip) given = frame;
      if (given <= 0) continue;
      if (visit.first_number == 0) visit.first_number = number;
      visit.last_number = number;
    }
  }
  for (auto& [id, of] : visits)
    std::erase_if(of, [&](const Visit& visit) { return visit.last - visit.first < kMinVisit * video.rate_hz; });
  return visits;
}

/// Whether a number was given to another person, for longer than a slip, before a frame.
bool was_anothers(const std::map<int, std::vector<Visit>>& visits, int id, int number, int frame) {
  for (const auto& [other, of] : visits) {
    if (other == id) continue;
    for (const Visit& visit : of) {
      const auto found = visit.numbers.find(number);
      if (found != visit.numbers.end() && found->second > 0 && found->second < frame) return true;
    }
  }
  return false;
}

Score assess(const Recorded& video, std::span<const track::offline::TrackRow> rows) {
  Score score;
  const auto visits = visits_of(video, rows);
  std::set<int> numbers;
  for (const track::offline::TrackRow& row : rows) numbers.insert(row.id);
  score.numbers = static_cast<int>(numbers.size());
  score.people = static_cast<int>(visits.size());
  for (const auto& [id, of] : visits) {
    if (!of.empty() && of.front().first > 2 * video.rate_hz && of.front().first_number != 0) {
      ++score.newcomers;
      score.taken += was_anothers(visits, id, of.front().first_number, of.front().first);
    }
    for (std::size_t i = 1; i < of.size(); ++i) {
      const double away = (of[i].first - of[i - 1].last) / video.rate_hz;
      if (away < kSoonest || away > kLatest) continue;
      ++score.returns;
      const int before = of[i - 1].last_number, after = of[i].first_number;
      if (after == 0 || before == 0) continue;
      if (before == after) {
        ++score.right;
      } else if (was_anothers(visits, id, after, of[i].first)) {
        ++score.wrong;
      }
    }
  }
  return score;
}

/// Why who came back did not get the number from before, one line each.
void explain(const Recorded& video, std::span<const track::offline::TrackRow> rows) {
  std::map<int, std::pair<int, int>> spans;
  for (const track::offline::TrackRow& row : rows) {
    const auto [span, is_new] = spans.try_emplace(row.id, row.frame, row.frame);
    span->second.second = row.frame;
  }
  for (const auto& [id, of] : visits_of(video, rows)) {
    for (std::size_t i = 1; i < of.size(); ++i) {
      const double away = (of[i].first - of[i - 1].last) / video.rate_hz;
      const int before = of[i - 1].last_number, after = of[i].first_number;
      if (away < kSoonest || away > kLatest || (before == after && before != 0)) continue;
      fmt::print(stderr, "person {} away {:.1f} s from frame {}: #{} ({} to {}), then #{} ({} to {})\n", id, away, of[i - 1].last,
                 before, spans[before].first, spans[before].second, after, spans[after].first, spans[after].second);
    }
  }
}

struct Kind {
  std::string name;
  PeopleSituation situation = PeopleSituation::returns;
  bool own_clothes = true;
};

void print(const std::string& name, const Score& score) {
  const auto fraction = [](int part, int all) { return all > 0 ? 100.0 * part / all : 0.0; };
  fmt::print("| {} | {} | {:.1f} % | {:.1f} % | {} | {:.1f} % | {} | {} |\n", name, score.returns,
             fraction(score.right, score.returns), fraction(score.wrong, score.returns), score.newcomers,
             fraction(score.taken, score.newcomers), score.people, score.numbers);
  std::fflush(stdout);
}

struct Sweep {
  int frames = 1500, seeds = 2, first_seed = 1;
  bool plain = false, explained = false;
  double rate = 12.5, pace = 1.3;
  track::offline::ReturnOptions tried;
  std::vector<double> thresholds{2, 0.5, 0.7, 0.8, 0.9, 0.95};
};

void add_options(CLI::App& app, Sweep& sweep) {
  app.add_option("--frames", sweep.frames);
  app.add_option("--seeds", sweep.seeds);
  app.add_option("--first-seed", sweep.first_seed);
  app.add_option("--rate", sweep.rate);
  app.add_option("--pace", sweep.pace);
  app.add_flag("--explain", sweep.explained);
  app.add_flag("--plain", sweep.plain, "sharp images, as no camera records them");
  app.add_option("--least", sweep.thresholds, "minimum probabilities of a pair; 2: no pairs");
  app.add_option("--longest", sweep.tried.longest_away);
  app.add_option("--usually", sweep.tried.typically_away);
  app.add_option("--along", sweep.tried.along);
  app.add_option("--across", sweep.tried.across);
  app.add_option("--anywhere", sweep.tried.anywhere);
}

Recorded rendered(const Kind& kind, const Sweep& sweep, int seed) {
  PeopleVideoOptions options;
  options.frames = sweep.frames;
  options.people = 12;
  options.rate_hz = sweep.rate;
  options.pace = sweep.pace;
  options.own_clothes = kind.own_clothes;
  if (!sweep.plain) options.degradation = {0.6, 0.2, 1.5, 1.5, 0.5, 8};
  return video(options, kind.situation, static_cast<std::uint64_t>(seed));
}

/// For each minimum probability, the sum over the seeds.
std::vector<Score> scores(const Kind& kind, const Sweep& sweep) {
  std::vector<Score> sums(sweep.thresholds.size());
  for (int seed = sweep.first_seed; seed < sweep.first_seed + sweep.seeds; ++seed) {
    const Recorded recorded = rendered(kind, sweep, seed);
    for (std::size_t k = 0; k < sweep.thresholds.size(); ++k) {
      track::offline::JoinOptions join;
      join.view = Box{0, 0, 1.0 * recorded.size.width, 1.0 * recorded.size.height};
      join.returns = sweep.tried;
      join.returns.min_probability = sweep.thresholds[k];
      track::offline::TrackletLog log = recorded.log;
      const std::vector<track::offline::TrackRow> rows = track::offline::join(log, join);
      sums[k].add(assess(recorded, rows));
      if (sweep.explained) explain(recorded, rows);
    }
  }
  return sums;
}

}  // namespace
}  // namespace marey

int main(int argc, char** argv) {
  using namespace marey;
  CLI::App app;
  Sweep sweep;
  std::string only;
  add_options(app, sweep);
  app.add_option("--only", only, "scenes whose name contains this");
  CLI11_PARSE(app, argc, argv);
  fmt::print("| scene | returns | same number | another's | newcomers | another's | people | numbers |\n");
  fmt::print("| --- | --- | --- | --- | --- | --- | --- | --- |\n");
  for (const Kind& kind :
       {Kind{"clothes of their own", PeopleSituation::returns, true}, Kind{"two teams", PeopleSituation::returns, false},
        Kind{"no person returns, two teams", PeopleSituation::crowd, false},
        Kind{"no person returns, clothes of their own", PeopleSituation::crowd, true}}) {
    if (kind.name.find(only) == std::string::npos) continue;
    const std::vector<Score> sums = scores(kind, sweep);
    for (std::size_t k = 0; k < sums.size(); ++k) print(fmt::format("{}, from {} on", kind.name, sweep.thresholds[k]), sums[k]);
  }
}
