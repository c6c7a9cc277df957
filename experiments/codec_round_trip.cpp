#include "experiments/codec_round_trip.h"

#include <cstdint>
#include <memory>
#include <string>

#include <opencv2/core.hpp>

#include "marey/core/error.h"
#include "marey/files/c_deleter.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavutil/opt.h>
}

namespace marey::experiments {
namespace {

using CodecPtr = std::unique_ptr<AVCodecContext, CDeleter<AVCodecContext, avcodec_free_context>>;
using FramePtr = std::unique_ptr<AVFrame, CDeleter<AVFrame, av_frame_free>>;
using PacketPtr = std::unique_ptr<AVPacket, CDeleter<AVPacket, av_packet_free>>;

constexpr int kRate = 25;
constexpr int kQuiet = AV_LOG_TRACE;  // the log of the host program stays empty

void check(int code) {
  if (code < 0) throw Error("H.264 in memory: error {} of the codec", code);
}

CodecPtr open_encoder(const cv::Size& size, int crf) {
  const AVCodec* encoder = avcodec_find_encoder_by_name("libx264");
  if (encoder == nullptr) throw Error("no encoder libx264 is installed; install FFmpeg's libraries built with x264");
  CodecPtr codec(allocated(avcodec_alloc_context3(encoder)));
  codec->log_level_offset = kQuiet;
  codec->width = size.width;
  codec->height = size.height;
  codec->pix_fmt = AV_PIX_FMT_YUV420P;
  codec->color_range = AVCOL_RANGE_MPEG;
  codec->time_base = {1, kRate};
  codec->framerate = {kRate, 1};
  codec->gop_size = 2 * kRate;
  codec->thread_count = 1;
  av_opt_set(codec->priv_data, "preset", "veryfast", 0);
  av_opt_set(codec->priv_data, "crf", std::to_string(crf).c_str(), 0);
  check(avcodec_open2(codec.get(), encoder, nullptr));
  return codec;
}

CodecPtr open_decoder() {
  const AVCodec* decoder = avcodec_find_decoder(AV_CODEC_ID_H264);
  if (decoder == nullptr) throw Error("no H.264 decoder is installed; install FFmpeg's libraries");
  CodecPtr codec(allocated(avcodec_alloc_context3(decoder)));
  codec->log_level_offset = kQuiet;
  codec->thread_count = 1;
  check(avcodec_open2(codec.get(), decoder, nullptr));
  return codec;
}

class RoundTrip {
 public:
  RoundTrip(const cv::Size& size, int crf) : encoder_(open_encoder(size, crf)), decoder_(open_decoder()) {}

  void encode(const AVFrame* frame) {
    check(avcodec_send_frame(encoder_.get(), frame));
    while (avcodec_receive_packet(encoder_.get(), packet_.get()) >= 0) {
      decode(packet_.get());
      av_packet_unref(packet_.get());
    }
  }

  void decode(const AVPacket* packet) {
    check(avcodec_send_packet(decoder_.get(), packet));
    while (avcodec_receive_frame(decoder_.get(), frame_.get()) >= 0) {
      const cv::Size size(frame_->width, frame_->height), half(size.width / 2, size.height / 2);
      images.emplace_back(plane(0, size), plane(1, half), plane(2, half), Image::Range::limited);
    }
  }

  std::vector<Image> images;

 private:
  cv::Mat plane(int index, const cv::Size& size) const {
    return cv::Mat(size, CV_8UC1, frame_->data[index], static_cast<std::size_t>(frame_->linesize[index])).clone();
  }

  CodecPtr encoder_, decoder_;
  PacketPtr packet_{allocated(av_packet_alloc())};
  FramePtr frame_{allocated(av_frame_alloc())};
};

}  // namespace

std::vector<Image> codec_round_trip(const std::vector<Image>& images, int crf) {
  if (images.empty()) return {};
  RoundTrip codec(images.front().size(), crf);
  for (std::size_t i = 0; i < images.size(); ++i) {
    const FramePtr frame(allocated(av_frame_alloc()));
    const cv::Mat planes[] = {images[i].luma(), images[i].cb(), images[i].cr()};
    frame->format = AV_PIX_FMT_YUV420P;
    frame->width = planes[0].cols;
    frame->height = planes[0].rows;
    frame->pts = static_cast<std::int64_t>(i);
    for (int k = 0; k < 3; ++k) {
      frame->data[k] = planes[k].data;  // the encoder copies frames that it does not own
      frame->linesize[k] = static_cast<int>(planes[k].step);
    }
    codec.encode(frame.get());
  }
  codec.encode(nullptr);
  codec.decode(nullptr);
  if (codec.images.size() != images.size()) {
    throw Error("H.264 in memory: {} of {} frames came back", codec.images.size(), images.size());
  }
  return std::move(codec.images);
}

}  // namespace marey::experiments
