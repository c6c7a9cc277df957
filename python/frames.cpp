#include <algorithm>
#include <cstring>
#include <limits>
#include <utility>

#include <opencv2/imgproc.hpp>

#include "bindings.h"

namespace marey::python {
namespace {

using Pixels = nb::ndarray<const std::uint8_t, nb::c_contig, nb::device::cpu>;

/// A copy: Python may write into its array again as soon as it is asked for the next one.
Image image_of(const Pixels& pixels) {
  const cv::Size size(static_cast<int>(pixels.shape(1)), static_cast<int>(pixels.shape(0)));
  auto* data = const_cast<std::uint8_t*>(pixels.data());
  if (pixels.ndim() == 2) return Image(cv::Mat(size, CV_8UC1, data).clone());
  return Image::from_bgr(cv::Mat(size, CV_8UC3, data));
}

/// An array that owns its pixels.
nb::object array_of(const cv::Mat& image) {
  auto* copy = new cv::Mat(image.clone());
  const nb::capsule owner(copy, [](void* mat) noexcept { delete static_cast<cv::Mat*>(mat); });
  const auto rows = static_cast<std::size_t>(copy->rows), columns = static_cast<std::size_t>(copy->cols);
  return nb::cast(nb::ndarray<nb::numpy, std::uint8_t>(copy->data, {rows, columns, 3}, owner));
}

class FrameSource final : public Source {
 public:
  explicit FrameSource(std::shared_ptr<Held> frames) : frames_(std::move(frames)) {
    const nb::gil_scoped_acquire gil;
    const nb::handle object = frames_->get();
    info_.name = nb::cast<std::string>(object.attr("name"));
    info_.rate_hz = nb::cast<double>(object.attr("rate"));
    if (!object.attr("count").is_none()) info_.frame_count = nb::cast<std::int64_t>(object.attr("count"));
    const auto [height, width] = nb::cast<std::pair<int, int>>(object.attr("size"));
    info_.size = {width, height};
    opened_ = std::make_shared<Held>(object.attr("open")());
  }

  const SourceInfo& info() const override { return info_; }

  std::optional<Frame> next() override {
    const nb::gil_scoped_acquire gil;
    const nb::object given = opened_->get().attr("next")();
    if (given.is_none()) return std::nullopt;
    Frame frame;
    frame.index = next_++;
    frame.time = given[0].is_none() ? timestamp_from_seconds(static_cast<double>(frame.index) / *info_.rate_hz)
                                    : timestamp_from_seconds(nb::cast<double>(given[0]));
    frame.image = image_of(nb::cast<Pixels>(given[1]));
    return frame;
  }

 private:
  std::shared_ptr<Held> frames_, opened_;
  SourceInfo info_;
  std::int64_t next_ = 0;
};

class FunctionDetector final : public detect::Detector {
 public:
  explicit FunctionDetector(std::shared_ptr<Held> function) : function_(std::move(function)) {}

  detect::Detections detect(const Frame& frame, std::span<const Expected>) override {
    const cv::Mat bgr = frame.image.bgr();
    const nb::gil_scoped_acquire gil;
    const auto rows = nb::cast<nb::ndarray<const double, nb::shape<-1, 5>, nb::c_contig>>(function_->get()(array_of(bgr)));
    detect::Detections found;
    for (std::size_t i = 0; i < rows.shape(0); ++i) {
      const double* row = rows.data() + 5 * i;
      Detection& one = found.detections.emplace_back();
      one.box = {row[0], row[1], row[2] - row[0], row[3] - row[1]};
      one.centre = one.box.centre();
      one.area = one.box.width * one.box.height;
      one.score = row[4];
    }
    return found;
  }

