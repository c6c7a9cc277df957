#include "marey/format/tracks/track_file.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <iterator>
#include <limits>
#include <memory>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "marey/core/error.h"
#include "marey/format/format.h"
#include "marey/format/match/ground_builder.h"
#include "marey/format/match/ground_file.h"
#include "marey/format/nesting.h"
#include "marey/format/read_file.h"
#include "marey/format/text_rows.h"
#include "marey/format/tracks/keypoints_json.h"
#include "marey/format/tracks/mot.h"
#include "marey/format/tracks/outline_json.h"

namespace marey::format::tracks {
namespace {

void append_mot(std::string& lines, const Instant& instant, const Sample& sample) {
  if (!sample.box) return;
  const Box& box = *sample.box;
  fmt::format_to(std::back_inserter(lines), "{},{},{:.2f},{:.2f},{:.2f},{:.2f},{:.4g},-1,-1,-1\n", instant.index + 1,
                 number(sample.track), box.left + 1, box.top + 1, box.width, box.height,
                 sample.measured() ? sample.score.value_or(1) : 0.0);
}

void append_csv(std::string& lines, const Instant& instant, const Sample& sample, const std::string& label) {
  auto out = std::back_inserter(lines);
  fmt::format_to(out, "{},{:.6f},{},{},{:.3f},{:.3f},", instant.index, seconds(instant.time), number(sample.track),
                 quoted_field(label), sample.position.x(), sample.position.y());
  if (sample.velocity) {
    fmt::format_to(out, "{:.2f},{:.2f},", sample.velocity->x(), sample.velocity->y());
  } else {
    lines += ",,";
  }
  if (sample.box) {
    fmt::format_to(out, "{:.2f},{:.2f},{:.2f},{:.2f},", sample.box->left, sample.box->top, sample.box->width, sample.box->height);
  } else {
    lines += ",,,,";
  }
  fmt::format_to(out, "{}\n", to_string(sample.provenance));
}

/// A row for each body point that is known.
void append_points(std::string& lines, const Instant& instant, const Sample& sample, const KeypointSet& set) {
  if (!sample.keypoints) return;
  const auto& points = sample.keypoints->points;
  for (std::size_t i = 0; i < std::min(points.size(), set.points.size()); ++i) {
    if (!points[i]) continue;
    const Keypoint<2>& point = *points[i];
    fmt::format_to(std::back_inserter(lines), "{},{:.6f},{},{},{:.3f},{:.3f},{:.3f},{:.4f},{:.4f}\n", instant.index,
                   seconds(instant.time), number(sample.track), quoted_field(set.points[i]), point.position.x(), point.position.y(),
                   std::sqrt(point.covariance.trace() / 2), point.visibility, point.presence);
  }
}

void append_json(std::string& lines, const Instant& instant, const Sample& sample, const std::string& label,
                 const KeypointSet* set) {
  auto out = std::back_inserter(lines);
  fmt::format_to(out, R"({{"frame":{},"time":{:.6f},"id":{},)", instant.index, seconds(instant.time), number(sample.track));
  if (!label.empty()) {
    using nlohmann::json;
    fmt::format_to(out, R"("label":{},)", json(label).dump(-1, ' ', false, json::error_handler_t::replace));
  }
  fmt::format_to(out, R"("x":{:.3f},"y":{:.3f},)", sample.position.x(), sample.position.y());
  if (sample.velocity) fmt::format_to(out, R"("vx":{:.2f},"vy":{:.2f},)", sample.velocity->x(), sample.velocity->y());
  if (sample.box) {
    fmt::format_to(out, R"("left":{:.2f},"top":{:.2f},"width":{:.2f},"height":{:.2f},)", sample.box->left, sample.box->top,
                   sample.box->width, sample.box->height);
  }
  fmt::format_to(out, R"("state":"{}")", to_string(sample.provenance));
  if (sample.outline) {
    lines += R"(,"outline":)";
    tracks::append_json(lines, *sample.outline);
  }
  if (sample.keypoints && set != nullptr) {
    lines += R"(,"keypoints":)";
    tracks::append_json(lines, *sample.keypoints, *set);
  }
  lines += "}\n";
}

template <TrackText text>
std::unique_ptr<Sink> create(const std::string& path, const WritePlan&) {
  return std::make_unique<TrackFile>(path, text);
}

}  // namespace

TrackFile::TrackFile(const std::string& path, TrackText text) : path_(path), file_(path), text_(text) {}

Sink::SinkRequirements TrackFile::begin(const RecordingHeader& header) {
  if (header.frame.metric()) {
    throw Error("{}: such a file holds boxes in an image, and these positions are {}", path_, to_string(header.frame));
  }
  keypoints_ = header.keypoints;
  if (text_ == TrackText::csv)
    file_.write(keypoints_ ? "frame,time,id,point,x,y,sd,visibility,presence\n"
                           : "frame,time,id,label,x,y,vx,vy,left,top,width,height,state\n");
  return {};
}

void TrackFile::write(const Instant& instant) {
  names_.add(instant.named);
  lines_.clear();
  for (const Sample& sample : instant.samples) {
    switch (text_) {
      case TrackText::mot:
        append_mot(lines_, instant, sample);
        break;
      case TrackText::csv:
        if (keypoints_) {
          append_points(lines_, instant, sample, *keypoints_);
        } else {
          append_csv(lines_, instant, sample, names_.label(sample.track));
        }
        break;
      case TrackText::jsonl:
        append_json(lines_, instant, sample, names_.label(sample.track), keypoints_ ? &*keypoints_ : nullptr);
        break;
    }
  }
  file_.write(lines_);
}

namespace {

match::GroundMatch in_image(double rate_hz) {
  match::GroundMatch match;
  match.recording.header.frame.kind = FrameOfReference::Kind::image;
  match.recording.header.rate_hz = rate_hz;
  return match;
}

match::GroundMatch read_mot_tracks(const std::string& path, const ReadOptions& options) {
  MotTable table = read_mot(path, MotKind::tracks);
  match::GroundMatch match = in_image(options.rate_hz);
  match::GroundBuilder builder(path);
  for (const LabelledBox& box : table.boxes) {
    builder.add(builder.person(std::to_string(box.id), box.id, {}, {}), {.frame = box.frame,
                                                                         .time = box.frame / options.rate_hz,
                                                                         .location = box.box.centre(),
                                                                         .box = box.box,
                                                                         .score = box.score});
  }
  match.order = builder.finish(match.recording);
  match.warnings = std::move(table.warnings);
  return match;
}

/// Lines of JSON as TrackFile writes them. Outlines are skipped.
class JsonLines {
 public:
  explicit JsonLines(const std::string& path) : path_(path), builder_(path) {}

