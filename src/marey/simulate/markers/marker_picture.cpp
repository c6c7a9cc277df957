// A picture is a ground (CV_32FC1, levels of 255), things laid over it, markers drawn last by `draw_discs`, and exposure: noise,
// saturation, depth, compression. Markers keep off each other and off what is saturated, as far as the setting does not want it
// otherwise.
#include "marey/simulate/markers/marker_picture.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <optional>

#include <opencv2/imgproc.hpp>

#include "marey/simulate/markers/discs.h"
#include "marey/simulate/people/camera_look.h"
#include "marey/simulate/random.h"
#include "marey/simulate/value_noise.h"

namespace marey::simulate::markers {
namespace {

constexpr std::array<NamedMarkerSetting, 11> kSettings{{{"levels", MarkerSetting::levels},
                                                        {"bar", MarkerSetting::bar},
                                                        {"texture", MarkerSetting::texture},
                                                        {"gradient", MarkerSetting::gradient},
                                                        {"vignette", MarkerSetting::vignette},
                                                        {"glow", MarkerSetting::glow},
                                                        {"reflections", MarkerSetting::reflections},
                                                        {"compressed", MarkerSetting::compressed},
                                                        {"everything", MarkerSetting::everything},
                                                        {"wand", MarkerSetting::wand},
                                                        {"dots", MarkerSetting::dots}}};

/// A picture while it is made.
struct Stage {
  Random random;
  std::uint64_t seed;
  cv::Mat ground;        // CV_32FC1
  double base = 18;      // level of the empty ground
  double quantizer = 0;  // of compression; 0: none
  std::vector<Vector<2>> markers;
};

Vector<2> place_in(Stage& stage, double margin) {
  return {stage.random.uniform(margin, stage.ground.cols - 1 - margin),
          stage.random.uniform(margin, stage.ground.rows - 1 - margin)};
}

/// Fills a polygon, with an edge as soft as a lens makes it.
void fill(cv::Mat& ground, const std::vector<cv::Point2f>& corners, double level, double softness = 0.7) {
  cv::Mat mask = cv::Mat::zeros(ground.size(), CV_8U);
  std::vector<cv::Point> fine;
  for (const cv::Point2f& corner : corners) fine.emplace_back(cvRound(corner.x * 16), cvRound(corner.y * 16));
  cv::fillPoly(mask, std::vector<std::vector<cv::Point>>{fine}, cv::Scalar(255), cv::LINE_AA, 4);
  cv::Mat share;
  mask.convertTo(share, CV_32F, 1 / 255.0);
  cv::GaussianBlur(share, share, {}, softness);
  ground = ground.mul(1 - share) + level * share;
}

/// A bar through the picture's middle part, so wide, at any angle.
void lay_bar(Stage& stage, double width, double level) {
  const double angle = stage.random.uniform(0, std::numbers::pi);
  const Vector<2> along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
  const Vector<2> middle = place_in(stage, 0.25 * stage.ground.rows);
  std::vector<cv::Point2f> corners;
  for (const auto& [u, v] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)}) {
    const Vector<2> corner = middle + along * (2000.0 * u) + across * (width / 2 * v);
    corners.emplace_back(static_cast<float>(corner.x()), static_cast<float>(corner.y()));
  }
  fill(stage.ground, corners, level);
}

void lay_levels(Stage& stage, int areas) {
  for (int i = 0; i < areas; ++i) {
    const Vector<2> middle = place_in(stage, 0);
    const double reach = stage.ground.cols * stage.random.uniform(0.06, 0.3);
    const int corner_count = stage.random.integer(3, 7);
    const double turn = stage.random.uniform(0, 2 * std::numbers::pi);
    std::vector<cv::Point2f> corners;
    for (int k = 0; k < corner_count; ++k) {
      const double angle = turn + 2 * std::numbers::pi * k / corner_count, far = reach * stage.random.uniform(0.6, 1.2);
      corners.emplace_back(static_cast<float>(middle.x() + far * std::cos(angle)),
                           static_cast<float>(middle.y() + far * std::sin(angle)));
    }
    fill(stage.ground, corners, stage.random.uniform(stage.base + 10, 120));
  }
}

