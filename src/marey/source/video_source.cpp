// Video files through FFmpeg's libraries. OpenCV's reader is not used because it converts every frame to BGR (half of the
// decoding time of a large picture), counts time as index / rate, and does not tell a file that ends from one that breaks off.
#include "marey/source/video_source.h"

#include <algorithm>
#include <filesystem>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/imgutils.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

namespace marey {
namespace {

template <typename T, void (*Free)(T**)>
struct FreeBy {
  void operator()(T* object) const { Free(&object); }
};
using FormatPtr = std::unique_ptr<AVFormatContext, FreeBy<AVFormatContext, avformat_close_input>>;
using CodecPtr = std::unique_ptr<AVCodecContext, FreeBy<AVCodecContext, avcodec_free_context>>;
using FramePtr = std::unique_ptr<AVFrame, FreeBy<AVFrame, av_frame_free>>;
using PacketPtr = std::unique_ptr<AVPacket, FreeBy<AVPacket, av_packet_free>>;
struct FreeScaler {
  void operator()(SwsContext* scaler) const { sws_freeContext(scaler); }
};

std::string reason(int code) {
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(code, text, sizeof text);
  return text;
}

class VideoSource final : public Source {
 public:
  VideoSource(const std::string& path, std::optional<double> rate_hz) : given_rate_(rate_hz) {
    info_.name = path;
    open(path);
    if (rate_hz) info_.rate_hz = rate_hz;
  }

  const SourceInfo& info() const override { return info_; }
  std::vector<std::string> warnings() const override { return warnings_; }

  std::optional<Frame> next() override {
    while (auto decoded = decode()) {
      Picture picture = to_picture(*decoded);
      if (picture.empty()) continue;
      Frame frame;
      frame.index = next_index_++;
      frame.time = time_of(*decoded, frame.index);
      frame.picture = std::move(picture);
      return frame;
    }
    tell_the_end();
    return std::nullopt;
  }

 private:
  void open(const std::string& path) {
    AVFormatContext* format = nullptr;
    if (const int code = avformat_open_input(&format, path.c_str(), nullptr, nullptr); code < 0) {
      throw Error("{}: cannot be read as a video ({}); give a video file or a folder of pictures", path, reason(code));
    }
    format_.reset(format);
    if (const int code = avformat_find_stream_info(format, nullptr); code < 0) {
      throw Error("{}: cannot be read as a video ({}); the file may be damaged", path, reason(code));
    }
    const AVCodec* codec = nullptr;
    const int stream = av_find_best_stream(format, AVMEDIA_TYPE_VIDEO, -1, -1, &codec, 0);
    if (stream < 0 || codec == nullptr) throw Error("{}: holds no video that can be decoded; give a video file", path);
    stream_ = format->streams[stream];
    codec_.reset(avcodec_alloc_context3(codec));
    avcodec_parameters_to_context(codec_.get(), stream_->codecpar);
    codec_->thread_count = 0;  // one thread a core, in frames: results are the same, and in order
    if (const int code = avcodec_open2(codec_.get(), codec, nullptr); code < 0) {
      throw Error("{}: its video ({}) cannot be decoded ({})", path, codec->long_name, reason(code));
    }
    info_.size = {codec_->width, codec_->height};
    if (info_.size.area() <= 0) throw Error("{}: its pictures have no size; the file is damaged or is no video", path);
    const AVRational rate = av_guess_frame_rate(format, stream_, nullptr);
    if (rate.num > 0 && rate.den > 0) info_.rate_hz = av_q2d(rate);
    info_.frame_count = frame_count();
  }

  std::optional<std::int64_t> frame_count() const {
    if (stream_->nb_frames > 0) return stream_->nb_frames;
    if (!info_.rate_hz) return std::nullopt;
    if (stream_->duration > 0) return std::llround(stream_->duration * av_q2d(stream_->time_base) * *info_.rate_hz);
    if (format_->duration > 0) return std::llround(static_cast<double>(format_->duration) / AV_TIME_BASE * *info_.rate_hz);
    return std::nullopt;
  }

  /// The next decoded picture; nothing at the end. A packet that cannot be decoded is counted and passed over.
  FramePtr decode() {
    FramePtr frame(av_frame_alloc());
    for (;;) {
      const int code = avcodec_receive_frame(codec_.get(), frame.get());
      if (code == 0) return frame;
      if (code == AVERROR_EOF) return nullptr;
      if (code != AVERROR(EAGAIN)) {
        ++undecodable_;
        if (flushed_) return nullptr;
      }
      feed();
    }
  }

  void feed() {
    if (flushed_) return;
    for (;;) {
      av_packet_unref(packet_.get());
      const int code = av_read_frame(format_.get(), packet_.get());
      if (code < 0) {
        if (code != AVERROR_EOF) broken_ = reason(code);
        avcodec_send_packet(codec_.get(), nullptr);
        flushed_ = true;
        return;
      }
      if (packet_->stream_index != stream_->index) continue;
      if (packet_->flags & AV_PKT_FLAG_CORRUPT) ++undecodable_;
      if (avcodec_send_packet(codec_.get(), packet_.get()) < 0) {
        ++undecodable_;
        continue;
      }
      return;
    }
  }

  Picture to_picture(const AVFrame& decoded) {
    const auto format = static_cast<AVPixelFormat>(decoded.format);
    const bool full = decoded.color_range == AVCOL_RANGE_JPEG || format == AV_PIX_FMT_YUVJ420P;
    const auto range = full ? Picture::Range::full : Picture::Range::limited;
    const bool planar = format == AV_PIX_FMT_YUV420P || format == AV_PIX_FMT_YUVJ420P;
    const bool upright = decoded.linesize[0] > 0;
    if (upright && planar) return planes_of(decoded, range);
    if (upright && format == AV_PIX_FMT_GRAY8) return grey_of(decoded, CV_8UC1);
    if (upright && format == AV_PIX_FMT_GRAY16LE) return grey_of(decoded, CV_16UC1);
    return converted(decoded);
  }

