#include "marey/simulate/markers/marker_ground.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>

#include <opencv2/imgproc.hpp>

#include "marey/simulate/markers/discs.h"
#include "marey/simulate/value_noise.h"

namespace marey::simulate::markers {
namespace {

/// Fills a polygon, with an edge as soft as a lens makes it.
void fill(cv::Mat& ground, const std::vector<cv::Point2f>& corners, double level, double softness = 0.7) {
  cv::Mat mask = cv::Mat::zeros(ground.size(), CV_8U);
  std::vector<cv::Point> fine;
  for (const cv::Point2f& corner : corners) fine.emplace_back(cvRound(corner.x * 16), cvRound(corner.y * 16));
  cv::fillPoly(mask, std::vector<std::vector<cv::Point>>{fine}, cv::Scalar(255), cv::LINE_AA, 4);
  cv::Mat fraction;
  mask.convertTo(fraction, CV_32F, 1 / 255.0);
  cv::GaussianBlur(fraction, fraction, {}, softness);
  ground = ground.mul(1 - fraction) + level * fraction;
}

}  // namespace

Vector<2> MarkerStage::location(double margin) {
  return {random.uniform(margin, ground.cols - 1 - margin), random.uniform(margin, ground.rows - 1 - margin)};
}

void lay_bar(MarkerStage& stage, double width, double level) {
  const double angle = stage.random.uniform(0, std::numbers::pi);
  const Vector<2> along(std::cos(angle), std::sin(angle)), across(-along.y(), along.x());
  const Vector<2> middle = stage.location(0.25 * stage.ground.rows);
  std::vector<cv::Point2f> corners;
  for (const auto& [u, v] : {std::pair(-1, -1), std::pair(1, -1), std::pair(1, 1), std::pair(-1, 1)}) {
    const Vector<2> corner = middle + along * (2000.0 * u) + across * (width / 2 * v);
    corners.emplace_back(static_cast<float>(corner.x()), static_cast<float>(corner.y()));
  }
  fill(stage.ground, corners, level);
}

void lay_levels(MarkerStage& stage, int areas) {
  for (int i = 0; i < areas; ++i) {
    const Vector<2> middle = stage.location(0);
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

void lay_texture(MarkerStage& stage) {
  const Vector<2> lit = stage.location(0.2 * stage.ground.rows);
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

void strew_specks(MarkerStage& stage, int count, double minimum, double maximum) {
  std::vector<Disc> specks;
  for (int i = 0; i < count; ++i) {
    const Vector<2> at = stage.location(3);
    const float under = stage.ground.at<float>(static_cast<int>(at.y()), static_cast<int>(at.x()));
    specks.push_back({at, stage.random.uniform(0.6, 1.2), under + stage.random.uniform(minimum, maximum), 0.6});
  }
  for (const Disc& speck : specks) stage.specks.push_back(speck.centre);
  draw_discs(stage.ground, specks, 2);
}

void lay_gradient(MarkerStage& stage, double rise) {
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

void lay_vignette(MarkerStage& stage) {
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

void lay_lamp(MarkerStage& stage, const Vector<2>& at, double radius) {
  const double halo = stage.random.uniform(60, 160), length = stage.random.uniform(0.8, 2.5) * radius + 6;
  for (int y = 0; y < stage.ground.rows; ++y) {
    auto* row = stage.ground.ptr<float>(y);
    for (int x = 0; x < stage.ground.cols; ++x) {
      const double away = std::hypot(x - at.x(), y - at.y()) - radius;
      row[x] += static_cast<float>(away > 0 ? halo * std::exp(-away / length) : 600);
    }
  }
}

void lay_glow(MarkerStage& stage) {
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

void lay_reflection(MarkerStage& stage) {
  Vector<2> at = stage.location(60);
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
  cv::Mat fraction;
  mask.convertTo(fraction, CV_32F, 1 / 255.0);
  cv::GaussianBlur(fraction, fraction, {}, stage.random.uniform(0.7, 1.5));
  stage.ground += stage.random.uniform(300, 700) * fraction;
}

}  // namespace marey::simulate::markers
