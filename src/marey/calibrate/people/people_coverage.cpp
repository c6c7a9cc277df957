#include "marey/calibrate/people/people_coverage.h"

#include <algorithm>

#include <fmt/format.h>

#include "marey/calibrate/people/image_people.h"

namespace marey::calibrate::people {
namespace {

constexpr double kMoved = 0.1;  // by definition: of the body's size, between views that count

}  // namespace

void PeopleCoverage::add(std::span<const View> seen) {
  std::vector<char> shown(seen.size(), 0), fresh(seen.size(), 0);
  for (std::size_t c = 0; c < seen.size(); ++c) {
    if (seen[c].size.empty()) continue;
    std::vector<Points> people;
    for (const Keypoints<2>& person : seen[c].people) {
      if (Points points = sure_points(person); !points.empty()) people.push_back(std::move(points));
    }
    shown[c] = !people.empty();
    fresh[c] = std::any_of(people.begin(), people.end(), [&](const Points& person) {
      return std::all_of(counted_[c].begin(), counted_[c].end(),
                         [&](const Points& before) { return distance_in_sizes(before, person) >= kMoved; });
    });
    if (!fresh[c]) continue;
    std::vector<Vector<2>> pixels;
    for (const Points& person : people) {
      for (const auto& point : person) {
        if (point) pixels.push_back(*point);
      }
    }
    images_.add_view(c, pixels, seen[c].size);
    counted_[c] = std::move(people);
  }
  for (std::size_t a = 0; a < seen.size(); ++a) {
    for (std::size_t b = a + 1; b < seen.size(); ++b) images_.add_shared(a, b, shown[a] && shown[b] && (fresh[a] || fresh[b]));
  }
}

std::vector<std::string> PeopleCoverage::missing(std::span<const std::string> names) const {
  const std::vector<std::size_t> first = images_.chained_to();
  std::vector<std::string> sentences;
  for (std::size_t c = 0; c < names.size(); ++c) {
    if (images_.views(c) == 0) {
      sentences.push_back(fmt::format("camera \"{}\" has seen no person: walk before it", names[c]));
      continue;
    }
    if (first[c] != 0) {
      // The camera that it has most in common with already.
      std::size_t best = 0;
      for (std::size_t other = 0; other < names.size(); ++other) {
        if (first[other] != first[c] && images_.shared(c, other) > images_.shared(c, best)) best = other;
      }
      const std::int64_t views = images_.shared(c, best);
      sentences.push_back(
          views == 0
              ? fmt::format("camera \"{}\" has seen no person together with \"{}\": walk where both see you", names[c], names[best])
              : fmt::format("camera \"{}\" has {} of {} views together with \"{}\": walk on where both see you", names[c], views,
                            images_.criteria().shared, names[best]));
    }
    if (!images_.is_covered(c))
      sentences.push_back(
          fmt::format("camera \"{}\" has seen people in {:.0f} % of its image, {:.0f} % are wanted: walk nearer to "
                      "it, and from side to side of its image",
                      names[c], 100 * images_.coverage(c), 100 * images_.criteria().fraction));
  }
  return sentences;
}

}  // namespace marey::calibrate::people
