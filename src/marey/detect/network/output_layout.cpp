#include "marey/detect/network/output_layout.h"

#include <algorithm>
#include <array>
#include <cmath>

#include <fmt/format.h>

#include "marey/core/error.h"

namespace marey::detect::network {
namespace {

constexpr std::array<std::string_view, 9> kLayoutNames = {"ssd_raw",    "ssd",     "yolov5",  "yolox",  "yolov8",
                                                          "suppressed", "nanodet", "rt_detr", "rf_detr"};
constexpr int kMaxQueries = 1000;  // candidates of a network of the DETR kind
constexpr int kDistances = 8;      // of nanodet's distributions

/// A tensor as rows and columns, the batch of one omitted.
struct Table {
  int rows = 0, columns = 0;
  const float* values = nullptr;
  float at(int row, int column) const {
    return values[static_cast<std::size_t>(row) * static_cast<std::size_t>(columns) + static_cast<std::size_t>(column)];
  }
};

Table table_of(const Tensor& tensor) {
  std::vector<int> shape = tensor.shape;
  if (shape.size() > 1 && shape.front() == 1) shape.erase(shape.begin());
  while (shape.size() > 2) {
    const auto one = std::find(shape.begin(), shape.end() - 1, 1);
    if (one == shape.end() - 1) break;
    shape.erase(one);
  }
  if (shape.size() == 1) shape.push_back(1);
  if (shape.size() != 2) return {};
  if (static_cast<std::size_t>(shape[0]) * static_cast<std::size_t>(shape[1]) != tensor.values.size()) return {};
  return {shape[0], shape[1], tensor.values.data()};
}

int cells(cv::Size input, std::initializer_list<int> strides) {
  int count = 0;
  for (const int stride : strides) count += ((input.width + stride - 1) / stride) * ((input.height + stride - 1) / stride);
  return count;
}

double logistic(double x) {
  return 1 / (1 + std::exp(-x));
}

Candidate centred(double x, double y, double width, double height, double score) {
  return {x - width / 2, y - height / 2, x + width / 2, y + height / 2, score};
}

/// Of several outputs with one number a candidate, the one whose name holds `word`, else the one at `place` among them.
std::size_t named_or_nth(std::span<const Tensor> outputs, const std::vector<std::size_t>& lists, std::string_view word,
                         std::size_t location) {
  for (const std::size_t i : lists) {
    if (outputs[i].name.find(word) != std::string::npos) return i;
  }
  return lists[location];
}

[[noreturn]] void contradicts_layout(std::span<const Tensor> outputs, Layout layout) {
  std::string shapes;
  for (const Tensor& output : outputs) shapes += fmt::format("{}{}", shapes.empty() ? "" : ", ", fmt::join(output.shape, "x"));
  throw Error("the network's outputs ({}) are not of the layout {}", shapes, layout_name(layout));
}

/// Boxes, and beside them two lists of numbers: classes and scores.
struct Listed {
  Table boxes, classes, scores;
  int count = 0;
};

std::optional<Listed> listed(std::span<const Tensor> outputs) {
  std::optional<std::size_t> boxes;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (const Table table = table_of(outputs[i]); table.columns == 4 && table.rows > 0 && !boxes) boxes = i;
  }
  if (!boxes) return std::nullopt;
  const Table corners = table_of(outputs[*boxes]);
  const auto total = static_cast<std::size_t>(corners.rows);
  std::vector<std::size_t> lists;
  int count = corners.rows;
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    if (i == *boxes) continue;
    if (outputs[i].values.size() == total) {
      lists.push_back(i);
    } else if (outputs[i].values.size() == 1) {
      count = std::clamp(static_cast<int>(std::lround(outputs[i].values[0])), 0, corners.rows);
    } else {
      return std::nullopt;
    }
  }
  if (lists.size() != 2) return std::nullopt;
  const std::size_t scores = named_or_nth(outputs, lists, "score", 1);
  const std::size_t classes = lists[0] == scores ? lists[1] : lists[0];
  const auto column = [&](std::size_t i) { return Table{static_cast<int>(total), 1, outputs[i].values.data()}; };
  return Listed{corners, column(classes), column(scores), count};
}

