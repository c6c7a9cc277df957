#include "marey/track/bramble/evidence_sums.h"

#include <algorithm>

namespace marey::track::bramble {
namespace {

/// Whether the two could share a point.
bool meet(const GridShape& a, const GridShape& b) {
  return a.top < b.bottom() && b.top < a.bottom() && a.left < b.right && b.left < a.right;
}

}  // namespace

EvidenceSums::EvidenceSums(const BlobEvidence& evidence)
    : stride_(static_cast<std::size_t>(evidence.log_ratio.cols) + 1),
      sums_(stride_ * static_cast<std::size_t>(evidence.log_ratio.rows)) {
  for (int row = 0; row < evidence.log_ratio.rows; ++row) {
    const float* from = evidence.log_ratio.ptr<float>(row);
    double* to = &sums_[static_cast<std::size_t>(row) * stride_];
    to[0] = 0;
    for (int column = 0; column < evidence.log_ratio.cols; ++column)
      to[column + 1] = to[column] + static_cast<double>(from[column]);
  }
}

double EvidenceSums::sum(const GridShape& shape) const {
  double all = 0;
  for (std::size_t i = 0; i < shape.rows.size(); ++i)
    all += sum(shape.top + static_cast<int>(i), shape.rows[i].begin, shape.rows[i].end);
  return all;
}

EvidenceSums::Gain EvidenceSums::gain(const GridShape& shape, std::span<const GridShape* const> others) const {
  Gain gain{sum(shape), shape.points};
  thread_local std::vector<const GridShape*> near;
  near.clear();
  for (const GridShape* other : others) {
    if (meet(shape, *other)) near.push_back(other);
  }
  if (near.empty()) return gain;
  thread_local std::vector<RowSpan> covered;
  for (std::size_t i = 0; i < shape.rows.size(); ++i) {
    const int row = shape.top + static_cast<int>(i);
    covered.clear();
    for (const GridShape* other : near) {
      if (row < other->top || row >= other->bottom()) continue;
      const RowSpan& theirs = other->rows[static_cast<std::size_t>(row - other->top)];
      const RowSpan shared{std::max(shape.rows[i].begin, theirs.begin), std::min(shape.rows[i].end, theirs.end)};
      if (shared.begin < shared.end) covered.push_back(shared);
    }
    std::sort(covered.begin(), covered.end(), [](const RowSpan& a, const RowSpan& b) { return a.begin < b.begin; });
    int done = -1;  // columns before this one are counted
    for (const RowSpan& span : covered) {
      const int begin = std::max<int>(span.begin, done);
      if (begin >= span.end) continue;
      gain.evidence -= sum(row, begin, span.end);
      gain.points -= span.end - begin;
      done = span.end;
    }
  }
  return gain;
}

}  // namespace marey::track::bramble
