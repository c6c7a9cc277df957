#include "marey/draw/canvas.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <opencv2/imgproc.hpp>

#include "marey/core/colour.h"

namespace marey::draw {
namespace {

// Positions within a pixel are given to OpenCV in sixteenths.
constexpr int kShift = 4;

constexpr int kFont = cv::FONT_HERSHEY_SIMPLEX;
constexpr double kCapitalHeight = 21;  // of this font at scale 1

cv::Point fine(cv::Point2f point) {
  constexpr float kOne = 1 << kShift;
  return {cvRound(point.x * kOne), cvRound(point.y * kOne)};
}

/// BT.601, limited range.
std::array<double, 3> planes_of(const Colour& colour) {
  const double red = colour.red, green = colour.green, blue = colour.blue;
  const double luma = 0.299 * red + 0.587 * green + 0.114 * blue;
  return {16 + luma * 219 / 255, 128 + (blue - luma) / 1.772 * 224 / 255, 128 + (red - luma) / 1.402 * 224 / 255};
}

void blend(cv::Mat plane, const cv::Mat& stencil, double value) {
  const int target = static_cast<int>(std::lround(value));
  for (int y = 0; y < plane.rows; ++y) {
    auto* pixel = plane.ptr<unsigned char>(y);
    const auto* opacity = stencil.ptr<unsigned char>(y);
    for (int x = 0; x < plane.cols; ++x) {
      pixel[x] = static_cast<unsigned char>(pixel[x] + ((target - pixel[x]) * opacity[x] + (target > pixel[x] ? 127 : -127)) / 255);
    }
  }
}

struct TagShape {
  double scale;
  int thickness, pad;
  cv::Size extent;
};

TagShape shape_of(const std::string& text, double text_height) {
  TagShape shape{text_height / kCapitalHeight, std::max(1, cvRound(text_height / 8)), std::max(2, cvRound(text_height / 4)), {}};
  int baseline = 0;
  shape.extent = cv::getTextSize(text, kFont, shape.scale, shape.thickness, &baseline);
  return shape;
}

}  // namespace

Colour colour_of(int number) {
  // Hues a golden angle apart are far from all those just before; three kinds of lightness keep the rest apart.
  const double hue = std::fmod(number * 137.50776, 360.0) / 60.0;
  const double value = 1.0 - 0.18 * (number % 3);
  const double saturation = 0.95 - 0.2 * (number % 2);
  const auto channel = [&](double offset) {
    const double k = std::fmod(offset + hue, 6.0);
    const double level = value - value * saturation * std::clamp(std::min(k, 4 - k), 0.0, 1.0);
    return static_cast<unsigned char>(std::lround(255 * level));
  };
  return {channel(5), channel(3), channel(1)};
}

Colour colour_of(const Appearance& appearance) {
  const auto rgb = srgb_from_lab(appearance.lightness, appearance.a, appearance.b);
  const auto channel = [](float value) { return static_cast<unsigned char>(std::lround(value)); };
  return {channel(rgb[0]), channel(rgb[1]), channel(rgb[2])};
}

Image with_white(const Image& image, double white) {
  if (image.luma().depth() != CV_16U) return image;
  cv::Mat luma;
  image.luma().convertTo(luma, CV_16U, 65535 / std::max(1.0, white));
  return Image(luma);
}

double lightest(const Image& image) {
  double maximum = 0;
  cv::minMaxLoc(image.luma(), nullptr, &maximum);
  return maximum;
}

Canvas::Canvas(const Image& image) {
  const bool full = image.range() == Image::Range::full;
  const double luma_scale = (full ? 219.0 / 255.0 : 1.0) * (image.luma().depth() == CV_16U ? 1.0 / 257.0 : 1.0);
  image.luma().convertTo(luma_, CV_8U, luma_scale, full ? 16 : 0);
  if (image.is_colour()) {
    const double chroma_scale = full ? 224.0 / 255.0 : 1.0;
    image.cb().convertTo(cb_, CV_8U, chroma_scale, 128 * (1 - chroma_scale));
    image.cr().convertTo(cr_, CV_8U, chroma_scale, 128 * (1 - chroma_scale));
  } else {
    cb_ = cv::Mat((luma_.rows + 1) / 2, (luma_.cols + 1) / 2, CV_8UC1, cv::Scalar(128));
    cr_ = cb_.clone();
  }
}

cv::Rect Canvas::even_part(const cv::Rect2f& where, double margin) const {
  const int left = std::max(0, static_cast<int>(std::floor(where.x - margin))) & ~1;
  const int top = std::max(0, static_cast<int>(std::floor(where.y - margin))) & ~1;
  const int right = std::min(luma_.cols, static_cast<int>(std::ceil(where.x + where.width + margin)) + 1);
  const int bottom = std::min(luma_.rows, static_cast<int>(std::ceil(where.y + where.height + margin)) + 1);
  return right > left && bottom > top ? cv::Rect(left, top, right - left, bottom - top) : cv::Rect();
}

void Canvas::lay(const cv::Mat& stencil, cv::Point at, const Colour& colour) {
  const auto [luma, cb, cr] = planes_of(colour);
  blend(luma_(cv::Rect(at, stencil.size())), stencil, luma);
  cv::Mat even = stencil, half;
  if (stencil.rows % 2 != 0 || stencil.cols % 2 != 0) {
    cv::copyMakeBorder(stencil, even, 0, stencil.rows % 2, 0, stencil.cols % 2, cv::BORDER_REPLICATE);
  }
  cv::resize(even, half, {even.cols / 2, even.rows / 2}, 0, 0, cv::INTER_AREA);
  const cv::Rect chroma(at / 2, half.size());
  blend(cb_(chroma), half, cb);
  blend(cr_(chroma), half, cr);
}

void Canvas::strokes(const std::vector<Stroke>& strokes, const Colour& colour, double thickness) {
  if (strokes.empty()) return;
  float left = strokes[0].from.x, right = left, top = strokes[0].from.y, bottom = top;
  for (const Stroke& stroke : strokes) {
    left = std::min({left, stroke.from.x, stroke.to.x});
    right = std::max({right, stroke.from.x, stroke.to.x});
    top = std::min({top, stroke.from.y, stroke.to.y});
    bottom = std::max({bottom, stroke.from.y, stroke.to.y});
  }
  const cv::Rect part = even_part({left, top, right - left, bottom - top}, thickness + 1);
  if (part.empty()) return;
  cv::Mat stencil = cv::Mat::zeros(part.size(), CV_8UC1);
  const cv::Point2f origin(part.tl());
  for (const Stroke& stroke : strokes) {
    cv::line(stencil, fine(stroke.from - origin), fine(stroke.to - origin), cv::Scalar(255 * stroke.opacity),
             std::max(1, cvRound(thickness)), cv::LINE_AA, kShift);
  }
  lay(stencil, part.tl(), colour);
}

void Canvas::discs(const std::vector<cv::Point2f>& centres, double radius, const Colour& colour, double opacity) {
  if (centres.empty()) return;
  cv::Point2f low = centres[0], high = low;
  for (const cv::Point2f& centre : centres) {
    low = {std::min(low.x, centre.x), std::min(low.y, centre.y)};
    high = {std::max(high.x, centre.x), std::max(high.y, centre.y)};
  }
  const cv::Rect part = even_part({low, high}, radius + 1);
  if (part.empty()) return;
  cv::Mat stencil = cv::Mat::zeros(part.size(), CV_8UC1);
  for (const cv::Point2f& centre : centres) {
    cv::circle(stencil, fine(centre - cv::Point2f(part.tl())), cvRound(radius * (1 << kShift)), cv::Scalar(255 * opacity),
               cv::FILLED, cv::LINE_AA, kShift);
  }
  lay(stencil, part.tl(), colour);
}

void Canvas::rectangle(const cv::Rect2f& where, const Colour& colour, double thickness, double opacity) {
  const cv::Rect part = even_part(where, thickness + 1);
  if (part.empty()) return;
  cv::Mat stencil = cv::Mat::zeros(part.size(), CV_8UC1);
  const cv::Point2f origin(part.tl());
  cv::rectangle(stencil, fine(where.tl() - origin), fine(where.br() - origin), cv::Scalar(255 * opacity),
                std::max(1, cvRound(thickness)), cv::LINE_AA, kShift);
  lay(stencil, part.tl(), colour);
}

void Canvas::coarsen(const cv::Rect2f& where) {
  constexpr int kCells = 4;              // across: fewer than any face is known by
  constexpr float kToCorners = 0.7071F;  // half an ellipse's axes, of the sides of a rectangle that it goes round
  const cv::Point2f centre(where.x + where.width / 2, where.y + where.height / 2);
  const cv::Size2f half(where.width * kToCorners, where.height * kToCorners);
  const cv::Rect part = even_part({centre.x - half.width, centre.y - half.height, 2 * half.width, 2 * half.height}, 0);
  if (part.empty()) return;
  cv::Mat stencil(part.size(), CV_8UC1, cv::Scalar(0));
  cv::ellipse(stencil, fine(centre - cv::Point2f(static_cast<float>(part.x), static_cast<float>(part.y))),
              cv::Size(fine({half.width, half.height})), 0, 0, 360, cv::Scalar(255), cv::FILLED, cv::LINE_8, kShift);
  cv::Mat chroma_stencil;
  const auto cover = [&](cv::Mat plane, const cv::Mat& mask) {
    cv::Mat cells, coarse;
    cv::resize(plane, cells, {std::min(kCells, plane.cols), std::min(kCells, plane.rows)}, 0, 0, cv::INTER_AREA);
    cv::resize(cells, coarse, plane.size(), 0, 0, cv::INTER_LINEAR);
    coarse.copyTo(plane, mask);
  };
  cover(luma_(part), stencil);
  const cv::Rect chroma = cv::Rect(part.x / 2, part.y / 2, (part.width + 1) / 2, (part.height + 1) / 2) & cv::Rect({}, cb_.size());
  cv::resize(stencil, chroma_stencil, chroma.size(), 0, 0, cv::INTER_NEAREST);
  cover(cb_(chroma), chroma_stencil);
  cover(cr_(chroma), chroma_stencil);
}

void Canvas::fill(const cv::Rect2f& where, const Colour& colour) {
  const cv::Rect part = even_part(where, 0);
  if (!part.empty()) lay(cv::Mat(part.size(), CV_8UC1, cv::Scalar(255)), part.tl(), colour);
}

void Canvas::text(const std::string& text, cv::Point2f centre, const Colour& colour, double text_height) {
  const double scale = text_height / kCapitalHeight;
  const int thickness = std::max(1, cvRound(text_height / 8));
  int baseline = 0;
  const cv::Size extent = cv::getTextSize(text, kFont, scale, thickness, &baseline);
  const cv::Point2f corner(centre.x - static_cast<float>(extent.width) / 2, centre.y - static_cast<float>(extent.height) / 2);
  const cv::Rect part = even_part({corner, cv::Size2f(extent)}, 2);
  if (part.empty()) return;
  cv::Mat stencil = cv::Mat::zeros(part.size(), CV_8UC1);
  cv::putText(stencil, text, cv::Point(cvRound(corner.x), cvRound(corner.y) + extent.height) - part.tl(), kFont, scale,
              cv::Scalar(255), thickness, cv::LINE_AA);
  lay(stencil, part.tl(), colour);
}

cv::Rect Canvas::tag_area(const std::string& text, cv::Point2f corner, double text_height) const {
  const TagShape shape = shape_of(text, text_height);
  const cv::Size size(shape.extent.width + 2 * shape.pad, shape.extent.height + 2 * shape.pad);
  const int left = std::clamp(cvRound(corner.x), 0, std::max(0, luma_.cols - size.width)) & ~1;
  const int top = std::clamp(cvRound(corner.y) - size.height, 0, std::max(0, luma_.rows - size.height)) & ~1;
  return cv::Rect({left, top}, size) & cv::Rect({}, luma_.size());
}

void Canvas::tag(const std::string& text, cv::Point2f corner, const Colour& colour, double text_height) {
  const TagShape shape = shape_of(text, text_height);
  const cv::Rect part = tag_area(text, corner, text_height);
  if (part.empty()) return;
  lay(cv::Mat(part.size(), CV_8UC1, cv::Scalar(225)), part.tl(), colour);
  cv::Mat stencil = cv::Mat::zeros(part.size(), CV_8UC1);
  cv::putText(stencil, text, {shape.pad, shape.pad + shape.extent.height}, kFont, shape.scale, cv::Scalar(255), shape.thickness,
              cv::LINE_AA);
  const bool light = planes_of(colour)[0] > 120;
  lay(stencil, part.tl(), light ? Colour{0, 0, 0} : Colour{255, 255, 255});
}

Image Canvas::take() {
  return {std::move(luma_), std::move(cb_), std::move(cr_), Image::Range::limited};
}

}  // namespace marey::draw