void lay_texture(Stage& stage) {
  const Vector<2> lit = place_in(stage, 0.2 * stage.ground.rows);
  const double reach = stage.ground.cols * stage.random.uniform(0.15, 0.4), height = stage.random.uniform(8, 30);
  const double grain = stage.random.uniform(2.5, 9);  // px
  for (int y = 0; y < stage.ground.rows; ++y) {
    auto* row = stage.ground.ptr<float>(y);
    for (int x = 0; x < stage.ground.cols; ++x) {
      const Vector<2> at(x, y);
      const double light = std::exp(-(at - lit).squaredNorm() / (2 * reach * reach));
      if (light < 0.02) continue;
      const double bumps = 0.6 * value_noise(at / grain, stage.seed) + 0.4 * value_noise(at / (3 * grain), stage.seed + 1);
      row[x] += static_cast<float>(light * height * (0.8 + std::max(-0.5, bumps)));
    }
  }
}

/// Spots of 2 to 4 px, of few grey levels.
void strew_specks(Stage& stage, int count) {
  std::vector<Disc> specks;
  for (int i = 0; i < count; ++i) {
    const Vector<2> at = place_in(stage, 3);
    const float under = stage.ground.at<float>(static_cast<int>(at.y()), static_cast<int>(at.x()));
    specks.push_back({at, stage.random.uniform(0.6, 1.2), under + stage.random.uniform(7, 40), 0.6});
  }
  draw_discs(stage.ground, specks, 2);
}

void lay_gradient(Stage& stage, double rise) {
  const double angle = stage.random.uniform(0, 2 * std::numbers::pi);
  const double reach = std::hypot(stage.ground.cols, stage.ground.rows) / 2;
  for (int y = 0; y < stage.ground.rows; ++y) {
    auto* row = stage.ground.ptr<float>(y);
    for (int x = 0; x < stage.ground.cols; ++x) {
      const double along =
          ((x - stage.ground.cols / 2.0) * std::cos(angle) + (y - stage.ground.rows / 2.0) * std::sin(angle)) / reach;
      row[x] += static_cast<float>(rise * (along + 1) / 2);
    }
  }
}

void lay_vignette(Stage& stage) {
  const double lit = stage.random.uniform(30, 100), fall = stage.random.uniform(0.4, 0.8);
  const double reach = std::hypot(stage.ground.cols, stage.ground.rows) / 2;
  for (int y = 0; y < stage.ground.rows; ++y) {
    auto* row = stage.ground.ptr<float>(y);
    for (int x = 0; x < stage.ground.cols; ++x) {
      const double out = std::hypot(x - stage.ground.cols / 2.0, y - stage.ground.rows / 2.0) / reach;
      row[x] += static_cast<float>(lit * (1 - fall * out * out));
    }
  }
}

/// A lamp and the light that the lens spreads round it: a saturated core and a halo that falls off by e in a few tens of pixels.
void lay_lamp(Stage& stage, const Vector<2>& at, double radius) {
  const double halo = stage.random.uniform(60, 160), length = stage.random.uniform(0.8, 2.5) * radius + 6;
  for (int y = 0; y < stage.ground.rows; ++y) {
    auto* row = stage.ground.ptr<float>(y);
    for (int x = 0; x < stage.ground.cols; ++x) {
      const double away = std::hypot(x - at.x(), y - at.y()) - radius;
      row[x] += static_cast<float>(away > 0 ? halo * std::exp(-away / length) : 600);
    }
  }
}

void lay_glow(Stage& stage) {
  const int lamps = stage.random.integer(1, 2);
  for (int i = 0; i < lamps; ++i) {
    const double radius = stage.random.uniform(8, 45), out = stage.random.uniform(-0.4, 1.2) * radius;
    const double along = stage.random.uniform();
    const double w = stage.ground.cols - 1, h = stage.ground.rows - 1;
    const std::array<Vector<2>, 4> edges{Vector<2>(along * w, -out), Vector<2>(along * w, h + out), Vector<2>(-out, along * h),
                                         Vector<2>(w + out, along * h)};
    lay_lamp(stage, edges[static_cast<std::size_t>(stage.random.integer(0, 3))], radius);
  }
}

