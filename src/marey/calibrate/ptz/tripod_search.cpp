#include "marey/calibrate/ptz/tripod_search.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "marey/calibrate/ptz/frame_fit.h"
#include "marey/core/stop.h"
#include "marey/geometry/ground_view.h"

namespace marey::calibrate::ptz {
namespace {

constexpr double kSampleStep = 0.5;                     // m between samples of the model's lines; numerical
constexpr std::array<double, 3> kAcross{-1.6, 0, 1.6};  // deviations from where main cameras stand: tripods that are tried
constexpr std::array<double, 4> kBehind{-1.2, -0.4, 0.4, 1.1};
constexpr std::array<double, 4> kUp{-1.4, -0.5, 0.4, 1.5};
constexpr double kMinUp = 3;                         // m up: no main camera stands lower; physical
constexpr double kMaxApart = 2.5;                    // deviations; numerical
constexpr double kRangeOfMiddle = 110;               // m: where an image's middle shows no ground; numerical
constexpr std::array<double, 3> kMove{1.5, 4, 1.5};  // m: the first steps of a tripod that is moved
constexpr double kSameGround = 5;                    // m: hypotheses that show the same ground are one
constexpr std::size_t kStarts = 40, kOfTripod = 4;   // headings of one tripod; numerical: cost alone
constexpr std::size_t kHeadings = 3;                 // of an image that a hypothesis is tested on; numerical: cost alone

struct Hypothesis {
  geometry::Tripod tripod;
  geometry::Heading heading;
  double score = 0;
};

struct Search {
  Search(std::span<const SearchImage> given, const geometry::PitchSize& size, const TripodSolveOptions& how,
         const TripodSearchOptions& what)
      : images(given), pitch(size), lines(geometry::pitch_lines(size, kSampleStep)), samples(lines), solve(how), options(what) {
    for (const SearchImage& one : images) masks.push_back(paint_mask(one.image, options.again.mask));
    solve.near = near;
  }
  cv::Size size() const { return images.front().image.size(); }
  double aspect() const { return static_cast<double>(masks.front().near.rows) / masks.front().near.cols; }

