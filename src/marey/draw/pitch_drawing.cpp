#include "marey/draw/pitch_drawing.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>

#include <fmt/format.h>

#include "marey/draw/canvas.h"
#include "marey/draw/svg_text.h"

namespace marey::draw {
namespace {

constexpr Colour kModel{230, 40, 40}, kModelPaint{250, 220, 40}, kFits{60, 220, 90}, kMisfit{255, 90, 0};

cv::Point2f point(const Vector<2>& p) {
  return {static_cast<float>(p.x()), static_cast<float>(p.y())};
}

bool in_picture(const Vector<2>& pixel, cv::Size size) {
  return cv::Rect2d({-0.5, -0.5}, cv::Size2d(size)).contains({pixel.x(), pixel.y()});
}

/// What a cell of the map is worth, from good to bad.
struct Shade {
  double metres;
  const char* colour;
};
constexpr std::array<Shade, 6> kShades{
    {{0.03, "#1a9850"}, {0.06, "#91cf60"}, {0.12, "#d9ef8b"}, {0.25, "#fee08b"}, {0.5, "#fc8d59"}, {1e9, "#d73027"}}};

const char* shade_of(double metres) {
  return std::find_if(kShades.begin(), kShades.end(), [&](const Shade& shade) { return metres <= shade.metres; })->colour;
}

}  // namespace

Picture draw_pitch(const Picture& picture, const GroundView& view, const std::vector<geometry::PitchLine>& lines,
                   const std::vector<Vector<2>>& paint, const std::vector<DrawnClick>& clicks) {
  Canvas canvas(picture);
  const double unit = std::max(1.0, picture.size().width / 1500.0);
  std::vector<Canvas::Stroke> strokes;
  for (const geometry::PitchLine& line : lines) {
    std::optional<Vector<2>> last;
    for (const Vector<2>& place : line.points) {
      auto here = view.pixel(place);
      if (here && !in_picture(*here, view.size())) here.reset();
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

std::string pitch_map_svg(const std::string& title, const geometry::PitchSize& size,
                          const std::function<std::optional<double>(const Vector<2>&)>& metres) {
  constexpr double cell = 1, scale = 8, margin = 24, top = 40, bottom = 50;
  std::string text;
  const auto add = [&]<typename... Args>(fmt::format_string<Args...> format, Args&&... args) {
    fmt::format_to(std::back_inserter(text), format, std::forward<Args>(args)...);
    text += '\n';
  };
  const double width = scale * size.length + 2 * margin, height = scale * size.width + top + bottom;
  add(R"(<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 {:.0f} {:.0f}" font-family="sans-serif" font-size="13">)", width,
      height);
  add(R"(<rect width="100%" height="100%" fill="white"/>)");
  add(R"(<text x="{}" y="24" font-size="16" font-weight="bold">{}</text>)", margin, escaped(title));
  add(R"svg(<g transform="translate({},{}) scale({})">)svg", margin, top, scale);
  for (double y = 0; y < size.width; y += cell) {
    for (double x = 0; x < size.length; x += cell) {
      const auto worth = metres({x + cell / 2, y + cell / 2});
      add(R"(<rect x="{:g}" y="{:g}" width="{:g}" height="{:g}" fill="{}"/>)", x, y, cell * 1.02, cell * 1.02,
          worth ? shade_of(*worth) : "#dddddd");
    }
  }
  for (const geometry::PitchLine& line : geometry::pitch_lines(size, 0.1)) {
    text += R"(<polyline fill="none" stroke="black" stroke-width="0.15" points=")";
    for (const Vector<2>& place : line.points) fmt::format_to(std::back_inserter(text), "{:.2f},{:.2f} ", place.x(), place.y());
    text += "\"/>\n";
  }
  add("</g>");
  double x = margin;
  const double y = height - 30;
  for (std::size_t i = 0; i < kShades.size(); ++i) {
    add(R"(<rect x="{}" y="{}" width="16" height="16" fill="{}"/>)", x, y, kShades[i].colour);
    add(R"(<text x="{}" y="{}">{}</text>)", x + 22, y + 13,
        i + 1 < kShades.size() ? fmt::format("up to {:g} m", kShades[i].metres) : std::string("more"));
    x += 112;
  }
  add(R"(<rect x="{}" y="{}" width="16" height="16" fill="#dddddd"/><text x="{}" y="{}">not in view</text>)", x, y, x + 22, y + 13);
  add("</svg>");
  return text;
}

}  // namespace marey::draw
