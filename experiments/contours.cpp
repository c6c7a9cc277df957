#include "experiments/contours.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <ctime>
#include <memory>
#include <mutex>
#include <utility>

#include <fmt/format.h>
#include <tbb/parallel_for.h>

#include "experiments/codec_round_trip.h"
#include "experiments/naive_contours.h"

namespace marey::experiments {
namespace {

using simulate::people::PeopleVideo;
using Situation = simulate::people::PeopleSituation;

constexpr std::size_t kMethodCount = kContourMethods.size();
constexpr std::size_t kSilhouettes = 1, kMarey = 2;
using Tallies = std::array<ContourTally, kMethodCount>;

/// Both teams of a football match in one wide image, for speed.
ContourCase timed_match() {
  return {.name = "22 players, 3072 px wide",
          .situation = Situation::crowd,
          .height_px = 120,
          .degraded = true,
          .frames = 40,
          .people = 22,
          .size = {3072, 1728},
          .timed = true};
}

/// Short videos of pairs who meet behind boards and are hidden for half a second, both at once: a hundred full occlusions,
/// however few videos are asked for.
ContourCase hidden_in_pairs(int height_px, int videos) {
  constexpr int kBoards = 12;                         // in an image, where as many fit
  const int for_a_hundred = height_px < 40 ? 5 : 12;  // videos
  return {.name = fmt::format("hidden for 0.5 s in pairs, {} px", height_px),
          .situation = Situation::post,
          .height_px = static_cast<double>(height_px),
          .hidden_s = 0.6,  // of which arms and legs take a fifth
          .min_hidden_s = 0.6,
          .in_pairs = true,
          .frames = 90,
          .people = kBoards,
          .videos = std::max(videos, for_a_hundred)};
}

std::vector<ContourCase> all_cases(int videos) {
  std::vector<ContourCase> cases;
  for (const int height : {25, 60, 120}) {
    cases.push_back({.name = fmt::format("recorded, alone, {} px", height),
                     .situation = Situation::apart,
                     .height_px = static_cast<double>(height),
                     .degraded = true,
                     .videos = videos});
  }
  for (const int height : {25, 60}) {
    cases.push_back({.name = fmt::format("behind a board, {} px", height),
                     .situation = Situation::post,
                     .height_px = static_cast<double>(height),
                     .videos = videos});
  }
  for (const int height : {60, 120}) {
    for (const bool same : {false, true}) {
      cases.push_back({.name = fmt::format("recorded, overlapping, {} px{}", height, same ? ", same shirts" : ""),
                       .situation = Situation::overlap,
                       .height_px = static_cast<double>(height),
                       .degraded = true,
                       .same_shirts = same,
                       .videos = videos});
    }
  }
  for (const int height : {25, 60, 200}) {
    for (const int crf : {18, 35}) {
      cases.push_back({.name = fmt::format("edge, {} px, crf {}", height, crf),
                       .situation = Situation::apart,
                       .height_px = static_cast<double>(height),
                       .crf = crf,
                       .frames = 80,
                       .videos = std::max(1, videos / 4)});
    }
  }
  for (const int height : {25, 60}) {
    cases.push_back({.name = fmt::format("hidden for up to 0.5 s, {} px", height),
                     .situation = Situation::post,
                     .height_px = static_cast<double>(height),
                     .hidden_s = 0.5,
                     .videos = 2 * videos});
  }
  for (const int height : {25, 60}) cases.push_back(hidden_in_pairs(height, videos));
  cases.push_back(timed_match());
  return cases;
}

/// The images of a video that are shown before it, then its own; and the truth of its own.
struct Video {
  std::vector<Image> earlier, images;
  std::vector<std::vector<simulate::people::TrueFigure>> truth;
};

Video render(const PeopleVideo& people, const std::optional<int>& crf) {
  Video video;
  for (int i = 0; i < PeopleVideo::kEarlier; ++i) video.earlier.push_back(people.render_earlier(i));
  for (int i = 0; i < people.frames(); ++i) {
    simulate::people::RenderedFrame rendered = people.render(i);
    video.images.push_back(std::move(rendered.image));
    video.truth.push_back(std::move(rendered.people));
  }
  if (!crf) return video;
  video.earlier = codec_round_trip(video.earlier, *crf);
  video.images = codec_round_trip(video.images, *crf);
  return video;
}

Frame frame_of(const Image& image, int index, double rate_hz) {
  Frame frame;
  frame.index = index;
  frame.time = timestamp_from_seconds(index / rate_hz);
  frame.image = image;
  return frame;
}

Tallies evaluate(const ContourCase& what, std::uint64_t seed, const ContourExperimentOptions& options) {
  simulate::people::PeopleVideoOptions scene;
  scene.height_px = what.height_px;
  scene.same_shirts = what.same_shirts;
  scene.frames = what.frames;
  scene.people = what.people;
  scene.size = what.size;
  if (what.hidden_s) scene.hidden_s = *what.hidden_s;
  scene.min_hidden_s = what.min_hidden_s;
  scene.in_pairs = what.in_pairs;
  if (what.degraded) scene.degradation = simulate::people::ImageDegradation::recorded();
  const PeopleVideo people(what.situation, seed, scene);
  const Video video = render(people, what.crf);
  const std::array<std::unique_ptr<OutlineMethod>, kMethodCount> methods{naive_method(), silhouette_method(),
                                                                         marey_method(options.outlines)};
  std::vector<Frame> samples;
  for (std::size_t i = 0; i < video.earlier.size(); ++i) {
    samples.push_back(frame_of(video.earlier[i], static_cast<int>(i), scene.rate_hz));
  }
  for (const auto& method : methods) method->prime(samples);
  std::vector<ContourEvaluator> evaluators(kMethodCount, ContourEvaluator(scene.size));
  Tallies tallies;
  for (std::size_t i = 0; i < video.images.size(); ++i) {
    const Frame frame = frame_of(video.images[i], static_cast<int>(i), scene.rate_hz);
    for (std::size_t m = 0; m < kMethodCount; ++m) {
      const auto begin = std::chrono::steady_clock::now();
      const std::clock_t processor_begin = std::clock();
      const auto shapes = methods[m]->step(frame, methods[kSilhouettes]->detections(), video.truth[i]);
      const std::chrono::duration<double> taken = std::chrono::steady_clock::now() - begin;
      if (what.timed) {
        tallies[m].step_s.add(taken.count());
        tallies[m].processor_s.add(static_cast<double>(std::clock() - processor_begin) / CLOCKS_PER_SEC);
        continue;
      }
      evaluators[m].observe(static_cast<int>(i), video.truth[i], shapes);
    }
  }
  for (std::size_t m = 0; m < kMethodCount; ++m) tallies[m].add(evaluators[m].tally());
  return tallies;
}

/// What every case came to, and the rows made of it.
class Rows {
 public:
  Rows(std::vector<ContourCase> cases, std::vector<Tallies> tallies) : cases_(std::move(cases)), tallies_(std::move(tallies)) {}

