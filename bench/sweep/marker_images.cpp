// Markers in images that show more than markers: found, missed and false ones, beside three naive detectors. Each
// image is inspected alone, as the first of a recording.
//   marker_pictures [--pictures N: of each setting] [--setting NAME] [--first-seed N] [--no-peers] [--times]
#include <algorithm>
#include <cstdint>
#include <ctime>
#include <string>
#include <string_view>
#include <vector>

#include <CLI/CLI.hpp>
#include <fmt/core.h>
#include <opencv2/features2d.hpp>
#include <opencv2/imgproc.hpp>

#include "marey/detect/markers/marker_detector.h"
#include "marey/simulate/markers/marker_image.h"

#include "experiments/markdown_table.h"

namespace {

using namespace marey;
using simulate::markers::MarkerImage;

constexpr double kNear = 1.5;  // px; a marker further away than that, and than its shade, was not found

struct Score {
  std::int64_t markers = 0, missed = 0, false_ones = 0;
  int images = 0;
  double ms = 0, worst_ms = 0;

  void add(const MarkerImage& image, std::vector<Vector<2>> found, double took) {
    std::int64_t lost = 0;
    for (const Vector<2>& marker : image.markers) {  // each find is of one marker
      const auto nearest = std::min_element(found.begin(), found.end(), [&](const Vector<2>& a, const Vector<2>& b) {
        return (a - marker).squaredNorm() < (b - marker).squaredNorm();
      });
      if (nearest == found.end() || (*nearest - marker).norm() > std::max(kNear, image.shade * image.radius)) {
        ++lost;
      } else {
        found.erase(nearest);
      }
    }
    std::erase_if(found, [&](const Vector<2>& location) {  // neither right nor wrong
      return std::any_of(image.specks.begin(), image.specks.end(),
                         [&](const Vector<2>& s) { return (s - location).norm() < 2 * kNear; });
    });
    markers += std::ssize(image.markers);
    missed += lost;
    false_ones += std::ssize(found);
    ++images;
    ms += took;
    worst_ms = std::max(worst_ms, took);
  }

  std::string text(bool times) const {
    std::string cell = fmt::format("{:.2f} %, {:.2f}",
                                   100.0 * static_cast<double>(missed) / static_cast<double>(std::max<std::int64_t>(1, markers)),
                                   static_cast<double>(false_ones) / images);
    if (times) cell += fmt::format("; {:.2f} ms, worst {:.1f}", ms / images, worst_ms);
    return cell;
  }

  void add(const Score& other) {
    markers += other.markers, missed += other.missed, false_ones += other.false_ones;
    images += other.images, ms += other.ms, worst_ms = std::max(worst_ms, other.worst_ms);
  }
};

std::vector<Vector<2>> ours(const MarkerImage& image) {
  Frame frame;
  frame.image = Image(image.image);
  detect::markers::MarkerOptions options;
  options.max_markers = 20000;
  detect::markers::MarkerDetector detector(options);
  std::vector<Vector<2>> found;
  for (const Detection& detection : detector.detect(frame, {}).detections) found.push_back(detection.centre);
  return found;
}

cv::Mat bytes_of(const MarkerImage& image) {
  cv::Mat bytes;
  image.image.convertTo(bytes, CV_8U, image.bits == 8 ? 1 : 255.0 / ((1 << image.bits) - 1));
  return bytes;
}

/// Connected components above a threshold, of 3 to 10,000 px.
std::vector<Vector<2>> components(const cv::Mat& bytes, double threshold, int method) {
  cv::Mat above, labels, statistics, centroids;
  cv::threshold(bytes, above, threshold, 255, method);
  const int count = cv::connectedComponentsWithStats(above, labels, statistics, centroids);
  std::vector<Vector<2>> found;
  for (int i = 1; i < count; ++i) {
    const int area = statistics.at<int>(i, cv::CC_STAT_AREA);
    if (area >= 3 && area <= 10000) found.emplace_back(centroids.at<double>(i, 0), centroids.at<double>(i, 1));
  }
  return found;
}

std::vector<Vector<2>> half_of_maximum(const MarkerImage& image) {
  const cv::Mat bytes = bytes_of(image);
  double maximum = 0;
  cv::minMaxLoc(bytes, nullptr, &maximum);
  return components(bytes, maximum / 2, cv::THRESH_BINARY);
}

std::vector<Vector<2>> otsu(const MarkerImage& image) {
  return components(bytes_of(image), 0, cv::THRESH_BINARY | cv::THRESH_OTSU);
}

std::vector<Vector<2>> simple_blobs(const MarkerImage& image) {
  cv::SimpleBlobDetector::Params options;
  options.blobColor = 255;
  options.minArea = 4;
  options.minDistBetweenBlobs = 3;
  std::vector<cv::KeyPoint> points;
  cv::SimpleBlobDetector::create(options)->detect(bytes_of(image), points);
  std::vector<Vector<2>> found;
  for (const cv::KeyPoint& point : points) found.emplace_back(point.pt.x, point.pt.y);
  return found;
}

using Finder = std::vector<Vector<2>> (*)(const MarkerImage&);
constexpr std::pair<std::string_view, Finder> kFinders[] = {
    {"Marey", ours}, {"half of the maximum", half_of_maximum}, {"Otsu", otsu}, {"SimpleBlobDetector", simple_blobs}};

/// One image's score is added to that of each finder.
void inspect_at(const MarkerImage& image, std::vector<Score>& scores) {
  for (std::size_t i = 0; i < scores.size(); ++i) {
    const std::clock_t begin = std::clock();
    auto found = kFinders[i].second(image);
    const double took = 1e3 * static_cast<double>(std::clock() - begin) / CLOCKS_PER_SEC;
    scores[i].add(image, std::move(found), took);
  }
}

void print_row(std::string setting, const std::vector<Score>& scores, bool times) {
  std::vector<std::string> cells{std::move(setting), std::to_string(scores.front().markers)};
  for (const Score& score : scores) cells.push_back(score.text(times));
  fmt::print("{}", experiments::markdown_row(cells));
}

}  // namespace

int main(int count, char** words) {
  cv::setNumThreads(1);
  int images = 20;
  std::uint64_t first = 1;
  std::string only;
  bool no_peers = false, times = false;
  CLI::App app("Markers in images that show more than markers: missed, false ones an image");
  app.add_option("--pictures", images, "of each setting")->capture_default_str();
  app.add_option("--setting", only);
  app.add_option("--first-seed", first)->capture_default_str();
  app.add_flag("--no-peers", no_peers);
  app.add_flag("--times", times, "processor time of an image too");
  CLI11_PARSE(app, count, words);
  const std::size_t finders = no_peers ? 1 : std::size(kFinders);
  std::vector<std::string> titles{"setting", "markers"};
  for (std::size_t i = 0; i < finders; ++i) titles.emplace_back(kFinders[i].first);
  fmt::print("{}", experiments::markdown_header(titles));
  std::vector<Score> all(finders);
  for (const auto& [name, setting] : simulate::markers::marker_settings()) {
    if (!only.empty() && only != name) continue;
    std::vector<Score> scores(finders);
    for (std::uint64_t seed = first; seed < first + static_cast<std::uint64_t>(images); ++seed)
      inspect_at(simulate::markers::simulate_marker_image(setting, seed), scores);
    print_row(std::string(name), scores, times);
    if (setting > simulate::markers::MarkerSetting::everything) continue;
    for (std::size_t i = 0; i < finders; ++i) all[i].add(scores[i]);
  }
  if (only.empty()) print_row("all up to everything", all, times);
}