/// Boxes, and beside them a table of a number for each class.
struct Scored {
  Table boxes, logits;
};

std::optional<Scored> scored(std::span<const Tensor> outputs) {
  if (outputs.size() != 2) return std::nullopt;
  for (const bool first : {true, false}) {
    const Table boxes = table_of(outputs[first ? 0 : 1]), logits = table_of(outputs[first ? 1 : 0]);
    if (boxes.columns == 4 && boxes.rows > 0 && logits.rows == boxes.rows) return Scored{boxes, logits};
  }
  return std::nullopt;
}

// --- Each layout's candidates ---------------------------------------------------------------------------------------------

struct Anchor {
  double y, x, height, width;  // shares
};

/// TensorFlow's six layers: scales evenly from 0.2 to 0.95, ratios 1, 2, 1/2, 3, 1/3 and one scale between; three in the lowest.
std::vector<Anchor> ssd_anchors(cv::Size input) {
  std::vector<Anchor> anchors;
  cv::Size cells((input.width + 15) / 16, (input.height + 15) / 16);
  for (int layer = 0; layer < 6; ++layer) {
    const double scale = 0.2 + 0.75 * layer / 5, next = layer == 5 ? 1.0 : 0.2 + 0.75 * (layer + 1) / 5;
    std::vector<std::pair<double, double>> shapes = {{scale, 1}, {scale, 2},       {scale, 0.5},
                                                     {scale, 3}, {scale, 1 / 3.0}, {std::sqrt(scale * next), 1}};
    if (layer == 0) shapes = {{0.1, 1}, {scale, 2}, {scale, 0.5}};
    for (int y = 0; y < cells.height; ++y) {
      for (int x = 0; x < cells.width; ++x) {
        for (const auto& [size, ratio] : shapes)
          anchors.push_back({(y + 0.5) / cells.height, (x + 0.5) / cells.width, size / std::sqrt(ratio), size * std::sqrt(ratio)});
      }
    }
    cells = {(cells.width + 1) / 2, (cells.height + 1) / 2};
  }
  return anchors;
}

std::vector<Candidate> of_ssd_raw(const Scored& raw, cv::Size input, int required, double minimum) {
  const std::vector<Anchor> anchors = ssd_anchors(input);
  if (static_cast<int>(anchors.size()) != raw.boxes.rows || required >= raw.logits.columns)
    throw Error("the network has {} candidates of {} classes; SSD over {}x{} px has {}, and class {} is wanted", raw.boxes.rows,
                raw.logits.columns, input.width, input.height, anchors.size(), required);
  std::vector<Candidate> found;
  for (int i = 0; i < raw.boxes.rows; ++i) {
    const double score = logistic(raw.logits.at(i, required));
    if (score < minimum) continue;
    const Anchor& anchor = anchors[static_cast<std::size_t>(i)];
    const double y = anchor.y + raw.boxes.at(i, 0) / 10 * anchor.height, x = anchor.x + raw.boxes.at(i, 1) / 10 * anchor.width;
    const double height = anchor.height * std::exp(raw.boxes.at(i, 2) / 5.0),
                 width = anchor.width * std::exp(raw.boxes.at(i, 3) / 5.0);
    found.push_back(centred(x * input.width, y * input.height, width * input.width, height * input.height, score));
  }
  return found;
}

std::vector<Candidate> of_ssd(std::span<const Tensor> outputs, cv::Size input, int required, double minimum) {
  std::vector<Candidate> found;
  const double w = input.width, h = input.height;
  if (outputs.size() == 1) {
    const Table table = table_of(outputs[0]);
    if (table.columns != 7) contradicts_layout(outputs, Layout::ssd);
    for (int i = 0; i < table.rows; ++i) {
      if (std::lround(table.at(i, 1)) != required || table.at(i, 2) < minimum) continue;
      found.push_back({table.at(i, 3) * w, table.at(i, 4) * h, table.at(i, 5) * w, table.at(i, 6) * h, table.at(i, 2)});
    }
    return found;
  }
  const auto lists = listed(outputs);
  if (!lists) contradicts_layout(outputs, Layout::ssd);
  for (int i = 0; i < lists->count; ++i) {
    if (std::lround(lists->classes.at(i, 0)) != required || lists->scores.at(i, 0) < minimum) continue;
    const Table& b = lists->boxes;
    found.push_back({b.at(i, 1) * w, b.at(i, 0) * h, b.at(i, 3) * w, b.at(i, 2) * h, lists->scores.at(i, 0)});
  }
  return found;
}