/// A chain of ellipses of all sizes: light on metal.
void lay_reflection(Stage& stage) {
  Vector<2> at = place_in(stage, 60);
  double angle = stage.random.uniform(0, 2 * std::numbers::pi);
  cv::Mat mask = cv::Mat::zeros(stage.ground.size(), CV_8U);
  const int parts = stage.random.integer(3, 6);
  for (int i = 0; i < parts; ++i) {
    const cv::Size2f axes(static_cast<float>(stage.random.uniform(14, 50)), static_cast<float>(stage.random.uniform(5, 22)));
    cv::ellipse(mask,
                cv::RotatedRect({static_cast<float>(at.x()), static_cast<float>(at.y())}, axes,
                                static_cast<float>(stage.random.uniform(0, 180))),
                cv::Scalar(255), cv::FILLED);
    angle += stage.random.uniform(-0.8, 0.8);
    at += Vector<2>(std::cos(angle), std::sin(angle)) * stage.random.uniform(8, 24);
  }
  cv::Mat share;
  mask.convertTo(share, CV_32F, 1 / 255.0);
  cv::GaussianBlur(share, share, {}, stage.random.uniform(0.7, 1.5));
  stage.ground += stage.random.uniform(300, 700) * share;
}

void compress(Stage& stage) {
  lay_levels(stage, 2);
  stage.quantizer = stage.random.uniform(8, 28);
}

void lay(Stage& stage, MarkerSetting setting) {
  switch (setting) {
    case MarkerSetting::levels:
      return lay_levels(stage, stage.random.integer(3, 5));
    case MarkerSetting::bar:
      return lay_bar(stage, stage.ground.cols * stage.random.uniform(0.15, 0.4), stage.random.uniform(40, 110));
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
      for (int i = stage.random.integer(1, 3); i > 0; --i) lay_lamp(stage, place_in(stage, 20), stage.random.uniform(12, 30));
      return;
    case MarkerSetting::dots:
      return lay_gradient(stage, stage.random.uniform(60, 110));
  }
}

/// The brightest and the middle of the ground round a place.
struct Under {
  double most = 0, mean = 0;
};

Under under(const cv::Mat& ground, const Vector<2>& at, double reach) {
  const int r = static_cast<int>(std::ceil(reach));
  const cv::Rect box =
      cv::Rect(static_cast<int>(at.x()) - r, static_cast<int>(at.y()) - r, 2 * r + 1, 2 * r + 1) & cv::Rect({}, ground.size());
  double most = 0;
  cv::minMaxLoc(ground(box), nullptr, &most);
  return {most, cv::mean(ground(box))[0]};
}

struct Kind {
  double low_radius = 1.5, high_radius = 6;
  double low_level = 130, high_level = 250;
};

