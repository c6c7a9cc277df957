// Explaining foreground by people. A body is a head, a trunk and legs in a box. A place is good where the body's pixels are
// foreground that no person explains yet, and bad for every pixel of the body that is background; pixels explained by a person
// placed before, and those outside the image, count neither for nor against. People are placed one after another, the best place
// first (greedy): those known to be here near where they are expected, then new ones anywhere. Then each is moved to its best place
// given all the others. A person behind another is thus found by what sticks out, and keeps a whole body's box.
//
// All is done on a coarse grid, a person some 32 cells tall, whose sums over rectangles come from integral images; so the
// cost does not depend on the resolution: some 10 µs for each person in a group.
// References: Xu, Hilton et al., "Tracking football players with multiple cameras", 2004 (a shared region: boxes keep their
// size); Fleuret et al., "Multicamera people tracking with a probabilistic occupancy map", PAMI 30(2), 2008 (a mask
// explained by body-sized boxes); Viola & Jones, IJCV 57(2), 2004 (sums over rectangles).
#include "marey/detect/people/people_fit.h"

#include <algorithm>
#include <cmath>
#include <numeric>
#include <optional>

#include "marey/detect/people/people_grid.h"

namespace marey::detect::people {
namespace {

constexpr BodyPart kHead = {0.28, 0.0, 0.72, 0.16}, kTrunk = {0.10, 0.16, 0.90, 0.52}, kLegs = {0.18, 0.52, 0.82, 1.0};
constexpr double kBodyFraction = 0.44 * 0.16 + 0.8 * 0.36 + 0.64 * 0.48;  // of the box
constexpr double kMinTrunk = 0.15;                                        // filled, of what is not explained: a quick no
constexpr BodyPart kWholeBox = {0, 0, 1, 1};
constexpr BodyPart kAboveHead = {0.25, -0.16, 0.75, -0.02};
constexpr double kAboveHeadCost = 0.3;  // a head has no body above it, or this is a trunk
constexpr double kArmsScore = 0.2;      // of a pixel of the box beside the body, where one of the body is worth 1
constexpr double kDistanceCost = 1.0;   // of a known person found one width, or half a height, from where it is expected
constexpr double kReachAcross = 0.7;    // of the width: how far from there it is searched for
constexpr double kReachUp = 0.25;       // of the height
constexpr double kRefineAcross = 0.2, kRefineUp = 0.08;
constexpr double kMinVisible = 0.3;      // of the body: within the image, and not behind something
constexpr double kUnobservedCost = 0.2;  // of a body of which all is hidden: of two places, the visible one
constexpr double kKnownBefore = 0.15;    // of cover: this much better must a person new be, to come before a person known
constexpr double kHeightSlack = 0.08;    // how far a known person's height may be from the one learned
constexpr double kWidthSlack = 0.1;
constexpr int kMaxNew = 12;
constexpr double kBetter = 1e-9;  // by less, a place is as good as the one before it
constexpr int kCoarse = 2;        // cells between the places first tried

Box known_box(const Box& box, const FitScene& scene) {
  const auto foot = box.foot();
  const auto size = scene.size_at(foot.x(), foot.y());
  if (!size) return box;
  const double height = std::clamp(box.height, size->height * (1 - kHeightSlack), size->height * (1 + kHeightSlack));
  const double width = std::clamp(box.width, size->width * (1 - kWidthSlack), size->width * (1 + kWidthSlack));
  const auto centre = box.centre();
  return Box::from_centre(centre, width, height);
}

Box moved(const Box& box, double dx, double dy) {
  return {box.left + dx, box.top + dy, box.width, box.height};
}

class Fit {
 public:
  Fit(PeopleGrid& grid, const FitScene& scene, const PersonSize& typical, const FitOptions& options)
      : grid_(grid), scene_(scene), options_(options) {
    enough_ = 0.5 * options.min_cover_new * kMinVisible * kBodyFraction * typical.width * typical.height;
  }

  std::vector<Located> run(std::span<const Box> known) {
    position_all(known);
    refine();
    measure_observed();
    return std::move(located_);
  }

 private:
  struct Location {
    Box box;
    double cover = 0;
    double arms = 0;      ///< what the rest of the box adds to the value: foreground beside the body
    double fraction = 0;  ///< of the visible body that lies on unexplained foreground
    double value = -1;    ///< what is maximised: the cover less the costs of an unlikely place
  };

