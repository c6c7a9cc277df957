// What lies close by decides whether a blob is a marker. One threshold a tile cannot tell where a tile has two backgrounds: at the
// edge of a grey bar, on a lamp's glow, over lit texture. So a blob that no disc fits must stand out from its own rim; and a region
// that passes as a whole is searched again above its own median, like the levels of a component tree (Salembier et al. 1998), each
// taken halfway up the last, which leaves a marker alone at the level at which its surroundings fall below.
#include "marey/detect/markers/marker_local.h"

#include <algorithm>
#include <cmath>

namespace marey::detect::markers {
namespace {

constexpr std::size_t kMostInnerRuns = 1 << 16;
constexpr std::size_t kMostPieces = 64;  // a frame

double value_of(const cv::Mat& image, int x, int y) {
  return image.depth() == CV_8U ? image.ptr<std::uint8_t>(y)[x] : image.ptr<std::uint16_t>(y)[x];
}

/// The pixel of the blob's box that stands out most.
double extreme_of(const cv::Mat& image, const cv::Rect& box, bool dark) {
  double low = 0, high = 0;
  cv::minMaxLoc(image(box & cv::Rect({}, image.size())), &low, &high);
  return dark ? low : high;
}

}  // namespace

std::optional<RimLevels> rim_levels(const cv::Mat& image, const cv::Rect& frame, bool dark) {
  std::vector<double> rim;
  const cv::Rect within({}, image.size());
  const auto look = [&](int x, int y) {
    if (within.contains({x, y})) rim.push_back(value_of(image, x, y));
  };
  for (int x = frame.x; x < frame.br().x; ++x) look(x, frame.y), look(x, frame.br().y - 1);
  for (int y = frame.y; y < frame.br().y; ++y) look(frame.x, y), look(frame.br().x - 1, y);
  if (rim.empty()) return std::nullopt;
  const auto at = [&](double share) {
    const auto place = rim.begin() + static_cast<std::ptrdiff_t>(share * static_cast<double>(rim.size() - 1));
    std::nth_element(rim.begin(), place, rim.end());
    return *place;
  };
  return RimLevels{at(0.5), at(dark ? 0.3 : 0.7)};
}

double height_over_rim(const cv::Mat& image, const MarkerBlob& blob, bool dark) {
  const auto rim = rim_levels(image, {blob.box.x - 2, blob.box.y - 2, blob.box.width + 4, blob.box.height + 4}, dark);
  if (!rim) return 0;
  const double extreme = extreme_of(image, blob.box, dark);
  return dark ? rim->upper - extreme : extreme - rim->upper;
}

std::optional<double> bright_contrast(const cv::Mat& image, std::span<const MarkerBlob> blobs, const MarkerLevels& levels,
                                      bool dark) {
  constexpr std::size_t kLooked = 4000;  // blobs
  double fifth = 0, fourth = 0;          // powers: a thousand dim specks count less than one marker ten times as bright
  for (std::size_t i = 0; i < std::min(kLooked, blobs.size()); ++i) {
    const double height = height_over_rim(image, blobs[i], dark);
    if (height <= 0) continue;
    const double outstanding = std::abs(extreme_of(image, blobs[i].box, dark) -
                                        levels.background(static_cast<int>(blobs[i].mean_x), static_cast<int>(blobs[i].mean_y)));
    const double contrast = std::min(height, outstanding);
    fourth += std::pow(contrast, 4);
    fifth += std::pow(contrast, 5);
  }
  return fourth > 0 ? std::optional(fifth / fourth) : std::nullopt;
}

InnerBlobFinder::InnerBlobFinder() : finder_(kMostInnerRuns) {}

MarkerBlob InnerBlobFinder::moved(MarkerBlob blob, const cv::Point& by) {
  blob.box += by;
  blob.mean_x += by.x;
  blob.mean_y += by.y;
  return blob;
}

void InnerBlobFinder::begin(const cv::Mat& image, const MarkerRunFinder& finder, std::span<const MarkerBlob> blobs) {
  pieces_.clear();
  std::vector<Piece> begun;
  std::vector<int> piece_of(blobs.size(), -1);
  for (const std::size_t region : regions_) {
    const cv::Rect box = blobs[region].box;
    if (begun.size() >= kMostPieces || pixels_left_ < box.area()) break;
    pixels_left_ -= box.area();
    piece_of[region] = static_cast<int>(begun.size());
    begun.push_back({box.tl(), cv::Mat(box.size(), image.type()), cv::Mat::zeros(box.size(), CV_8UC1), 0});
    image(box).copyTo(begun.back().pixels);
  }
  for (const MarkerRun& run : finder.runs()) {
    const int piece = piece_of[static_cast<std::size_t>(run.parent)];
    if (piece < 0) continue;
    const cv::Point corner = begun[static_cast<std::size_t>(piece)].corner;
    begun[static_cast<std::size_t>(piece)].own.row(run.row - corner.y).colRange(run.begin - corner.x, run.end - corner.x) = 255;
  }
  for (Piece& piece : begun) finish(std::move(piece));
}

/// Finds the median of a piece's own pixels, and makes it that of the others.
void InnerBlobFinder::finish(Piece piece) {
  std::vector<std::uint32_t> histogram(piece.pixels.depth() == CV_8U ? 256 : 65536, 0);
  std::uint32_t count = 0;
  for (int y = 0; y < piece.pixels.rows; ++y) {
    for (int x = 0; x < piece.pixels.cols; ++x) {
      if (piece.own.ptr<std::uint8_t>(y)[x] == 0) continue;
      ++histogram[static_cast<std::size_t>(value_of(piece.pixels, x, y))];
      ++count;
    }
  }
  std::size_t level = 0;
  for (std::uint32_t below = 0; level + 1 < histogram.size() && 2 * (below += histogram[level]) < count;) ++level;
  piece.median = static_cast<double>(level);
  piece.pixels.setTo(piece.median, piece.own == 0);
  pieces_.push_back(std::move(piece));
}

void InnerBlobFinder::search(std::size_t piece, double least, bool dark) {
  const Piece& here = pieces_[piece];
  const int tile = MarkerThresholds::kTile;
  const auto tiles = static_cast<std::size_t>((here.pixels.cols + tile - 1) / tile * ((here.pixels.rows + tile - 1) / tile));
  const double top = here.pixels.depth() == CV_8U ? 255 : 65535;
  const double threshold = std::clamp(dark ? here.median - least : here.median + least, 0.0, top);
  const auto found =
      finder_.find(here.pixels, {std::vector<std::uint16_t>(tiles, static_cast<std::uint16_t>(threshold)), dark}, {});
  found_.assign(found.begin(), found.end());
  runs_.assign(finder_.runs().begin(), finder_.runs().end());
}

void InnerBlobFinder::add_piece(std::size_t parent, std::size_t found) {
  const cv::Rect box = found_[found].box;
  if (pieces_.size() >= kMostPieces || pixels_left_ < box.area()) return;
  pixels_left_ -= box.area();
  Piece piece{pieces_[parent].corner + box.tl(), pieces_[parent].pixels(box).clone(), cv::Mat::zeros(box.size(), CV_8UC1), 0};
  for (const MarkerRun& run : runs_) {
    if (run.parent != static_cast<std::int32_t>(found)) continue;
    piece.own.row(run.row - box.y).colRange(run.begin - box.x, run.end - box.x) = 255;
  }
  finish(std::move(piece));
}

}  // namespace marey::detect::markers
