// SVG images, element by element: pugixml keeps them well-formed whatever their texts are.
#pragma once

#include <initializer_list>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <variant>

#include <pugixml.hpp>

#include "marey/core/geometry.h"

namespace marey::draw {

/// The least of 1, 2 and 5 times a power of ten that is `least` or more: a round step of an axis.
double round_step(double minimum);

/// A text, or a number that is written with as many decimals as its image has, without zeros at its end.
struct SvgAttribute {
  SvgAttribute(const char* attribute, double number) : name(attribute), value(number) {}
  SvgAttribute(const char* attribute, std::string text) : name(attribute), value(std::move(text)) {}

  const char* name;
  std::variant<double, std::string> value;
};

/// An element of an image, which its Svg holds. What is added to it is drawn over what was added before. Texts become plain
/// (files/text_safety.h).
class SvgElement {
 public:
  using Attributes = std::initializer_list<SvgAttribute>;

  void set(Attributes attributes);

  SvgElement add(const char* name, Attributes attributes, std::string_view text = {}, Attributes more = {});
  SvgElement rect(const Box& box, Attributes attributes);
  SvgElement line(const Vector<2>& from, const Vector<2>& to, Attributes attributes);
  SvgElement circle(const Vector<2>& centre, double radius, Attributes attributes);
  SvgElement polyline(std::span<const Vector<2>> points, Attributes attributes);  ///< without filling
  SvgElement polygon(std::span<const Vector<2>> points, Attributes attributes);
  SvgElement text(const Vector<2>& at, std::string_view text, Attributes attributes = {});

 protected:
  SvgElement(pugi::xml_node node, int decimals) : node_(node), decimals_(decimals) {}
  std::string points_text(std::span<const Vector<2>> points) const;

  pugi::xml_node node_;
  int decimals_;
};

/// An image.
class Svg : public SvgElement {
 public:
  explicit Svg(Attributes attributes, int decimals = 1);
  Svg(const Svg&) = delete;
  /// A sheet of white paper.
  Svg(double width, double height, double font_size, int decimals = 1);

  /// An element a line, without a declaration: a file of its own, or a part of an HTML page.
  std::string str() const;

 private:
  pugi::xml_document document_;
};

}  // namespace marey::draw
