#include "marey/draw/movie_writer.h"

#include <algorithm>
#include <cmath>
#include <filesystem>
#include <string_view>

#include <opencv2/imgproc.hpp>

#include "marey/core/error.h"
#include "marey/core/time.h"
#include "marey/draw/mp4_file.h"
#include "marey/files/c_deleter.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/opt.h>
}

namespace marey::draw {
namespace {

namespace fs = std::filesystem;

using CodecPtr = std::unique_ptr<AVCodecContext, CDeleter<AVCodecContext, avcodec_free_context>>;
using FramePtr = std::unique_ptr<AVFrame, CDeleter<AVFrame, av_frame_free>>;
using PacketPtr = std::unique_ptr<AVPacket, CDeleter<AVPacket, av_packet_free>>;

constexpr AVRational kTick{1, 90'000};
constexpr int kSilent = AV_LOG_TRACE;        // the host program's log gets nothing of ours
constexpr int kThreads = 4;                  // x264 writes other bytes for another number, and holds a frame back for each
constexpr double kSlow = 10;                 // Hz: a recording of fewer frames is encoded by one thread, which holds none back
constexpr int kSecondsBetweenKeyFrames = 2;  // a player seeks to these

std::string reason(int code) {
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(code, text, sizeof text);
  return text;
}

}  // namespace

struct MovieWriter::Parts {
  std::string path;
  CodecPtr codec;
  std::optional<Mp4File> file;
  PacketPtr packet{allocated(av_packet_alloc())};
  std::int64_t last_tick = -1;
  std::int64_t ticks_a_frame = 0;
  std::int64_t frames = 0, packets = 0;

  void open_codec(cv::Size size, double rate, Quality quality);
  void encode(const AVFrame* frame);
  void check(int code) const {
    if (code < 0) throw Error("{}: cannot be written ({})", path, reason(code));
  }
};

void MovieWriter::Parts::open_codec(cv::Size size, double rate, Quality quality) {
  const AVCodec* encoder = avcodec_find_encoder_by_name("libx264");
  if (encoder == nullptr) encoder = avcodec_find_encoder(AV_CODEC_ID_H264);
  if (encoder == nullptr)
    throw Error("{}: FFmpeg's libraries have no H.264 encoder; install ones built with x264 or OpenH264", path);
  codec.reset(allocated(avcodec_alloc_context3(encoder)));
  codec->log_level_offset = kSilent;
  codec->width = (size.width + 1) & ~1;  // 4:2:0 wants even sides
  codec->height = (size.height + 1) & ~1;
  codec->pix_fmt = AV_PIX_FMT_YUV420P;
  codec->color_range = AVCOL_RANGE_MPEG;
  codec->time_base = kTick;
  codec->framerate = av_d2q(rate, 1'000'000);
  codec->gop_size = std::max(1, static_cast<int>(std::lround(kSecondsBetweenKeyFrames * rate)));
  codec->thread_count = quality == Quality::to_record && rate < kSlow ? 1 : kThreads;
  codec->flags |= AV_CODEC_FLAG_GLOBAL_HEADER;
  // Fast enough that the video is not what one waits for.
  const int quantizer = quality == Quality::to_view ? 22 : 8;
  if (std::string_view(encoder->name) == "libopenh264") {
    codec->qmin = codec->qmax = quantizer;
    codec->profile = FF_PROFILE_H264_HIGH;
  } else {
    av_opt_set(codec->priv_data, "preset", quality == Quality::to_record ? "ultrafast" : "superfast", 0);
    av_opt_set(codec->priv_data, "crf", std::to_string(quantizer).c_str(), 0);
  }
  if (const int code = avcodec_open2(codec.get(), encoder, nullptr); code < 0) {
    throw Error("{}: the H.264 encoder ({}) cannot encode {} x {} pixels ({})", path, encoder->name, size.width, size.height,
                reason(code));
  }
}

/// A null frame asks for what the encoder still holds.
void MovieWriter::Parts::encode(const AVFrame* frame) {
  check(avcodec_send_frame(codec.get(), frame));
  for (;;) {
    const int code = avcodec_receive_packet(codec.get(), packet.get());
    if (code == AVERROR(EAGAIN) || code == AVERROR_EOF) return;
    check(code);
    packet->duration = ticks_a_frame;
    file->write(*packet);
    ++packets;
    av_packet_unref(packet.get());
  }
}

MovieWriter::MovieWriter(const std::string& path, cv::Size size, std::optional<double> rate_hz, Quality quality, Keep keep,
                         const std::string& sound_of)
    : parts_(std::make_unique<Parts>()) {
  std::error_code error;
  if (fs::exists(path, error) && !fs::is_regular_file(path, error))
    throw Error("{}: is not a place for a video; name a file", path);
  parts_->path = path;
  const double rate = rate_hz.value_or(kDefaultRate);
  parts_->ticks_a_frame = std::max<std::int64_t>(1, std::llround(kTick.den / rate));
  parts_->open_codec(size, rate, quality);
  parts_->file.emplace(path, *parts_->codec, keep, sound_of);
}

MovieWriter::~MovieWriter() = default;

void MovieWriter::write(const Image& image, Timestamp time) {
  Parts& p = *parts_;
  const FramePtr frame(allocated(av_frame_alloc()));
  frame->format = p.codec->pix_fmt;
  frame->width = p.codec->width;
  frame->height = p.codec->height;
  const std::int64_t tick = std::llround(seconds(time) * kTick.den);
  frame->pts = p.last_tick = std::max(tick, p.last_tick + 1);
  cv::Mat luma = image.luma();
  if (luma.cols != frame->width || luma.rows != frame->height) {
    cv::copyMakeBorder(image.luma(), luma, 0, frame->height - luma.rows, 0, frame->width - luma.cols, cv::BORDER_REPLICATE);
  }
  const cv::Mat* planes[] = {&luma, &image.cb(), &image.cr()};
  for (int i = 0; i < 3; ++i) {
    frame->data[i] = planes[i]->data;  // the encoder copies what it does not own
    frame->linesize[i] = static_cast<int>(planes[i]->step);
  }
  p.encode(frame.get());
  ++p.frames;
}

void MovieWriter::finish() {
  Parts& p = *parts_;
  p.encode(nullptr);
  // x264 keeps frames for itself without a word where it found no memory for its threads.
  if (p.packets != p.frames)
    throw Error("{}: the encoder returned {} of {} frames; memory is short here", p.path, p.packets, p.frames);
  p.file->finish();
}

}  // namespace marey::draw
