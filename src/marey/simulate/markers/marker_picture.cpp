#include "marey/simulate/markers/marker_picture.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include <opencv2/imgproc.hpp>

#include "marey/simulate/markers/discs.h"
#include "marey/simulate/random.h"

namespace marey::simulate::markers {
namespace {

/// Adds to every pixel what `level` says of its place.
template <typename Level>
void add_light(cv::Mat& image, Level&& level) {
  for (int y = 0; y < image.rows; ++y) {
    float* row = image.ptr<float>(y);
    for (int x = 0; x < image.cols; ++x) row[x] += static_cast<float>(level(x, y));
  }
}

void add_gradient(cv::Mat& image, Random& random) {
  const double angle = random.uniform(0, 2 * std::numbers::pi), slope = random.uniform(20, 70) / image.cols;
  add_light(image, [&](int x, int y) {
    return slope *
           std::max(0.0, std::cos(angle) * (x - image.cols / 2.0) + std::sin(angle) * (y - image.rows / 2.0) + image.cols / 2.0);
  });
}

void add_vignette(cv::Mat& image, Random& random) {
  const double most = random.uniform(20, 50);
  add_light(image, [&](int x, int y) {
    const double r = std::hypot(x - image.cols / 2.0, y - image.rows / 2.0) / (0.5 * image.cols);
    return most * std::exp(-r * r);
  });
}

/// A lamp outside the picture, or half in it.
void add_glow(cv::Mat& image, Random& random) {
  const double along = random.uniform(), reach = random.uniform(15, 60), most = random.uniform(80, 400);
  const double x0 = random.chance(0.5) ? along * image.cols : (random.chance(0.5) ? -10 : image.cols + 10);
  const double y0 = x0 > 0 && x0 < image.cols ? (random.chance(0.5) ? -10 : image.rows + 10) : along * image.rows;
  add_light(image, [&](int x, int y) { return most * std::exp(-std::hypot(x - x0, y - y0) / reach); });
}

/// Smooth blotches of some px, as cloth and walls have them under infrared light.
void add_texture(cv::Mat& image, Random& random, double most) {
  cv::Mat coarse(image.rows / 4, image.cols / 4, CV_32FC1);
  for (int y = 0; y < coarse.rows; ++y) {
    for (int x = 0; x < coarse.cols; ++x) coarse.at<float>(y, x) = static_cast<float>(random.gaussian());
  }
  cv::Mat fine;
  cv::GaussianBlur(coarse, coarse, {0, 0}, 0.8);
  cv::resize(coarse, fine, image.size(), 0, 0, cv::INTER_CUBIC);
  const cv::Rect lit(static_cast<int>(random.uniform(0, 0.4) * image.cols), static_cast<int>(random.uniform(0, 0.4) * image.rows),
                     static_cast<int>(random.uniform(0.3, 0.6) * image.cols),
                     static_cast<int>(random.uniform(0.3, 0.6) * image.rows));
  cv::Mat(image(lit)) += most * fine(lit);
}

void add_streak(cv::Mat& image, Random& random) {
  const double angle = random.uniform(0, std::numbers::pi), length = random.uniform(40, 120), width = random.uniform(1, 3);
  const Vector<2> middle(random.uniform(0, image.cols), random.uniform(0, image.rows)), along(std::cos(angle), std::sin(angle));
  add_light(image, [&](int x, int y) {
    const Vector<2> off = Vector<2>(x, y) - middle;
    const double t = std::clamp(off.dot(along), -length / 2, length / 2);
    return 300 * std::exp(-(off - t * along).squaredNorm() / (2 * width * width));
  });
}

void add_bars(cv::Mat& image, Random& random) {
  for (int bars = random.integer(1, 3); bars > 0; --bars) {
    const double width = random.uniform(6, bars == 1 ? 213 : 80);
    const double at = random.uniform(0, image.cols);
    const bool upright = random.chance(0.7);
    draw_barrier(image,
                 upright ? Box{at, -1, width, image.rows + 2.0} : Box{-1, at * image.rows / image.cols, image.cols + 2.0, width},
                 random.uniform(25, 110));
  }
}

Vector<2> free_place(const MarkerPicture& picture, const cv::Size& size, double apart, Random& random) {
  for (;;) {
    const Vector<2> place(random.uniform(15, size.width - 16), random.uniform(15, size.height - 16));
    if (std::none_of(picture.markers.begin(), picture.markers.end(),
                     [&](const Vector<2>& other) { return (other - place).norm() < apart; }))
      return place;
  }
}

std::uint64_t noise_seed(std::uint64_t seed) {
  return seed * 7919 + 13;
}

/// What JPEG loses: each block of 8 × 8 px is rounded in the frequencies, by the table for luma of ITU-T T.81, annex K.
cv::Mat as_jpeg(const cv::Mat& image, int quality) {
  static const cv::Mat steps = (cv::Mat_<float>(8, 8) << 16, 11, 10, 16, 24, 40, 51, 61, 12, 12, 14, 19, 26, 58, 60, 55, 14, 13, 16,
                                24, 40, 57, 69, 56, 14, 17, 22, 29, 51, 87, 80, 62, 18, 22, 37, 56, 68, 109, 103, 77, 24, 35, 55,
                                64, 81, 104, 113, 92, 49, 64, 78, 87, 103, 121, 120, 101, 72, 92, 95, 98, 112, 100, 103, 99);
  const double factor = quality < 50 ? 50.0 / quality : 2 - quality / 50.0;
  cv::Mat result(image.size(), CV_8UC1), block, round;
  for (int y = 0; y + 8 <= image.rows; y += 8) {
    for (int x = 0; x + 8 <= image.cols; x += 8) {
      const cv::Rect here(x, y, 8, 8);
      image(here).convertTo(block, CV_32F);
      cv::dct(block, block);
      cv::divide(block, steps, round, 1 / factor);
      round.convertTo(round, CV_32S);
      round.convertTo(round, CV_32F);
      cv::multiply(round, steps, block, factor);
      cv::idct(block, block);
      block.convertTo(result(here), CV_8U);
    }
  }
  return result;
}

}  // namespace

MarkerPicture hard_picture(std::uint64_t seed) {
  Random random(seed);
  MarkerPicture picture;
  picture.radius = random.uniform(2.5, 7);
  cv::Mat image(480, 640, CV_32FC1, cv::Scalar(random.uniform(8, 25)));
  const auto maybe = [&](auto&& add) {
    if (random.chance(0.45)) add();
  };
  maybe([&] { add_gradient(image, random); });
  maybe([&] { add_vignette(image, random); });
  maybe([&] { add_bars(image, random); });
  maybe([&] { add_texture(image, random, random.uniform(3, 12)); });
  maybe([&] { add_glow(image, random); });
  maybe([&] { add_streak(image, random); });
  std::vector<Disc> discs;
  const double level = random.uniform(170, 245);
  for (int left = random.integer(3, 12), draw = 0; left > 0 && draw < 1000; ++draw) {
    const Vector<2> place = free_place(picture, image.size(), 2 * picture.radius + 4, random);
    const cv::Rect around(static_cast<int>(place.x() - picture.radius) - 2, static_cast<int>(place.y() - picture.radius) - 2,
                          static_cast<int>(2 * picture.radius) + 5, static_cast<int>(2 * picture.radius) + 5);
    double most = 0;
    cv::minMaxLoc(image(around & cv::Rect({}, image.size())), nullptr, &most);
    if (most > level - 90) continue;
    picture.markers.push_back(place);
    discs.push_back({place, picture.radius, level, random.uniform(0.5, 0.9)});
    --left;
  }
  draw_discs(image, discs);
  picture.image = expose(image, random.uniform(1, 4), noise_seed(seed));
  if (random.chance(0.5)) picture.image = as_jpeg(picture.image, random.integer(60, 95));
  return picture;
}

MarkerPicture wand_picture(std::uint64_t seed) {
  Random random(seed);
  MarkerPicture picture;
  picture.radius = random.uniform(2, 5);
  cv::Mat image(704, 1024, CV_32FC1, cv::Scalar(random.uniform(10, 30)));
  add_vignette(image, random);
  add_texture(image, random, random.uniform(4, 10));
  add_texture(image, random, random.uniform(4, 10));
  std::vector<Disc> discs;
  for (int specks = random.integer(20, 80); specks > 0; --specks) {
    discs.push_back({{random.uniform(5, 1018), random.uniform(5, 698)}, random.uniform(0.6, 1.1), random.uniform(35, 80), 0.5});
  }
  for (int lamps = 2; lamps > 0; --lamps) {
    const Vector<2> place(random.uniform(60, 960), random.chance(0.5) ? random.uniform(5, 60) : random.uniform(640, 700));
    discs.push_back({place, random.uniform(15, 40), 400, random.uniform(3, 8)});
  }
  draw_discs(image, discs);
  discs.clear();
  Vector<2> place(random.uniform(330, 690), random.uniform(330, 370));
  const double angle = random.uniform(0, std::numbers::pi);
  const Vector<2> along(std::cos(angle), std::sin(angle));
  const Vector<2> smear =
      random.chance(0.5) ? random.uniform(0, 1.5) * picture.radius * Vector<2>(along.y(), -along.x()) : Vector<2>(0, 0);
  const double blur = random.uniform(0.6, 1.8);
  for (int i = random.integer(2, 3); i > 0; --i) {
    picture.markers.push_back(place);
    for (int step = -4; step <= 4; ++step)
      discs.push_back({place + step / 8.0 * smear, picture.radius, random.uniform(235, 300), blur});
    place += along * picture.radius * (random.chance(0.4) ? random.uniform(2.2, 3) : random.uniform(8, 30));
  }
  draw_discs(image, discs);
  picture.image = expose(image, 2, noise_seed(seed));
  return picture;
}

MarkerPicture dense_dots(std::uint64_t seed, int count) {
  Random random(seed);
  MarkerPicture picture;
  picture.radius = 1.3;
  cv::Mat image(1024, 1280, CV_32FC1, cv::Scalar(20));
  add_gradient(image, random);
  std::vector<Disc> discs;
  for (int i = 0; i < count; ++i) {
    picture.markers.push_back(free_place(picture, image.size(), 6, random));
    discs.push_back({picture.markers.back(), random.uniform(1, 1.6), 220, 0.6});
  }
  draw_discs(image, discs);
  picture.image = expose(image, 2, noise_seed(seed));
  return picture;
}

}  // namespace marey::simulate::markers
