#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <span>
#include <vector>

#include <opencv2/core.hpp>
#include <opencv2/imgproc.hpp>

#include "marey/core/frame.h"

namespace marey::detect::background::test {

/// A person of 20 × 56 px who stands at `x`, `foot` (left, bottom), casting a shadow to the right.
struct Figure {
  int x = 0;
  int foot = 0;
};

struct SceneFrame {
  Frame frame;
  cv::Mat people;   ///< the truth: 255 where a person is seen
  cv::Mat shadows;  ///< 255 where a shadow is seen
};

/// What an instant is recorded under.
struct Conditions {
  double light = 1;                 ///< multiplies the ground
  double sway = 0;                  ///< px, how far the tree at the upper right has moved
  double shake_x = 0, shake_y = 0;  ///< px, how far the camera has
};

/// Videos a textured ground, or a room with shelves: the content is known to the pixel.
class SmallScene {
 public:
  explicit SmallScene(std::uint32_t seed, double noise = 2, bool shelves = false)
      : random_(seed), noise_(noise), ground_(kHeight, kWidth, CV_32FC1) {
    std::normal_distribution<float> texture(0, 8);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        const float coarse = 12 * std::sin(0.05F * static_cast<float>(x)) * std::cos(0.07F * static_cast<float>(y));
        ground_.at<float>(y, x) = 110 + coarse + texture(random_);
        if (shelves && y < kShelfBottom) ground_.at<float>(y, x) += (x / 6 * 37 + y / 26 * 17) % 5 * 22.0F - 44;
      }
    }
  }

  /// The next image, 1 / kRate later: the light multiplies the ground, `sway` px is how far the tree at the upper right has
  /// moved.
  SceneFrame video(std::span<const Figure> figures, double light = 1, double sway = 0) {
    return video(figures, Conditions{.light = light, .sway = sway});
  }
  SceneFrame video(std::span<const Figure> figures, const Conditions& under) {
    SceneFrame result;
    result.people = cv::Mat::zeros(kHeight, kWidth, CV_8UC1);
    result.shadows = cv::Mat::zeros(kHeight, kWidth, CV_8UC1);
    cv::Mat levels = ground_.clone();
    cv::Mat cb(kHeight / 2, kWidth / 2, CV_8UC1, cv::Scalar(122)), cr(kHeight / 2, kWidth / 2, CV_8UC1, cv::Scalar(124));
    draw_tree(levels, under.sway);
    for (const Figure& figure : figures) draw_shadow(figure, levels, result.shadows);
    for (const Figure& figure : figures) draw_figure(figure, levels, cb, cr, result.people);
    result.shadows.setTo(0, result.people);
    if (under.shake_x != 0 || under.shake_y != 0) {
      for (cv::Mat* plane : {&levels, &result.people, &result.shadows}) shift(*plane, under.shake_x, under.shake_y);
      for (cv::Mat* plane : {&cb, &cr}) shift(*plane, under.shake_x / 2, under.shake_y / 2);
      cv::threshold(result.people, result.people, 127, 255, cv::THRESH_BINARY);
      cv::threshold(result.shadows, result.shadows, 127, 255, cv::THRESH_BINARY);
    }
    result.frame.index = recorded_;
    result.frame.time = timestamp_from_seconds(static_cast<double>(recorded_++) / kRate);
    result.frame.image = Image(exposed(levels, under.light), cb, cr, Image::Range::limited);
    return result;
  }

  static constexpr int kWidth = 320, kHeight = 200, kRate = 10;
  static constexpr int kTreeLeft = 240, kTreeBottom = 60;
  static constexpr int kShelfBottom = 150;

 private:
  static void shift(cv::Mat& plane, double x, double y) {
    const cv::Matx23d moved(1, 0, x, 0, 1, y);
    cv::Mat result;
    cv::warpAffine(plane, result, moved, plane.size(), cv::INTER_LINEAR, cv::BORDER_REPLICATE);
    plane = result;
  }

  static void draw_tree(cv::Mat& levels, double sway) {
    for (int y = 0; y < kTreeBottom; ++y) {
      for (int x = kTreeLeft; x < kWidth; ++x) {
        const double leaf = std::sin((x + sway) * 0.9) * std::sin((y + sway / 2) * 0.8);
        levels.at<float>(y, x) = leaf > 0 ? 60.0F : 130.0F;
      }
    }
  }

  static void draw_shadow(const Figure& figure, cv::Mat& levels, cv::Mat& shadows) {
    for (int v = 0; v < 12; ++v) {
      for (int u = 8; u < 55; ++u) {
        const int x = figure.x + u, y = figure.foot - v;
        if (x < 0 || x >= kWidth || y < 0 || y >= kHeight) continue;
        levels.at<float>(y, x) = 16 + (levels.at<float>(y, x) - 16) * 0.62F;
        shadows.at<std::uint8_t>(y, x) = 255;
      }
    }
  }

  static void draw_figure(const Figure& figure, cv::Mat& levels, cv::Mat& cb, cv::Mat& cr, cv::Mat& people) {
    for (int v = 0; v < 56; ++v) {
      for (int u = 0; u < 20; ++u) {
        const int x = figure.x + u, y = figure.foot - v;
        if (x < 0 || x >= kWidth || y < 0 || y >= kHeight) continue;
        const bool head = v >= 46, legs = v < 26;
        if (head && (u < 6 || u > 13)) continue;
        levels.at<float>(y, x) = head ? 150.0F : legs ? 45.0F : 75.0F + static_cast<float>((u / 4) % 2) * 20;
        cb.at<std::uint8_t>(y / 2, x / 2) = head ? 112 : legs ? 128 : 140;
        cr.at<std::uint8_t>(y / 2, x / 2) = head ? 142 : legs ? 126 : 112;
        people.at<std::uint8_t>(y, x) = 255;
      }
    }
  }

  cv::Mat exposed(const cv::Mat& levels, double light) {
    cv::Mat image(levels.size(), CV_8UC1);
    std::normal_distribution<double> noise(0, noise_);
    for (int y = 0; y < kHeight; ++y) {
      for (int x = 0; x < kWidth; ++x) {
        image.at<std::uint8_t>(y, x) = cv::saturate_cast<std::uint8_t>(16 + (levels.at<float>(y, x) - 16) * light + noise(random_));
      }
    }
    return image;
  }

  std::mt19937 random_;
  double noise_;
  cv::Mat ground_;
  std::int64_t recorded_ = 0;
};

}  // namespace marey::detect::background::test
