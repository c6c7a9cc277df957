// Everything happens in the order of the world: leaves move over the ground, people are drawn before them, cloud, lamp and exposure
// multiply the image, rain falls before it, the camera moves, blurs, codes and adds its noise. The image is drawn with a
// margin that covers the camera's movement.
#include "marey/simulate/people/restless_video.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "marey/simulate/people/street_image.h"
#include "marey/simulate/random.h"
#include "marey/simulate/value_noise.h"

namespace marey::simulate::people {
namespace {

constexpr double kStatureShown = 1.78;                      // m
constexpr double kFocalWidths = 3;                          // focal length in widths of the image
constexpr double kBranch = 34, kTwig = 7;                   // px: how far apart leaves move independently
constexpr double kCloudWide = 130;                          // px
constexpr double kCloudSpeed = 55;                          // px/s
constexpr double kExposureEvery = 2, kExposureTakes = 0.2;  // s

int margin_of(const Unrest& unrest) {
  return unrest.jitter_px > 0 ? 8 + 2 * static_cast<int>(std::ceil(3 * unrest.jitter_px)) : 0;
}

LevelCamera camera_of(const RestlessVideoOptions& options) {
  LevelCamera camera;
  camera.size = options.size;
  camera.focal = kFocalWidths * options.size.width;
  camera.distance = camera.focal * kStatureShown * std::cos(camera.pitch) / options.height_px;
  return camera;
}

PeopleMotion motion_of(const RestlessVideoOptions& options, std::uint64_t seed) {
  PeopleVideoOptions people;
  people.size = options.size;
  people.rate_hz = options.rate_hz;
  people.frames = options.frames;
  people.people = options.people;
  people.height_px = options.height_px;
  Random random(seed);
  return move_people(options.situation, camera_of(options), people, random);
}

/// The crowns of two trees and a hedge, in shares of the image.
struct Crown {
  double x, y, wide, high;
};
constexpr Crown kCrowns[] = {{0.18, 0.14, 0.17, 0.24}, {0.74, 0.2, 0.22, 0.26}, {0.5, 0.45, 0.14, 0.08}};

/// Leaves of single colours, lit and shaded, with gaps.
void draw_leaves(cv::Size size, std::uint64_t seed, Planes& leaves, cv::Mat& cover) {
  leaves.luma = cv::Mat::zeros(size, CV_32FC1);
  leaves.cb = cv::Mat(size, CV_32FC1, cv::Scalar(128)), leaves.cr = leaves.cb.clone();
  cover = cv::Mat::zeros(size, CV_32FC1);
  Random random(seed + 99);
  const double area = static_cast<double>(size.area());
  for (const Crown& crown : kCrowns) {
    const int count = static_cast<int>(area * crown.wide * crown.high / 2.2);
    for (int i = 0; i < count; ++i) {
      const double r = std::sqrt(random.uniform()), angle = random.uniform(0, 2 * std::numbers::pi);
      const cv::Point at(static_cast<int>((crown.x + crown.wide * r * std::cos(angle)) * size.width),
                         static_cast<int>((crown.y + crown.high * r * std::sin(angle)) * size.height));
      const cv::Size leaf(random.integer(1, 4), random.integer(1, 2));
      const double turn = random.uniform(0, 180), lit = random.uniform();
      const auto fill = [&](cv::Mat& plane, double value) {
        cv::ellipse(plane, at, leaf, turn, 0, 360, cv::Scalar(value), cv::FILLED);
      };
      fill(leaves.luma, 32 + 95 * lit * lit);
      fill(leaves.cb, 128 - 14 * lit - 4);
      fill(leaves.cr, 128 - 8 * lit - 4);
      fill(cover, 1);
    }
  }
}

cv::Mat half_size(const cv::Mat& full) {
  cv::Mat half;
  cv::resize(full, half, {(full.cols + 1) / 2, (full.rows + 1) / 2}, 0, 0, cv::INTER_AREA);
  return half;
}

/// What is drawn over a plane where `cover` says so.
void mix(const cv::Mat& over, const cv::Mat& cover, cv::Mat& plane) {
  for (int y = 0; y < plane.rows; ++y) {
    for (int x = 0; x < plane.cols; ++x) {
      const float fraction = cover.at<float>(y, x);
      auto& level = plane.at<std::uint8_t>(y, x);
      level = clamp_level(static_cast<float>(level) + fraction * (over.at<float>(y, x) - static_cast<float>(level)));
    }
  }
}

void multiply(const cv::Mat& light, float zero, cv::Mat& plane) {
  for (int y = 0; y < plane.rows; ++y) {
    for (int x = 0; x < plane.cols; ++x) {
      auto& level = plane.at<std::uint8_t>(y, x);
      level = clamp_level(zero + (static_cast<float>(level) - zero) * light.at<float>(y, x));
    }
  }
}

void add_grain(cv::Mat& plane, double sigma, cv::RNG& random) {
  cv::Mat grain(plane.size(), CV_16SC1);
  random.fill(grain, cv::RNG::NORMAL, 0, 16 * sigma);
  for (int y = 0; y < plane.rows; ++y) {
    for (int x = 0; x < plane.cols; ++x) {
      auto& level = plane.at<std::uint8_t>(y, x);
      level = clamp_level(static_cast<float>(level) + static_cast<float>(grain.at<std::int16_t>(y, x)) / 16);
    }
  }
}

/// The part of `plane` within the margin, moved by `shift`.
cv::Mat moved(const cv::Mat& plane, const Vector<2>& shift, cv::Size size, int margin) {
  const cv::Matx23d by(1, 0, shift.x() - margin, 0, 1, shift.y() - margin);
  cv::Mat out;
  cv::warpAffine(plane, out, by, size, cv::INTER_CUBIC, cv::BORDER_REPLICATE);
  return out;
}

std::vector<double> exposures(const RestlessVideoOptions& options, Random random) {
  std::vector<double> values;
  double from = 1, to = 1;
  double next = kExposureEvery;
  for (int i = 0; i < options.frames; ++i) {
    const double time = i / options.rate_hz;
    if (time >= next) {
      from = to;
      to = 1 + random.uniform(-1, 1) * options.unrest.exposure_step;
      next += kExposureEvery;
    }
    const double fraction = std::clamp((time - (next - kExposureEvery)) / kExposureTakes, 0.0, 1.0);
    values.push_back(from + fraction * (to - from));
  }
  return values;
}

}  // namespace

RestlessVideo::RestlessVideo(std::uint64_t seed, const RestlessVideoOptions& options)
    : seed_(seed),
      options_(options),
      detected_(camera_of(options)),
      motion_(motion_of(options, seed)),
      shake_(std::max(options.unrest.jitter_px, 1e-9), 1, options.size.width / 2.0, seed),
      exposures_(exposures(options, Random(seed + 7))) {
  const int margin = margin_of(options.unrest);
  detected_.size += cv::Size(2 * margin, 2 * margin);
  const Image ground = options.lawn ? draw_lawn(detected_, seed) : draw_street(detected_.size, seed);
  still_ = {ground.luma().clone(), ground.cb().clone(), ground.cr().clone()};  // `ground` may own them
  if (options.unrest.leaves_px > 0) draw_leaves(detected_.size, seed, leaves_, cover_);
}

/// The ground with its leaves in this frame. Branches go with the gusts, twigs shiver on them.
Planes RestlessVideo::ground(int index) const {
  const double time = index / options_.rate_hz;
  Planes planes{still_.luma.clone(), still_.cb.clone(), still_.cr.clone()};
  if (cover_.empty()) return planes;
  cv::Mat from_x(cover_.size(), CV_32FC1), from_y(cover_.size(), CV_32FC1);
  const double reach = index < options_.unrest.calm * options_.frames ? 0 : options_.unrest.leaves_px;
  const double gust = 0.55 + 0.45 * value_noise({time / 1.7, 3.5}, seed_ + 5);
  for (int y = 0; y < cover_.rows; ++y) {
    for (int x = 0; x < cover_.cols; ++x) {
      const double branch = x / kBranch + 0.7 * y / kBranch, twig = x / kTwig + 1.3 * y / kTwig;
      const double sway = value_noise({branch, 1.4 * time}, seed_ + 1), lift = value_noise({branch, 1.4 * time + 50}, seed_ + 2);
      const double shiver = value_noise({twig, 5 * time}, seed_ + 3), flutter = value_noise({twig, 5 * time + 50}, seed_ + 4);
      from_x.at<float>(y, x) = static_cast<float>(x - gust * reach * (1.6 * sway + 0.6 * shiver));
      from_y.at<float>(y, x) = static_cast<float>(y - gust * reach * (0.6 * lift + 0.6 * flutter));
    }
  }
  const auto blown = [&](const cv::Mat& plane) {
    cv::Mat out;
    cv::remap(plane, out, from_x, from_y, cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    return out;
  };
  const cv::Mat cover = blown(cover_);
  mix(blown(leaves_.luma), cover, planes.luma);
  const cv::Mat half_cover = half_size(cover);
  mix(half_size(blown(leaves_.cb)), half_cover, planes.cb);
  mix(half_size(blown(leaves_.cr)), half_cover, planes.cr);
  return planes;
}

/// What multiplies the light of each place of the image with its margin.
cv::Mat RestlessVideo::light(int index) const {
  const Unrest& unrest = options_.unrest;
  cv::Mat light(detected_.size, CV_32FC1, cv::Scalar(exposures_[static_cast<std::size_t>(index)]));
  const double time = index / options_.rate_hz;
  const bool lit = unrest.lamp > 0 && index >= options_.frames * 2 / 5;
  if (!lit && unrest.clouds <= 0) return light;
  const double wide = 0.45 * detected_.size.width;
  for (int y = 0; y < light.rows; ++y) {
    for (int x = 0; x < light.cols; ++x) {
      const double away = std::hypot(x - 0.6 * light.cols, y - 0.2 * light.rows) / wide;
      const double lamp = lit ? unrest.lamp * (0.35 + 0.65 * std::exp(-away * away / 2)) : 0;
      const double cloud = value_noise(Vector<2>(x - kCloudSpeed * time, 1.6 * y) / kCloudWide, seed_ + 11);
      const double shade = unrest.clouds * std::clamp(2.2 * cloud, 0.0, 1.0);
      light.at<float>(y, x) *= static_cast<float>((1 + lamp) * (1 - shade));
    }
  }
  return light;
}

void RestlessVideo::rain(cv::Mat& luma, int index) const {
  Random random(seed_ * 104729 + static_cast<std::uint64_t>(index));
  cv::Mat streaks = cv::Mat::zeros(luma.size(), CV_8UC1);
  for (int i = 0; i < options_.unrest.rain; ++i) {
    const double x = random.uniform(0, luma.cols), y = random.uniform(-10, luma.rows), length = random.uniform(6, 22);
    cv::line(streaks, cv::Point2d(x, y), cv::Point2d(x - 0.12 * length, y + length), cv::Scalar(random.uniform(50, 150)), 1,
             cv::LINE_AA);
  }
  for (int y = 0; y < luma.rows; ++y) {
    for (int x = 0; x < luma.cols; ++x) {
      auto& level = luma.at<std::uint8_t>(y, x);
      const float fraction = static_cast<float>(streaks.at<std::uint8_t>(y, x)) / 255;
      level = clamp_level(static_cast<float>(level) + fraction * (190 - static_cast<float>(level)));
    }
  }
}

Vector<2> RestlessVideo::shift(double time) const {
  return options_.unrest.jitter_px > 0 ? Vector<2>(shake_.turn(time).head<2>()) : Vector<2>::Zero().eval();
}

RestlessFrame RestlessVideo::render(int index) const {
  const double time = index / options_.rate_hz;
  const Planes now = ground(index);
  RenderOptions render;
  render.noise = 0;
  const PeopleRenderer renderer(Image(now.luma, now.cb, now.cr, Image::Range::limited), detected_, motion_.posts, render);
  std::vector<PosedFigure> people;
  for (const auto& one : motion_.frames[static_cast<std::size_t>(index)])
    people.push_back({one.id, &motion_.figures[static_cast<std::size_t>(one.id - 1)], one.stance});
  const RenderedFrame frame = renderer.render(people);
  Planes planes{frame.image.luma().clone(), frame.image.cb().clone(), frame.image.cr().clone()};
  cv::Mat truth = cv::Mat::zeros(detected_.size, CV_8UC1);
  for (const TrueFigure& person : frame.people) truth |= person.visible.pixel_mask(detected_.size);

  const cv::Mat lit = light(index), half_lit = half_size(lit);
  multiply(lit, 16, planes.luma);
  multiply(half_lit, 128, planes.cb);
  multiply(half_lit, 128, planes.cr);
  if (options_.unrest.rain > 0) rain(planes.luma, index);
  const int margin = margin_of(options_.unrest);
  if (margin > 0) {
    const Vector<2> by = shift(time);
    planes.luma = moved(planes.luma, by, options_.size, margin);
    const cv::Size half((options_.size.width + 1) / 2, (options_.size.height + 1) / 2);
    planes.cb = moved(planes.cb, by / 2, half, margin / 2);
    planes.cr = moved(planes.cr, by / 2, half, margin / 2);
    truth = moved(truth, by, options_.size, margin) > 127;
  }
  ImageDegradation lens = options_.degradation, codec;
  std::swap(lens.quantizer, codec.quantizer);
  apply(lens, planes.luma, planes.cb, planes.cr);
  cv::RNG random(seed_ * 1'000'003 + static_cast<std::uint64_t>(index) * 7919 + 1);
  add_grain(planes.luma, options_.noise, random);
  add_grain(planes.cb, options_.noise / 2, random);
  add_grain(planes.cr, options_.noise / 2, random);
  apply(codec, planes.luma, planes.cb, planes.cr);
  return {Image(planes.luma, planes.cb, planes.cr, Image::Range::limited), truth};
}

}  // namespace marey::simulate::people