std::vector<Candidate> of_yolov5(const Table& table, int required, double minimum) {
  std::vector<Candidate> found;
  for (int i = 0; i < table.rows; ++i) {
    const double score = table.at(i, 4) * table.at(i, 5 + required);
    if (score >= minimum) found.push_back(centred(table.at(i, 0), table.at(i, 1), table.at(i, 2), table.at(i, 3), score));
  }
  return found;
}

std::vector<Candidate> of_yolox(const Table& table, cv::Size input, int required, double minimum) {
  std::vector<Candidate> found;
  int i = 0;
  for (const int stride : {8, 16, 32}) {
    for (int y = 0; y < (input.height + stride - 1) / stride; ++y) {
      for (int x = 0; x < (input.width + stride - 1) / stride; ++x, ++i) {
        const double score = table.at(i, 4) * table.at(i, 5 + required);
        if (score < minimum) continue;
        found.push_back(centred((table.at(i, 0) + x) * stride, (table.at(i, 1) + y) * stride, std::exp(table.at(i, 2)) * stride,
                                std::exp(table.at(i, 3)) * stride, score));
      }
    }
  }
  return found;
}

std::vector<Candidate> of_yolov8(const Table& table, int required, double minimum) {
  std::vector<Candidate> found;
  for (int i = 0; i < table.columns; ++i) {
    const double score = table.at(4 + required, i);
    if (score >= minimum) found.push_back(centred(table.at(0, i), table.at(1, i), table.at(2, i), table.at(3, i), score));
  }
  return found;
}

std::vector<Candidate> of_suppressed(const Table& table, int required, double minimum) {
  std::vector<Candidate> found;
  for (int i = 0; i < table.rows; ++i) {
    if (std::lround(table.at(i, 5)) != required || table.at(i, 4) < minimum) continue;
    found.push_back({table.at(i, 0), table.at(i, 1), table.at(i, 2), table.at(i, 3), table.at(i, 4)});
  }
  return found;
}

/// The mean of a distribution over 0 … 7 that is given by logits.
double expected_distance(const Table& table, int row, int column) {
  double sum = 0, mean = 0;
  for (int k = 0; k < kDistances; ++k) {
    const double weight = std::exp(table.at(row, column + k));
    sum += weight, mean += k * weight;
  }
  return mean / sum;
}

std::vector<Candidate> of_nanodet(const Table& table, cv::Size input, int required, double minimum) {
  const int classes = table.columns - 4 * kDistances;
  std::vector<Candidate> found;
  int i = 0;
  for (const int stride : {8, 16, 32, 64}) {
    for (int y = 0; y < (input.height + stride - 1) / stride; ++y) {
      for (int x = 0; x < (input.width + stride - 1) / stride; ++x, ++i) {
        if (table.at(i, required) < minimum) continue;
        const auto side = [&](int which) { return stride * expected_distance(table, i, classes + which * kDistances); };
        const double cx = x * stride, cy = y * stride;
        found.push_back({cx - side(0), cy - side(1), cx + side(2), cy + side(3), table.at(i, required)});
      }
    }
  }
  return found;
}

std::vector<Candidate> of_rt_detr(const Listed& lists, int required, double minimum) {
  std::vector<Candidate> found;
  for (int i = 0; i < lists.count; ++i) {
    if (std::lround(lists.classes.at(i, 0)) != required || lists.scores.at(i, 0) < minimum) continue;
    const Table& b = lists.boxes;
    found.push_back({b.at(i, 0), b.at(i, 1), b.at(i, 2), b.at(i, 3), lists.scores.at(i, 0)});
  }
  return found;
}

