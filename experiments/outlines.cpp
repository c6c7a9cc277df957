#include "experiments/outlines.h"

#include <algorithm>
#include <array>
#include <cmath>
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

constexpr double kObserved = 0.5;      // share of a person that must be visible for him to count
constexpr int kMinFrames = 25;         // who can be seen for less does not count at all
constexpr double kReachHeights = 0.5;  // a name farther than this from the person is not on him
constexpr std::array<const char*, 4> kMethods{"silhouettes", "boxes (Xu et al.)", "published (Arnaut & Costa)", "Marey"};

/// Sums of one method over one or more videos; what OutlineScore reports as means.
struct Tally {
  int people = 0, lost = 0;
  std::int64_t frames = 0, tracked = 0;
  double iou = 0;
  std::int64_t errors = 0, bends = 0;
  double error = 0, bend = 0;
  double seconds = 0;
  std::int64_t targets = 0;
  std::array<double, 3> visible{};  ///< sums of IoU: alone, front, behind
  std::array<std::int64_t, 3> visibles{};
  std::int64_t curves = 0, wild = 0;

  void add(const Tally& other) {
    people += other.people;
    lost += other.lost;
    frames += other.frames;
    tracked += other.tracked;
    iou += other.iou;
    errors += other.errors;
    error += other.error;
    bends += other.bends;
    bend += other.bend;
    seconds += other.seconds;
    targets += other.targets;
    for (std::size_t i = 0; i < visible.size(); ++i) {
      visible[i] += other.visible[i];
      visibles[i] += other.visibles[i];
    }
    curves += other.curves;
    wild += other.wild;
  }

