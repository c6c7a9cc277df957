#include "marey/track/bramble/blob_search.h"

#include <algorithm>
#include <cmath>
#include <set>
#include <utility>

#include <tbb/parallel_for.h>

namespace marey::track::bramble {
namespace {

constexpr double kCell = 0.5;     // m
constexpr double kApart = 0.8;    // m
constexpr std::size_t kMost = 6;  // candidates at an instant
constexpr std::size_t kMostCells = 60'000;
constexpr int kFewestRows = 3;         // of the grid: who is seen smaller has no shape
constexpr double kEnoughInGrid = 0.6;  // of a person, that a camera must see

GridShape shape_at(const EvidenceView& seen, const Vector<2>& place) {
  GridShape shape;
  const Vector<3> foot(place.x(), place.y(), seen.view->surface().height(place));
  cover(cylinder_outline(*seen.view->camera(), {.foot = foot}), *seen.evidence, shape);
  if (shape.share_in_grid() < kEnoughInGrid || std::ssize(shape.rows) < kFewestRows) shape = {};
  return shape;
}

}  // namespace

/// The cells on which somebody's feet may be seen: those that the grids' points lie on.
void BlobSearch::lay_out(std::span<const EvidenceView> views) {
  std::set<std::pair<int, int>> seen;
  for (const EvidenceView& one : views) {
    if (one.evidence == nullptr) continue;
    const BlobEvidence& grid = *one.evidence;
    for (int row = 0; row < grid.log_ratio.rows; ++row) {
      for (int column = 0; column < grid.log_ratio.cols; ++column) {
        const auto place = one.view->place(grid.origin + grid.step * Vector<2>(column, row));
        if (!place || place->by_pixel.norm() * grid.step > 6) continue;
        seen.emplace(static_cast<int>(std::lround(place->ground.x() / kCell)),
                     static_cast<int>(std::lround(place->ground.y() / kCell)));
      }
    }
  }
  for (const auto& [x, y] : seen) {
    if (cells_.size() >= kMostCells) break;
    Cell cell{{kCell * x, kCell * y}, std::vector<GridShape>(views.size())};
    bool is_seen = false;
    for (std::size_t i = 0; i < views.size(); ++i) {
      if (views[i].evidence == nullptr) continue;
      cell.shapes[i] = shape_at(views[i], cell.place);
      is_seen |= cell.shapes[i].points > 0;
    }
    if (is_seen) cells_.push_back(std::move(cell));
  }
}

std::vector<BlobSearch::Candidate> BlobSearch::find(std::span<const EvidenceView> views,
                                                    const std::vector<std::vector<GridShape>>& explained, double least) {
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
    if (scores[c] > least) good.push_back({cells_[c].place, scores[c]});
  }
  std::stable_sort(good.begin(), good.end(), [](const Candidate& a, const Candidate& b) { return a.evidence > b.evidence; });
  std::vector<Candidate> found;
  for (const Candidate& one : good) {
    if (found.size() == kMost) break;
    const auto is_near = [&](const Candidate& other) { return (other.place - one.place).norm() < kApart; };
    if (std::none_of(found.begin(), found.end(), is_near)) found.push_back(one);
  }
  return found;
}

}  // namespace marey::track::bramble