  std::span<const SearchImage> images;
  geometry::PitchSize pitch;
  std::vector<geometry::PitchLine> lines;
  SearchLines samples;
  TripodSolveOptions solve;
  TripodSearchOptions options;
  std::vector<PaintMask> masks;
  LocationPrior near = main_camera_prior(pitch);
};

std::vector<geometry::Tripod> tripods_of(const Search& search) {
  std::vector<geometry::Tripod> tripods;
  for (const double x : kAcross) {
    for (const double y : kBehind) {
      for (const double z : kUp) {
        geometry::Tripod& tripod = tripods.emplace_back();
        tripod.location = search.near.location + search.near.sigma.cwiseProduct(Vector<3>(x, y, z));
        tripod.ahead = search.solve.ahead, tripod.bend = search.solve.bend;
      }
    }
  }
  return tripods;
}

/// The tripod moved, with the heading that shows the same ground in the image's middle as large as before.
Hypothesis moved(const Hypothesis& from, const Vector<3>& by) {
  const auto numbers = from.tripod.as_numbers();
  const Vector<3> rotated = from.heading.as_vector();
  const geometry::TripodFrame<double> frame(numbers.data(), rotated.data());
  const double range = frame.ahead.z() < -1e-3 ? std::min(kRangeOfMiddle, -frame.centre.z() / frame.ahead.z()) : kRangeOfMiddle;
  const Vector<3> middle = from.tripod.location + range * frame.ahead;
  Hypothesis to = from;
  to.tripod.location += by;
  const Vector<3> was = middle - from.tripod.location, is = middle - to.tripod.location;
  const auto pan = [](const Vector<3>& ray) { return std::atan2(ray.x(), ray.y()); };
  const auto tilt = [](const Vector<3>& ray) { return std::atan2(-ray.z(), ray.head<2>().norm()); };
  to.heading.pan += pan(is) - pan(was);
  to.heading.tilt += tilt(is) - tilt(was);
  to.heading.log_focal += std::log(is.norm() / was.norm());
  return to;
}

bool stands_apart(const Search& search, const Hypothesis& one) {
  const Vector<3> off = (one.tripod.location - search.near.location).cwiseQuotient(search.near.sigma);
  return off.cwiseAbs().maxCoeff() > kMaxApart || one.tripod.location.z() < kMinUp;
}

/// Tripod and heading together, by small steps to the top of the score.
Hypothesis climbed_together(const Search& search, const PaintMask& seen, Hypothesis at) {
  const auto rate = [&](Hypothesis& one) {
    one.score = stands_apart(search, one) ? -1e9 : search.samples.fine.score(seen.near, one.tripod, one.heading);
  };
  rate(at);
  for (double part = 1; part > 0.08; part /= 1.7) {
    for (int round = 0; round < 6; ++round) {
      const HeadingCandidate turned = climbed(seen, at.tripod, search.samples, {at.heading, at.score});
      at.heading = turned.heading, at.score = turned.score;
      Hypothesis best = at;
      for (int axis = 0; axis < 3; ++axis) {
        for (const double side : {-1.0, 1.0}) {
          Hypothesis other = moved(at, side * part * kMove[static_cast<std::size_t>(axis)] * Vector<3>::Unit(axis));
          rate(other);
          if (other.score > best.score) best = other;
        }
      }
      if (best.score <= at.score) break;
      at = best;
    }
  }
  return at;
}

/// Whether two hypotheses show the same ground: they are one.
bool same_ground(const Hypothesis& a, const Hypothesis& b, cv::Size size) {
  const geometry::GroundView left(geometry::camera_of(a.tripod, a.heading, size)),
      right(geometry::camera_of(b.tripod, b.heading, size));
  int both = 0;
  for (const double x : {0.15, 0.5, 0.85}) {
    for (const double y : {0.5, 0.8}) {
      const auto u = left.location({x * size.width, y * size.height}), v = right.location({x * size.width, y * size.height});
      if (!u || !v) continue;
      if ((u->ground - v->ground).norm() > kSameGround) return false;
      ++both;
    }
  }
  return both > 0;
}

/// The best hypotheses of an image that show different ground.
std::vector<Hypothesis> hypotheses_of(const Search& search, std::size_t image) {
  const PaintMask& seen = search.masks[image];
  std::vector<Hypothesis> all;
  for (const geometry::Tripod& tripod : tripods_of(search)) {
    stop_point();
    const auto range = headings_over_pitch(tripod, search.pitch, search.options.again.min_log_focal, search.options.max_log_focal);
    for (const HeadingCandidate& one :
         best_headings(seen, tripod, search.samples, headings_in(range, search.aspect(), true), kStarts, kOfTripod))
      all.push_back({tripod, one.heading, one.score});
  }
  const auto better = [](const Hypothesis& a, const Hypothesis& b) { return a.score > b.score; };
  std::stable_sort(all.begin(), all.end(), better);
  all.resize(std::min(all.size(), search.options.climbed));
  cv::parallel_for_(cv::Range(0, static_cast<int>(all.size())), [&](const cv::Range& range) {
    for (int i = range.start; i < range.end; ++i) {
      Hypothesis& one = all[static_cast<std::size_t>(i)];
      one = climbed_together(search, seen, one);
    }
  });
  std::stable_sort(all.begin(), all.end(), better);
  std::vector<Hypothesis> best;
  for (const Hypothesis& one : all) {
    const bool known =
        std::any_of(best.begin(), best.end(), [&](const Hypothesis& other) { return same_ground(one, other, seen.near.size()); });
    if (!known) best.push_back(one);
    if (best.size() == 2 * search.options.tested) break;
  }
  return best;
}

/// What of the images a tripod explains.
struct Tested {
  geometry::Tripod tripod;
  Matrix<geometry::Tripod::numbers> covariance = Matrix<geometry::Tripod::numbers>::Zero();
  std::vector<std::optional<ImageEvidence>> views;  // one an image
  double merit = 0;
  std::size_t explained = 0;
};

/// One image's hypothesis on its paint, place and heading together, by what main cameras have in common.
void refine_alone(const Search& search, std::size_t image, Hypothesis& one) {
  const cv::Mat& luma = search.images[image].image.luma();
  for (const double reach : {18.0, 12.0, 7.0, 4.0}) {
    PaintOptions how;
    how.reach = reach * std::max(0.7, luma.cols / 1280.0);
    const Paint paint = find_paint(luma, one.tripod, one.heading, search.lines, how);
    const std::array<TripodFrameSight, 1> sight{TripodFrameSight{one.heading, paint.detected, {}}};
    const TripodSolution found = solve_tripod(one.tripod, sight, search.size(), search.solve);
    if (!std::isfinite(found.cost) || found.tripod.location.z() < kMinUp) return;
    one.tripod = found.tripod, one.heading = found.headings.front();
  }
}

ImageEvidence evidence_at(const Search& search, std::size_t image, const geometry::Tripod& tripod,
                          const geometry::Heading& heading) {
  return evidence_of(search.images[image].image, search.masks[image], tripod, search.pitch, search.lines, heading,
                     search.options.again);
}

/// The heading in an image that explains it, if it is enough and no other explains it nearly as well.
std::optional<ImageEvidence> heading_in(const Search& search, std::size_t image, const geometry::Tripod& tripod) {
  const FindAgainOptions& again = search.options.again;
  const auto range = headings_over_pitch(tripod, search.pitch, again.min_log_focal, search.options.max_log_focal);
  auto all = headings_by_evidence(search.images[image].image, search.masks[image], tripod, search.pitch, search.lines,
                                  search.samples, headings_in(range, search.aspect(), true), kHeadings, again);
  if (all.empty() || !all.front().enough(again)) return std::nullopt;
  for (std::size_t i = 1; i < all.size(); ++i) {
    if (!alike(all[i].fit.aim.heading, all.front().fit.aim.heading) && all[i].merit() > again.rival * all.front().merit())
      return std::nullopt;
  }
  return std::move(all.front());
}

/// Solves the tripod on all images that it explains, and inspects them again with it.
void solve_together(const Search& search, Tested& tested) {
  std::vector<TripodFrameSight> sights;
  std::vector<std::size_t> of;
  for (std::size_t i = 0; i < tested.views.size(); ++i) {
    if (!tested.views[i]) continue;
    sights.push_back({tested.views[i]->fit.aim.heading, tested.views[i]->paint, {}});
    of.push_back(i);
  }
  if (sights.empty()) return;
  const TripodSolution found = solve_tripod(tested.tripod, sights, search.size(), search.solve);
  if (!std::isfinite(found.cost)) return;
  tested.tripod = found.tripod, tested.covariance = found.covariance;
  for (std::size_t k = 0; k < of.size(); ++k) {
    tested.views[of[k]] = evidence_at(search, of[k], tested.tripod, found.headings[k]);
    if (!tested.views[of[k]]->enough(search.options.again)) tested.views[of[k]].reset();
  }
}

void count_up(Tested& tested) {
  tested.merit = 0, tested.explained = 0;
  for (const auto& view : tested.views) {
    if (view) tested.merit += view->merit(), ++tested.explained;
  }
}

/// A hypothesis of one image, tested on all of them.
Tested tested(const Search& search, std::size_t image, const Hypothesis& one) {
  Tested result;
  result.tripod = one.tripod;
  result.views.resize(search.images.size());
  result.views[image] = evidence_at(search, image, one.tripod, one.heading);
  for (int round = 0; round < 2; ++round) {
    for (std::size_t i = 0; i < result.views.size(); ++i) {
      stop_point();
      if (!result.views[i]) result.views[i] = heading_in(search, i, result.tripod);
    }
    solve_together(search, result);
    solve_together(search, result);
  }
  count_up(result);
  return result;
}

/// How many lines of the model are seen in one image or another; the centre circle counts as two, as it fixes a view alone.
int lines_observed(const Search& search, const Tested& tested) {
  constexpr int kPieces = 5;  // of a line in an image: numerical, fewer may be people's
  std::vector<int> most(search.lines.size(), 0);
  for (const auto& view : tested.views) {
    if (!view) continue;
    std::vector<int> pieces(search.lines.size(), 0);
    for (const PaintSighting& one :
         agreeing_paint(view->paint, tested.tripod, view->fit.aim, search.size(), AimOptions{}.cut_off / 2, view->paint.size()))
      ++pieces[static_cast<std::size_t>(one.line)];
    for (std::size_t i = 0; i < most.size(); ++i) most[i] = std::max(most[i], pieces[i]);
  }
  int count = 0;
  for (std::size_t i = 0; i < most.size(); ++i) count += most[i] < kPieces ? 0 : search.lines[i].name == "centre circle" ? 2 : 1;
  return count;
}

/// Whether a line of the model that ought to be in view is in no image: the pitch is another sport's, or the view is wrong.
bool lacks_a_line(const Search& search, const Tested& tested) {
  constexpr int kInView = 60;  // pieces of a line in all images together; numerical: with fewer nothing is said
  for (const geometry::PitchLine& line : search.lines) {
    int expected = 0, agreeing = 0;
    for (std::size_t i = 0; i < tested.views.size(); ++i) {
      if (!tested.views[i]) continue;
      const Aim& aim = tested.views[i]->fit.aim;
      PaintOptions how;
      how.reach = 4 * std::max(1.0, search.size().width / 1280.0);
      const Paint paint = find_paint(search.images[i].image.luma(), tested.tripod, aim.heading,
                                     std::span<const geometry::PitchLine>(&line, 1), how);
      expected += paint.expected;
      agreeing += static_cast<int>(
          agreeing_paint(paint.detected, tested.tripod, aim, search.size(), AimOptions{}.cut_off / 2, paint.detected.size())
              .size());
    }
    if (expected >= kInView && agreeing < search.options.line_present * expected) return true;
  }
  return false;
}

bool same_answer(const Search& search, const Tested& a, const Tested& b) {
  for (std::size_t i = 0; i < a.views.size(); ++i) {
    if (a.views[i] && b.views[i])
      return same_ground({a.tripod, a.views[i]->fit.aim.heading}, {b.tripod, b.views[i]->fit.aim.heading}, search.size());
  }
  return false;
}

/// Indices of the images that show most lines, the best first.
std::vector<std::size_t> richest(std::span<const SearchImage> images, std::size_t count) {
  std::vector<std::size_t> order(images.size());
  for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
  std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return images[a].lines > images[b].lines; });
  order.resize(std::min(order.size(), count));
  return order;
}

