// An image is a ground (CV_32FC1, levels of 255), things laid over it, markers drawn last by `draw_discs`, and exposure: noise,
// saturation, depth, compression. Markers keep off each other and off what is saturated, as far as the setting does not want it
// otherwise.
#include "marey/simulate/markers/marker_image.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include "marey/simulate/markers/discs.h"
#include "marey/simulate/markers/marker_ground.h"
#include "marey/simulate/people/image_degradation.h"

namespace marey::simulate::markers {
namespace {

constexpr std::array<NamedMarkerSetting, 12> kSettings{{{"levels", MarkerSetting::levels},
                                                        {"bar", MarkerSetting::bar},
                                                        {"texture", MarkerSetting::texture},
                                                        {"gradient", MarkerSetting::gradient},
                                                        {"vignette", MarkerSetting::vignette},
                                                        {"glow", MarkerSetting::glow},
                                                        {"reflections", MarkerSetting::reflections},
                                                        {"compressed", MarkerSetting::compressed},
                                                        {"everything", MarkerSetting::everything},
                                                        {"wand", MarkerSetting::wand},
                                                        {"dots", MarkerSetting::dots},
                                                        {"shaded", MarkerSetting::shaded}}};

void compress(MarkerStage& stage) {
  lay_levels(stage, 2);
  stage.quantizer = stage.random.uniform(8, 28);
}

void lay(MarkerStage& stage, MarkerSetting setting) {
  switch (setting) {
    case MarkerSetting::levels:
      return lay_levels(stage, stage.random.integer(3, 5));
    case MarkerSetting::bar: {
      const double level = stage.random.uniform(40, 110), width = stage.ground.cols * stage.random.uniform(0.15, 0.4);
      return lay_bar(stage, width, level);
    }
    case MarkerSetting::texture:
      lay_texture(stage);
      return strew_specks(stage, stage.random.integer(20, 80));
    case MarkerSetting::gradient:
      return lay_gradient(stage, stage.random.uniform(30, 100));
    case MarkerSetting::vignette:
      return lay_vignette(stage);
    case MarkerSetting::glow:
      return lay_glow(stage);
    case MarkerSetting::reflections:
      for (int i = stage.random.integer(1, 3); i > 0; --i) lay_reflection(stage);
      return;
    case MarkerSetting::compressed:
      return compress(stage);
    case MarkerSetting::everything:
      for (int i = 0; i < 3; ++i) lay(stage, kSettings[static_cast<std::size_t>(stage.random.integer(0, 7))].setting);
      return;
    case MarkerSetting::wand:
      lay_texture(stage);
      strew_specks(stage, stage.random.integer(60, 150));
      for (int i = stage.random.integer(1, 3); i > 0; --i) lay_lamp(stage, stage.location(20), stage.random.uniform(12, 30));
      return;
    case MarkerSetting::dots:
      return lay_gradient(stage, stage.random.uniform(60, 110));
    case MarkerSetting::shaded:
      for (int i = stage.random.integer(1, 4); i > 0; --i) {
        const double level = stage.random.uniform(60, 250), width = stage.random.uniform(2, 5);
        lay_bar(stage, width, level);
      }
      return strew_specks(stage, stage.random.integer(100, 2000), 7, 240);
  }
}

/// The brightest and the middle of the ground round a place.
struct Under {
  double maximum = 0, mean = 0;
};

Under under(const cv::Mat& ground, const Vector<2>& at, double reach) {
  const int r = static_cast<int>(std::ceil(reach));
  const cv::Rect box =
      cv::Rect(static_cast<int>(at.x()) - r, static_cast<int>(at.y()) - r, 2 * r + 1, 2 * r + 1) & cv::Rect({}, ground.size());
  double maximum = 0;
  cv::minMaxLoc(ground(box), nullptr, &maximum);
  return {maximum, cv::mean(ground(box))[0]};
}

struct Kind {
  double low_radius = 1.5, high_radius = 6;
  double low_level = 130, high_level = 250;
};

/// This many markers, each clear of the others and on a ground that it outshines.
void strew_markers(MarkerStage& stage, MarkerImage& drawn, int count, const Kind& kind) {
  const double radius = stage.random.uniform(kind.low_radius, kind.high_radius), blur = stage.random.uniform(0.5, 1.0);
  const double level = stage.random.uniform(kind.low_level, kind.high_level);
  std::vector<Disc> discs;
  drawn.contrast = 255;
  for (int attempt = 0; attempt < 200 * count && std::ssize(discs) < count; ++attempt) {
    const Disc disc{stage.location(radius + 5), radius * stage.random.uniform(0.8, 1.25), level * stage.random.uniform(0.75, 1.0),
                    blur};
    const double apart = 3 * radius + 8;
    if (std::any_of(discs.begin(), discs.end(), [&](const Disc& other) { return (other.centre - disc.centre).norm() < apart; }))
      continue;
    const Under ground = under(stage.ground, disc.centre, disc.radius + 4);
    const double peak = (disc.level - ground.maximum) * (1 - std::exp(-disc.radius * disc.radius / (2 * blur * blur)));
    if (peak < std::max(40.0, 10 * drawn.noise)) continue;
    drawn.contrast = std::min(drawn.contrast, peak);
    discs.push_back(disc);
  }
  for (const Disc& disc : discs) drawn.markers.push_back(disc.centre);
  drawn.radius = radius;
  draw_discs(stage.ground, discs, 4);
}

/// One disc that moves along `path` while it is exposed; where it is saturated, so is what it sweeps.
void draw_swept(cv::Mat& ground, const Disc& disc, const Vector<2>& path) {
  const int steps = std::max(1, static_cast<int>(std::ceil(path.norm())) * 2);
  const int r = static_cast<int>(disc.radius + path.norm() / 2 + 8);
  const cv::Rect box =
      cv::Rect(static_cast<int>(disc.centre.x()) - r, static_cast<int>(disc.centre.y()) - r, 2 * r + 1, 2 * r + 1) &
      cv::Rect({}, ground.size());
  cv::Mat part = ground(box), sum = cv::Mat::zeros(box.size(), CV_32F);
  for (int i = 0; i <= steps; ++i) {
    cv::Mat one = part.clone();
    Disc there = disc;
    there.centre += path * (static_cast<double>(i) / steps - 0.5) - Vector<2>(box.x, box.y);
    draw_discs(one, std::span(&there, 1), 2);
    sum += one / (steps + 1);
  }
  sum.copyTo(part);
}

/// Three on a line; a companion that touches one of them in every second image.
void draw_wand(MarkerStage& stage, MarkerImage& drawn) {
  Random& random = stage.random;
  const double radius = random.uniform(3, 7), span = random.uniform(90, 260), blur = random.uniform(0.6, 1.2);
  const double level = random.chance(0.6) ? random.uniform(300, 1200) : random.uniform(160, 250);
  const double streak = random.chance(0.6) ? random.uniform(0, 3 * radius) : 0;
  for (int attempt = 0; attempt < 2000; ++attempt) {
    const double angle = random.uniform(0, 2 * std::numbers::pi), streak_angle = random.uniform(0, 2 * std::numbers::pi);
    const Vector<2> along(std::cos(angle), std::sin(angle)),
        path = streak * Vector<2>(std::cos(streak_angle), std::sin(streak_angle));
    const Vector<2> middle = stage.location(20);
    std::vector<Vector<2>> locations{middle - 0.5 * span * along, middle + 0.2 * span * along, middle + 0.5 * span * along};
    if (random.chance(0.5)) {
      const double turn = random.uniform(0, 2 * std::numbers::pi), apart = random.uniform(1.5, 2.4) * radius;
      locations.push_back(locations[0] + apart * Vector<2>(std::cos(turn), std::sin(turn)));
    }
    const bool clear = std::all_of(locations.begin(), locations.end(), [&](const Vector<2>& at) {
      const bool within = at.x() > 25 && at.y() > 25 && at.x() < stage.ground.cols - 26 && at.y() < stage.ground.rows - 26;
      return within && under(stage.ground, at, radius + streak / 2 + 6).maximum < 90;
    });
    if (!clear) continue;
    for (const Vector<2>& at : locations) draw_swept(stage.ground, {at, radius, level, blur}, path);
    drawn.markers = locations;
    drawn.radius = radius;
    drawn.contrast = std::min(level, 255.0) - 90;
    return;
  }
}

void draw_dots(MarkerStage& stage, MarkerImage& drawn) {
  std::vector<Disc> dots;
  for (int i = 0; i < 2000; ++i) {
    const Vector<2> at = stage.location(6);
    const double ground = under(stage.ground, at, 2).mean;
    dots.push_back({at, stage.random.uniform(1.2, 2.2), ground + stage.random.uniform(60, 130), 0.7});
    drawn.markers.push_back(at);
  }
  drawn.radius = 1.7;
  drawn.contrast = 40;
  draw_discs(stage.ground, dots, 3);
}

/// One sphere: lit from aside, with a gleam, on a ground that shines through its soft edge.
void draw_sphere(cv::Mat& ground, const Vector<2>& at, double radius, double level, const Vector<2>& light) {
  const int r = static_cast<int>(radius + 4);
  const cv::Rect box =
      cv::Rect(static_cast<int>(at.x()) - r, static_cast<int>(at.y()) - r, 2 * r + 1, 2 * r + 1) & cv::Rect({}, ground.size());
  for (int y = box.y; y < box.y + box.height; ++y) {
    for (int x = box.x; x < box.x + box.width; ++x) {
      const Vector<2> off = (Vector<2>(x, y) - at) / radius;
      const double fraction = 0.5 * std::erfc((off.norm() - 1) * radius / (std::numbers::sqrt2 * 0.7));
      const double up = std::sqrt(std::max(0.0, 1 - off.squaredNorm()));
      const double lit = std::max(0.0, off.dot(light) + up * std::sqrt(1 - light.squaredNorm()));
      const double gleam = 2 * std::exp(-(off - 0.6 * light).squaredNorm() / 0.06);
      float& pixel = ground.at<float>(y, x);
      pixel += static_cast<float>(fraction * (level * (0.35 + 0.65 * lit + gleam) - pixel));
    }
  }
}

/// Rows of spheres, as on a plate that a camera is calibrated by.
void draw_plate(MarkerStage& stage, MarkerImage& drawn) {
  Random& random = stage.random;
  const int rows = random.integer(2, 5), columns = random.integer(4, 15);
  const double radius = random.uniform(2.5, 7), level = random.uniform(120, 220), turn = random.uniform(0, 2 * std::numbers::pi);
  const Vector<2> light = random.uniform(0.3, 0.8) * Vector<2>(std::cos(turn), std::sin(turn));
  const double tilt = random.uniform(-0.1, 0.1);
  for (int row = 0; row < rows; ++row) {
    for (int column = 0; column < columns; ++column) {
      const Vector<2> at(stage.ground.cols * (column + 1.0) / (columns + 1), stage.ground.rows * (row + 1.0) / (rows + 1));
      const Vector<2> location = at + Vector<2>(0, tilt * at.x()) + random.uniform_pair(-3, 3, -3, 3);
      if (location.y() < 20 || location.y() > stage.ground.rows - 20) continue;
      const double bright = level * random.uniform(0.85, 1.0), size = radius * random.uniform(0.9, 1.1);
      draw_sphere(stage.ground, location, size, bright, light);
      drawn.markers.push_back(location);
    }
  }
  drawn.radius = radius;
  drawn.shade = 0.6;  // the gleam stands off the middle
  drawn.contrast = 0.35 * level;
}

cv::Mat exposed(const MarkerStage& stage, MarkerImage& drawn) {
  const double scale = drawn.bits == 8 ? 1 : drawn.bits == 12 ? 4095 / 255.0 : 65535 / 255.0;
  cv::Mat held = cv::min(stage.ground, 255.0) * scale;  // the sensor is full before it is read
  cv::Mat image = expose(held, drawn.noise * scale, stage.seed, drawn.bits == 8 ? CV_8U : CV_16U);
  if (drawn.bits == 12) image = cv::min(image, 4095);
  if (stage.quantizer <= 0 || drawn.bits != 8) return image;
  cv::Mat cb(image.rows / 2, image.cols / 2, CV_8U, cv::Scalar(128)), cr = cb.clone();
  people::ImageDegradation degradation;
  degradation.quantizer = stage.quantizer;
  people::apply(degradation, image, cb, cr);
  return image;
}

cv::Size size_of(MarkerSetting setting, Random& random) {
  if (setting == MarkerSetting::wand) return {1024, 704};
  if (setting == MarkerSetting::dots) return {1280, 1024};
  return random.chance(0.7) ? cv::Size(640, 480) : cv::Size(1024, 704);
}

}  // namespace

std::span<const NamedMarkerSetting> marker_settings() {
  return kSettings;
}

MarkerImage simulate_marker_image(MarkerSetting setting, std::uint64_t seed) {
  MarkerStage stage{
      .random = Random(seed * 1000003 + static_cast<std::uint64_t>(setting)), .seed = seed, .ground = {}, .specks = {}};
  MarkerImage drawn;
  stage.base = stage.random.uniform(8, 35);
  stage.ground = cv::Mat(size_of(setting, stage.random), CV_32FC1, cv::Scalar(stage.base));
  const bool own_depth = setting != MarkerSetting::compressed && setting != MarkerSetting::wand && setting != MarkerSetting::dots &&
                         setting != MarkerSetting::shaded;
  if (own_depth && stage.random.chance(0.4)) drawn.bits = stage.random.chance(0.5) ? 12 : 16;
  drawn.noise = stage.random.uniform(1, setting == MarkerSetting::compressed ? 3 : 5);
  lay(stage, setting);
  if (setting == MarkerSetting::wand) {
    draw_wand(stage, drawn);
  } else if (setting == MarkerSetting::dots) {
    draw_dots(stage, drawn);
  } else if (setting == MarkerSetting::shaded) {
    draw_plate(stage, drawn);
    drawn.specks = stage.specks;
  } else {
    strew_markers(stage, drawn, stage.random.integer(3, 12), {});
  }
  drawn.image = exposed(stage, drawn);
  return drawn;
}

}  // namespace marey::simulate::markers