  static std::shared_ptr<const void> share(const AVFrame& decoded) {
    return {static_cast<const void*>(av_frame_clone(&decoded)), [](const void* frame) {
              auto* owned = static_cast<AVFrame*>(const_cast<void*>(frame));
              av_frame_free(&owned);
            }};
  }

  static Picture planes_of(const AVFrame& decoded, Picture::Range range) {
    const int half_width = (decoded.width + 1) / 2;
    const int half_height = (decoded.height + 1) / 2;
    return {cv::Mat(decoded.height, decoded.width, CV_8UC1, decoded.data[0], decoded.linesize[0]),
            cv::Mat(half_height, half_width, CV_8UC1, decoded.data[1], decoded.linesize[1]),
            cv::Mat(half_height, half_width, CV_8UC1, decoded.data[2], decoded.linesize[2]), range, share(decoded)};
  }

  static Picture grey_of(const AVFrame& decoded, int type) {
    return Picture(cv::Mat(decoded.height, decoded.width, type, decoded.data[0], decoded.linesize[0]).clone());
  }

  /// Any other storage, or a picture whose size is not the first one's, is brought to 4:2:0 (grey deeper than 8 bits stays
  /// grey) at the first picture's size.
  Picture converted(const AVFrame& decoded) {
    const auto format = static_cast<AVPixelFormat>(decoded.format);
    const AVPixFmtDescriptor* description = av_pix_fmt_desc_get(format);
    const bool grey = description != nullptr && description->nb_components == 1;
    const bool deep = grey && description->comp[0].depth > 8;
    const AVPixelFormat target = deep ? AV_PIX_FMT_GRAY16LE : grey ? AV_PIX_FMT_GRAY8 : AV_PIX_FMT_YUV420P;
    scaler_.reset(sws_getCachedContext(scaler_.release(), decoded.width, decoded.height, format, decoded.width, decoded.height,
                                       target, SWS_BILINEAR, nullptr, nullptr, nullptr));
    if (!scaler_) return {};
    FramePtr result(av_frame_alloc());
    result->format = target;
    result->width = decoded.width;
    result->height = decoded.height;
    if (av_frame_get_buffer(result.get(), 0) < 0) return {};
    sws_scale(scaler_.get(), decoded.data, decoded.linesize, 0, decoded.height, result->data, result->linesize);
    if (grey) return grey_of(*result, deep ? CV_16UC1 : CV_8UC1);
    return planes_of(*result, Picture::Range::limited);
  }

  Timestamp time_of(const AVFrame& decoded, std::int64_t index) {
    if (given_rate_) return timestamp_from_seconds(static_cast<double>(index) / *given_rate_);
    const std::int64_t stamp = decoded.best_effort_timestamp;
    Timestamp time = last_time_ + nominal_step();
    if (stamp != AV_NOPTS_VALUE) {
      if (!first_stamp_) first_stamp_ = stamp;
      const AVRational nanoseconds{1, 1'000'000'000};
      const Timestamp stamped{Duration(av_rescale_q(stamp - *first_stamp_, stream_->time_base, nanoseconds))};
      if (index == 0 || stamped > last_time_) time = stamped;
    } else if (index == 0) {
      time = Timestamp{};
    }
    last_time_ = time;
    return time;
  }

  Duration nominal_step() const { return duration_from_seconds(1.0 / info_.rate_hz.value_or(25.0)); }

  void tell_the_end() {
    if (std::exchange(ended_, true)) return;
    if (undecodable_ > 0) {
      warnings_.push_back(fmt::format("{}: {} packets could not be decoded and were left out", info_.name, undecodable_));
    }
    const bool counted = stream_->nb_frames > 0 && next_index_ + 2 < stream_->nb_frames;
    if (!broken_.empty() || counted) {
      warnings_.push_back(fmt::format("{}: breaks off after frame {} ({:.2f} s){}{}; it was processed as far as it goes",
                                      info_.name, next_index_, seconds(last_time_),
                                      counted ? fmt::format(" of {}", stream_->nb_frames) : std::string(),
                                      broken_.empty() ? std::string() : ": " + broken_));
    }
  }

  SourceInfo info_;
  std::optional<double> given_rate_;
  FormatPtr format_;
  CodecPtr codec_;
  AVStream* stream_ = nullptr;
  PacketPtr packet_{av_packet_alloc()};
  std::unique_ptr<SwsContext, FreeScaler> scaler_;
  std::optional<std::int64_t> first_stamp_;
  Timestamp last_time_{};
  std::int64_t next_index_ = 0;
  std::int64_t undecodable_ = 0;
  std::string broken_;
  std::vector<std::string> warnings_;
  bool flushed_ = false;
  bool ended_ = false;
};

}  // namespace

std::unique_ptr<Source> open_video(const std::string& path, std::optional<double> rate_hz) {
  std::error_code ignored;
  if (!std::filesystem::exists(path, ignored)) throw Error("{}: no such file", path);
  if (std::filesystem::is_regular_file(path, ignored) && std::filesystem::file_size(path, ignored) == 0) {
    throw Error("{}: the file is empty", path);
  }
  av_log_set_level(AV_LOG_QUIET);
  return std::make_unique<VideoSource>(path, rate_hz);
}

}  // namespace marey
