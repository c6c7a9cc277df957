// Colours in the chroma planes as they are stored, without a conversion. The hue of red-green-blue does not change when grey is
// added or when all three are scaled, and both move chroma (Cb, Cr) along a ray from grey: a range of hues is a sector of the
// chroma plane, and saturation (largest − smallest) is the distance along the ray. So a pixel passes when it lies on the right side
// of three lines: the sector's two edges, and the chord between its ends at the least saturation. Cost: six multiplications a
// chroma pixel.
#include "marey/detect/markers/marker_colour.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <string>

#include "marey/core/error.h"
#include "marey/core/geometry.h"

namespace marey::detect::markers {
namespace {

/// (Cb, Cr) − 128 of the fully saturated, brightest colour of a hue; BT.601, limited range.
Vector<2> chroma_of_hue(double hue_deg) {
  const double h = std::fmod(std::fmod(hue_deg, 360.0) + 360.0, 360.0) / 60.0;
  const auto channel = [h](double peak) {
    const double away = std::abs(std::remainder(h - peak, 6.0));
    return std::clamp(2.0 - away, 0.0, 1.0);
  };
  const double red = channel(0), green = channel(2), blue = channel(4);
  return {112.0 * (blue - 0.299 * red - 0.587 * green - 0.114 * blue) / 0.886,
          112.0 * (red - 0.299 * red - 0.587 * green - 0.114 * blue) / 0.701};
}

double cross(const Vector<2>& a, const Vector<2>& b) {
  return a.x() * b.y() - a.y() * b.x();
}

double number(std::string_view text, std::string_view whole) {
  double value = 0;
  const auto [end, problem] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (problem != std::errc{} || end != text.data() + text.size() || !std::isfinite(value)) {
    throw Error("colour \"{}\" is not understood; write hue±tolerance in degrees, as in 120±15 or 120+-15", whole);
  }
  return value;
}

}  // namespace

MarkerColour parse_marker_colour(std::string_view text) {
  MarkerColour colour;
  std::size_t sign = std::string_view::npos, length = 0;
  for (const std::string_view mark : {std::string_view("\u00b1"), std::string_view("+-")}) {
    if (const auto at = text.find(mark); at != std::string_view::npos) sign = at, length = mark.size();
  }
  colour.hue_deg = number(text.substr(0, sign), text);
  if (sign != std::string_view::npos) colour.tolerance_deg = number(text.substr(sign + length), text);
  if (colour.hue_deg < 0 || colour.hue_deg > 360) throw Error("colour \"{}\": the hue must lie in 0–360 degrees", text);
  if (colour.tolerance_deg <= 0 || colour.tolerance_deg > 60) {
    throw Error("colour \"{}\": the tolerance must lie above 0 and be at most 60 degrees", text);
  }
  return colour;
}

void colour_heights(const Image& image, const MarkerColour& colour, cv::Mat& heights) {
  if (!image.is_colour()) throw Error("markers of a colour cannot be found in a grey image; leave the colour out");
  const double scale = image.range() == Image::Range::full ? 255.0 / 224.0 : 1.0;
  Vector<2> low = chroma_of_hue(colour.hue_deg - colour.tolerance_deg) * scale;
  Vector<2> high = chroma_of_hue(colour.hue_deg + colour.tolerance_deg) * scale;
  if (cross(low, high) < 0) std::swap(low, high);
  // Height above the chord, with its distance from grey as the unit: cross(c, high − low) / cross(low, high) is 1 on it.
  const Vector<2> chord = (high - low) / cross(low, high) * (64.0 / colour.min_saturation);
  const auto lx = static_cast<float>(low.x()), ly = static_cast<float>(low.y());
  const auto hx = static_cast<float>(high.x()), hy = static_cast<float>(high.y());
  const auto kx = static_cast<float>(chord.x()), ky = static_cast<float>(chord.y());
  heights.create(image.cb().size(), CV_8UC1);
  for (int y = 0; y < heights.rows; ++y) {
    const auto* cb = image.cb().ptr<std::uint8_t>(y);
    const auto* cr = image.cr().ptr<std::uint8_t>(y);
    auto* out = heights.ptr<std::uint8_t>(y);
    for (int x = 0; x < heights.cols; ++x) {
      const float b = cb[x] - 128.0f, r = cr[x] - 128.0f;
      const bool inside = (lx * r - ly * b >= 0) & (b * hy - r * hx >= 0);
      const float height = std::min(255.0f, std::max(0.0f, b * ky - r * kx));
      out[x] = static_cast<std::uint8_t>(inside ? static_cast<int>(height) : 0);
    }
  }
}

}  // namespace marey::detect::markers