  std::vector<ContourRow> all() {
    alone();
    board();
    overlapping();
    edge();
    jitter();
    occlusion();
    shape();
    speed();
    return std::move(rows_);
  }

 private:
  template <typename Value>
  void add(const std::string& name, const std::string& must, const Tallies& tallies, const Value& value, int digits = 2) {
    ContourRow row{.name = name, .must = must, .values = {}, .digits = digits};
    for (std::size_t m = 0; m < kMethodCount; ++m) {
      const Mean mean = value(tallies[m]);
      row.values[m] = mean.value();
      row.samples = mean.count;
    }
    if (row.samples > 0) rows_.push_back(std::move(row));
  }

  template <typename Chosen>
  Tallies sum_where(const Chosen& chosen) const {
    Tallies sum;
    for (std::size_t c = 0; c < cases_.size(); ++c) {
      for (std::size_t m = 0; m < kMethodCount && chosen(cases_[c]); ++m) sum[m].add(tallies_[c][m]);
    }
    return sum;
  }

  void alone() {
    for (std::size_t c = 0; c < cases_.size(); ++c) {
      if (cases_[c].situation != Situation::apart || !cases_[c].degraded) continue;
      const double height = cases_[c].height_px;
      add(
          "IoU, " + cases_[c].name,
          height < 40   ? "≥ 0.72"
          : height < 90 ? "≥ 0.86"
                        : "≥ 0.92",
          tallies_[c], [](const ContourTally& one) { return one.alone; }, 3);
    }
  }

  void board() {
    for (std::size_t c = 0; c < cases_.size(); ++c) {
      if (cases_[c].situation != Situation::post || cases_[c].hidden_s) continue;
      add(
          "IoU, " + cases_[c].name, cases_[c].height_px < 40 ? "≥ 0.70" : "≥ 0.83", tallies_[c],
          [](const ContourTally& one) { return one.whole; }, 3);
    }
  }

  void overlapping() {
    for (std::size_t c = 0; c < cases_.size(); ++c) {
      if (cases_[c].situation != Situation::overlap) continue;
      add(
          "IoU of the front person, " + cases_[c].name, "≥ 0.80", tallies_[c], [](const ContourTally& one) { return one.front; },
          3);
      add("IoU of the one behind, " + cases_[c].name, "≥ 0.70", tallies_[c], [](const ContourTally& one) { return one.behind; }, 3);
    }
    const Tallies sum = sum_where([](const ContourCase& one) { return one.situation == Situation::overlap; });
    add(
        "found at IoU 0.5, all who overlap or are alone there", "≥ 0.90", sum, [](const ContourTally& one) { return one.found; },
        3);
  }

  void edge() {
    for (std::size_t c = 0; c < cases_.size(); ++c) {
      if (!cases_[c].crf) continue;
      add("edge bias, px, " + cases_[c].name, "± 0.5", tallies_[c], [](const ContourTally& one) { return one.bias; });
    }
    const Tallies degraded = sum_where([](const ContourCase& one) { return one.degraded && one.situation == Situation::apart; });
    add("edge bias, px, recorded", "± 0.5", degraded, [](const ContourTally& one) { return one.bias; });
  }

