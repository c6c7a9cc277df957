#include "experiments/outlines.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <map>
#include <memory>
#include <mutex>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "marey/evaluate/label_loss.h"
#include "marey/evaluate/outline_overlap.h"

#include "experiments/outline_methods.h"

namespace marey::experiments {
namespace {

constexpr double kSeen = 0.5;          // share of a person that must be visible for him to count
constexpr int kLeastFrames = 25;       // who can be seen for less does not count at all
constexpr double kReachHeights = 0.5;  // a name farther than this from the person is not on him
constexpr std::array<const char*, 4> kMethods{"silhouettes", "boxes (Xu et al.)", "published (Arnaut & Costa)", "Marey"};

/// Sums of one method over one or more films; what OutlineScore tells as means.
struct Tally {
  int people = 0, lost = 0;
  std::int64_t frames = 0, followed = 0;
  double iou = 0;
  std::int64_t errors = 0, bends = 0;
  double error = 0, bend = 0;
  double seconds = 0;
  std::int64_t targets = 0;

  void add(const Tally& other) {
    people += other.people;
    lost += other.lost;
    frames += other.frames;
    followed += other.followed;
    iou += other.iou;
    errors += other.errors;
    error += other.error;
    bends += other.bends;
    bend += other.bend;
    seconds += other.seconds;
    targets += other.targets;
  }

  OutlineScore score() const {
    OutlineScore result{people, lost, frames, 0, 0, {}, {}, {}};
    if (frames > 0) {
      result.followed = static_cast<double>(followed) / static_cast<double>(frames);
      result.iou = iou / static_cast<double>(frames);
    }
    if (errors > 0) result.centre_error = error / static_cast<double>(errors);
    if (bends > 0) result.jitter = std::sqrt(bend / static_cast<double>(bends));
    if (targets > 0 && seconds > 0) result.target_us = 1e6 * seconds / static_cast<double>(targets);
    return result;
  }
};

/// The second difference of a path, where three frames in a row are known.
class Bends {
 public:
  void add(int frame, const Vector<2>& place, Tally& tally) {
    if (frame == last_ + 1 && run_ >= 2) {
      tally.bend += (place - 2 * path_[1] + path_[0]).squaredNorm();
      ++tally.bends;
    }
    run_ = frame == last_ + 1 ? run_ + 1 : 1;
    last_ = frame;
    path_ = {path_[1], place};
  }

 private:
  int last_ = -2, run_ = 0;
  std::array<Vector<2>, 2> path_{Vector<2>::Zero(), Vector<2>::Zero()};
};

bool lies_within(const simulate::people::Silhouette& silhouette, cv::Size picture) {
  return (silhouette.pixels() & cv::Rect({0, 0}, picture)) == silhouette.pixels();
}

/// Judges one method on one film.
class Judge {
 public:
  Judge(cv::Size picture, double reach) : picture_(picture), reach_(reach) {}

  void see(int frame, std::span<const simulate::people::TrueFigure> truth, std::span<const FollowedShape> shapes) {
    auto& true_places = truth_.emplace_back();
    auto& places = named_.emplace_back();
    for (const FollowedShape& shape : shapes) places.push_back({shape.name, shape.centre});
    for (const simulate::people::TrueFigure& person : truth) {
      if (person.visible_share < kSeen) continue;
      ++seen_[person.id];
      const Vector<2> centre = person.whole.centre();
      Target& target = targets_[person.id];
      if (target.name.empty()) target.name = name_on(centre, shapes);
      if (target.name.empty()) continue;
      true_places.push_back({std::to_string(person.id), centre});
      score(frame, person, centre, target, shapes);
    }
  }

  Tally finish() {
    std::map<std::string, bool> lost;
    for (const evaluate::LabelFate& fate : evaluate::judge_labels(truth_, named_, reach_)) lost[fate.marker] = fate.lost();
    for (const auto& [id, frames] : seen_) {
      if (frames < kLeastFrames) continue;
      ++tally_.people;
      const auto fate = lost.find(std::to_string(id));
      tally_.lost += fate == lost.end() || fate->second ? 1 : 0;
    }
    return tally_;
  }

