// A cast shadow multiplies the light of the ground it falls on: the ground's texture and its colour stay (Horprasert, Harwood
// and Davis 1999; Cucchiara et al. 2003). For each cell of 4 × 4 foreground pixels the gain that best maps scene to frame is found
// by least squares, with what it leaves unexplained. Textured ground that is still seen, only darker, is a shadow without doubt.
// Where the ground is smooth a dark coat appears the same; so the scene itself is asked how deep its shadows are: each sure cell
// counts for its depth, and a smooth cell is a shadow only at a depth that counts, or at a shallow one. A shadow lies beside or
// below its owner: a cell with parts of a thing both above and below it, in an unbroken column, belongs to the thing. Cost: five
// sums a foreground pixel.
#include "marey/detect/background/background_shadow.h"

#include <algorithm>
#include <cmath>

namespace marey::detect::background {
namespace {

constexpr double kMaxDepth = 0.35;       // of the light left; less is a dark thing
constexpr double kShallowest = 0.97;     // nearer to 1 there is nothing to explain
constexpr double kTypicalMinimum = 0.6;  // shadows this shallow are trusted before any was seen on textured ground
constexpr double kEvidence = 12;         // sure cells that make a depth typical
constexpr double kForget = 0.998;        // a frame
constexpr double kTexture = 25;          // squared levels: the scene's variance within a textured cell
constexpr double kNoise = 10;            // squared levels left unexplained in a smooth cell
constexpr double kCorrelation = 0.8;     // squared: how much of a textured cell's frame the scene explains
constexpr int kMinCellPixels = 8;        // pixels of a cell to evaluate it by
constexpr int kEdge = 100;               // 1/1024 of the light: how much deeper than its neighbour a shadow's pixel may be
constexpr double kColour = 6;            // levels of chroma
constexpr double kColourful = 8;         // levels of chroma left in a shadow, from which on a pixel is evaluated by them alone
constexpr double kPixelColour = 4;       // levels of chroma, of one pixel

}  // namespace

void ShadowFinder::begin(cv::Size size) {
  size_ = size;
  stride_ = static_cast<std::size_t>((size.width + kCell - 1) / kCell) + 2;
  const std::size_t rows = static_cast<std::size_t>((size.height + kCell - 1) / kCell) + 2;
  cells_.assign(stride_ * rows, {});
  labels_.assign(stride_ * rows, Label::none);
  lightest_.assign(stride_ * rows, kNever);
  touched_.clear();
  evidence_.fill(0);
}

void ShadowFinder::gather(std::span<const PixelRun> runs, const FramePlanes& frame, const SceneView& scene) {
  for (const PixelRun& run : runs) {
    const auto* pixels = frame.luma.ptr<std::uint8_t>(run.row);
    const std::int16_t* means = scene.luma.mean(run.row);
    for (int x = run.begin; x < run.end;) {
      const std::size_t index = cell_at(run.row, x);
      const int end = std::min(run.end, (x / kCell + 1) * kCell);
      Cell& cell = cells_[index];
      if (cell.count == 0) touched_.push_back(index);
      for (; x < end; ++x) {
        const int is = pixels[x] - scene.black;
        const int was = ((means[x] + 64) >> 7) - scene.black;
        ++cell.count;
        cell.darker += is < was ? 1 : 0;
        cell.frame += is;
        cell.scene += was;
        cell.frame2 += is * is;
        cell.scene2 += was * was;
        cell.both += is * was;
      }
    }
  }
}

bool ShadowFinder::same_colour(std::size_t index, double ratio, const FramePlanes& frame, const SceneView& scene) const {
  if (frame.cb.empty()) return true;
  const int top = (static_cast<int>(index / stride_) - 1) * kCell / 2;
  const int left = (static_cast<int>(index % stride_) - 1) * kCell / 2;
  double cb = 0, cr = 0;
  int count = 0;
  for (int y = top; y < std::min(top + kCell / 2, frame.cb.rows); ++y) {
    for (int x = left; x < std::min(left + kCell / 2, frame.cb.cols); ++x) {
      cb += frame.cb.at<std::uint8_t>(y, x) - 128 - ratio * (scene.cb.mean(y)[x] / 128.0 - 128);
      cr += frame.cr.at<std::uint8_t>(y, x) - 128 - ratio * (scene.cr.mean(y)[x] / 128.0 - 128);
      ++count;
    }
  }
  return std::abs(cb) < kColour * count && std::abs(cr) < kColour * count;
}

bool ShadowFinder::is_default(double ratio) const {
  if (ratio >= kTypicalMinimum) return true;
  const int bin = std::clamp(static_cast<int>(ratio * kBins), 1, kBins - 2);
  return evidence_[bin - 1] + evidence_[bin] + evidence_[bin + 1] >= kEvidence;
}

ShadowFinder::Label ShadowFinder::label_of(std::size_t index, const FramePlanes& frame, const SceneView& scene) {
  Cell& cell = cells_[index];
  if (cell.darker * 10 < cell.count * 9 || cell.scene2 == 0) return Label::thing;
  if (cell.count < kMinCellPixels) return Label::unsure;
  const double n = cell.count;
  const double ratio = static_cast<double>(cell.both) / cell.scene2;
  if (ratio < kMaxDepth || ratio > kShallowest || !same_colour(index, ratio, frame, scene)) return Label::thing;
  cell.ratio = static_cast<int>(ratio * 1024);
  const double left_over = (cell.frame2 - ratio * cell.both) / n;
  const double texture = (cell.scene2 - static_cast<double>(cell.scene) * cell.scene / n) / n;
  const double seen_texture = (cell.frame2 - static_cast<double>(cell.frame) * cell.frame / n) / n;
  const double shared = (cell.both - static_cast<double>(cell.frame) * cell.scene / n) / n;
  if (texture * ratio * ratio > kTexture) {
    const bool observed_through = shared > 0 && shared * shared > kCorrelation * texture * seen_texture;
    if (!observed_through) return cell.count < kCell * kCell && is_default(ratio) ? Label::unsure : Label::thing;
    evidence_[std::min(static_cast<int>(ratio * kBins), kBins - 1)] += 1;
    return Label::shadow;
  }
  const double slope = 0.06 * cell.frame / n;
  if (!is_default(ratio)) return Label::thing;
  if (left_over < kNoise + slope * slope + texture * ratio * ratio) return Label::shadow;
  return cell.count < kCell * kCell ? Label::unsure : Label::thing;  // at a shadow's blurred rim
}

/// A cell at a region's rim has too few pixels to be evaluated and goes with the most of its eight neighbours; so does one thing
/// all among shadows.
void ShadowFinder::settle_by_neighbours() {
  changed_.clear();
  for (const std::size_t index : touched_) {
    if (labels_[index] == Label::shadow) continue;
    int shadows = 0, things = 0;
    for (const std::size_t row : {index - stride_, index, index + stride_}) {
      for (const std::size_t at : {row - 1, row, row + 1}) {
        shadows += labels_[at] == Label::shadow ? 1 : 0;
        things += labels_[at] == Label::thing ? 1 : 0;
      }
    }
    const bool outvoted = labels_[index] == Label::unsure ? shadows > 0 && shadows >= things : shadows >= 6;
    if (outvoted) changed_.push_back(index);
  }
  for (const std::size_t index : changed_) labels_[index] = Label::shadow;
  for (const std::size_t index : touched_) {
    if (labels_[index] == Label::unsure) labels_[index] = Label::thing;
  }
}

bool ShadowFinder::is_within_body(std::size_t index) const {
  std::size_t up = index;
  while (labels_[up] == Label::shadow) up -= stride_;
  if (labels_[up] != Label::thing) return false;
  std::size_t down = index;
  while (labels_[down] == Label::shadow) down += stride_;
  return labels_[down] == Label::thing;
}

/// Chroma has half the resolution, so that at the shadow's edge it may be anything between the shadow's and the lit ground's.
bool ShadowFinder::is_coloured_shadow(int frame, int scene, int frame_cb, int frame_cr, int scene_cb, int scene_cr) {
  if (frame >= kShallowest * scene || frame <= kMaxDepth * scene) return false;
  const double ratio = static_cast<double>(frame) / scene;
  const double strength = std::hypot(scene_cb, scene_cr);
  if (ratio * strength < kColourful) return false;
  const double along = (frame_cb * scene_cb + frame_cr * scene_cr) / strength;
  const double across = (frame_cr * scene_cb - frame_cb * scene_cr) / strength;
  return std::abs(across) < kPixelColour && along > ratio * strength - kPixelColour && along < strength + kPixelColour;
}

void ShadowFinder::assess(std::span<const PixelRun> runs, const FramePlanes& frame, const SceneView& scene) {
  for (const std::size_t index : touched_) {
    cells_[index] = {};
    labels_[index] = Label::none;
  }
  touched_.clear();
  for (double& evidence : evidence_) evidence *= kForget;
  gather(runs, frame, scene);
  for (const std::size_t index : touched_) labels_[index] = label_of(index, frame, scene);
  settle_by_neighbours();
  changed_.clear();
  for (const std::size_t index : touched_) {
    if (labels_[index] == Label::shadow && is_within_body(index)) changed_.push_back(index);
  }
  for (const std::size_t index : changed_) labels_[index] = Label::thing;
  set_limits();
}

/// All of a cell in shadow is shadow. Of a thing's cell that has shadow beside it, so are the pixels that are no darker than the
/// shadow: the edge between the two runs through the cell.
void ShadowFinder::set_limits() {
  for (const std::size_t index : touched_) {
    if (labels_[index] == Label::shadow) {
      lightest_[index] = 0;
      continue;
    }
    int limit = kNever;
    for (const std::size_t at : {index - 1, index + 1, index - stride_, index + stride_}) {
      if (labels_[at] == Label::shadow && cells_[at].ratio > 0) limit = std::min(limit, cells_[at].ratio - kEdge);
    }
    lightest_[index] = limit;
  }
}

}  // namespace marey::detect::background
