#include "marey/draw/pitch_svg.h"

#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "marey/draw/canvas.h"

namespace marey::draw {
namespace {

constexpr double kPitchMargin = 3;  // m round the pitch
constexpr int kPitchDecimals = 2;   // of metres that are drawn
constexpr Colour kPageGrass{42, 93, 54};
constexpr double kMinContrast = 2.6;  // of luminances, as WCAG 2.2 counts them: black reaches it on this grass, and red stays red
constexpr float kColourless = 12;     // chroma below which a shirt is white, grey or black
constexpr float kWhite = 65, kBlack = 30;  // L* from which on a colourless shirt is one, in video
constexpr float kPureWhite = 98, kPureBlack = 0, kVivid = 1.3F;

std::string css_of(const Colour& colour) {
  return fmt::format("#{:02x}{:02x}{:02x}", colour.red, colour.green, colour.blue);
}

double luminance(const Colour& colour) {
  const auto linear = [](double channel) {
    const double value = channel / 255;
    return value <= 0.04045 ? value / 12.92 : std::pow((value + 0.055) / 1.055, 2.4);
  };
  return 0.2126 * linear(colour.red) + 0.7152 * linear(colour.green) + 0.0722 * linear(colour.blue);
}

double contrast_to_grass(const Colour& colour) {
  constexpr double glare = 0.05;
  const double one = luminance(colour) + glare, other = luminance(kPageGrass) + glare;
  return std::max(one, other) / std::min(one, other);
}

Box shown_part(const PitchFrame& frame) {
  const double top = frame.y_down ? frame.corner.y() : -frame.corner.y() - frame.size.width;
  return {frame.corner.x() - kPitchMargin, top - kPitchMargin, frame.size.length + 2 * kPitchMargin,
          frame.size.width + 2 * kPitchMargin};
}

std::string view_box_of(const Box& shown) {
  return fmt::format("{:.2f} {:.2f} {:.2f} {:.2f}", shown.left, shown.top, shown.width, shown.height);
}

}  // namespace

PitchSvg::PitchSvg(const PitchFrame& frame) : svg_({{"viewBox", view_box_of(shown_part(frame))}}, kPitchDecimals) {
  svg_.rect(shown_part(frame), {{"fill", css_of(kPageGrass)}, {"rx", 1.5}});
  field_ = svg_.add("g", {{"transform", frame.y_down ? "scale(1 1)" : "scale(1 -1)"}});
}

std::string PitchSvg::html() {
  field_->add("use", {{"href", "#lines"}});
  return svg_.str();
}

std::string PitchSvg::lines_html(const PitchFrame& frame) {
  constexpr double step = 0.1;  // m
  Svg svg({{"style", "position: absolute; width: 0; height: 0"}}, kPitchDecimals);
  SvgElement lines = svg.add("defs", {}).add("g", {{"id", "lines"}});
  for (geometry::PitchLine& line : geometry::pitch_lines(frame.size, step)) {
    for (Vector<2>& point : line.points) point += frame.corner;
    lines.polyline(line.points, {{"stroke", "#b9cdbf"}, {"stroke-width", 0.15}});
  }
  return svg.str();
}

std::string colour_on_grass(const Appearance& shirt) {
  Appearance shown = shirt;
  if (std::hypot(shirt.a, shirt.b) < kColourless) {
    shown.a = shown.b = 0;
    if (shirt.lightness > kWhite) shown.lightness = kPureWhite;
    if (shirt.lightness < kBlack) shown.lightness = kPureBlack;
  } else {
    shown.a *= kVivid;
    shown.b *= kVivid;
  }
  while (contrast_to_grass(colour_of(shown)) < kMinContrast && shown.lightness < kPureWhite) shown.lightness += 1;
  return css_of(colour_of(shown));
}

}  // namespace marey::draw