 private:
  struct Target {
    std::string name;
    Bends bends;
  };

  std::string name_on(const Vector<2>& centre, std::span<const FollowedShape> shapes) const {
    std::string name;
    double reach = reach_;
    for (const FollowedShape& shape : shapes) {
      const double distance = (shape.centre - centre).norm();
      if (distance > reach) continue;
      reach = distance;
      name = shape.name;
    }
    return name;
  }

  void score(int frame, const simulate::people::TrueFigure& person, const Vector<2>& centre, Target& target,
             std::span<const FollowedShape> shapes) {
    ++tally_.frames;
    const auto own = std::find_if(shapes.begin(), shapes.end(), [&](const auto& shape) { return shape.name == target.name; });
    if (own == shapes.end()) return;
    const evaluate::SilhouetteMask mask{person.whole.mask, person.whole.lattice.tl(), person.whole.samples};
    const double share = evaluate::overlap(own->polygon, mask, &picture_).iou();
    tally_.iou += share;
    if (share <= 0) return;
    ++tally_.followed;
    if (!lies_within(person.whole, picture_)) return;
    tally_.error += (own->centre - centre).norm();
    ++tally_.errors;
    target.bends.add(frame, own->centre, tally_);
  }

  cv::Size picture_;
  double reach_;
  std::map<int, int> seen_;
  std::map<int, Target> targets_;
  std::vector<std::vector<evaluate::NamedPlace>> truth_, named_;
  Tally tally_;
};

std::vector<OutlineCase> cases(int videos) {
  const int few = std::max(1, videos / 10);
  using S = simulate::people::PeopleSituation;
  const auto steady = simulate::people::LightChange::steady;
  return {{"apart, 25 px", S::apart, 25, steady, few, 0, {}},
          {"apart, 60 px", S::apart, 60, steady, few, 0, {}},
          {"partly hidden, 25 px", S::crossing, 25, steady, videos, 0, {}},
          {"partly hidden, 60 px", S::crossing, 60, steady, videos, 0, {}},
          {"behind a board, 25 px", S::post, 25, steady, videos, 0, {}},
          {"behind a board, 60 px", S::post, 60, steady, videos, 0, {}},
          {"abrupt changes, 60 px", S::abrupt, 60, steady, few, 0, {}},
          {"border, 60 px", S::border, 60, steady, few, 0, {}},
          {"gradual light, 60 px", S::apart, 60, simulate::people::LightChange::gradual, few, 0, {}},
          {"sudden light, 60 px", S::apart, 60, simulate::people::LightChange::sudden, few, 0, {}}};
}

Frame frame_of(const simulate::people::PeopleFilm& film, int index, const Picture& picture) {
  Frame frame;
  frame.index = index;
  frame.time = timestamp_from_seconds(index / film.options().rate_hz);
  frame.picture = picture;
  return frame;
}

/// What came of one film: every method's tally, and the truth's.
struct FilmResult {
  std::array<Tally, kMethods.size()> methods;
  Tally truth;
};

FilmResult follow(const OutlineCase& what, std::uint64_t seed, const OutlineExperimentOptions& options) {
  simulate::people::PeopleFilmOptions scene;
  scene.height_px = what.height_px;
  scene.light = what.light;
  const simulate::people::PeopleFilm film(what.situation, seed, scene);
  std::array<std::unique_ptr<OutlineMethod>, kMethods.size()> methods{
      silhouette_method(), box_method(), published_method(options.published), marey_method(options.outlines)};
  std::vector<Frame> samples;
  for (int i = 0; i < simulate::people::PeopleFilm::kEarlier; ++i) samples.push_back(frame_of(film, i, film.render_earlier(i)));
  for (const auto& method : methods) method->prime(samples);
  samples.clear();

  std::vector<Judge> judges(kMethods.size(), Judge(scene.size, kReachHeights * what.height_px));
  std::map<int, Bends> true_paths;
  FilmResult result;
  for (int i = 0; i < film.frames(); ++i) {
    const simulate::people::RenderedFrame rendered = film.render(i);
    const Frame frame = frame_of(film, i, rendered.picture);
    for (std::size_t m = 0; m < methods.size(); ++m) {
      judges[m].see(i, rendered.people, methods[m]->step(frame, methods.front()->detections(), rendered.people));
    }
    for (const simulate::people::TrueFigure& person : rendered.people) {
      if (lies_within(person.whole, scene.size)) true_paths[person.id].add(i, person.whole.centre(), result.truth);
    }
  }
  for (std::size_t m = 0; m < methods.size(); ++m) {
    result.methods[m] = judges[m].finish();
    result.methods[m].seconds = methods[m]->seconds();
    result.methods[m].targets = methods[m]->targets();
  }
  return result;
}

}  // namespace

OutlineExperiment run_outline_experiment(const OutlineExperimentOptions& options, const Hooks& hooks) {
  OutlineExperiment experiment;
  experiment.seed = options.seed;
  for (const OutlineCase& what : cases(options.videos)) {
    if (what.name.find(options.only) != std::string::npos) experiment.cases.push_back(what);
  }
  for (const char* name : kMethods) experiment.rows.push_back({name, {}});
  int all = 0, done = 0;
  for (const OutlineCase& what : experiment.cases) all += what.videos;
  std::mutex telling;
  for (OutlineCase& what : experiment.cases) {
    // Films are independent; what came of each is put together in their order.
    std::vector<FilmResult> results(static_cast<std::size_t>(what.videos));
    tbb::parallel_for(0, what.videos, [&](int v) {
      results[static_cast<std::size_t>(v)] = follow(what, options.seed + static_cast<std::uint64_t>(v), options);
      const std::lock_guard lock(telling);
      ++done;
      hooks.advance({"films", done, all});
    });
    FilmResult total;
    for (const FilmResult& result : results) {
      for (std::size_t m = 0; m < kMethods.size(); ++m) total.methods[m].add(result.methods[m]);
      total.truth.add(result.truth);
    }
    for (std::size_t m = 0; m < kMethods.size(); ++m) experiment.rows[m].scores.push_back(total.methods[m].score());
    what.people = total.methods.front().people;
    what.true_jitter = total.truth.score().jitter;
  }
  return experiment;
}

std::string to_text(const OutlineExperiment& experiment) {
  std::string text;
  const auto number = [](const std::optional<double>& value, int digits) {
    return value ? fmt::format("{:.{}f}", *value, digits) : std::string("-");
  };
  for (std::size_t c = 0; c < experiment.cases.size(); ++c) {
    const OutlineCase& what = experiment.cases[c];
    fmt::format_to(std::back_inserter(text), "{}{}: {} {}, {} people; the true centres' jitter is {} px\n", c > 0 ? "\n" : "",
                   what.name, what.videos, what.videos == 1 ? "film" : "films", what.people, number(what.true_jitter, 2));
    fmt::format_to(std::back_inserter(text), "{:<28}{:>8}{:>12}{:>8}{:>12}{:>10}{:>12}\n", "", "IoU", "centre, px", "lost",
                   "followed", "jitter", "us a target");
    for (const auto& row : experiment.rows) {
      const OutlineScore& score = row.scores[c];
      fmt::format_to(std::back_inserter(text), "{:<28}{:>8.3f}{:>12}{:>8}{:>11.1f}%{:>10}{:>12}\n", row.method, score.iou,
                     number(score.centre_error, 2), score.lost, 100 * score.followed, number(score.jitter, 2),
                     number(score.target_us, 1));
    }
  }
  return text;
}

}  // namespace marey::experiments
