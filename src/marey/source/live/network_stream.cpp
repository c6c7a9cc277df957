#include "marey/source/live/network_stream.h"

#include <atomic>
#include <chrono>
#include <memory>
#include <utility>

#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/files/c_deleter.h"
#include "marey/files/limits.h"
#include "marey/files/source_name.h"
#include "marey/source/decoded_image.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

namespace marey::source::live {
namespace {

using NetworkFormat = std::unique_ptr<AVFormatContext, CDeleter<AVFormatContext, avformat_close_input>>;
using NetworkCodec = std::unique_ptr<AVCodecContext, CDeleter<AVCodecContext, avcodec_free_context>>;
using NetworkFrame = std::unique_ptr<AVFrame, CDeleter<AVFrame, av_frame_free>>;
using NetworkPacket = std::unique_ptr<AVPacket, CDeleter<AVPacket, av_packet_free>>;

std::string why(int code) {
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(code, text, sizeof text);
  return text;
}

/// FFmpeg asks it all the time whether to continue: not after the deadline, not when the camera is dropped.
struct Patience {
  explicit Patience(std::stop_token token) : stop(std::move(token)) {}

  void wait_for(double s) {
    end = std::chrono::steady_clock::now() + std::chrono::duration_cast<std::chrono::nanoseconds>(std::chrono::duration<double>(s));
  }
  static int is_over(void* self) {
    const auto& patience = *static_cast<const Patience*>(self);
    return patience.stop.stop_requested() || std::chrono::steady_clock::now() > patience.end ? 1 : 0;
  }

  std::stop_token stop;
  std::chrono::steady_clock::time_point end{};
};

class NetworkStream final : public Connection {
 public:
  NetworkStream(NetworkOptions options, std::stop_token stop)
      : options_(std::move(options)), shown_(shown_source(options_.url)), patience_(std::move(stop)) {
    open();
    open_decoder();
    info_.name = shown_;
    info_.size = {codec_->width, codec_->height};
    const AVRational rate = av_guess_frame_rate(format_.get(), stream_, nullptr);
    if (rate.num > 0 && rate.den > 0) info_.rate_hz = av_q2d(rate);
  }

  const SourceInfo& info() const override { return info_; }

  Came next(Shot& shot) override {
    for (;;) {
      const int code = avcodec_receive_frame(codec_.get(), frame_.get());
      if (code == 0) return take(shot);
      if (code != AVERROR(EAGAIN)) return Came::damaged;
      if (!feed()) return Came::damaged;
      if (patience_.stop.stop_requested()) return Came::nothing;
    }
  }

