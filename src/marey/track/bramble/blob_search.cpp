#include "marey/track/bramble/blob_search.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <tbb/parallel_for.h>

namespace marey::track::bramble {
namespace {

constexpr double kCell = 0.5;              // m
constexpr double kApart = 0.8;             // m
constexpr std::size_t kMaxCandidates = 6;  // at an instant; numerical: more only cost time
constexpr std::size_t kMaxCells = 60'000;
constexpr int kMinRows = 3;            // of the grid: a person seen smaller has no shape
constexpr double kEnoughInGrid = 0.6;  // of a person, that a camera must see

GridShape shape_at(const EvidenceView& detected, const Vector<2>& location) {
  GridShape shape;
  const Vector<3> foot(location.x(), location.y(), detected.view->surface().height(location));
  cover(cylinder_outline(*detected.view->camera(), {.foot = foot}), *detected.evidence, shape);
  if (shape.fraction_in_grid() < kEnoughInGrid || std::ssize(shape.rows) < kMinRows) shape = {};
  return shape;
}

}  // namespace

/// The cells on which a person's feet may be seen: those that the grids' points lie on.
void BlobSearch::lay_out(std::span<const EvidenceView> views) {
  std::set<std::pair<int, int>> detected;
  for (const EvidenceView& one : views) {
    if (one.evidence == nullptr) continue;
    const BlobEvidence& grid = *one.evidence;
    for (int row = 0; row < grid.log_ratio.rows; ++row) {
      for (int column = 0; column < grid.log_ratio.cols; ++column) {
        const auto location = one.view->location(grid.origin + grid.step * Vector<2>(column, row));
        if (!location || location->by_pixel.norm() * grid.step > 6) continue;
        detected.emplace(static_cast<int>(std::lround(location->ground.x() / kCell)),
                         static_cast<int>(std::lround(location->ground.y() / kCell)));
      }
    }
  }
  for (const auto& [x, y] : detected) {
    if (cells_.size() >= kMaxCells) break;
    Cell cell{{kCell * x, kCell * y}, std::vector<GridShape>(views.size())};
    bool is_seen = false;
    for (std::size_t i = 0; i < views.size(); ++i) {
      if (views[i].evidence == nullptr) continue;
      cell.shapes[i] = shape_at(views[i], cell.location);
      is_seen |= cell.shapes[i].points > 0;
    }
    if (is_seen) cells_.push_back(std::move(cell));
  }
}

std::vector<BlobSearch::Candidate> BlobSearch::find(std::span<const EvidenceView> views,
                                                    const std::vector<std::vector<GridShape>>& explained, double minimum) {
  const bool all_see = std::all_of(views.begin(), views.end(), [](const EvidenceView& one) { return one.evidence != nullptr; });
  if (cells_.empty() && all_see) lay_out(views);
  std::vector<EvidenceSums> left(views.size());
  for (std::size_t i = 0; i < views.size(); ++i) {
    if (views[i].evidence == nullptr) continue;
    BlobEvidence rest = *views[i].evidence;
    rest.log_ratio = rest.log_ratio.clone();
    for (const GridShape& shape : explained[i]) {
      for (std::size_t r = 0; r < shape.rows.size(); ++r) {
        float* row = rest.log_ratio.ptr<float>(shape.top + static_cast<int>(r));
        std::fill(row + shape.rows[r].begin, row + shape.rows[r].end, 0.0F);
      }
    }
    left[i] = EvidenceSums(rest);
  }
  std::vector<double> scores(cells_.size());
  tbb::parallel_for(std::size_t{0}, cells_.size(), [&](std::size_t c) {
    for (std::size_t i = 0; i < views.size(); ++i) {
      if (views[i].evidence != nullptr && cells_[c].shapes[i].points > 0) scores[c] += left[i].sum(cells_[c].shapes[i]);
    }
  });
  std::vector<Candidate> good;
  for (std::size_t c = 0; c < cells_.size(); ++c) {
    if (scores[c] > minimum) good.push_back({cells_[c].location, scores[c]});
  }
  std::stable_sort(good.begin(), good.end(), [](const Candidate& a, const Candidate& b) { return a.evidence > b.evidence; });
  std::vector<Candidate> found;
  for (const Candidate& one : good) {
    if (found.size() == kMaxCandidates) break;
    const auto is_near = [&](const Candidate& other) { return (other.location - one.location).norm() < kApart; };
    if (std::none_of(found.begin(), found.end(), is_near)) found.push_back(one);
  }
  return found;
}

}  // namespace marey::track::bramble