  Location inspect_at(const Box& box) const {
    Location location;
    location.box = box;
    location.cover = -1;
    PeopleGrid::Count body = grid_.count(box, kTrunk);
    if (body.filled < kMinTrunk * body.valid) return location;
    body += grid_.count(box, kHead);
    body += grid_.count(box, kLegs);
    const double area = kBodyFraction * box.area();
    if (body.visible < kMinVisible * area) return location;
    const double unobserved = std::max(0.0, 1 - body.visible / area);
    location.cover =
        (body.filled - options_.blank_penalty * (body.valid - body.filled)) / body.visible - kUnobservedCost * unobserved;
    location.arms = kArmsScore * std::max(0, grid_.count(box, kWholeBox).filled - body.filled) / area;
    location.fraction = static_cast<double>(body.filled) / body.visible;
    return location;
  }

  double above_head(const Box& box) const {
    const PeopleGrid::Count count = grid_.count(box, kAboveHead);
    return count.valid > 0 ? kAboveHeadCost * count.filled / count.valid : 0;
  }

  Location best_near(const Box& box, double across, double up) const {
    Location best;
    const double step = grid_.cell();
    const int most_x = std::max(1, static_cast<int>(across * box.width / step));
    const int most_y = std::max(1, static_cast<int>(up * box.height / step));
    for (int y = -most_y; y <= most_y; ++y) {
      for (int x = -most_x; x <= most_x; ++x) {
        const Box there = moved(box, x * step, y * step);
        const double dx = x * step / box.width, dy = 2 * y * step / box.height;
        Location location = inspect_at(there);
        location.value = location.cover + location.arms - kDistanceCost * (dx * dx + dy * dy);
        if (location.value > best.value) best = location;
      }
    }
    return best;
  }

  void location(const Location& location, int known) {
    located_.push_back({location.box, location.cover, 0, known});
    grid_.explain(location.box);
    grid_.sum();
  }

  void position_all(std::span<const Box> known) {
    std::vector<int> waiting(known.size());
    std::iota(waiting.begin(), waiting.end(), 0);
    std::vector<std::optional<Location>> nearest(known.size());  // the location near each, while no person is placed about there
    const auto place_one = [&](const Location& one, int identity) {
      location(one, identity);
      for (const int other : waiting) {
        const Box box = known_box(known[other], scene_);
        if (may_change(box, kReachAcross * box.width, kReachUp * box.height, one.box)) nearest[other].reset();
      }
      for (Candidate& candidate : candidates_) {
        const Box& box = candidate.location.box;
        candidate.stale = candidate.stale || may_change(box, 0, -kAboveHead.top * box.height, one.box);
      }
    };
    for (int newcomers = 0; newcomers < kMaxNew;) {
      Location best;
      std::size_t identity = 0;
      for (std::size_t i = 0; i < waiting.size(); ++i) {
        std::optional<Location>& near = nearest[waiting[i]];
        if (!near) near = best_near(known_box(known[waiting[i]], scene_), kReachAcross, kReachUp);
        const Location& found = *near;
        if (found.cover < options_.min_cover_known && found.fraction < options_.min_fraction_known) continue;
        if (found.value <= best.value) continue;
        best = found;
        identity = i;
      }
      const Location other = best_anywhere();
      if (other.cover >= options_.min_cover_new && other.value > best.value + kKnownBefore) {
        place_one(other, -1);
        ++newcomers;
      } else if (best.value > -1) {
        place_one(best, waiting[identity]);
        waiting.erase(waiting.begin() + static_cast<std::ptrdiff_t>(identity));
      } else {
        return;
      }
    }
  }

  /// Whether a person placed in `placed` may change how good a place is that lies within `across` and `up` of `box`.
  bool may_change(const Box& box, double across, double up, const Box& located) const {
    const double slack = 3 * grid_.cell();
    across += 0.03 * located.width + slack;
    up += 0.08 * located.height + slack;
    return box.left - across < located.right() && located.left < box.right() + across && box.top - up < located.bottom() &&
           located.top < box.bottom() + up;
  }

  /// A place for a person new, and what it was worth when last computed.
  struct Candidate {
    Location location;
    bool stale = true;  ///< a person was placed about there since
  };

