#include "marey/format/tracks/blob_file.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <iterator>
#include <string_view>
#include <utility>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

#include "marey/core/error.h"
#include "marey/core/frame_numbers.h"
#include "marey/core/time.h"
#include "marey/files/input_file.h"
#include "marey/format/format.h"
#include "marey/format/nesting.h"
#include "marey/format/text_rows.h"

namespace marey::format::tracks {
namespace {

constexpr double kMaxBlob = 1e7;        // px
constexpr double kUnknownSigma = 0.25;  // px; of a blob whose covariance the file does not specify

enum Column { kFrame, kTime, kX, kY, kVarX, kCovXY, kVarY, kArea, kScore, kLeft, kTop, kWidth, kHeight, kColumns };
constexpr std::array<std::string_view, kColumns> kColumnNames{"frame", "time",  "x",    "y",   "var_x", "cov_xy", "var_y",
                                                              "area",  "score", "left", "top", "width", "height"};
constexpr std::string_view kHeader = "camera,frame,time,x,y,var_x,cov_xy,var_y,area,score,left,top,width,height";

/// One line, by column; nothing if the line does not specify.
struct BlobLine {
  std::string camera;
  std::array<std::optional<double>, kColumns> value;

  std::int64_t frame() const { return static_cast<std::int64_t>(*value[kFrame]); }
};

Detection detection_of(const BlobLine& line) {
  const auto& value = line.value;
  Detection blob;
  blob.centre = {*value[kX], *value[kY]};
  blob.covariance = Matrix<2>::Identity() * (kUnknownSigma * kUnknownSigma);
  if (value[kVarX] && value[kVarY]) {
    const double across = value[kCovXY].value_or(0);
    blob.covariance = (Matrix<2>() << *value[kVarX], across, across, *value[kVarY]).finished();
  }
  blob.area = value[kArea].value_or(0);
  blob.score = std::clamp(value[kScore].value_or(1), 0.0, 1.0);
  if (value[kLeft] && value[kTop] && value[kWidth] && value[kHeight]) {
    blob.box = {*value[kLeft], *value[kTop], *value[kWidth], *value[kHeight]};
  } else {
    const double side = 2 * std::sqrt(std::max(blob.area, 1.0) / 3.14159);
    blob.box = Box::from_centre(blob.centre, side, side);
  }
  return blob;
}

}  // namespace

BlobText blob_text_of(const std::string& path) {
  return path.ends_with(".jsonl") ? BlobText::jsonl : BlobText::csv;
}

BlobWriter::BlobWriter(const std::string& path, BlobText text, const std::string& camera)
    : file_(path), text_(text), camera_(text == BlobText::csv ? quoted_field(camera) : nlohmann::json(camera).dump()) {
  if (text_ == BlobText::csv) file_.write(fmt::format("{}\n", kHeader));
}

void BlobWriter::write(const Frame& frame, std::span<const Detection> blobs) {
  lines_.clear();
  auto out = std::back_inserter(lines_);
  for (const Detection& blob : blobs) {
    const Matrix<2> spread = blob.covariance.value_or(Matrix<2>::Identity() * (kUnknownSigma * kUnknownSigma));
    if (text_ == BlobText::csv) {
      fmt::format_to(out, "{},{},{:.6f},{:.4f},{:.4f},{:.4g},{:.4g},{:.4g},{:.2f},{:.3f},{:g},{:g},{:g},{:g}\n", camera_,
                     frame.index, seconds(frame.time), blob.centre.x(), blob.centre.y(), spread(0, 0), spread(0, 1), spread(1, 1),
                     blob.area, blob.score, blob.box.left, blob.box.top, blob.box.width, blob.box.height);
      continue;
    }
    fmt::format_to(
        out, R"({{"camera":{},"frame":{},"time":{:.6f},"x":{:.4f},"y":{:.4f},"var_x":{:.4g},"cov_xy":{:.4g},"var_y":{:.4g},)",
        camera_, frame.index, seconds(frame.time), blob.centre.x(), blob.centre.y(), spread(0, 0), spread(0, 1), spread(1, 1));
    fmt::format_to(out, R"("area":{:.2f},"score":{:.3f},"left":{:g},"top":{:g},"width":{:g},"height":{:g}}})", blob.area,
                   blob.score, blob.box.left, blob.box.top, blob.box.width, blob.box.height);
    lines_ += '\n';
  }
  file_.write(lines_);
}

/// The lines of either form.
class BlobReader::Lines {
 public:
  explicit Lines(const std::string& path) : path_(path), in_(path) {
    if (!in_ || !std::getline(in_, text_))
      throw Error("{}: these blobs cannot be read, or there are none; is the name right?", path);
    json_ = text_.starts_with('{');
    if (json_) return;
    std::string_view header = text_;
    if (header.starts_with("\xEF\xBB\xBF")) header.remove_prefix(3);
    split_fields(header, ',', fields_);
    for (std::size_t i = 0; i < fields_.size(); ++i) {
      if (fields_[i] == "camera") camera_ = i;
      const auto known = std::find(kColumnNames.begin(), kColumnNames.end(), fields_[i]);
      if (known != kColumnNames.end()) columns_[static_cast<std::size_t>(known - kColumnNames.begin())] = i;
    }
    for (const Column required : {kFrame, kX, kY}) {
      if (!columns_[required])
        throw Error("{}:1: there is no column \"{}\"; the header must be {}", path, kColumnNames[required], kHeader);
    }
    text_.clear();
  }

