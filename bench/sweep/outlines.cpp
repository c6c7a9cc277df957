// Outlines of people as a match's cameras show them (halo, smeared colour, blur, blocks), 22 to 178 px tall, alone and in part
// behind each other: IoU with what is visible of each, beside the silhouettes of the background model alone and GrabCut begun with
// the true box. A person without an outline counts 0; identity does not count here.
//   outlines [VIDEOS A SCENE (2)] [TEXT OF A SCENE'S NAME] [FOLDER FOR IMAGES, or -] [peers]
#include <algorithm>
#include <array>
#include <cmath>
#include <cstdlib>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include <fmt/core.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

#include "marey/evaluate/outline_overlap.h"
#include "marey/simulate/people/people_video.h"

#include "experiments/outline_methods.h"

namespace marey {
namespace {

using simulate::people::PeopleSituation;
using simulate::people::PeopleVideo;
using simulate::people::RenderedFrame;
using simulate::people::TrueFigure;

constexpr int kEvery = 5;                               // frames, that are evaluated
constexpr double kMinOverlap = 0.2, kMaxOverlap = 0.7;  // of the smaller silhouette, shared: what is evaluated as an overlap

struct Scene {
  const char* name;
  PeopleSituation situation;
  double height_px;
  bool same_shirts = false;
  double from = 0;     ///< share of the video that is omitted: people meet as it begins
  bool plain = false;  ///< a sharp image, as no camera gives it
};

constexpr auto kApart = PeopleSituation::apart, kOverlap = PeopleSituation::overlap;
constexpr std::array kScenes{Scene{"apart, 22 px", kApart, 22},
                             Scene{"apart, 40 px", kApart, 40},
                             Scene{"apart, 60 px", kApart, 60},
                             Scene{"apart, 100 px", kApart, 100},
                             Scene{"apart, 178 px", kApart, 178},
                             Scene{"overlap, 22 px", kOverlap, 22},
                             Scene{"overlap, 40 px", kOverlap, 40},
                             Scene{"overlap, 60 px", kOverlap, 60},
                             Scene{"overlap, 100 px", kOverlap, 100},
                             Scene{"overlap, 178 px", kOverlap, 178},
                             Scene{"overlap, same shirts, 40 px", kOverlap, 40, true},
                             Scene{"overlap, same shirts, 60 px", kOverlap, 60, true},
                             Scene{"overlap, same shirts, 100 px", kOverlap, 100, true},
                             Scene{"overlap, same shirts, 178 px", kOverlap, 178, true},
                             Scene{"overlap as it begins, 60 px", kOverlap, 60, false, 0.36},
                             Scene{"overlap as it begins, 100 px", kOverlap, 100, false, 0.36},
                             Scene{"plain, apart, 25 px", kApart, 25, false, 0, true},
                             Scene{"plain, apart, 60 px", kApart, 60, false, 0, true},
                             Scene{"plain, apart, 120 px", kApart, 120, false, 0, true}};

struct Mean {
  double sum = 0, shared = 0, drawn = 0, true_area = 0;
  int count = 0, found = 0;
  void add(const evaluate::OutlineOverlap& overlap) {
    const double value = overlap.iou();
    sum += value;
    ++count;
    found += value >= 0.5 ? 1 : 0;
    shared += overlap.shared;
    drawn += overlap.outline;
    true_area += overlap.silhouette;
  }
  std::string text() const {
    if (count == 0) return "-";
    return fmt::format("{:.3f} {:>3.0f}% {:.2f} {:.2f}", sum / count, 100.0 * found / count, drawn > 0 ? shared / drawn : 0,
                       shared / true_area);
  }
};
using Score = std::array<Mean, 3>;  // alone, in front, behind

evaluate::SilhouetteMask mask_of(const simulate::people::Silhouette& silhouette) {
  return {silhouette.mask, silhouette.lattice.tl(), silhouette.samples};
}

double shared_part(const simulate::people::Silhouette& a, const simulate::people::Silhouette& b) {
  const cv::Rect both = a.lattice & b.lattice;
  if (both.empty()) return 0;
  cv::Mat shared;
  cv::bitwise_and(a.mask(both - a.lattice.tl()) != 0, b.mask(both - b.lattice.tl()) != 0, shared);
  return cv::countNonZero(shared) / (std::min(a.area(), b.area()) * a.samples * a.samples);
}

/// 0 alone, 1 in front, 2 behind; nothing for who is not evaluated.
std::optional<std::size_t> kind_of(const TrueFigure& person, const std::vector<TrueFigure>& people, cv::Size image) {
  if ((person.whole.pixels() & cv::Rect({0, 0}, image)) != person.whole.pixels()) return std::nullopt;
  double maximum = 0;
  bool nearer = false;
  for (const TrueFigure& other : people) {
    if (other.id == person.id) continue;
    const double part = shared_part(person.whole, other.whole);
    if (part <= maximum) continue;
    maximum = part;
    nearer = person.foot.y() > other.foot.y();
  }
  if (maximum <= 0) return person.visible_fraction < 1 ? std::nullopt : std::optional<std::size_t>(0);
  if (maximum < kMinOverlap || maximum > kMaxOverlap) return std::nullopt;
  return nearer ? 1 : 2;
}

/// Every outline is one person's at most: pairs are taken from the best on.
void assess(const RenderedFrame& truth, cv::Size image, const std::vector<experiments::TrackedShape>& shapes, Score& score) {
  struct Pair {
    evaluate::OutlineOverlap overlap;
    std::size_t person, shape;
  };
  std::vector<Pair> pairs;
  for (std::size_t i = 0; i < truth.people.size(); ++i) {
    for (std::size_t j = 0; j < shapes.size(); ++j) {
      std::vector<std::vector<Vector<2>>> hiding;
      for (const auto& other : shapes) {
        if (std::find(shapes[j].behind.begin(), shapes[j].behind.end(), other.name) != shapes[j].behind.end())
          hiding.push_back(other.polygon);
      }
      const auto both = evaluate::visible_overlap(shapes[j].polygon, hiding, mask_of(truth.people[i].visible), image);
      if (both.shared > 0) pairs.push_back({both, i, j});
    }
  }
  std::stable_sort(pairs.begin(), pairs.end(), [](const Pair& a, const Pair& b) { return a.overlap.iou() > b.overlap.iou(); });
  std::vector<evaluate::OutlineOverlap> own;
  for (const TrueFigure& person : truth.people) own.push_back({0, 0, person.visible.area()});
  std::vector<bool> taken(shapes.size(), false);
  for (const Pair& pair : pairs) {
    if (own[pair.person].shared > 0 || taken[pair.shape]) continue;
    own[pair.person] = pair.overlap;
    taken[pair.shape] = true;
  }
  for (std::size_t i = 0; i < truth.people.size(); ++i) {
    if (const auto kind = kind_of(truth.people[i], truth.people, image)) score[*kind].add(own[i]);
  }
}

cv::Mat bgr_of(const Image& image) {
  cv::Mat cb, cr, planes, bgr;
  cv::resize(image.cb(), cb, image.size());
  cv::resize(image.cr(), cr, image.size());
  const std::array<cv::Mat, 3> all{image.luma(), cr, cb};
  cv::merge(all.data(), all.size(), planes);
  cv::cvtColor(planes, bgr, cv::COLOR_YCrCb2BGR);
  return bgr;
}

void evaluate_grabcut(const RenderedFrame& truth, cv::Size image, Score& score) {
  const cv::Mat bgr = bgr_of(truth.image);
  for (const TrueFigure& person : truth.people) {
    const auto kind = kind_of(person, truth.people, image);
    if (!kind) continue;
    const Box box = person.visible.box();
    const double by = 0.3 * box.height;
    const cv::Rect all = cv::Rect(cv::Point(static_cast<int>(box.left - by), static_cast<int>(box.top - by)),
                                  cv::Point(static_cast<int>(box.right() + by), static_cast<int>(box.bottom() + by))) &
                         cv::Rect({0, 0}, image);
    const cv::Rect inner =
        cv::Rect(cv::Point(static_cast<int>(std::floor(box.left)) - 1, static_cast<int>(std::floor(box.top)) - 1),
                 cv::Point(static_cast<int>(std::ceil(box.right())) + 1, static_cast<int>(std::ceil(box.bottom())) + 1)) &
        all;
    cv::Mat mask, background, foreground;
    cv::setRNGSeed(1);
    cv::grabCut(bgr(all), mask, inner - all.tl(), background, foreground, 3, cv::GC_INIT_WITH_RECT);
    const cv::Mat own = (mask & 1) != 0;
    const cv::Mat visible = person.visible.pixel_mask(image)(all);
    const auto pixels = [](const cv::Mat& any) { return static_cast<double>(cv::countNonZero(any)); };
    score[*kind].add({pixels(own & visible), pixels(own), pixels(visible)});
  }
}

void draw(const std::string& file, const RenderedFrame& truth, const std::vector<experiments::TrackedShape>& shapes) {
  Box all;
  for (const TrueFigure& person : truth.people) all = all.empty() ? person.whole.box() : geometry::hull(all, person.whole.box());
  const cv::Rect area = cv::Rect(static_cast<int>(all.left) - 20, static_cast<int>(all.top) - 20, static_cast<int>(all.width) + 40,
                                 static_cast<int>(all.height) + 40) &
                        cv::Rect({0, 0}, truth.image.size());
  if (area.empty()) return;
  const double zoom = std::max(600.0 / area.height, 480 / truth.people.front().whole.box().height);
  cv::Mat large, plain;
  cv::resize(bgr_of(truth.image)(area), large, {}, zoom, zoom, cv::INTER_CUBIC);
  plain = large.clone();
  for (const auto& shape : shapes) {
    std::vector<cv::Point> points;
    for (const Vector<2>& p : shape.polygon) {
      points.emplace_back(static_cast<int>((p.x() - area.x + 0.5) * zoom), static_cast<int>((p.y() - area.y + 0.5) * zoom));
    }
    const cv::Scalar colour = shape.behind.empty() ? cv::Scalar(0, 255, 0) : cv::Scalar(0, 200, 255);
    cv::polylines(large, points, true, colour, 1, cv::LINE_AA);
  }
  for (const TrueFigure& person : truth.people) {
    std::vector<std::vector<cv::Point>> edges;
    cv::findContours(person.visible.mask != 0, edges, cv::RETR_EXTERNAL, cv::CHAIN_APPROX_NONE);
    for (auto& edge : edges) {
      for (cv::Point& p : edge) {
        const cv::Point location = p + person.visible.lattice.tl();
        p = {static_cast<int>(((location.x + 0.5) / person.visible.samples - area.x) * zoom),
             static_cast<int>(((location.y + 0.5) / person.visible.samples - area.y) * zoom)};
      }
    }
    cv::drawContours(large, edges, -1, cv::Scalar(255, 255, 255), 1, cv::LINE_AA);
  }
  cv::hconcat(plain, large, large);
  cv::imwrite(file, large);
}

struct Scores {
  Score silhouettes, grabcut, marey;
};

void run_tracker(const Scene& scene, std::uint64_t seed, const std::string& folder, bool peers, Scores& scores) {
  simulate::people::PeopleVideoOptions options;
  options.height_px = scene.height_px;
  options.same_shirts = scene.same_shirts;
  if (!scene.plain) options.degradation = simulate::people::ImageDegradation::recorded();
  options.frames = 80;
  const PeopleVideo video(scene.situation, seed, options);
  const auto silhouettes = experiments::silhouette_method(), marey = experiments::marey_method({});
  std::vector<Frame> samples;
  const auto frame_of = [&](int index, const Image& image) {
    Frame frame;
    frame.index = index;
    frame.time = timestamp_from_seconds(index / video.options().rate_hz);
    frame.image = image;
    return frame;
  };
  for (int i = 0; i < PeopleVideo::kEarlier; ++i) samples.push_back(frame_of(i, video.render_earlier(i)));
  if (peers) silhouettes->prime(samples);
  marey->prime(samples);
  const int first = static_cast<int>(scene.from * video.frames());
  for (int i = first; i < video.frames(); ++i) {
    const RenderedFrame rendered = video.render(i);
    const Frame frame = frame_of(i - first, rendered.image);
    const auto plain = peers ? silhouettes->step(frame, {}, {}) : std::vector<experiments::TrackedShape>();
    const auto shapes = marey->step(frame, {}, {});
    if (i % kEvery != 0 || i < first + 10) continue;
    if (peers) assess(rendered, video.options().size, plain, scores.silhouettes);
    assess(rendered, video.options().size, shapes, scores.marey);
    if (peers && i % (2 * kEvery) == 0) evaluate_grabcut(rendered, video.options().size, scores.grabcut);
    if (!folder.empty() && i % (2 * kEvery) == 0)
      draw(fmt::format("{}/{}_{}_{:03}.png", folder, scene.name, seed, i), rendered, shapes);
  }
}

void print(const char* method, const Score& score) {
  fmt::print("  {:<20}{:>22}{:>22}{:>22}\n", method, score[0].text(), score[1].text(), score[2].text());
}

}  // namespace
}  // namespace marey

int main(int count, char** arguments) {
  const int videos = count > 1 ? std::atoi(arguments[1]) : 2;
  const std::string only = count > 2 ? arguments[2] : "",
                    folder = count > 3 && std::string(arguments[3]) != "-" ? arguments[3] : "";
  const bool peers = count > 4;
  if (!folder.empty()) std::filesystem::create_directories(folder);
  fmt::print(
      "of what is visible: mean IoU, share of 0.5 or more, precision, recall; overlaps of 20 to 70 %; recorded look but for the "
      "plain ones, 768x576, seeds "
      "1 to {}\n",
      videos);
  for (const marey::Scene& scene : marey::kScenes) {
    if (std::string(scene.name).find(only) == std::string::npos) continue;
    marey::Scores scores;
    for (int seed = 1; seed <= videos; ++seed) marey::run_tracker(scene, static_cast<std::uint64_t>(seed), folder, peers, scores);
    fmt::print("{:<22}{:>22}{:>22}{:>22}\n", scene.name, "alone", "front", "behind");
    if (peers) {
      marey::print("silhouettes", scores.silhouettes);
      marey::print("GrabCut, every 2nd", scores.grabcut);
    }
    marey::print("Marey", scores.marey);
    std::fflush(stdout);
  }
}