 private:
  std::shared_ptr<Held> function_;
};

nb::dict dict_of(const RecordingHeader& header) {
  nb::dict dict;
  dict["name"] = header.name;
  dict["dimensions"] = header.frame.dimensions();
  dict["frame"] = to_string(header.frame);
  dict["rate_hz"] = header.rate_hz;
  return dict;
}

class ObjectSink final : public Sink {
 public:
  ObjectSink(std::shared_ptr<Held> object, bool images) : object_(std::move(object)), images_(images) {
    const nb::gil_scoped_acquire gil;
    name_ = nb::cast<std::string>(nb::repr(object_->get()));
  }

  std::string name() const override { return name_; }
  SinkRequirements begin(const RecordingHeader& header) override {
    dimensions_ = header.frame.dimensions();
    const nb::gil_scoped_acquire gil;
    object_->get().attr("begin")(dict_of(header));
    return {.images = images_};
  }
  void write(const Instant& instant) override {
    const nb::gil_scoped_acquire gil;
    object_->get().attr("write")(tuple_of(instant, dimensions_, images_));
  }
  void finish() override {
    const nb::gil_scoped_acquire gil;
    object_->get().attr("finish")();
  }

 private:
  std::shared_ptr<Held> object_;
  bool images_;
  std::string name_;
  int dimensions_ = 2;
};

/// A new array of this many rows, of `width` numbers each (1: one dimension).
template <typename T>
std::pair<nb::object, T*> new_array(std::size_t rows, std::size_t width) {
  auto* data = new T[std::max<std::size_t>(rows * width, 1)];
  const nb::capsule owner(data, [](void* numbers) noexcept { delete[] static_cast<T*>(numbers); });
  if (width == 1) return {nb::cast(nb::ndarray<nb::numpy, T>(data, {rows}, owner)), data};
  return {nb::cast(nb::ndarray<nb::numpy, T>(data, {rows, width}, owner)), data};
}

}  // namespace

std::unique_ptr<Source> open_frames(std::shared_ptr<Held> frames) {
  return std::make_unique<FrameSource>(std::move(frames));
}

std::unique_ptr<detect::Detector> detector_of(std::shared_ptr<Held> function) {
  return std::make_unique<FunctionDetector>(std::move(function));
}

std::unique_ptr<Sink> sink_of(std::shared_ptr<Held> object, bool images) {
  return std::make_unique<ObjectSink>(std::move(object), images);
}

nb::tuple tuple_of(const Instant& instant, int dimensions, bool images) {
  constexpr double none = std::numeric_limits<double>::quiet_NaN();
  const std::size_t rows = instant.samples.size();
  const auto width = static_cast<std::size_t>(dimensions);
  const auto [ids, id] = new_array<std::int32_t>(rows, 1);
  const auto [positions, position] = new_array<double>(rows, width);
  const auto [provenances, provenance] = new_array<std::uint8_t>(rows, 1);
  const auto [scores, score] = new_array<double>(rows, 1);
  const auto [boxes, box] = new_array<double>(rows, 4);
  for (std::size_t i = 0; i < rows; ++i) {
    const Sample& sample = instant.samples[i];
    id[i] = number(sample.track);
    for (std::size_t axis = 0; axis < width; ++axis) position[i * width + axis] = sample.position[static_cast<Eigen::Index>(axis)];
    provenance[i] = static_cast<std::uint8_t>(sample.provenance);
    score[i] = sample.score.value_or(none);
    const Box at = sample.box.value_or(Box{none, none, none, none});
    box[4 * i] = at.left, box[4 * i + 1] = at.top, box[4 * i + 2] = at.left + at.width, box[4 * i + 3] = at.top + at.height;
  }
  nb::list named, frames;
  for (const TrackName& name : instant.named) named.append(nb::make_tuple(number(name.id), name.label, name.team));
  if (images) {
    for (const Frame& frame : instant.frames) frames.append(array_of(frame.image.bgr()));
  }
  return nb::make_tuple(instant.index, seconds(instant.time), ids, positions, provenances, scores, boxes, named, frames);
}

}  // namespace marey::python