  /// Nothing at the end. Throws Error for a line that cannot be used.
  std::optional<BlobLine> next() {
    while (text_.empty() || text_ == "\r") {
      if (!std::getline(in_, text_)) return std::nullopt;
      ++number_;
    }
    BlobLine line = json_ ? of_json() : of_fields();
    text_.clear();
    check(line);
    return line;
  }

 private:
  [[noreturn]] void fail(const std::string& what) const { throw Error("{}:{}: {}", path_, number_, what); }

  BlobLine of_fields() {
    split_fields(text_, ',', fields_);
    BlobLine line;
    if (camera_ && *camera_ < fields_.size()) line.camera = unquoted(fields_[*camera_]);
    for (std::size_t k = 0; k < kColumns; ++k) {
      if (!columns_[k] || *columns_[k] >= fields_.size() || fields_[*columns_[k]].empty()) continue;
      line.value[k] = number_of(fields_[*columns_[k]]);
      if (!line.value[k]) fail(fmt::format("{} is {}; it must be a number", kColumnNames[k], shown(fields_[*columns_[k]])));
    }
    return line;
  }

  BlobLine of_json() {
    check_nesting(text_, Notation::json, fmt::format("{}:{}", path_, number_));
    try {
      const auto json = nlohmann::json::parse(text_);
      BlobLine line{.camera = json.value("camera", ""), .value = {}};
      for (std::size_t k = 0; k < kColumns; ++k) {
        if (const auto found = json.find(kColumnNames[k]); found != json.end()) line.value[k] = found->get<double>();
      }
      return line;
    } catch (const nlohmann::json::exception&) {
      fail("is not JSON of a blob: frame, x and y are wanted");
    }
  }

  void check(const BlobLine& line) {
    const auto& value = line.value;
    if (!value[kFrame] || *value[kFrame] != std::floor(*value[kFrame]) || *value[kFrame] < 0 || *value[kFrame] > 1e12)
      fail("frame must be a whole number from 0");
    for (const Column k : {kX, kY}) {
      if (!value[k] || !(std::abs(*value[k]) < kMaxBlob)) fail(fmt::format("{} must be a number of px", kColumnNames[k]));
    }
    const bool spread = value[kVarX].has_value() && value[kVarY].has_value();
    const double across = value[kCovXY].value_or(0);
    if (spread && !(*value[kVarX] >= 0 && *value[kVarY] >= 0 && across * across <= *value[kVarX] * *value[kVarY] * 1.01))
      fail("var_x, cov_xy and var_y are not covariance");
    if (number_ > 1 && line.frame() < last_frame_) fail("its frame comes before that of the line above; sort the lines by frame");
    last_frame_ = line.frame();
    if (!first_camera_) first_camera_ = line.camera;
    if (line.camera != *first_camera_)
      fail(fmt::format("holds blobs of several cameras, {} and {}; keep the lines of one", shown(*first_camera_),
                       shown(line.camera)));
  }

  std::string path_;
  InputStream in_;
  std::string text_;
  bool json_ = false;
  int number_ = 1;
  std::int64_t last_frame_ = 0;
  std::optional<std::string> first_camera_;
  std::vector<std::string_view> fields_;
  std::optional<std::size_t> camera_;
  std::array<std::optional<std::size_t>, kColumns> columns_{};
};

struct BlobReader::Parts {
  explicit Parts(const std::string& path) : lines(path) {}

