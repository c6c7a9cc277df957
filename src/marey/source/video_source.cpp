#include "marey/source/video_source.h"

#include <cmath>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/files/text_safety.h"
#include "marey/source/decoder.h"
#include "marey/source/rates.h"

namespace marey::source {
namespace {

class VideoSource final : public Source {
 public:
  VideoSource(const std::string& path, std::optional<double> rate_hz) : decoder_(path), given_rate_(rate_hz) {
    info_.name = path;
    info_.size = decoder_.size();
    info_.rate_hz = rate_hz ? rate_hz : decoder_.rate_hz();
    info_.frame_count = decoder_.frame_count();
    const auto duration = decoder_.duration_s();
    const auto rate = decoder_.rate_hz();
    if (!info_.frame_count && duration && rate) info_.frame_count = std::llround(*duration * *rate);
    if (rate_hz && rate && differ(*rate_hz, *rate)) {
      warnings_.push_back(fmt::format(
          "{}: its header says {:g} frames per second, the given rate is {:g}, and that is used: times and speeds depend "
          "on it; if the header is right, remove the rate (\"rate\" in the rig, or --rate)",
          path, *rate, *rate_hz));
    }
  }

  const SourceInfo& info() const override { return info_; }
  std::vector<std::string> warnings() const override { return warnings_; }

  std::optional<Frame> next() override {
    auto decoded = decoder_.next();
    if (!decoded) {
      report_the_end();
      return std::nullopt;
    }
    Frame frame;
    frame.index = next_index_++;
    frame.time = time_of(decoded->stamp_ns, frame.index);
    frame.image = std::move(decoded->image);
    return frame;
  }

 private:
  /// The container's stamp, counted from the first; one frame after the last where it is missing or does not move on.
  Timestamp time_of(std::optional<std::int64_t> stamp_ns, std::int64_t index) {
    if (given_rate_) return last_time_ = timestamp_from_seconds(static_cast<double>(index) / *given_rate_);
    if (index == 0) {
      first_stamp_ = stamp_ns.value_or(0);
      return last_time_;
    }
    const Timestamp stamped{Duration(stamp_ns.value_or(first_stamp_) - first_stamp_)};
    const Timestamp nominal = last_time_ + duration_from_seconds(1.0 / info_.rate_hz.value_or(kDefaultRate));
    last_time_ = stamped > last_time_ ? stamped : nominal;
    return last_time_;
  }

  void report_the_end() {
    if (std::exchange(ended_, true)) return;
    const Decoder::Trouble& trouble = decoder_.trouble();
    const auto warn = [&](const std::string& text) { warnings_.push_back(info_.name + ": " + text); };
    if (trouble.rescaled > 0) warn(fmt::format("images scaled to the size of the first: {}", trouble.rescaled));
    if (trouble.damaged > 0) warn(fmt::format("damaged images, used as far as they could be decoded: {}", trouble.damaged));
    if (trouble.undecodable > 0) warn(fmt::format("images omitted because they could not be decoded: {}", trouble.undecodable));
    if (!trouble.stopped && (!trouble.broken.empty() || is_short())) {
      const auto count = decoder_.frame_count();
      const std::string whole = count ? fmt::format(" of {}", *count) : std::string();
      warn(fmt::format("the file breaks off after {} frames{} ({:.1f} s); it was processed as far as it goes", next_index_, whole,
                       seconds(last_time_)));
    }
  }

  /// Whether the header promised more than came. A few frames that a decoder keeps to itself, and a second of rounding or of
  /// sound after the last image, are not loss.
  bool is_short() const {
    if (const auto count = decoder_.frame_count()) return next_index_ + decoder_.trouble().undecodable + 2 + *count / 100 < *count;
    const auto duration = decoder_.duration_s();
    return duration && !given_rate_ && seconds(last_time_) + 1 + *duration / 100 < *duration;
  }

  Decoder decoder_;
  SourceInfo info_;
  std::optional<double> given_rate_;
  std::int64_t first_stamp_ = 0;
  Timestamp last_time_{};
  std::int64_t next_index_ = 0;
  std::vector<std::string> warnings_;
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<Source> open_video(const std::string& path, std::optional<double> rate_hz) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) throw Error("{}: no such file", plain_text(path));
  if (std::filesystem::is_regular_file(path, ignored) && std::filesystem::file_size(path, ignored) == 0) {
    throw Error("{}: the file is empty", path);
  }
  return std::make_unique<VideoSource>(path, rate_hz);
}

}  // namespace marey::source