 private:
  void open() {
    AVFormatContext* opened = allocated(avformat_alloc_context());
    opened->interrupt_callback = {Patience::is_over, &patience_};
    opened->flags |= AVFMT_FLAG_NOBUFFER | AVFMT_FLAG_DISCARD_CORRUPT;
    AVDictionary* settings = nullptr;
    av_dict_set(&settings, "rtsp_transport", options_.udp ? "udp" : "tcp", 0);
    av_dict_set(&settings, "allowed_media_types", "video", 0);
    av_dict_set_int(&settings, "probesize", 500'000, 0);
    av_dict_set_int(&settings, "analyzeduration", 500'000, 0);
    av_dict_set_int(&settings, "timeout", static_cast<std::int64_t>(options_.open_s * 1e6), 0);
    av_dict_set(&settings, "protocol_whitelist", "http,https,httpproxy,tls,tcp,udp,rtp,rtsp,crypto", 0);  // no file of the host's
    patience_.wait_for(options_.open_s);
    const int code = avformat_open_input(&opened, options_.url.c_str(), nullptr, &settings);
    av_dict_free(&settings);
    if (patience_.stop.stop_requested()) {
      avformat_close_input(&opened);
      throw Stopped();
    }
    if (code < 0) throw Error("{}: cannot be reached ({}); is it on, and is its address right?", shown_, why(code));
    format_.reset(opened);
    patience_.wait_for(options_.open_s);
    if (avformat_find_stream_info(format_.get(), nullptr) < 0) throw Error("{}: sends nothing that can be read as a video", shown_);
  }

  void open_decoder() {
    const AVCodec* codec = nullptr;
    const int stream = av_find_best_stream(format_.get(), AVMEDIA_TYPE_VIDEO, -1, -1, &codec, 0);
    if (stream < 0 || codec == nullptr) throw Error("{}: sends no video that can be decoded", shown_);
    stream_ = format_->streams[stream];
    codec_.reset(allocated(avcodec_alloc_context3(codec)));
    avcodec_parameters_to_context(codec_.get(), stream_->codecpar);
    codec_->thread_count = 1;
    codec_->flags |= AV_CODEC_FLAG_LOW_DELAY;
    codec_->max_pixels = static_cast<std::int64_t>(Limits::in_force().image_px);
    codec_->log_level_offset = AV_LOG_TRACE;
    if (const int code = avcodec_open2(codec_.get(), codec, nullptr); code < 0)
      throw Error("{}: its video ({}) cannot be decoded ({})", shown_, codec->long_name, why(code));
    if (codec_->width <= 0 || codec_->height <= 0) throw Error("{}: does not specify how large its images are", shown_);
  }

  /// One packet to the decoder; false where it had to be omitted. Throws Error if the stream has ended.
  bool feed() {
    av_packet_unref(packet_.get());
    patience_.wait_for(options_.silent_s);
    const int code = av_read_frame(format_.get(), packet_.get());
    if (patience_.stop.stop_requested()) return true;
    if (code == AVERROR(EAGAIN)) return true;
    if (code < 0) throw Error("{}: the stream has ended ({})", shown_, code == AVERROR_EXIT ? "nothing came any more" : why(code));
    if (packet_->stream_index != stream_->index || packet_->size == 0) return true;
    const bool key = (packet_->flags & AV_PKT_FLAG_KEY) != 0;
    if ((packet_->flags & AV_PKT_FLAG_CORRUPT) != 0) wait_for_key_ = true;
    if (wait_for_key_ && !key) return false;
    wait_for_key_ = false;
    read_clock();
    if (avcodec_send_packet(codec_.get(), packet_.get()) >= 0) return true;
    wait_for_key_ = true;
    return false;
  }

  /// The sender's clock, µs, if RTCP has reported it: since the first sender report each packet brings it.
  void read_clock() {
    std::size_t size = 0;
    const std::uint8_t* data = av_packet_get_side_data(packet_.get(), AV_PKT_DATA_PRFT, &size);
    if (data == nullptr || size < sizeof(AVProducerReferenceTime)) return;
    const auto* reported = reinterpret_cast<const AVProducerReferenceTime*>(data);
    wallclock_ = Duration(reported->wallclock * 1000);
    wallclock_pts_ = packet_->pts;
  }

  Came take(Shot& shot) {
    const bool whole = frame_->decode_error_flags == 0 && (frame_->flags & AV_FRAME_FLAG_CORRUPT) == 0;
    shot.given.frame.image = whole ? maker_(*frame_, {frame_->width, frame_->height}) : Image();
    if (wallclock_ && wallclock_pts_ != AV_NOPTS_VALUE && frame_->pts != AV_NOPTS_VALUE) {
      const std::int64_t back = av_rescale_q(wallclock_pts_ - frame_->pts, stream_->time_base, AVRational{1, 1'000'000'000});
      shot.device_time = *wallclock_ - Duration(back);
    }
    av_frame_unref(frame_.get());
    return shot.given.frame.image.empty() ? Came::damaged : Came::frame;
  }

  NetworkOptions options_;
  std::string shown_;
  Patience patience_;  // outlives what asks it
  NetworkFormat format_;
  NetworkCodec codec_;
  AVStream* stream_ = nullptr;
  NetworkPacket packet_{allocated(av_packet_alloc())};
  NetworkFrame frame_{allocated(av_frame_alloc())};
  ImageConverter maker_;
  SourceInfo info_;
  bool wait_for_key_ = true;
  std::optional<Duration> wallclock_;
  std::int64_t wallclock_pts_ = AV_NOPTS_VALUE;
};

}  // namespace

Connect connect_network(const NetworkOptions& options) {
  return [options](LiveTime&, const std::stop_token& stop) -> std::unique_ptr<Connection> {
    return std::make_unique<NetworkStream>(options, stop);
  };
}

}  // namespace marey::source::live