  /// From the bottom up: of places equally good, the lowest, whose head is the top of the silhouette.
  void list_candidates() {
    const double step = kCoarse * grid_.cell();
    for (double foot_y = grid_.bottom(); foot_y > grid_.top(); foot_y -= step) {
      for (double foot_x = grid_.left(); foot_x < grid_.right(); foot_x += step) {
        if (const auto size = scene_.size_at(foot_x, foot_y)) candidates_.push_back({{.box = size->box_at(foot_x, foot_y)}});
      }
    }
  }

  Location best_anywhere() {
    Location best;
    if (grid_.filled_in_all() < enough_) return best;
    if (candidates_.empty()) list_candidates();
    for (Candidate& candidate : candidates_) {
      if (candidate.stale) candidate = {search_new(candidate.location.box), false};
      if (candidate.location.value > best.value + kBetter) best = candidate.location;
    }
    if (best.value <= -1) return best;
    const auto foot = best.box.foot();
    for (int y = kCoarse - 1; y > -kCoarse; --y) {
      for (int x = 1 - kCoarse; x < kCoarse; ++x) {
        const double foot_x = foot.x() + x * grid_.cell(), foot_y = foot.y() + y * grid_.cell();
        const auto size = scene_.size_at(foot_x, foot_y);
        if (!size) continue;
        const Location location = search_new(size->box_at(foot_x, foot_y));
        if (location.value > best.value + kBetter) best = location;
      }
    }
    return best;
  }

  Location search_new(const Box& box) const {
    Location location = inspect_at(box);
    if (location.cover >= options_.min_cover_new) location.value = location.cover + location.arms - above_head(box);
    return location;
  }

  void refine() {
    if (located_.size() < 2) return;
    for (std::size_t i = 0; i < located_.size(); ++i) {
      explain_all_but(i);
      const Location better = best_near(located_[i].box, kRefineAcross, kRefineUp);
      if (better.cover < located_[i].cover) continue;
      located_[i].box = better.box;
      located_[i].cover = better.cover;
    }
  }

  void explain_all_but(std::size_t excluded) {
    grid_.reset();
    for (std::size_t i = 0; i < located_.size(); ++i) {
      if (i != excluded) grid_.explain(located_[i].box);
    }
    grid_.sum();
  }

  void measure_observed() {
    grid_.reset();
    grid_.sum();
    for (Located& one : located_) {
      PeopleGrid::Count body = grid_.count(one.box, kHead);
      body += grid_.count(one.box, kTrunk);
      body += grid_.count(one.box, kLegs);
      one.detected = body.valid > 0 ? static_cast<double>(body.filled) / body.valid : 0;
    }
  }

  PeopleGrid& grid_;
  const FitScene& scene_;
  const FitOptions& options_;
  double enough_;  ///< px² of unexplained foreground, half of the least that can make a person new
  std::vector<Located> located_;
  std::vector<Candidate> candidates_;
};

Box bounds_of(std::span<const PixelRun> runs) {
  int left = runs.front().begin, right = runs.front().end;
  for (const PixelRun& run : runs) {
    left = std::min(left, run.begin);
    right = std::max(right, run.end);
  }
  return {double(left), double(runs.front().row), double(right - left), double(runs.back().row + 1 - runs.front().row)};
}

}  // namespace

std::vector<Located> fit_people(std::span<const PixelRun> runs, std::span<const Box> known, const FitScene& scene,
                                const FitOptions& options) {
  if (runs.empty()) return {};
  Box location = bounds_of(runs);
  const auto foot = location.foot();
  PersonSize typical{location.height, location.width};
  if (const auto size = scene.size_at(foot.x(), foot.y()))
    typical = *size;
  else if (known.empty())
    return {};
  else
    typical = {known.front().height, known.front().width};
  for (const Box& box : known) location = geometry::hull(location, box);
  const double cell = std::max(1.0, std::round(typical.height / options.cells_tall));
  const Box wide{std::floor(location.left - typical.width), std::floor(location.top - typical.height / 4),
                 location.width + 2 * typical.width + 1, location.height + typical.height + 1};
  PeopleGrid grid(wide, scene, cell);
  grid.fill(runs, scene);
  return Fit(grid, scene, typical, options).run(known);
}

}  // namespace marey::detect::people
