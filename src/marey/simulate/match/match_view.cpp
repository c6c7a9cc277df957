// A person's box is that of its figure's limbs, each seen as two discs and what lies between them, so that it breathes with the
// gait as real boxes do. Occlusion is counted on a coarse raster of each box: a cell is hidden where the box of a person
// nearer covers it. Cost: two projections a limb, some fifty a person and camera.
#include "marey/simulate/match/match_view.h"

#include <algorithm>
#include <cmath>

#include "marey/simulate/people/silhouette_raster.h"

namespace marey::simulate::match {
namespace {

constexpr int kColumns = 8, kRows = 16;  // of the raster of a box
constexpr double kBodyFraction = 0.75;   // of the width of a box that its person fills: people see past each other's elbows
constexpr double kMinHeight = 4;         // px; a box lower than this is not a person's

struct Located {
  ObservedPerson detected;
  double depth = 0;  // m
};

std::optional<Located> location(const GroundView& view, const people::Figure& figure, const people::Stance& stance) {
  const auto foot = sight(view, {stance.location.x(), stance.location.y(), 0});
  if (!foot) return std::nullopt;
  Located located;
  located.depth = foot->depth;
  for (const people::Limb& limb : people::pose(figure, stance)) {
    const auto from = sight(view, limb.from), to = sight(view, limb.to);
    if (!from || !to) return std::nullopt;
    const Box box =
        people::bounds(people::RoundCone2{from->at, to->at, limb.from_radius * from->scale, limb.to_radius * to->scale});
    located.detected.whole = located.detected.whole.empty() ? box : geometry::hull(located.detected.whole, box);
  }
  return located;
}

bool holds(const Box& box, double x, double y) {
  const double trim = (1 - kBodyFraction) / 2 * box.width;
  return x >= box.left + trim && x < box.right() - trim && y >= box.top && y < box.bottom();
}

double visible_fraction(const Located& located, std::span<const Located> all) {
  std::vector<const Box*> before;
  for (const Located& other : all) {
    if (other.depth < located.depth && !geometry::intersection(other.detected.whole, located.detected.whole).empty())
      before.push_back(&other.detected.whole);
  }
  const Box& box = located.detected.whole;
  int visible = 0;
  for (int row = 0; row < kRows; ++row) {
    const double y = box.top + box.height * (row + 0.5) / kRows;
    for (int column = 0; column < kColumns; ++column) {
      const double x = box.left + box.width * (column + 0.5) / kColumns;
      const Box& shown = located.detected.shown;
      if (x < shown.left || x >= shown.right() || y < shown.top || y >= shown.bottom()) continue;
      visible += std::none_of(before.begin(), before.end(), [&](const Box* other) { return holds(*other, x, y); }) ? 1 : 0;
    }
  }
  return static_cast<double>(visible) / (kRows * kColumns);
}

/// Every edge moves on its own, so that a size has the deviation asked for.
Box disturbed(const Box& box, double noise, Random& random) {
  const double sigma = noise / std::sqrt(2.0);
  const double left = box.left + sigma * box.width * random.gaussian();
  const double right = box.right() + sigma * box.width * random.gaussian();
  const double top = box.top + sigma * box.height * random.gaussian();
  const double bottom = box.bottom() + sigma * box.height * random.gaussian();
  return {left, top, std::max(1.0, right - left), std::max(1.0, bottom - top)};
}

int poisson(double mean, Random& random) {
  const double minimum = std::exp(-mean);
  int count = 0;
  for (double product = random.uniform(); product > minimum; product *= random.uniform()) ++count;
  return count;
}

/// What the box of a person upright at a place of the ground would be; nothing if that is out of the image.
std::optional<Box> box_at(const GroundView& view, const Vector<2>& at, double stature) {
  const auto foot = sight(view, {at.x(), at.y(), 0}), head = sight(view, {at.x(), at.y(), stature});
  if (!foot || !head || !view.camera()->in_image(foot->at) || !view.camera()->in_image(head->at)) return std::nullopt;
  const double height = foot->at.y() - head->at.y();
  if (height < kMinHeight) return std::nullopt;
  return Box::from_centre((foot->at + head->at) / 2, 0.3 * height, height);
}

void clothe(people::Figure& figure, const people::Rgb& shirt, const people::Rgb& shorts, const people::Rgb& socks) {
  figure.colours[static_cast<std::size_t>(people::FigurePart::shirt)] = shirt;
  figure.colours[static_cast<std::size_t>(people::FigurePart::shorts)] = shorts;
  figure.colours[static_cast<std::size_t>(people::FigurePart::socks)] = socks;
}

}  // namespace

std::optional<people::Sighting> sight(const GroundView& view, const Vector<3>& on_level) {
  const Vector<3> point = on_level + Vector<3>(0, 0, view.surface().height(on_level.head<2>()));
  const auto detected = view.camera()->project_with_jacobian(point);
  if (!detected) return std::nullopt;
  // Two of the three directions of space change the pixel: the geometric mean of how much.
  const double scale = std::pow((detected->by_world * detected->by_world.transpose()).determinant(), 0.25);
  return people::Sighting{detected->pixel, scale, (point - view.camera()->centre()).norm()};
}

std::array<people::Figure, kMatchPeople> match_figures(std::uint64_t seed) {
  Random random(seed * 2654435761u + 31);
  std::array<people::Figure, kMatchPeople> figures;
  for (std::size_t i = 0; i < figures.size(); ++i) {
    const int team = match_team(static_cast<int>(i)) == "white" ? 0 : 1;
    figures[i] = people::draw_figure(random, team);
    figures[i].stature = std::clamp(random.gaussian(1.79, 0.055), 1.68, 1.95);
    if (i >= kMatchPlayers)
      clothe(figures[i], {28, 28, 30}, {24, 24, 26}, {26, 26, 28});
    else if (i == 0)
      clothe(figures[i], {226, 205, 40}, {215, 192, 38}, {220, 200, 40});
    else if (i == kMatchSide)
      clothe(figures[i], {230, 110, 30}, {40, 40, 44}, {226, 108, 30});
    else if (team == 0)
      clothe(figures[i], {232, 233, 236}, {226, 227, 232}, {225, 225, 230});
    else
      clothe(figures[i], {26, 84, 190}, {24, 74, 176}, {26, 82, 186});
  }
  return figures;
}

people::Stance match_stance(const MatchPerson& person, const Matrix<3>& world_from_pitch) {
  const Matrix<2> turn = world_from_pitch.topLeftCorner<2, 2>();
  people::Stance stance;
  stance.location = turn * person.location + world_from_pitch.topRightCorner<2, 1>();
  const Vector<2> face = turn * Vector<2>(std::cos(person.heading), std::sin(person.heading));
  stance.heading = std::atan2(face.y(), face.x());
  stance.speed = person.velocity.norm();
  stance.phase = person.phase;
  return stance;
}

std::vector<ObservedPerson> people_in_view(const GroundView& view, std::span<const people::Figure, kMatchPeople> figures,
                                           std::span<const people::Stance, kMatchPeople> stances) {
  const Box image{0, 0, static_cast<double>(view.size().width), static_cast<double>(view.size().height)};
  std::vector<Located> all;
  for (std::size_t i = 0; i < figures.size(); ++i) {
    auto located = location(view, figures[i], stances[i]);
    if (!located) continue;
    located->detected.person = static_cast<int>(i);
    located->detected.shown = geometry::intersection(located->detected.whole, image);
    if (!located->detected.shown.empty() && located->detected.whole.height >= kMinHeight) all.push_back(*located);
  }
  std::vector<ObservedPerson> detected;
  for (const Located& located : all) {
    detected.push_back(located.detected);
    detected.back().visible_fraction = visible_fraction(located, all);
  }
  return detected;
}

ObservedPerson with_foot_moved(const ObservedPerson& detected, const GroundView& view, const Vector<2>& location,
                               const Vector<2>& by) {
  const auto from = sight(view, {location.x(), location.y(), 0}),
             to = sight(view, {location.x() + by.x(), location.y() + by.y(), 0});
  if (!from || !to) return detected;
  const Vector<2> moved = to->at - from->at;
  ObservedPerson result = detected;
  const bool cut = detected.shown.bottom() < detected.whole.bottom();
  result.shown.left += moved.x();
  if (!cut) result.shown.height = std::max(1.0, detected.shown.height + moved.y());
  return result;
}

std::vector<LabelledBox> detect_match(std::span<const ObservedPerson> detected, const GroundView& view,
                                      const Matrix<3>& world_from_pitch, const geometry::PitchSize& pitch, std::int32_t frame,
                                      const MatchDetectorOptions& options, Random& random) {
  std::vector<LabelledBox> boxes;
  for (const ObservedPerson& person : detected) {
    // The same numbers are drawn whatever results from them, so that one person's luck does not change another's.
    const double luck = random.uniform();
    const Box box = disturbed(person.shown, options.size_noise, random);
    const double score =
        std::clamp(0.86 * std::min(1.0, 0.55 + 0.45 * person.visible_fraction) + 0.08 * random.gaussian(), 0.1, 1.0);
    const double found = person.visible_fraction < kHiddenFraction ? options.hidden_found : 1.0;
    if (luck < (1 - options.missed) * found) boxes.push_back({frame, LabelledBox::no_person, box, score});
  }
  constexpr double kMargin = 3;   // m
  constexpr int kAttempts = 200;  // to find a place that the camera sees
  for (int left = poisson(options.false_alarms, random); left > 0; --left) {
    for (int attempt = 0; attempt < kAttempts; ++attempt) {
      const Vector<3> at = random.uniform_pair(-kMargin, pitch.length + kMargin, -kMargin, pitch.width + kMargin).homogeneous();
      const auto box = box_at(view, (world_from_pitch * at).head<2>(), random.uniform(1.5, 2));
      if (!box) continue;
      const double score = std::clamp(random.gaussian(0.55, 0.15), 0.1, 1.0);
      boxes.push_back({frame, LabelledBox::no_person, disturbed(*box, options.size_noise, random), score});
      break;
    }
  }
  std::stable_sort(boxes.begin(), boxes.end(), [](const LabelledBox& a, const LabelledBox& b) { return a.box.left < b.box.left; });
  return boxes;
}

}  // namespace marey::simulate::match
