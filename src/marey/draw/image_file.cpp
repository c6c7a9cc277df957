#include "marey/draw/image_file.h"

#include <cstdint>
#include <filesystem>
#include <memory>

#include <opencv2/imgproc.hpp>

#include "marey/core/error.h"
#include "marey/files/c_deleter.h"
#include "marey/files/whole_file.h"

extern "C" {
#include <libavcodec/avcodec.h>
}

namespace marey::draw {
namespace {

using CodecPtr = std::unique_ptr<AVCodecContext, CDeleter<AVCodecContext, avcodec_free_context>>;
using FramePtr = std::unique_ptr<AVFrame, CDeleter<AVFrame, av_frame_free>>;
using PacketPtr = std::unique_ptr<AVPacket, CDeleter<AVPacket, av_packet_free>>;

constexpr int kJpegQuality = 2;  // FFmpeg's scale: 2 is the best that is worth its bytes

bool stays_grey(const Image& image) {
  return !image.is_colour() && image.luma().type() == CV_8UC1;
}

bool is_deep_grey(const Image& image) {
  return !image.is_colour() && image.luma().type() == CV_16UC1;
}

/// PNG's 16 bits are big-endian.
cv::Mat swapped_bytes(const cv::Mat& deep) {
  cv::Mat swapped(deep.size(), CV_16UC1);
  for (int y = 0; y < deep.rows; ++y) {
    for (int x = 0; x < deep.cols; ++x) {
      const unsigned value = deep.at<std::uint16_t>(y, x);
      swapped.at<std::uint16_t>(y, x) = static_cast<std::uint16_t>(value << 8 | value >> 8);
    }
  }
  return swapped;
}

AVPixelFormat pixels_of(const Image& image, bool jpeg) {
  if (jpeg) return AV_PIX_FMT_YUVJ420P;
  if (is_deep_grey(image)) return AV_PIX_FMT_GRAY16BE;
  return stays_grey(image) ? AV_PIX_FMT_GRAY8 : AV_PIX_FMT_RGB24;
}

/// The planes that the encoder wants, in the order of AVFrame::data.
std::vector<cv::Mat> planes_of(const Image& image, bool jpeg) {
  if (!jpeg && stays_grey(image)) return {image.luma()};
  if (!jpeg && is_deep_grey(image)) return {swapped_bytes(image.luma())};
  const cv::Mat bgr = image.bgr();
  cv::Mat converted;
  if (!jpeg) {
    cv::cvtColor(bgr, converted, cv::COLOR_BGR2RGB);
    return {converted};
  }
  cv::cvtColor(bgr, converted, cv::COLOR_BGR2YCrCb);  // full range, as JPEG has it
  std::vector<cv::Mat> planes;
  cv::split(converted, planes);
  const cv::Size half((bgr.cols + 1) / 2, (bgr.rows + 1) / 2);
  cv::Mat cb, cr;
  cv::resize(planes[2], cb, half, 0, 0, cv::INTER_AREA);
  cv::resize(planes[1], cr, half, 0, 0, cv::INTER_AREA);
  return {planes[0], cb, cr};
}

}  // namespace

void write_image(const std::string& path, const Image& image) {
  namespace fs = std::filesystem;
  const std::string ending = fs::path(path).extension().string();
  const bool jpeg = ending == ".jpg" || ending == ".jpeg";
  const std::vector<cv::Mat> planes = planes_of(image, jpeg);
  const AVCodec* encoder = avcodec_find_encoder(jpeg ? AV_CODEC_ID_MJPEG : AV_CODEC_ID_PNG);
  if (encoder == nullptr) throw Error("{}: FFmpeg was built without an encoder for {}", path, jpeg ? "JPEG" : "PNG");
  const CodecPtr codec(allocated(avcodec_alloc_context3(encoder)));
  codec->log_level_offset = AV_LOG_TRACE;  // the host program's log gets nothing of ours
  codec->width = image.size().width;
  codec->height = image.size().height;
  codec->pix_fmt = pixels_of(image, jpeg);
  codec->color_range = AVCOL_RANGE_JPEG;
  codec->time_base = {1, 25};
  if (jpeg) {
    codec->flags |= AV_CODEC_FLAG_QSCALE;
    codec->global_quality = FF_QP2LAMBDA * kJpegQuality;
  }
  const FramePtr frame(allocated(av_frame_alloc()));
  const PacketPtr packet(allocated(av_packet_alloc()));
  frame->format = codec->pix_fmt;
  frame->width = codec->width;
  frame->height = codec->height;
  frame->quality = codec->global_quality;
  for (std::size_t i = 0; i < planes.size(); ++i) {
    frame->data[i] = planes[i].data;
    frame->linesize[i] = static_cast<int>(planes[i].step);
  }
  if (avcodec_open2(codec.get(), encoder, nullptr) < 0 || avcodec_send_frame(codec.get(), frame.get()) < 0 ||
      avcodec_send_frame(codec.get(), nullptr) < 0 || avcodec_receive_packet(codec.get(), packet.get()) < 0)
    throw Error("{}: an image of {} x {} pixels cannot be encoded", path, codec->width, codec->height);
  WholeFile file(path);
  file.write({reinterpret_cast<const char*>(packet->data), static_cast<std::size_t>(packet->size)});
  file.finish();
}

}  // namespace marey::draw
