#pragma once

#include <string>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/appearance.h"
#include "marey/core/image.h"

namespace marey::draw {

struct Colour {
  unsigned char red = 0, green = 0, blue = 0;
};

/// A colour that belongs to this number: neighbours differ, and it is the same in every run.
Colour colour_of(int number);
/// The colour of an appearance.
Colour colour_of(const Appearance& appearance);

/// Grey of 16 bits brought so that `white` becomes the lightest there is; other images as they are.
Image with_white(const Image& image, double white);
/// The largest luma of an image.
double lightest(const Image& image);

/// An image of one's own to paint on, in the planes that video is made of: nothing is converted to RGB and back. Coordinates
/// are pixels; what lies outside is cut off. Full-range images are brought to video's range on input.
class Canvas {
 public:
  explicit Canvas(const Image& image);

  struct Stroke {
    cv::Point2f from, to;
    double opacity = 1;
  };
  /// Strokes of one colour, one after the other, blended as one: where they meet nothing is darker.
  void strokes(const std::vector<Stroke>& strokes, const Colour& colour, double thickness);
  /// Filled discs of one colour.
  void discs(const std::vector<cv::Point2f>& centres, double radius, const Colour& colour, double opacity = 1);
  void rectangle(const cv::Rect2f& where, const Colour& colour, double thickness, double opacity = 1);
  /// An ellipse round this part in a few cells, which nothing can undo; the corners of `where` are in it.
  void coarsen(const cv::Rect2f& where);
  void fill(const cv::Rect2f& where, const Colour& colour);
  /// Text with its middle at `centre`.
  void text(const std::string& text, cv::Point2f centre, const Colour& colour, double text_height);
  /// What `tag` would cover.
  cv::Rect tag_area(const std::string& text, cv::Point2f corner, double text_height) const;
  /// Text on a filled tag whose bottom left corner is at `corner`; moved so that the whole tag is within the image.
  void tag(const std::string& text, cv::Point2f corner, const Colour& colour, double text_height);

  /// The image as painted so far; colour, limited range. The canvas may not be used afterwards.
  Image take();

 private:
  /// Lays `colour` over the image where `stencil`, whose top left pixel lies at `at` (even), is above 0 (255 hides the image).
  void lay(const cv::Mat& stencil, cv::Point at, const Colour& colour);
  /// An empty stencil, with even corners, that covers `where` as far as it is within the image.
  cv::Rect even_part(const cv::Rect2f& where, double margin) const;

  cv::Mat luma_, cb_, cr_;
};

}  // namespace marey::draw