/// So many markers, each clear of the others and on a ground that it outshines.
void strew_markers(Stage& stage, MarkerPicture& picture, int count, const Kind& kind) {
  const double radius = stage.random.uniform(kind.low_radius, kind.high_radius), blur = stage.random.uniform(0.5, 1.0);
  const double level = stage.random.uniform(kind.low_level, kind.high_level);
  std::vector<Disc> discs;
  picture.contrast = 255;
  for (int attempt = 0; attempt < 200 * count && std::ssize(discs) < count; ++attempt) {
    const Disc disc{place_in(stage, radius + 5), radius * stage.random.uniform(0.8, 1.25), level * stage.random.uniform(0.75, 1.0),
                    blur};
    const double apart = 3 * radius + 8;
    if (std::any_of(discs.begin(), discs.end(), [&](const Disc& other) { return (other.centre - disc.centre).norm() < apart; }))
      continue;
    const Under ground = under(stage.ground, disc.centre, disc.radius + 4);
    const double peak = (disc.level - ground.most) * (1 - std::exp(-disc.radius * disc.radius / (2 * blur * blur)));
    if (peak < std::max(40.0, 10 * picture.noise)) continue;
    picture.contrast = std::min(picture.contrast, peak);
    discs.push_back(disc);
  }
  for (const Disc& disc : discs) picture.markers.push_back(disc.centre);
  picture.radius = radius;
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

/// Three on a line; a companion that touches one of them in every second picture.
void draw_wand(Stage& stage, MarkerPicture& picture) {
  Random& random = stage.random;
  const double radius = random.uniform(3, 7), span = random.uniform(90, 260), blur = random.uniform(0.6, 1.2);
  const double level = random.chance(0.6) ? random.uniform(300, 1200) : random.uniform(160, 250);
  const double streak = random.chance(0.6) ? random.uniform(0, 3 * radius) : 0;
  for (int attempt = 0; attempt < 2000; ++attempt) {
    const double angle = random.uniform(0, 2 * std::numbers::pi), way = random.uniform(0, 2 * std::numbers::pi);
    const Vector<2> along(std::cos(angle), std::sin(angle)), path = streak * Vector<2>(std::cos(way), std::sin(way));
    const Vector<2> middle = place_in(stage, 20);
    std::vector<Vector<2>> places{middle - 0.5 * span * along, middle + 0.2 * span * along, middle + 0.5 * span * along};
    if (random.chance(0.5)) {
      const double turn = random.uniform(0, 2 * std::numbers::pi), apart = random.uniform(1.5, 2.4) * radius;
      places.push_back(places[0] + apart * Vector<2>(std::cos(turn), std::sin(turn)));
    }
    const bool clear = std::all_of(places.begin(), places.end(), [&](const Vector<2>& at) {
      const bool within = at.x() > 25 && at.y() > 25 && at.x() < stage.ground.cols - 26 && at.y() < stage.ground.rows - 26;
      return within && under(stage.ground, at, radius + streak / 2 + 6).most < 90;
    });
    if (!clear) continue;
    for (const Vector<2>& at : places) draw_swept(stage.ground, {at, radius, level, blur}, path);
    picture.markers = places;
    picture.radius = radius;
    picture.contrast = std::min(level, 255.0) - 90;
    return;
  }
}

void draw_dots(Stage& stage, MarkerPicture& picture) {
  std::vector<Disc> dots;
  for (int i = 0; i < 2000; ++i) {
    const Vector<2> at = place_in(stage, 6);
    const double ground = under(stage.ground, at, 2).mean;
    dots.push_back({at, stage.random.uniform(1.2, 2.2), ground + stage.random.uniform(60, 130), 0.7});
    picture.markers.push_back(at);
  }
  picture.radius = 1.7;
  picture.contrast = 40;
  draw_discs(stage.ground, dots, 3);
}

cv::Mat exposed(const Stage& stage, MarkerPicture& picture) {
  const double scale = picture.bits == 8 ? 1 : picture.bits == 12 ? 4095 / 255.0 : 65535 / 255.0;
  cv::Mat held = cv::min(stage.ground, 255.0) * scale;  // the sensor is full before it is read
  cv::Mat image = expose(held, picture.noise * scale, stage.seed, picture.bits == 8 ? CV_8U : CV_16U);
  if (picture.bits == 12) image = cv::min(image, 4095);
  if (stage.quantizer <= 0 || picture.bits != 8) return image;
  cv::Mat cb(image.rows / 2, image.cols / 2, CV_8U, cv::Scalar(128)), cr = cb.clone();
  people::CameraLook look;
  look.quantizer = stage.quantizer;
  people::apply(look, image, cb, cr);
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

MarkerPicture simulate_marker_picture(MarkerSetting setting, std::uint64_t seed) {
  Stage stage{.random = Random(seed * 1000003 + static_cast<std::uint64_t>(setting)), .seed = seed, .ground = {}, .markers = {}};
  MarkerPicture picture;
  stage.base = stage.random.uniform(8, 35);
  stage.ground = cv::Mat(size_of(setting, stage.random), CV_32FC1, cv::Scalar(stage.base));
  const bool own_depth = setting != MarkerSetting::compressed && setting != MarkerSetting::wand && setting != MarkerSetting::dots;
  if (own_depth && stage.random.chance(0.4)) picture.bits = stage.random.chance(0.5) ? 12 : 16;
  picture.noise = stage.random.uniform(1, setting == MarkerSetting::compressed ? 3 : 5);
  lay(stage, setting);
  if (setting == MarkerSetting::wand) {
    draw_wand(stage, picture);
  } else if (setting == MarkerSetting::dots) {
    draw_dots(stage, picture);
  } else {
    strew_markers(stage, picture, stage.random.integer(3, 12), {});
  }
  picture.image = exposed(stage, picture);
  return picture;
}

}  // namespace marey::simulate::markers
