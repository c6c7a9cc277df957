#include "marey/source/stabilise/stabiliser.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include <Eigen/Geometry>
#include <fmt/format.h>

#include "marey/source/stabilise/fast_warp.h"

namespace marey::source::stabilise {
namespace {

constexpr double kLostForGood = 10;         // s
constexpr double kMinBump = 3;              // px
constexpr std::ptrdiff_t kBumpSeconds = 3;  // s that it must have stood before and after
constexpr double kBumpDeviations = 3;       // of a second's mean, on either side
constexpr double kEnough = 0.7;             // share of samples whose motion must be known to report it

Vector<2> moved(const Matrix<3>& homography, const Vector<2>& pixel) {
  return (homography * pixel.homogeneous()).hnormalized();
}

/// The same homography between the halved pixels of chroma.
Matrix<3> of_chroma(const Matrix<3>& homography) {
  Matrix<3> from_chroma = Matrix<3>::Identity();
  from_chroma.diagonal() << 2, 2, 1;
  from_chroma.col(2) << 0.5, 0.5, 1;
  return from_chroma.inverse() * homography * from_chroma;
}

Image at_rest(const Image& image, const Image& under, const Matrix<3>& homography) {
  const Image& ground = under.size() == image.size() && under.is_colour() == image.is_colour() ? under : image;
  cv::Mat luma = ground.luma().clone();
  fast_warp(image.luma(), homography, luma);
  if (!image.is_colour()) return Image(luma);
  cv::Mat cb = ground.cb().clone(), cr = ground.cr().clone();
  fast_warp(image.cb(), of_chroma(homography), cb);
  fast_warp(image.cr(), of_chroma(homography), cr);
  return {luma, cb, cr, image.range()};
}

/// The mean, over four places of the image, of how far each is from its rest, squared.
double squared_motion(const Matrix<3>& homography, cv::Size size) {
  double sum = 0;
  for (const double x : {0.25, 0.75}) {
    for (const double y : {0.25, 0.75}) {
      const Vector<2> at(x * size.width, y * size.height);
      sum += (moved(homography, at) - at).squaredNorm() / 4;
    }
  }
  return sum;
}

class StabilisedSource final : public Source {
 public:
  StabilisedSource(std::unique_ptr<Source> source, ReferenceScene scene, std::shared_ptr<StabilisationLog> log)
      : source_(std::move(source)), log_(log), stabiliser_(std::move(scene), std::move(log)) {}

  const SourceInfo& info() const override { return source_->info(); }
  std::vector<std::string> warnings() const override { return source_->warnings(); }
  std::optional<Frame> next() override {
    while (auto frame = source_->next()) {
      if (frame->image.empty()) return frame;
      Frame stabilise = stabiliser_.stabilised(std::move(*frame));
      if (!log_->was_lost(stabilise.index)) return stabilise;
    }
    return std::nullopt;
  }