std::vector<Tested> all_tested(const Search& search) {
  std::vector<Tested> all;
  for (const std::size_t image : richest(search.images, search.options.start_images)) {
    std::vector<std::pair<double, Hypothesis>> refined;
    for (Hypothesis& one : hypotheses_of(search, image)) {
      stop_point();
      refine_alone(search, image, one);
      const ImageEvidence evidence = evidence_at(search, image, one.tripod, one.heading);
      one.heading = evidence.fit.aim.heading;
      if (evidence.enough(search.options.again)) refined.emplace_back(evidence.merit(), one);
    }
    std::stable_sort(refined.begin(), refined.end(), [](const auto& a, const auto& b) { return a.first > b.first; });
    refined.resize(std::min(refined.size(), search.options.tested));
    for (const auto& [merit, one] : refined) {
      const bool known = std::any_of(all.begin(), all.end(), [&](const Tested& other) {
        return other.views[image] && same_ground({other.tripod, other.views[image]->fit.aim.heading}, one, search.size());
      });
      if (!known) all.push_back(tested(search, image, one));
    }
  }
  std::stable_sort(all.begin(), all.end(), [](const Tested& a, const Tested& b) { return a.merit > b.merit; });
  return all;
}

}  // namespace

LocationPrior main_camera_prior(const geometry::PitchSize& pitch) {
  return {Vector<3>(pitch.length / 2, -31, 15), {2.5, 12, 4.5}};
}