  OutlineScore score() const {
    OutlineScore result;
    result.people = people;
    result.lost = lost;
    result.frames = frames;
    const std::array<std::optional<double>*, 3> means{&result.alone, &result.front, &result.behind};
    for (std::size_t i = 0; i < means.size(); ++i) {
      if (visibles[i] > 0) *means[i] = visible[i] / static_cast<double>(visibles[i]);
    }
    result.curves = curves;
    result.wild = wild;
    if (frames > 0) {
      result.tracked = static_cast<double>(tracked) / static_cast<double>(frames);
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
  void add(int frame, const Vector<2>& location, Tally& tally) {
    if (frame == last_ + 1 && run_ >= 2) {
      tally.bend += (location - 2 * path_[1] + path_[0]).squaredNorm();
      ++tally.bends;
    }
    run_ = frame == last_ + 1 ? run_ + 1 : 1;
    last_ = frame;
    path_ = {path_[1], location};
  }

 private:
  int last_ = -2, run_ = 0;
  std::array<Vector<2>, 2> path_{Vector<2>::Zero(), Vector<2>::Zero()};
};

/// Crosses itself, or is more than twice as wide or 1.6 times as high as its target.
bool is_wild(const TrackedShape& shape) {
  Vector<2> minimum = shape.polygon[0], maximum = shape.polygon[0];
  for (const Vector<2>& corner : shape.polygon) {
    minimum = minimum.cwiseMin(corner);
    maximum = maximum.cwiseMax(corner);
  }
  const Vector<2> size = maximum - minimum;
  if (shape.box_width > 0 && (size.x() > 2 * shape.box_width || size.y() > 1.6 * shape.box_height)) return true;
  const auto side = [](const Vector<2>& a, const Vector<2>& b, const Vector<2>& p) {
    return (b.x() - a.x()) * (p.y() - a.y()) - (b.y() - a.y()) * (p.x() - a.x());
  };
  const std::size_t count = shape.polygon.size();
  for (std::size_t i = 0; i < count; ++i) {
    const Vector<2>&a = shape.polygon[i], &b = shape.polygon[(i + 1) % count];
    for (std::size_t j = i + 2; j < count; ++j) {
      const Vector<2>&c = shape.polygon[j], &d = shape.polygon[(j + 1) % count];
      if ((j + 1) % count == i) continue;
      if (side(a, b, c) * side(a, b, d) < 0 && side(c, d, a) * side(c, d, b) < 0) return true;
    }
  }
  return false;
}

bool lies_within(const simulate::people::Silhouette& silhouette, cv::Size image) {
  return (silhouette.pixels() & cv::Rect({0, 0}, image)) == silhouette.pixels();
}

/// Evaluates one method on one video.
class Assessor {
 public:
  Assessor(cv::Size image, double reach) : image_(image), reach_(reach) {}

  void observe_frame(int frame, std::span<const simulate::people::TrueFigure> truth, std::span<const TrackedShape> shapes) {
    auto& true_places = truth_.emplace_back();
    auto& locations = named_.emplace_back();
    for (const TrackedShape& shape : shapes) {
      locations.push_back({shape.name, shape.centre});
      if (!shape.is_curve) continue;
      ++tally_.curves;
      tally_.wild += is_wild(shape) ? 1 : 0;
    }
    for (const simulate::people::TrueFigure& person : truth) {
      if (person.visible_fraction < kObserved) continue;
      ++detected_[person.id];
      const Vector<2> centre = person.whole.centre();
      Target& target = targets_[person.id];
      if (target.name.empty()) target.name = name_on(centre, shapes);
      if (target.name.empty()) continue;
      score_visible(person, truth, target, shapes);
      true_places.push_back({std::to_string(person.id), centre});
      score(frame, person, centre, target, shapes);
    }
  }

  Tally finish() {
    std::map<std::string, bool> lost;
    for (const evaluate::LabelFate& fate : evaluate::evaluate_labels(truth_, named_, reach_)) lost[fate.marker] = fate.lost();
    for (const auto& [id, frames] : detected_) {
      if (frames < kMinFrames) continue;
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

  std::string name_on(const Vector<2>& centre, std::span<const TrackedShape> shapes) const {
    std::string name;
    double reach = reach_;
    for (const TrackedShape& shape : shapes) {
      const double distance = (shape.centre - centre).norm();
      if (distance > reach) continue;
      reach = distance;
      name = shape.name;
    }
    return name;
  }

  /// How much of the smaller of two silhouettes the other shares, hidden parts included.
  static double shared_part(const simulate::people::Silhouette& a, const simulate::people::Silhouette& b) {
    const cv::Rect both = a.lattice & b.lattice;
    if (both.empty()) return 0;
    cv::Mat shared;
    cv::bitwise_and(a.mask(both - a.lattice.tl()) != 0, b.mask(both - b.lattice.tl()) != 0, shared);
    return cv::countNonZero(shared) / (std::min(a.area(), b.area()) * a.samples * a.samples);
  }

  void score_visible(const simulate::people::TrueFigure& person, std::span<const simulate::people::TrueFigure> truth,
                     const Target& target, std::span<const TrackedShape> shapes) {
    if (!lies_within(person.whole, image_)) return;
    double maximum = 0;
    bool nearer = false;
    for (const simulate::people::TrueFigure& other : truth) {
      if (other.id == person.id) continue;
      const double part = shared_part(person.whole, other.whole);
      if (part <= maximum) continue;
      maximum = part;
      nearer = person.foot.y() > other.foot.y();
    }
    if (maximum > 0 && (maximum < 0.2 || maximum > 0.7)) return;
    const std::size_t kind = maximum <= 0 ? 0 : nearer ? 1 : 2;
    if (kind == 0 && person.visible_fraction < 1) return;
    ++tally_.visibles[kind];
    const auto own = std::find_if(shapes.begin(), shapes.end(), [&](const auto& shape) { return shape.name == target.name; });
    if (own == shapes.end()) return;
    std::vector<std::vector<Vector<2>>> hiding;
    for (const TrackedShape& shape : shapes) {
      if (std::find(own->behind.begin(), own->behind.end(), shape.name) != own->behind.end()) hiding.push_back(shape.polygon);
    }
    const evaluate::SilhouetteMask mask{person.visible.mask, person.visible.lattice.tl(), person.visible.samples};
    tally_.visible[kind] += evaluate::visible_overlap(own->polygon, hiding, mask, image_).iou();
  }

  void score(int frame, const simulate::people::TrueFigure& person, const Vector<2>& centre, Target& target,
             std::span<const TrackedShape> shapes) {
    ++tally_.frames;
    const auto own = std::find_if(shapes.begin(), shapes.end(), [&](const auto& shape) { return shape.name == target.name; });
    if (own == shapes.end()) return;
    const evaluate::SilhouetteMask mask{person.whole.mask, person.whole.lattice.tl(), person.whole.samples};
    const double fraction = evaluate::overlap(own->polygon, mask, &image_).iou();
    tally_.iou += fraction;
    if (fraction <= 0) return;
    ++tally_.tracked;
    if (!lies_within(person.whole, image_)) return;
    tally_.error += (own->centre - centre).norm();
    ++tally_.errors;
    target.bends.add(frame, own->centre, tally_);
  }

  cv::Size image_;
  double reach_;
  std::map<int, int> detected_;
  std::map<int, Target> targets_;
  std::vector<std::vector<evaluate::NamedPosition>> truth_, named_;
  Tally tally_;
};

std::vector<OutlineCase> cases(int videos) {
  const int few = std::max(1, videos / 10), half = std::max(1, videos * 2 / 5);
  using S = simulate::people::PeopleSituation;
  const auto constant = simulate::people::LightChange::constant;
  return {{.name = "apart, 25 px", .situation = S::apart, .height_px = 25, .light = constant, .videos = few},
          {.name = "apart, 60 px", .situation = S::apart, .height_px = 60, .light = constant, .videos = few},
          {.name = "partly hidden, 25 px", .situation = S::crossing, .height_px = 25, .light = constant, .videos = videos},
          {.name = "partly hidden, 60 px", .situation = S::crossing, .height_px = 60, .light = constant, .videos = videos},
          {.name = "behind a board, 25 px", .situation = S::post, .height_px = 25, .light = constant, .videos = videos},
          {.name = "behind a board, 60 px", .situation = S::post, .height_px = 60, .light = constant, .videos = videos},
          {.name = "abrupt changes, 60 px", .situation = S::abrupt, .height_px = 60, .light = constant, .videos = few},
          {.name = "border, 60 px", .situation = S::border, .height_px = 60, .light = constant, .videos = few},
          {.name = "gradual light, 60 px",
           .situation = S::apart,
           .height_px = 60,
           .light = simulate::people::LightChange::gradual,
           .videos = few},
          {.name = "sudden light, 60 px",
           .situation = S::apart,
           .height_px = 60,
           .light = simulate::people::LightChange::sudden,
           .videos = few},
          {.name = "recorded, apart, 60 px", .situation = S::apart, .height_px = 60, .recorded = true, .videos = few},
          {.name = "recorded, apart, 150 px", .situation = S::apart, .height_px = 150, .recorded = true, .videos = few},
          {.name = "recorded, overlapping, 60 px", .situation = S::overlap, .height_px = 60, .recorded = true, .videos = half},
          {.name = "recorded, overlapping, same shirts, 60 px",
           .situation = S::overlap,
           .height_px = 60,
           .recorded = true,
           .same_shirts = true,
           .videos = half},
          {.name = "recorded, overlapping, 150 px", .situation = S::overlap, .height_px = 150, .recorded = true, .videos = few}};
}

Frame frame_of(const simulate::people::PeopleVideo& video, int index, const Image& image) {
  Frame frame;
  frame.index = index;
  frame.time = timestamp_from_seconds(index / video.options().rate_hz);
  frame.image = image;
  return frame;
}

/// The results from one video: every method's tally, and the truth's.
struct VideoResult {
  std::array<Tally, kMethods.size()> methods;
  Tally truth;
};

VideoResult run_tracker(const OutlineCase& what, std::uint64_t seed, const OutlineExperimentOptions& options) {
  simulate::people::PeopleVideoOptions scene;
  scene.height_px = what.height_px;
  scene.light = what.light;
  scene.same_shirts = what.same_shirts;
  if (what.recorded) scene.degradation = simulate::people::ImageDegradation::recorded();
  const simulate::people::PeopleVideo video(what.situation, seed, scene);
  std::array<std::unique_ptr<OutlineMethod>, kMethods.size()> methods{
      silhouette_method(), box_method(), published_method(options.published), marey_method(options.outlines)};
  std::vector<Frame> samples;
  for (int i = 0; i < simulate::people::PeopleVideo::kEarlier; ++i) samples.push_back(frame_of(video, i, video.render_earlier(i)));
  for (const auto& method : methods) method->prime(samples);
  samples.clear();

  std::vector<Assessor> judges(kMethods.size(), Assessor(scene.size, kReachHeights * what.height_px));
  std::map<int, Bends> true_paths;
  VideoResult result;
  for (int i = 0; i < video.frames(); ++i) {
    const simulate::people::RenderedFrame rendered = video.render(i);
    const Frame frame = frame_of(video, i, rendered.image);
    for (std::size_t m = 0; m < methods.size(); ++m) {
      judges[m].observe_frame(i, rendered.people, methods[m]->step(frame, methods.front()->detections(), rendered.people));
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
    // Videos are independent; what results from each is put together in their order.
    std::vector<VideoResult> results(static_cast<std::size_t>(what.videos));
    tbb::parallel_for(0, what.videos, [&](int v) {
      results[static_cast<std::size_t>(v)] = run_tracker(what, options.seed + static_cast<std::uint64_t>(v), options);
      const std::lock_guard lock(telling);
      ++done;
      hooks.advance({"videos", done, all});
    });
    VideoResult total;
    for (const VideoResult& result : results) {
      for (std::size_t m = 0; m < kMethods.size(); ++m) total.methods[m].add(result.methods[m]);
      total.truth.add(result.truth);
    }
    for (std::size_t m = 0; m < kMethods.size(); ++m) experiment.rows[m].scores.push_back(total.methods[m].score());
    what.people = total.methods.front().people;
    what.true_jitter = total.truth.score().jitter;
  }
  return experiment;
}

}  // namespace marey::experiments