 private:
  std::unique_ptr<Source> source_;
  std::shared_ptr<StabilisationLog> log_;
  Stabiliser stabiliser_;
};

}  // namespace

void StabilisationLog::add(const Frame& frame, const std::optional<SceneMotion>& motion, const PinholeView& view, cv::Size size) {
  const std::lock_guard lock(writing_);
  ++counts_.images;
  last_time_ = seconds(frame.time);
  if (!motion) {
    ++counts_.lost;
    lost_.insert(frame.index);
    if (!lost_from_) lost_from_ = last_time_;
    return;
  }
  lost_from_.reset();
  const Matrix<3> homography = moved_from_rest(*motion, view);
  const double squared = squared_motion(homography, size);
  squares_ += squared;
  counts_.max_px = std::max(counts_.max_px, std::sqrt(squared));
  if (seconds_.empty() || last_time_ >= seconds_.back().time + 1) seconds_.push_back({.time = last_time_});
  const Vector<2> middle(size.width / 2.0, size.height / 2.0);
  seconds_.back().sum += moved(homography, middle) - middle;
  ++seconds_.back().count;
}

bool StabilisationLog::was_lost(std::int64_t index) {
  const std::lock_guard lock(writing_);
  return lost_.erase(index) > 0;
}

StabilisationLog::Report StabilisationLog::report() const {
  const std::lock_guard lock(writing_);
  Report report = counts_;
  const std::int64_t reported = report.images - report.lost;
  if (reported > 0) report.rms_px = std::sqrt(squares_ / static_cast<double>(reported));
  if (lost_from_ && last_time_ - *lost_from_ >= kLostForGood) report.lost_since_s = lost_from_;
  // Where the middle stood before and after each second: the largest step of all, if it is one.
  std::vector<Vector<2>> means;
  for (const Second& second : seconds_) means.push_back(second.sum / second.count);
  const std::ptrdiff_t n = std::ssize(means);
  Vector<2> all = Vector<2>::Zero();
  for (const Vector<2>& mean : means) all += mean;
  Vector<2> before = Vector<2>::Zero();
  double maximum = 0;
  std::ptrdiff_t split = 0;
  for (std::ptrdiff_t i = 1; i < n; ++i) {
    before += means[static_cast<std::size_t>(i - 1)];
    if (i < kBumpSeconds || n - i < kBumpSeconds) continue;
    const auto left = static_cast<double>(i), right = static_cast<double>(n - i);
    const Vector<2> by = (all - before) / right - before / left;
    const double gain = left * right * by.squaredNorm();
    if (gain <= maximum) continue;
    maximum = gain;
    split = i;
    report.bump = Bump{.time = seconds_[static_cast<std::size_t>(i)].time, .by_px = by.norm()};
  }
  if (!report.bump) return report;
  Vector<2> sums[2] = {Vector<2>::Zero(), Vector<2>::Zero()};
  for (std::ptrdiff_t i = 0; i < n; ++i) sums[i >= split] += means[static_cast<std::size_t>(i)];
  double scatter = 0;
  for (std::ptrdiff_t i = 0; i < n; ++i) {
    const double count = i >= split ? static_cast<double>(n - split) : static_cast<double>(split);
    scatter += (means[static_cast<std::size_t>(i)] - sums[i >= split] / count).squaredNorm() / static_cast<double>(n);
  }
  if (report.bump->by_px < kMinBump || report.bump->by_px < kBumpDeviations * std::sqrt(scatter)) report.bump.reset();
  return report;
}

std::string stated(const StabilisationLog::Report& report) {
  return fmt::format("stabilised {} of {} images: the camera moved by {:.1f} px (root mean square), {:.1f} px at most",
                     report.images - report.lost, report.images, report.rms_px, report.max_px);
}

std::vector<std::string> warned(const StabilisationLog::Report& report) {
  std::vector<std::string> all;
  if (report.lost > 0)
    all.push_back(fmt::format("{} of {} images could not be stabilised and were omitted", report.lost, report.images));
  if (report.lost_since_s)
    all.push_back(
        fmt::format("from {:.1f} s on the images do not show the scene of the beginning: the video was cut, or the camera "
                    "rejected or covered",
                    *report.lost_since_s));
  if (report.bump)
    all.push_back(
        fmt::format("at about {:.0f} s the camera was turned by {:.0f} px and stayed so; its images are shown as it stood "
                    "most of the beginning",
                    report.bump->time, report.bump->by_px));
  return all;
}

Frame Stabiliser::stabilised(Frame frame) {
  const cv::Size size = frame.image.size();
  const auto motion = scene_.find(frame.image);
  log_->add(frame, motion, scene_.view(), size);
  if (!motion) return frame;
  last_ = at_rest(frame.image, last_, moved_from_rest(*motion, scene_.view()));
  frame.image = last_;
  return frame;
}

std::unique_ptr<Source> stabilised(std::unique_ptr<Source> source, ReferenceScene scene, std::shared_ptr<StabilisationLog> log) {
  return std::make_unique<StabilisedSource>(std::move(source), std::move(scene), std::move(log));
}

std::optional<double> motion_among(std::span<const Frame> samples) {
  if (samples.size() < 2 || samples.front().image.empty()) return std::nullopt;
  const cv::Size size = samples.front().image.size();
  ReferenceScene scene(size, std::nullopt);
  std::vector<Image> images;
  for (const Frame& frame : samples) {
    if (frame.image.size() == size) images.push_back(frame.image);
  }
  if (!scene.learn(images)) return std::nullopt;
  double squares = 0, known = 0;
  for (const Image& image : images) {
    const auto motion = scene.find(image);
    if (!motion) continue;
    squares += squared_motion(moved_from_rest(*motion, scene.view()), size);
    ++known;
  }
  if (known < kEnough * static_cast<double>(images.size())) return std::nullopt;
  return std::sqrt(squares / known);
}

}  // namespace marey::source::stabilise