std::vector<Candidate> of_rf_detr(const Scored& raw, cv::Size input, int required, double minimum) {
  std::vector<Candidate> found;
  for (int i = 0; i < raw.boxes.rows; ++i) {
    const double score = logistic(raw.logits.at(i, required));
    if (score < minimum) continue;
    found.push_back(centred(raw.boxes.at(i, 0) * input.width, raw.boxes.at(i, 1) * input.height, raw.boxes.at(i, 2) * input.width,
                            raw.boxes.at(i, 3) * input.height, score));
  }
  return found;
}

/// Whether a table has a column (or row) for the class, and as many candidates as its layout has over such an image.
bool holds_class(const Table& table, Layout layout, cv::Size input, int required) {
  if (required < 0) return false;
  switch (layout) {
    case Layout::yolov5:
      return table.columns > 5 + required;
    case Layout::yolox:
      return table.columns > 5 + required && table.rows == cells(input, {8, 16, 32});
    case Layout::yolov8:
      return table.rows > 4 + required;
    case Layout::suppressed:
      return table.columns == 6;
    case Layout::nanodet:
      return table.columns > 4 * kDistances + required && table.rows == cells(input, {8, 16, 32, 64});
    default:
      return false;
  }
}

}  // namespace

std::string_view layout_name(Layout layout) {
  return kLayoutNames[static_cast<std::size_t>(layout)];
}

std::optional<Layout> layout_named(std::string_view name) {
  const auto found = std::find(kLayoutNames.begin(), kLayoutNames.end(), name);
  if (found == kLayoutNames.end()) return std::nullopt;
  return static_cast<Layout>(found - kLayoutNames.begin());
}

std::string layout_names() {
  return fmt::format("{}", fmt::join(kLayoutNames, ", "));
}

std::optional<Layout> layout_of(std::span<const Tensor> outputs, cv::Size input) {
  if (const auto raw = scored(outputs)) return raw->boxes.rows <= kMaxQueries ? Layout::rf_detr : Layout::ssd_raw;
  if (const auto lists = listed(outputs)) return outputs.size() == 4 ? Layout::ssd : Layout::rt_detr;
  if (outputs.size() != 1) return std::nullopt;
  const Table table = table_of(outputs[0]);
  const int typical = cells(input, {8, 16, 32});
  if (table.columns == 7 && outputs[0].shape.size() == 4) return Layout::ssd;
  if (table.rows == 3 * typical && table.columns > 5) return Layout::yolov5;
  if (table.rows == typical && table.columns > 5) return Layout::yolox;
  if (table.rows == cells(input, {8, 16, 32, 64}) && table.columns > 4 * kDistances) return Layout::nanodet;
  if (table.columns == typical && table.rows > 4) return Layout::yolov8;
  if (table.columns == 6 && table.rows <= kMaxQueries) return Layout::suppressed;
  return std::nullopt;
}

std::vector<Candidate> candidates_of(std::span<const Tensor> outputs, Layout layout, cv::Size input, int required, double minimum) {
  if (layout == Layout::ssd) return of_ssd(outputs, input, required, minimum);
  if (layout == Layout::rt_detr) {
    const auto lists = listed(outputs);
    if (!lists) contradicts_layout(outputs, layout);
    return of_rt_detr(*lists, required, minimum);
  }
  if (layout == Layout::ssd_raw || layout == Layout::rf_detr) {
    const auto raw = scored(outputs);
    if (!raw || required < 0 || required >= raw->logits.columns) contradicts_layout(outputs, layout);
    return layout == Layout::ssd_raw ? of_ssd_raw(*raw, input, required, minimum) : of_rf_detr(*raw, input, required, minimum);
  }
  const Table table = outputs.size() == 1 ? table_of(outputs[0]) : Table{};
  if (!holds_class(table, layout, input, required)) contradicts_layout(outputs, layout);
  switch (layout) {
    case Layout::yolov5:
      return of_yolov5(table, required, minimum);
    case Layout::yolox:
      return of_yolox(table, input, required, minimum);
    case Layout::yolov8:
      return of_yolov8(table, required, minimum);
    case Layout::nanodet:
      return of_nanodet(table, input, required, minimum);
    default:
      return of_suppressed(table, required, minimum);
  }
}

}  // namespace marey::detect::network
