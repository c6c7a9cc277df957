#include "marey/source/live/jpeg_decoder.h"

#include <cstring>

#include "marey/files/c_deleter.h"
#include "marey/files/limits.h"
#include "marey/source/decoded_image.h"

extern "C" {
#include <libavcodec/avcodec.h>
}

namespace marey::source::live {

struct JpegDecoder::Parts {
  std::unique_ptr<AVCodecContext, CDeleter<AVCodecContext, avcodec_free_context>> codec;
  std::unique_ptr<AVPacket, CDeleter<AVPacket, av_packet_free>> packet{allocated(av_packet_alloc())};
  std::unique_ptr<AVFrame, CDeleter<AVFrame, av_frame_free>> frame{allocated(av_frame_alloc())};
  ImageConverter maker;
};

JpegDecoder::JpegDecoder() : parts_(std::make_unique<Parts>()) {
  const AVCodec* codec = avcodec_find_decoder(AV_CODEC_ID_MJPEG);
  parts_->codec.reset(allocated(avcodec_alloc_context3(codec)));
  parts_->codec->thread_count = 1;  // frame threads would add a frame of delay each
  parts_->codec->max_pixels = static_cast<std::int64_t>(Limits::in_force().image_px);
  parts_->codec->log_level_offset = AV_LOG_TRACE;
  if (avcodec_open2(parts_->codec.get(), codec, nullptr) < 0) parts_->codec.reset();
}

JpegDecoder::~JpegDecoder() = default;

Image JpegDecoder::decode(std::span<const std::uint8_t> bytes) {
  Parts& p = *parts_;
  if (p.codec == nullptr || bytes.empty()) return {};
  if (av_new_packet(p.packet.get(), static_cast<int>(bytes.size())) < 0) return {};
  std::memcpy(p.packet->data, bytes.data(), bytes.size());
  const int sent = avcodec_send_packet(p.codec.get(), p.packet.get());
  av_packet_unref(p.packet.get());
  if (sent < 0 || avcodec_receive_frame(p.codec.get(), p.frame.get()) < 0) return {};
  const bool whole = p.frame->decode_error_flags == 0 && (p.frame->flags & AV_FRAME_FLAG_CORRUPT) == 0;
  Image image = whole ? p.maker(*p.frame, {p.frame->width, p.frame->height}) : Image();
  av_frame_unref(p.frame.get());
  return image;
}

}  // namespace marey::source::live
