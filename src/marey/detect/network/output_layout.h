// What a detection network's outputs mean, inferred from their shapes.
//
// Published detectors end in one of nine layouts (N candidates, C classes):
//   ssd_raw    N×4 (dy, dx, ln dh, ln dw against anchors) and N×C logits: SSD-MobileNet before its post-processing
//   ssd        N×4 (top, left, bottom, right as shares), N classes, N scores, a count; or 1×1×N×7 (image, class, score, box as
//   shares) yolov5     N×(5+C): centre, size, objectness, classes; three anchors a cell of the strides 8, 16, 32 yolox      the
//   same with one candidate a cell, place in cells and size as a logarithm yolov8     (4+C)×N: centre, size, classes; YOLOv8, v9,
//   v11, v12 suppressed N×6: corners, score, class, suppressed inside the network: YOLOv10 and others nanodet    N×(C+32): classes,
//   then four sides as distributions over eight distances; strides 8, 16, 32, 64 rt_detr    N labels, N×4 corners, N scores:
//   RT-DETR, D-FINE rf_detr    N×4 centre and size as shares, N×C logits, at most a thousand candidates: RF-DETR, DETR
#pragma once

#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

#include <opencv2/core/types.hpp>

#include "marey/core/geometry.h"

namespace marey::detect::network {

enum class Layout { ssd_raw, ssd, yolov5, yolox, yolov8, suppressed, nanodet, rt_detr, rf_detr };

std::string_view layout_name(Layout layout);
std::optional<Layout> layout_named(std::string_view name);
/// All of them with commas between.
std::string layout_names();

/// One output of a network: numbers row by row.
struct Tensor {
  std::string name;
  std::vector<int> shape;
  std::vector<float> values;
};

/// What shapes like these are, for a network that is given images of `input` px; nothing if they are of no layout above.
std::optional<Layout> layout_of(std::span<const Tensor> outputs, cv::Size input);

/// One candidate that is of the wanted class: its box in px of the network's input, edges counted from the image's edge.
struct Candidate {
  double left = 0, top = 0, right = 0, bottom = 0;
  double score = 0;  ///< in [0, 1]
};

/// The candidates of class `wanted` (from 0, or as the network counts in `ssd`) whose score reaches `least`, none suppressed but by
/// the network itself. Outputs must be of that layout: the one who calls asked `layout_of`, or a person said so. Throws Error if
/// their shapes contradict it.
std::vector<Candidate> candidates_of(std::span<const Tensor> outputs, Layout layout, cv::Size input, int required, double minimum);

}  // namespace marey::detect::network
