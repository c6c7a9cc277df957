#include "marey/draw/svg.h"

#include <cmath>
#include <iterator>
#include <sstream>

#include <fmt/format.h>

#include "marey/files/text_safety.h"

namespace marey::draw {
namespace {

void append_number(std::string& text, double number, int decimals) {
  fmt::format_to(std::back_inserter(text), "{:.{}f}", number, decimals);
  if (decimals == 0) return;
  while (text.back() == '0') text.pop_back();
  if (text.back() == '.') text.pop_back();
}

}  // namespace

double round_step(double minimum) {
  const double power = std::pow(10, std::floor(std::log10(minimum))), ratio = minimum / power;
  return power * (ratio <= 1 ? 1 : ratio <= 2 ? 2 : ratio <= 5 ? 5 : 10);
}

void SvgElement::set(Attributes attributes) {
  for (const SvgAttribute& attribute : attributes) {
    std::string text;
    if (const double* number = std::get_if<double>(&attribute.value)) {
      append_number(text, *number, decimals_);
    } else {
      text = plain_text(std::get<std::string>(attribute.value));
    }
    node_.append_attribute(attribute.name).set_value(text.c_str());
  }
}

SvgElement SvgElement::add(const char* name, Attributes attributes, std::string_view text, Attributes more) {
  SvgElement element(node_.append_child(name), decimals_);
  element.set(attributes);
  element.set(more);
  if (!text.empty()) element.node_.text().set(plain_text(text).c_str());
  return element;
}

SvgElement SvgElement::rect(const Box& box, Attributes attributes) {
  return add("rect", {{"x", box.left}, {"y", box.top}, {"width", box.width}, {"height", box.height}}, {}, attributes);
}

SvgElement SvgElement::line(const Vector<2>& from, const Vector<2>& to, Attributes attributes) {
  return add("line", {{"x1", from.x()}, {"y1", from.y()}, {"x2", to.x()}, {"y2", to.y()}}, {}, attributes);
}

SvgElement SvgElement::circle(const Vector<2>& centre, double radius, Attributes attributes) {
  return add("circle", {{"cx", centre.x()}, {"cy", centre.y()}, {"r", radius}}, {}, attributes);
}

SvgElement SvgElement::polyline(std::span<const Vector<2>> points, Attributes attributes) {
  return add("polyline", {{"fill", "none"}, {"points", points_text(points)}}, {}, attributes);
}

SvgElement SvgElement::polygon(std::span<const Vector<2>> points, Attributes attributes) {
  return add("polygon", {{"points", points_text(points)}}, {}, attributes);
}

SvgElement SvgElement::text(const Vector<2>& at, std::string_view text, Attributes attributes) {
  return add("text", {{"x", at.x()}, {"y", at.y()}}, text, attributes);
}

std::string SvgElement::points_text(std::span<const Vector<2>> points) const {
  std::string text;
  for (const Vector<2>& point : points) {
    append_number(text, point.x(), decimals_);
    text += ',';
    append_number(text, point.y(), decimals_);
    text += ' ';
  }
  return text;
}

Svg::Svg(Attributes attributes, int decimals) : SvgElement({}, decimals) {
  node_ = document_.append_child("svg");
  set({{"xmlns", "http://www.w3.org/2000/svg"}});
  set(attributes);
}

Svg::Svg(double width, double height, double font_size, int decimals)
    : Svg({{"viewBox", fmt::format("0 0 {:.0f} {:.0f}", width, height)}, {"font-family", "sans-serif"}, {"font-size", font_size}},
          decimals) {
  add("rect", {{"width", "100%"}, {"height", "100%"}, {"fill", "white"}});
}

std::string Svg::str() const {
  std::ostringstream text;
  node_.print(text, "");
  return std::move(text).str();
}

}  // namespace marey::draw