SearchedTripod search_tripod(std::span<const SearchImage> images, const geometry::PitchSize& pitch, const TripodSolveOptions& solve,
                             const TripodSearchOptions& options) {
  SearchedTripod result;
  const auto rich = std::count_if(images.begin(), images.end(), [&](const auto& one) { return one.lines >= options.many_lines; });
  result.verdict = TripodVerdict::no_lines;
  if (rich < 1) return result;
  const Search search(images, pitch, solve, options);
  const std::vector<Tested> all = all_tested(search);
  result.verdict = TripodVerdict::none;
  if (all.empty()) return result;
  const Tested& best = all.front();
  result.tripod = best.tripod, result.covariance = best.covariance, result.merit = best.merit;
  for (std::size_t i = 0; i < images.size(); ++i) {
    if (best.views[i]) result.views.push_back({images[i].frame, best.views[i]->fit.aim.heading, best.views[i]->both()});
  }
  for (const Tested& other : all) {
    if (!same_answer(search, other, best)) result.rival = std::max(result.rival, other.merit);
  }
  if (best.explained < std::min(images.size(), options.lowest_images) ||
      static_cast<double>(best.explained) < options.fraction * static_cast<double>(rich) ||
      lines_observed(search, best) < options.lines || lacks_a_line(search, best))
    return result;
  result.verdict = result.rival > options.rival * result.merit ? TripodVerdict::ambiguous : TripodVerdict::found;
  return result;
}

}  // namespace marey::calibrate::ptz