  Lines lines;
  SourceInfo info;
  bool own_times = false;
  std::vector<std::string> warnings;
  std::optional<BlobLine> pending;
  std::int64_t next_index = 0;
};

BlobReader::BlobReader(const std::string& path, std::optional<double> rate_hz) {
  FrameNumbers numbers;
  std::int64_t frames = 0;
  Lines survey(path);
  while (const auto line = survey.next()) {
    numbers.add(line->frame(), line->value[kTime]);
    frames = line->frame() + 1;
  }
  numbers.check(path);
  parts_ = std::make_unique<Parts>(path);
  parts_->info.name = path;
  parts_->info.frame_count = frames;
  const auto own_rate = numbers.rate_hz();
  parts_->own_times = !rate_hz && own_rate;
  parts_->info.rate_hz = rate_hz ? rate_hz : own_rate ? own_rate : std::optional(kDefaultRate);
  if (!rate_hz && !own_rate)
    parts_->warnings.push_back(
        fmt::format("{}: blobs without times: {} frames a second were assumed; say otherwise with --rate", path, kDefaultRate));
  parts_->pending = parts_->lines.next();
}

BlobReader::~BlobReader() = default;
BlobReader::BlobReader(BlobReader&&) noexcept = default;

const SourceInfo& BlobReader::info() const {
  return parts_->info;
}

const std::vector<std::string>& BlobReader::warnings() const {
  return parts_->warnings;
}

std::optional<CameraFrame> BlobReader::next() {
  std::optional<BlobLine>& pending = parts_->pending;
  if (!pending) return std::nullopt;
  CameraFrame result;
  result.frame.index = parts_->next_index++;
  double time = static_cast<double>(result.frame.index) / *parts_->info.rate_hz;
  auto& blobs = result.detections.emplace();
  for (; pending && pending->frame() == result.frame.index; pending = parts_->lines.next()) {
    if (parts_->own_times && pending->value[kTime]) time = *pending->value[kTime];
    blobs.push_back(detection_of(*pending));
  }
  result.frame.time = timestamp_from_seconds(time);
  return result;
}

namespace {

/// By the first line of a file.
bool begins_blobs(std::string_view line) {
  if (line.starts_with('{'))
    return line.find("\"var_x\":") != std::string_view::npos && line.find("\"frame\":") != std::string_view::npos;
  std::vector<std::string_view> head;
  split_fields(line, ',', head);
  const auto has = [&](std::string_view name) { return std::find(head.begin(), head.end(), name) != head.end(); };
  return has("frame") && has("x") && has("y") && !has("id") && !has("z");
}

std::vector<Fact> facts_of_blobs(const std::string& path) {
  BlobReader reader(path, std::nullopt);
  std::int64_t blobs = 0, frames = 0, maximum = 0;
  while (const auto frame = reader.next()) {
    ++frames;
    blobs += std::ssize(*frame->detections);
    maximum = std::max<std::int64_t>(maximum, std::ssize(*frame->detections));
  }
  std::vector<Fact> facts{{"blobs", blobs}, {"frames", frames}};
  if (frames > 0)
    facts.push_back({"blobs_a_frame", static_cast<double>(blobs) / static_cast<double>(frames),
                     fmt::format("{:.1f}, at most {}", static_cast<double>(blobs) / static_cast<double>(frames), maximum)});
  return facts;
}

}  // namespace

bool is_blob_file(const std::string& path) {
  const Beginning file = beginning_of(path);
  return !file.folder && file.is_text() && begins_blobs(file.first_line());
}

Format blobs_format() {
  return {.name = "blobs",
          .title = "blobs that were found in images, one a line",
          .endings = {},
          .holds = Content::detections,
          .detail =
              "px; `camera,frame,time,x,y,var_x,cov_xy,var_y,area,score,left,top,width,height`, CSV or JSON lines; frames and "
              "pixels count from 0. Written by `marey detect`; for `marey track --targets markers --detections` and, as "
              "CSV, wherever observations are",
          .is = [](const Beginning& file) { return file.is_text() && file.has("var_x") && begins_blobs(file.first_line()); },
          .facts = facts_of_blobs};
}

}  // namespace marey::format::tracks
