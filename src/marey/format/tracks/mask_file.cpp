#include "marey/format/tracks/mask_file.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <memory>
#include <optional>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/format/format.h"
#include "marey/format/match/ground_builder.h"
#include "marey/format/match/ground_file.h"
#include "marey/format/read_file.h"
#include "marey/format/tracks/coco_instances.h"
#include "marey/format/tracks/mots.h"
#include "marey/geometry/bspline.h"

namespace marey::format::tracks {
namespace {

std::vector<Vector<2>> polygon_of(const Outline& contour) {
  return geometry::ClosedSpline(contour.order, contour.control_points).polygon();
}

/// Lower in the image is nearer to the camera.
double bottom_of(const Sample& sample) {
  return sample.box ? sample.box->bottom() : sample.position.y();
}

template <MaskText text>
std::unique_ptr<Sink> create_masks(const std::string& path, const WritePlan&) {
  return std::make_unique<MaskFile>(path, text);
}

/// Masks as tracks in an image: their boxes.
match::GroundMatch tracks_of_masks(MaskTable table, const std::string& path, double rate_hz) {
  match::GroundMatch match;
  match.recording.header.frame.kind = FrameOfReference::Kind::image;
  match.recording.header.rate_hz = rate_hz;
  match::GroundBuilder builder(path);
  for (const LabelledMask& mask : table.masks) {
    const Box box = mask.mask.box();
    if (box.empty()) continue;
    builder.add(builder.person(std::to_string(mask.id), mask.id, {}, {}),
                {.frame = mask.frame, .time = mask.frame / rate_hz, .location = box.centre(), .box = box});
  }
  match.order = builder.finish(match.recording);
  match.warnings = std::move(table.warnings);
  match.warnings.push_back(path + ": of its masks the boxes are read");
  return match;
}

}  // namespace

std::vector<LabelledMask> visible_masks(const Instant& instant, int width, int height) {
  struct Target {
    const Sample* sample;
    RunMask whole;
  };
  std::vector<Target> targets;
  for (const Sample& sample : instant.samples) {
    if (sample.outline) targets.push_back({&sample, RunMask::of_polygon(polygon_of(*sample.outline), width, height)});
  }
  const auto hides = [](const Sample& front, const Sample& back) {
    const auto& behind = back.outline->behind;
    if (std::find(behind.begin(), behind.end(), front.track) != behind.end()) return true;
    const auto& reverse = front.outline->behind;
    if (std::find(reverse.begin(), reverse.end(), back.track) != reverse.end()) return false;
    const double a = bottom_of(front), b = bottom_of(back);
    return a != b ? a > b : number(front.track) < number(back.track);
  };
  std::vector<LabelledMask> masks;
  for (const Target& own : targets) {
    RunMask visible = own.whole;
    for (const Target& other : targets) {
      if (&other != &own && hides(*other.sample, *own.sample)) visible = without(visible, other.whole);
    }
    if (visible.area() == 0) continue;
    masks.push_back({static_cast<std::int32_t>(instant.index), number(own.sample->track), std::move(visible)});
  }
  return masks;
}

MaskFile::MaskFile(const std::string& path, MaskText format) : path_(path), file_(path), text_(format) {}

Sink::SinkRequirements MaskFile::begin(const RecordingHeader& header) {
  if (header.frame.metric())
    throw Error("{}: such a file has masks in an image, and these positions are {}", path_, to_string(header.frame));
  if (header.rig && !header.rig->cameras.empty() && header.rig->cameras.front().size) {
    width_ = header.rig->cameras.front().size->width;
    height_ = header.rig->cameras.front().size->height;
  }
  if (text_ == MaskText::coco) file_.write("{\"annotations\":[");
  return {.images = width_ == 0};
}

void MaskFile::write(const Instant& instant) {
  if (width_ == 0) {
    if (instant.frames.empty() || instant.frames.front().image.empty())
      throw Error("{}: the size of the image is not known, which masks need; write it while the video is tracked", path_);
    width_ = instant.frames.front().image.size().width;
    height_ = instant.frames.front().image.size().height;
  }
  lines_.clear();
  if (text_ == MaskText::mots) {
    for (const LabelledMask& mask : visible_masks(instant, width_, height_)) append_mots(lines_, mask);
  } else {
    append_coco(instant);
  }
  file_.write(lines_);
}

void MaskFile::append_coco(const Instant& instant) {
  frames_.push_back(instant.index);
  for (const Sample& sample : instant.samples) {
    if (!sample.outline) continue;
    const std::vector<Vector<2>> polygon = polygon_of(*sample.outline);
    auto out = std::back_inserter(lines_);
    Vector<2> low = polygon[0], high = polygon[0];
    fmt::format_to(out, R"({}{{"id":{},"image_id":{},"category_id":1,"track_id":{},"iscrowd":0,"area":{:.2f},"segmentation":[[)",
                   annotations_ == 0 ? "\n" : ",\n", annotations_ + 1, instant.index + 1, number(sample.track),
                   std::abs(geometry::polygon_area(polygon)));
    for (std::size_t i = 0; i < polygon.size(); ++i) {
      low = low.cwiseMin(polygon[i]);
      high = high.cwiseMax(polygon[i]);
      fmt::format_to(out, "{}{:.2f},{:.2f}", i > 0 ? "," : "", polygon[i].x() + 0.5, polygon[i].y() + 0.5);
    }
    fmt::format_to(out, R"(]],"bbox":[{:.2f},{:.2f},{:.2f},{:.2f}]}})", low.x() + 0.5, low.y() + 0.5, high.x() - low.x(),
                   high.y() - low.y());
    ++annotations_;
  }
}

void MaskFile::finish() {
  if (text_ == MaskText::coco) {
    lines_ = "\n],\n\"categories\":[{\"id\":1,\"name\":\"person\"}],\n\"images\":[";
    for (std::size_t i = 0; i < frames_.size(); ++i) {
      fmt::format_to(std::back_inserter(lines_), R"({}{{"id":{},"frame_id":{},"width":{},"height":{}}})", i > 0 ? ",\n" : "\n",
                     frames_[i] + 1, frames_[i], width_, height_);
    }
    lines_ += "\n]}\n";
    file_.write(lines_);
  }
  file_.finish();
}

Format mots_format() {
  return {
      .name = "mots",
      .title = "MOTS text with masks",
      .endings = {},
      .holds = Content::image,
      .detail =
          "px; `frame id class height width runs`, the visible part of each contour as COCO's compressed runs; frames count from "
          "1. Read as boxes, and as masks by `marey evaluate`. It has no time: `--rate`",
      .is = [](const Beginning& file) { return !file.folder && file.is_text() && is_mots_text(file.text()); },
      .read = [](const std::string& path,
                 const ReadOptions& options) { return tracks_of_masks(parse_mots(read_file(path), path), path, options.rate_hz); },
      .create = create_masks<MaskText::mots>,
      .while_recording = true};
}

Format coco_instances_format() {
  return {.name = "coco-instances",
          .title = "COCO instances with polygons",
          .endings = {},
          .holds = Content::image,
          .detail =
              "px, a pixel's corner at (0, 0); `annotations` with `segmentation` (the whole contour, hidden parts included) and "
              "`track_id`, `images` with `frame_id`. Read as boxes, and as masks by `marey evaluate`. It has no time: `--rate`",
          .is = [](const Beginning& file) { return !file.folder && file.is_text() && is_coco_instances(file.text()); },
          .read =
              [](const std::string& path, const ReadOptions& options) {
                return tracks_of_masks(parse_coco_instances(read_file(path), path), path, options.rate_hz);
              },
          .create = create_masks<MaskText::coco>,
          .while_recording = true};
}

}  // namespace marey::format::tracks