  /// Root mean squares of second differences against those of the silhouettes.
  void jitter() {
    const Tallies sum = sum_where([](const ContourCase& one) { return one.situation == Situation::apart; });
    const std::array<const char*, 3> names{"jitter of the centre", "jitter of √area", "jitter of the width"};
    for (std::size_t i = 0; i < names.size(); ++i) {
      const std::optional<double> base = sum[kSilhouettes].bends[i].value();
      ContourRow row{.name = fmt::format("{}, × the silhouettes'", names[i]), .must = "≤ 0.5", .values = {}};
      for (std::size_t m = 0; m < kMethodCount && base; ++m) {
        if (const auto own = sum[m].bends[i].value()) row.values[m] = std::sqrt(*own / *base);
      }
      row.samples = sum[kMarey].bends[i].count;
      if (base) rows_.push_back(std::move(row));
    }
  }

  void occlusion() {
    const Tallies sum = sum_where([](const ContourCase& one) { return one.hidden_s && !one.min_hidden_s; });
    occlusion(sum, "up to 0.5 s", 0);
    for (std::size_t c = 0; c < cases_.size(); ++c) {
      if (cases_[c].min_hidden_s) occlusion(tallies_[c], cases_[c].name.substr(std::string("hidden for ").size()), 1);
    }
  }

  void occlusion(const Tallies& tallies, const std::string& kind, int digits) {
    add(
        "IoU of the first frame after a full occlusion of " + kind, "≥ 0.60", tallies,
        [](const ContourTally& one) { return one.back; }, 3);
    add("frames that these are hidden, of 12.5", "12.5", tallies, [](const ContourTally& one) { return one.hidden; }, 1);
    add(
        "identities lost there, of 100", "≤ 2", tallies,
        [](const ContourTally& one) { return Mean{100 * one.swapped.sum, one.swapped.count}; }, digits);
    add(
        "of them taken by another person, of 100", "≤ 2", tallies,
        [](const ContourTally& one) { return Mean{100 * one.taken_over.sum, one.taken_over.count}; }, digits);
  }

  void shape() {
    const Tallies sum = sum_where([](const ContourCase&) { return true; });
    add("contours that cross themselves, of 1000", "0", sum,
        [](const ContourTally& one) { return Mean{1000.0 * static_cast<double>(one.crossed), one.curves}; });
    add("contours that exceed 1.5 × their person's size, of 1000", "0", sum,
        [](const ContourTally& one) { return Mean{1000.0 * static_cast<double>(one.oversized), one.curves}; });
  }

  /// Detection, tracking and contours, of images that are decoded.
  void speed() {
    for (std::size_t c = 0; c < cases_.size(); ++c) {
      if (!cases_[c].timed) continue;
      ContourRow row{.name = "frames per second, " + cases_[c].name, .must = "≥ 12", .values = {}, .digits = 1, .is_time = true};
      for (std::size_t m = 0; m < kMethodCount; ++m) {
        if (const auto seconds = tallies_[c][m].step_s.value()) row.values[m] = 1 / *seconds;
      }
      row.samples = tallies_[c][kMarey].step_s.count;
      rows_.push_back(std::move(row));
      add(
          "processor time, ms per frame, " + cases_[c].name, "≤ 167", tallies_[c],
          [](const ContourTally& one) { return Mean{1000 * one.processor_s.sum, one.processor_s.count}; }, 0);
      rows_.back().is_time = true;
    }
  }

  std::vector<ContourCase> cases_;
  std::vector<Tallies> tallies_;
  std::vector<ContourRow> rows_;
};

}  // namespace

ContourExperiment run_contour_experiment(const ContourExperimentOptions& options, const Hooks& hooks) {
  std::vector<ContourCase> cases;
  for (ContourCase& one : all_cases(options.videos)) {
    if (one.name.find(options.only) != std::string::npos) cases.push_back(std::move(one));
  }
  int all = 0, done = 0;
  for (const ContourCase& what : cases) all += what.videos;
  std::mutex reporting;
  std::vector<Tallies> tallies(cases.size());
  for (std::size_t c = 0; c < cases.size(); ++c) {
    // Videos are independent; their results are added in their order.
    std::vector<Tallies> results(static_cast<std::size_t>(cases[c].videos));
    tbb::parallel_for(0, cases[c].videos, [&](int v) {
      results[static_cast<std::size_t>(v)] = evaluate(cases[c], options.seed + static_cast<std::uint64_t>(v), options);
      const std::lock_guard lock(reporting);
      ++done;
      hooks.advance({"videos", done, all});
    });
    for (const Tallies& result : results) {
      for (std::size_t m = 0; m < kMethodCount; ++m) tallies[c][m].add(result[m]);
    }
  }
  return {options.seed, options.videos, Rows(std::move(cases), std::move(tallies)).all()};
}

}  // namespace marey::experiments
