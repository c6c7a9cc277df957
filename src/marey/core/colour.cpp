// sRGB to CIE L*a*b* and back, and distances between colours of shirts: IEC 61966-2-1 and CIE 15:2004, white point D65.
#include "marey/core/colour.h"

#include <algorithm>
#include <cmath>

namespace marey {
namespace {

constexpr double kLightnessWeight = 0.6;  // of lightness against hue, in `perceived`
constexpr double kWeakChroma = 30;        // chroma up to which strength counts nearly whole

constexpr float white_x = 0.95047F, white_z = 1.08883F;
constexpr float bend = 216.0F / 24389.0F;  // where the cube root gives way to a line
constexpr float slope = 24389.0F / 27.0F / 116.0F;

float linear_of(float coded) {
  const float v = coded / 255.0F;
  return v <= 0.04045F ? v / 12.92F : std::pow((v + 0.055F) / 1.055F, 2.4F);
}

float coded_of(float linear) {
  const float v = std::clamp(linear, 0.0F, 1.0F);
  return 255.0F * (v <= 0.0031308F ? 12.92F * v : 1.055F * std::pow(v, 1 / 2.4F) - 0.055F);
}

/// linear_of at whole numbers.
const std::array<float, 257>& linear_table() {
  static const std::array<float, 257> table = [] {
    std::array<float, 257> made{};
    for (int i = 0; i < 257; ++i) made[i] = linear_of(static_cast<float>(std::min(i, 255)));
    return made;
  }();
  return table;
}

float linear_between(float coded) {
  const std::array<float, 257>& table = linear_table();
  const float v = std::clamp(coded, 0.0F, 255.0F);
  const int i = static_cast<int>(v);
  return table[i] + (v - static_cast<float>(i)) * (table[i + 1] - table[i]);
}

float root(float t) {
  return t > bend ? std::cbrt(t) : slope * t + 16.0F / 116.0F;
}

float cube(float f) {
  return f * f * f > bend ? f * f * f : (f - 16.0F / 116.0F) / slope;
}

}  // namespace

std::array<float, 3> lab_from_srgb(float red, float green, float blue) {
  const float r = linear_between(red), g = linear_between(green), b = linear_between(blue);
  const float x = root((0.4124564F * r + 0.3575761F * g + 0.1804375F * b) / white_x);
  const float y = root(0.2126729F * r + 0.7151522F * g + 0.0721750F * b);
  const float z = root((0.0193339F * r + 0.1191920F * g + 0.9503041F * b) / white_z);
  return {116 * y - 16, 500 * (x - y), 200 * (y - z)};
}

std::array<float, 3> srgb_from_lab(float lightness, float a, float b) {
  const float fy = (lightness + 16) / 116;
  const float x = white_x * cube(fy + a / 500), y = cube(fy), z = white_z * cube(fy - b / 200);
  return {coded_of(3.2404542F * x - 1.5371385F * y - 0.4985314F * z), coded_of(-0.9692660F * x + 1.8760108F * y + 0.0415560F * z),
          coded_of(0.0556434F * x - 0.2040259F * y + 1.0572252F * z)};
}

Vector<3> perceived(const Appearance& colour) {
  const double chroma = std::hypot(static_cast<double>(colour.a), static_cast<double>(colour.b));
  const double kept = chroma > 1e-6 ? kWeakChroma * std::log1p(chroma / kWeakChroma) / chroma : 1;
  return {kLightnessWeight * colour.lightness, kept * colour.a, kept * colour.b};
}

Appearance colour_at(const Vector<3>& point, double deviation) {
  const double kept = std::hypot(point[1], point[2]);
  const double chroma = kept > 1e-6 ? kWeakChroma * std::expm1(kept / kWeakChroma) / kept : 1;
  return {.lightness = static_cast<float>(point[0] / kLightnessWeight),
          .a = static_cast<float>(chroma * point[1]),
          .b = static_cast<float>(chroma * point[2]),
          .deviation = static_cast<float>(deviation)};
}

}  // namespace marey