  match::GroundMatch read(const std::string& text, double rate_hz) {
    match::GroundMatch match = in_image(rate_hz);
    for_each_line(text, path_, [&](std::string_view line, const std::string& where) {
      check_nesting(line, Notation::json, where);
      try {
        add(nlohmann::json::parse(line));
      } catch (const nlohmann::json::exception&) {
        throw Error("{}: is not JSON of a track: frame, time, id, x and y are wanted", where);
      }
    });
    match.order = builder_.finish(match.recording);
    if (const auto rate = median_rate_hz(match.recording.instants())) match.recording.header.rate_hz = *rate;
    if (outlines_) match.warnings.push_back(path_ + ": its outlines are skipped");
    if (keypoints_) match.warnings.push_back(path_ + ": its keypoints are skipped");
    return match;
  }

 private:
  void add(const nlohmann::json& line) {
    const auto number = [&](const char* name) { return line.at(name).get<double>(); };
    match::GroundBuilder::Row row{.frame = line.at("frame").get<std::int32_t>(),
                                  .provenance = provenance(line.value("state", "measured")),
                                  .time = number("time"),
                                  .location = {number("x"), number("y")}};
    if (line.contains("vx")) row.velocity = Vector<2>(number("vx"), number("vy"));
    if (line.contains("left")) row.box = Box{number("left"), number("top"), number("width"), number("height")};
    const int id = line.at("id").get<int>();
    if (id < 1 || row.frame < 0 || !row.location.allFinite())
      throw Error("{}: track {} in frame {} is nowhere", path_, id, row.frame);
    outlines_ |= line.contains("outline");
    keypoints_ |= line.contains("keypoints");
    builder_.add(builder_.person(id, line.value("label", ""), {}), row);
  }

  Provenance provenance(const std::string& name) const {
    if (const auto found = provenance_of(name)) return *found;
    throw Error("{}: a state is {}; it must be {}", path_, shown(name), fmt::join(kProvenanceNames, ", "));
  }

