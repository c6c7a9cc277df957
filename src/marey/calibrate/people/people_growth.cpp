#include "marey/calibrate/people/people_growth.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

#include "marey/calibrate/wand/wand_lens.h"
#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/geometry/median.h"

namespace marey::calibrate::people {
namespace {

constexpr std::array kFocalGuesses = {0.65, 0.9, 1.25, 1.75};  // unswept: of the longer side
constexpr std::size_t kGrownPoints = 160;  // numerical, time against precision: a camera, by which the rig grows
constexpr GrowthSubject kPeople = {
    .name = "people",
    .more = "let them walk longer",
    .everywhere = "let them walk through the whole volume, near and far",
    .shared = "let them walk where it and another camera both see them",
};
constexpr double kNoiseFactor = 1.5;  // unswept: times what the points state

MarkTable table_of(const PeopleViews& views, const std::vector<PointRow>& rows) {
  MarkTable table;
  for (const PointRow& row : rows) {
    auto& entries = table.emplace_back(views.cameras.size());
    for (std::size_t c = 0; c < entries.size(); ++c) {
      if (const auto at = views.pixel(row, c)) entries[c] = Marks{*at};
    }
  }
  return table;
}

void require_shared_points(const MarkTable& table, const Rig& rig) {
  const auto shared = shared_views(table, rig.cameras.size());
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    int maximum = 0;
    for (std::size_t other = 0; other < rig.cameras.size(); ++other) maximum = std::max(maximum, other == c ? 0 : shared[c][other]);
    if (maximum < kMinShared)
      throw Error(
          "camera \"{}\" and another camera never show one person at the same time: let people walk where both see them, or check "
          "that it recorded at the same time",
          rig.cameras[c].name);
  }
}

std::vector<StartingCamera> cameras_with_focal(const PeopleViews& views, const Rig& rig, double guess) {
  std::vector<StartingCamera> cameras;
  for (std::size_t c = 0; c < rig.cameras.size(); ++c) {
    const RigCamera& camera = rig.cameras[c];
    std::vector<double> sigmas;
    for (const ImagePerson& person : views.cameras[c].people) sigmas.push_back(person.sigma_px);
    const std::optional<double>& stated = views.cameras[c].stated_focal;
    bundle::LensFreedom freedom;
    if (!camera.lens) freedom.focal = stated ? kStatedFocal : 0.3;
    cameras.push_back({camera.name, wand::starting_lens(camera, stated.value_or(guess)), *camera.size, freedom,
                       kNoiseFactor * geometry::median(std::move(sigmas))});
  }
  return cameras;
}

/// Robust cost over all that was to be explained, px².
double cost_of(const Growth& growth, const std::vector<StartingCamera>& cameras, const MarkTable& table) {
  double noise = 0, cost = 0;
  for (const StartingCamera& camera : cameras) noise = std::max(noise, camera.sigma_px);
  const double cap = 9 * noise * noise;
  std::size_t required = 0;
  for (const auto& entries : table)
    required +=
        static_cast<std::size_t>(std::count_if(entries.begin(), entries.end(), [](const auto& one) { return one.has_value(); }));
  const auto errors = bundle::errors_of(growth.bundle);
  for (const auto& error : errors) cost += error ? std::min(cap, error->squaredNorm()) : cap;
  return cost + cap * static_cast<double>(required - std::min(required, errors.size()));
}

}  // namespace

Growth grow_by_people(const PeopleViews& views, const Rig& rig, const std::vector<PointRow>& rows, std::uint64_t seed) {
  const MarkTable table = table_of(views, some_of(rows, kGrownPoints * rig.cameras.size()));
  require_shared_points(table, rig);
  bool any_unknown = false;
  for (std::size_t c = 0; c < rig.cameras.size(); ++c)
    any_unknown = any_unknown || (!rig.cameras[c].lens && !views.cameras[c].stated_focal);
  double best = std::numeric_limits<double>::infinity();
  Growth result;
  std::string cause;
  for (const double guess : kFocalGuesses) {
    if (!any_unknown && guess != kFocalGuesses.front()) break;
    stop_point();
    try {
      const auto cameras = cameras_with_focal(views, rig, guess);
      Growth growth = grow_rig(cameras, MarkerLine{}, table, seed, kPeople);
      const double cost = cost_of(growth, cameras, table);
      if (cost < best) best = cost, result = std::move(growth);
    } catch (const Error& error) {
      if (cause.empty()) cause = error.what();  // another guess may do
    }
  }
  if (!std::isfinite(best))
    throw Error("the cameras' views of people do not make one geometry, with any focal length that was tried: {}",
                cause.empty() ? "check the lenses that the rig gives" : cause);
  return result;
}

}  // namespace marey::calibrate::people
