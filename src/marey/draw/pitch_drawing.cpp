#include "marey/draw/pitch_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <span>

#include <fmt/format.h>

#include "marey/draw/canvas.h"
#include "marey/draw/svg.h"

namespace marey::draw {
namespace {

constexpr Colour kModel{230, 40, 40}, kModelPaint{250, 220, 40}, kFits{60, 220, 90}, kMisfit{255, 90, 0};

cv::Point2f point(const Vector<2>& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y())};
}

bool in_image(const Vector<2>& pixel, cv::Size size) {
  return cv::Rect2d({-0.5, -0.5}, cv::Size2d(size)).contains({pixel.x(), pixel.y()});
}

/// What a cell of the map is worth, from good to bad.
struct Shade {
  double metres;
  const char* colour;
};
constexpr std::array<Shade, 6> kShades{
    {{0.03, "#1a9850"}, {0.06, "#91cf60"}, {0.12, "#d9ef8b"}, {0.25, "#fee08b"}, {0.5, "#fc8d59"}, {1e9, "#d73027"}}};

constexpr const char* kUnobserved = "#dddddd";

const char* shade_of(double metres) {
  return std::find_if(kShades.begin(), kShades.end(), [&](const Shade& shade) { return metres <= shade.metres; })->colour;
}

}  // namespace

Image draw_pitch(const Image& image, const GroundView& view, const std::vector<geometry::PitchLine>& lines,
                 const std::vector<Vector<2>>& paint, const std::vector<DrawnClick>& clicks) {
  Canvas canvas(image);
  const double unit = std::max(1.0, image.size().width / 1500.0);
  std::vector<Canvas::Stroke> strokes;
  for (const geometry::PitchLine& line : lines) {
    std::optional<Vector<2>> last;
    for (const Vector<2>& location : line.points) {
      auto here = view.pixel(location);
      if (here && !in_image(*here, view.size())) here.reset();
      if (last && here) strokes.push_back({point(*last), point(*here)});
      last = here;
    }
  }
  canvas.strokes(strokes, kModel, unit);
  strokes.clear();
  for (const Vector<2>& found : paint) strokes.push_back({point(found), point(found)});
  canvas.strokes(strokes, kModelPaint, 1.5 * unit);
  for (const DrawnClick& click : clicks) {
    const auto size = static_cast<float>(5 * unit);
    const cv::Point2f at = point(click.pixel);
    const Colour& colour = click.fits ? kFits : kMisfit;
    canvas.strokes({{at - cv::Point2f(size, 0), at + cv::Point2f(size, 0)}, {at - cv::Point2f(0, size), at + cv::Point2f(0, size)}},
                   colour, unit);
    if (!click.fits) canvas.tag(click.name, at + cv::Point2f(size, -size), colour, 10 * unit);
  }
  return canvas.take();
}

std::string pitch_map_svg(const std::string& title, const geometry::PitchSize& size, bool y_down,
                          const std::function<std::optional<double>(const Vector<2>&)>& metres) {
  constexpr double cell = 1, scale = 8, margin = 24, top = 40, bottom = 50;
  const double width = scale * size.length + 2 * margin, height = scale * size.width + top + bottom;
  Svg svg(width, height, 13, 2);
  svg.text({margin, 24}, title, {{"font-size", 16}, {"font-weight", "bold"}});
  const double origin = y_down ? top : top + scale * size.width;
  SvgElement map =
      svg.add("g", {{"transform", fmt::format("translate({},{}) scale({} {})", margin, origin, scale, y_down ? scale : -scale)}});
  for (double y = 0; y < size.width; y += cell) {
    for (double x = 0; x < size.length; x += cell) {
      const auto merit = metres({x + cell / 2, y + cell / 2});
      map.rect({x, y, cell * 1.02, cell * 1.02}, {{"fill", merit ? shade_of(*merit) : kUnobserved}});
    }
  }
  for (const geometry::PitchLine& line : geometry::pitch_lines(size, 0.1))
    map.polyline(line.points, {{"stroke", "black"}, {"stroke-width", 0.15}});
  Vector<2> corner(margin, height - 30);
  const auto add_key = [&](const char* colour, const std::string& meaning) {
    svg.rect({corner.x(), corner.y(), 16, 16}, {{"fill", colour}});
    svg.text(corner + Vector<2>(22, 13), meaning);
    corner.x() += 112;
  };
  for (const Shade& shade : std::span(kShades).first(kShades.size() - 1))
    add_key(shade.colour, fmt::format("up to {:g} m", shade.metres));
  add_key(kShades.back().colour, "more");
  add_key(kUnobserved, "not in view");
  return svg.str();
}

}  // namespace marey::draw