  const std::string& path_;
  match::GroundBuilder builder_;
  bool outlines_ = false, keypoints_ = false;
};

/// Six numbers or more on the first lines; `id` says whether an id, the second, may be.
bool is_mot(const Beginning& file, bool (*id)(double id)) {
  if (!file.is_text()) return false;
  TextLines lines(file.text());
  std::string_view line;
  std::vector<std::string_view> fields;
  int count = 0;
  while (lines.next(line) && lines.ended() && count < 100) {
    if (line.empty()) continue;
    split_fields(line, line.find(',') == std::string_view::npos ? ' ' : ',', fields);
    std::erase(fields, std::string_view());
    if (fields.size() < 6) return false;
    for (std::size_t i = 0; i < 6; ++i) {
      if (!number_of(fields[i])) return false;
    }
    if (!id(*number_of(fields[1]))) return false;
    ++count;
  }
  return count > 0;
}

std::vector<Fact> facts_of_detections(const std::string& path) {
  MotReader reader(path);
  std::int64_t boxes = 0;
  std::int32_t first = std::numeric_limits<std::int32_t>::max(), last = 0;
  double smallest = std::numeric_limits<double>::max(), largest = 0, minimum = smallest, maximum = -smallest;
  while (const auto piece = reader.next()) {
    for (const LabelledBox& box : *piece) {
      ++boxes;
      first = std::min(first, box.frame), last = std::max(last, box.frame);
      smallest = std::min(smallest, box.box.height), largest = std::max(largest, box.box.height);
      minimum = std::min(minimum, box.score), maximum = std::max(maximum, box.score);
    }
  }
  std::vector<Fact> facts{{"boxes", boxes}};
  if (boxes == 0) return facts;
  const std::int64_t frames = std::int64_t{last} - first + 1;
  facts.push_back({"first_frame", std::int64_t{first}, fmt::format("{}, counted from 0", first)});
  facts.push_back({"last_frame", std::int64_t{last}});
  facts.push_back({"boxes_a_frame", static_cast<double>(boxes) / static_cast<double>(frames),
                   fmt::format("{:.1f}", static_cast<double>(boxes) / static_cast<double>(frames))});
  facts.push_back({"heights_px", fmt::format("{:.0f} to {:.0f}", smallest, largest)});
  facts.push_back({"scores", fmt::format("{:g} to {:g}", minimum, maximum)});
  return facts;
}

}  // namespace

Format image_mot_format() {
  return {.name = "mot",
          .title = "MOTChallenge text with boxes",
          .endings = ".txt",
          .holds = Content::image,
          .detail = "px; `frame,id,left,top,width,height,score,-1,-1,-1`; frames and pixels count from 1. It has no time: `--rate`",
          .is = [](const Beginning& file) { return tracks::is_mot(file, [](double id) { return id >= 0; }); },
          .read = tracks::read_mot_tracks,
          .create = tracks::create<tracks::TrackText::mot>,
          .while_recording = true};
}

Format image_csv_format() {
  return {.name = "csv",
          .title = "tracks in an image, one row each",
          .endings = ".csv",
          .holds = Content::image,
          .detail =
              "px; `frame,time,id,label,x,y,vx,vy,left,top,width,height,state`; frames and pixels count from 0. With "
              "keypoints a row for each point instead: `frame,time,id,point,x,y,sd,visibility,presence`; not read back",
          .is = [](const Beginning& file) { return match::is_ground_csv(file, true); },
          .read = match::read_ground_match,
          .create = tracks::create<tracks::TrackText::csv>,
          .while_recording = true};
}

Format jsonl_format() {
  return {.name = "jsonl",
          .title = "tracks in an image, one JSON object a line",
          .endings = ".jsonl",
          .holds = Content::image,
          .detail = "px; the names of the CSV, and `outline` and `keypoints` where there are some, which are skipped when read",
          .is = [](const Beginning& file) { return file.text().starts_with("{\"frame\":"); },
          .read = [](const std::string& path,
                     const ReadOptions& options) { return tracks::JsonLines(path).read(read_file(path), options.rate_hz); },
          .create = tracks::create<tracks::TrackText::jsonl>,
          .while_recording = true};
}

Format detections_format() {
  return {.name = "detections",
          .title = "another program's detections, MOTChallenge text",
          .endings = {},
          .holds = Content::detections,
          .detail = "px; `frame,-1,left,top,width,height,score`; frames and pixels count from 1. For `marey track --detections`",
          .is = [](const Beginning& file) { return tracks::is_mot(file, [](double id) { return id == -1; }); },
          .facts = tracks::facts_of_detections};
}

}  // namespace marey::format::tracks
