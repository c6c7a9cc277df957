#include "marey/source/decoded_image.h"

#include <tuple>

#include "marey/files/c_deleter.h"

extern "C" {
#include <libavutil/frame.h>
#include <libavutil/pixdesc.h>
#include <libswscale/swscale.h>
}

namespace marey::source {
namespace {

struct FreeFrame {
  void operator()(AVFrame* frame) const { av_frame_free(&frame); }
};
using ScaledFrame = std::unique_ptr<AVFrame, FreeFrame>;

/// Keeps the planes alive for as long as the Image lives.
std::shared_ptr<const void> fraction(const AVFrame& decoded) {
  return std::shared_ptr<AVFrame>(allocated(av_frame_clone(&decoded)), FreeFrame());
}

cv::Mat plane(const AVFrame& decoded, int number, int width, int height, int type = CV_8UC1) {
  return {height, width, type, decoded.data[number], static_cast<std::size_t>(decoded.linesize[number])};
}

Image planes_of(const AVFrame& decoded, Image::Range range) {
  const int half_width = (decoded.width + 1) / 2;
  const int half_height = (decoded.height + 1) / 2;
  return {plane(decoded, 0, decoded.width, decoded.height), plane(decoded, 1, half_width, half_height),
          plane(decoded, 2, half_width, half_height), range, fraction(decoded)};
}

Image grey_of(const AVFrame& decoded, int type) {
  return Image(plane(decoded, 0, decoded.width, decoded.height, type).clone());
}

/// The old YUVJ formats mean "full range" by their name.
bool is_full_range(const AVFrame& decoded) {
  switch (decoded.format) {
    case AV_PIX_FMT_YUVJ420P:
    case AV_PIX_FMT_YUVJ422P:
    case AV_PIX_FMT_YUVJ444P:
    case AV_PIX_FMT_YUVJ440P:
    case AV_PIX_FMT_YUVJ411P:
      return true;
    default:
      return decoded.color_range == AVCOL_RANGE_JPEG;
  }
}

}  // namespace

/// swscale's context, made again only when what it depends on changes.
struct ImageConverter::Scaler {
  using Key = std::tuple<int, int, int, int, int, int, bool>;

  ~Scaler() { sws_freeContext(context); }

  SwsContext* get(const Key& required) {
    if (context != nullptr && key == required) return context;
    sws_freeContext(context);
    key = required;
    const auto [width, height, from, to_width, to_height, to, full] = required;
    context = sws_getContext(width, height, static_cast<AVPixelFormat>(from), to_width, to_height, static_cast<AVPixelFormat>(to),
                             SWS_BILINEAR, nullptr, nullptr, nullptr);
    if (context == nullptr) return nullptr;
    const AVPixFmtDescriptor* source = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(from));
    const bool rgb = source != nullptr && (source->flags & AV_PIX_FMT_FLAG_RGB) != 0;
    const int* bt601 = sws_getCoefficients(SWS_CS_ITU601);
    // RGB becomes limited range; everything else keeps the range it has.
    sws_setColorspaceDetails(context, bt601, rgb || full ? 1 : 0, bt601, !rgb && full ? 1 : 0, 0, 1 << 16, 1 << 16);
    return context;
  }

  SwsContext* context = nullptr;
  Key key;
};

ImageConverter::ImageConverter() : scaler_(std::make_unique<Scaler>()) {}
ImageConverter::~ImageConverter() = default;

Image ImageConverter::operator()(const AVFrame& decoded, cv::Size size) {
  const bool full = is_full_range(decoded);
  const bool as_it_is = decoded.linesize[0] > 0 && cv::Size(decoded.width, decoded.height) == size;
  const bool planar = decoded.format == AV_PIX_FMT_YUV420P || decoded.format == AV_PIX_FMT_YUVJ420P;
  if (as_it_is && planar) return rotated(planes_of(decoded, full ? Image::Range::full : Image::Range::limited));
  if (as_it_is && decoded.format == AV_PIX_FMT_GRAY8) return rotated(grey_of(decoded, CV_8UC1));
  if (as_it_is && decoded.format == AV_PIX_FMT_GRAY16LE) return rotated(grey_of(decoded, CV_16UC1));
  return rotated(converted(decoded, size, full));
}

Image ImageConverter::converted(const AVFrame& decoded, cv::Size size, bool full_range) {
  const AVPixFmtDescriptor* description = av_pix_fmt_desc_get(static_cast<AVPixelFormat>(decoded.format));
  if (description == nullptr) return {};
  const bool grey = description->nb_components <= 2;
  const bool deep = grey && description->comp[0].depth > 8;
  const AVPixelFormat target = deep ? AV_PIX_FMT_GRAY16LE : grey ? AV_PIX_FMT_GRAY8 : AV_PIX_FMT_YUV420P;
  const bool full = full_range && !grey;
  SwsContext* scaler = scaler_->get({decoded.width, decoded.height, decoded.format, size.width, size.height, target, full});
  if (scaler == nullptr) return {};
  const ScaledFrame result(allocated(av_frame_alloc()));
  result->format = target;
  result->width = size.width;
  result->height = size.height;
  if (av_frame_get_buffer(result.get(), 0) < 0) return {};
  if (sws_scale(scaler, decoded.data, decoded.linesize, 0, decoded.height, result->data, result->linesize) <= 0) return {};
  if (grey) return grey_of(*result, deep ? CV_16UC1 : CV_8UC1);
  const bool rgb = (description->flags & AV_PIX_FMT_FLAG_RGB) != 0;
  return planes_of(*result, full && !rgb ? Image::Range::full : Image::Range::limited);
}

Image ImageConverter::rotated(const Image& image) const {
  if (turn_ == 0 || image.empty()) return image;
  const int code = turn_ == 90 ? cv::ROTATE_90_CLOCKWISE : turn_ == 180 ? cv::ROTATE_180 : cv::ROTATE_90_COUNTERCLOCKWISE;
  cv::Mat luma, cb, cr;
  cv::rotate(image.luma(), luma, code);
  if (!image.is_colour()) return Image(luma);
  cv::rotate(image.cb(), cb, code);
  cv::rotate(image.cr(), cr, code);
  return {luma, cb, cr, image.range()};
}

}  // namespace marey::source
