// Where a camera may be aimed whose lines lie on a mask of paint: headings tried all over a range, coarse first.
//
// Of each heading the model's lines are laid over the mask: what lies near counts by its length in the image, what lies far counts
// against it. The lines are prepared once for a tripod, in arrays of floats. Cost: about a microsecond a heading.
#pragma once

#include <span>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/calibrate/ptz/paint_mask.h"
#include "marey/geometry/pitch.h"
#include "marey/geometry/tripod.h"

namespace marey::calibrate::ptz {

/// Samples of the model's lines, every `stride`th.
class LineSamples {
 public:
  LineSamples(std::span<const geometry::PitchLine> lines, std::size_t stride);

  /// How well a heading explains a mask: lines that are there by their length, shrunk px, others against it. `near` CV_32F.
  double score(const cv::Mat& near, const geometry::Tripod& tripod, const geometry::Heading& heading) const;

 private:
  std::vector<float> x_, y_;
  std::vector<unsigned char> begins_;  // whether a sample is the first of its line
};

struct HeadingCandidate {
  geometry::Heading heading;
  double score = 0;
};

/// Where headings are tried: pan, tilt, ln f.
struct HeadingRange {
  Vector<3> minimum = Vector<3>::Constant(9), maximum = Vector<3>::Constant(-9);
};

/// All that show some of the pitch.
HeadingRange headings_over_pitch(const geometry::Tripod& tripod, const geometry::PitchSize& pitch, double min_log_focal,
                                 double max_log_focal);

/// Evenly spread in the image, for a coarse search; `with_margin`: beyond the range by half an image.
std::vector<geometry::Heading> headings_in(const HeadingRange& range, double aspect, bool with_margin);

/// The same lines at the strides that the stages of a search take.
struct SearchLines {
  explicit SearchLines(std::span<const geometry::PitchLine> lines) : coarse(lines, 7), middle(lines, 5), fine(lines, 2) {}
  LineSamples coarse, middle, fine;
};

/// The best `count` of `headings` that differ, the best first: all of them coarsely, then finer about the best `starts`.
std::vector<HeadingCandidate> best_headings(const PaintMask& seen, const geometry::Tripod& tripod, const SearchLines& lines,
                                            const std::vector<geometry::Heading>& headings, std::size_t starts, std::size_t count);

/// By small steps to the top of the score.
HeadingCandidate climbed(const PaintMask& seen, const geometry::Tripod& tripod, const SearchLines& lines, HeadingCandidate at);

}  // namespace marey::calibrate::ptz
