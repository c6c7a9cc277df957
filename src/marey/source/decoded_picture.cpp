#include "marey/source/decoded_picture.h"

#include <tuple>

#include "marey/core/c_deleter.h"

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

/// Keeps the planes alive for as long as the Picture lives.
std::shared_ptr<const void> share(const AVFrame& decoded) {
  return std::shared_ptr<AVFrame>(allocated(av_frame_clone(&decoded)), FreeFrame());
}

cv::Mat plane(const AVFrame& decoded, int number, int width, int height, int type = CV_8UC1) {
  return {height, width, type, decoded.data[number], static_cast<std::size_t>(decoded.linesize[number])};
}

Picture planes_of(const AVFrame& decoded, Picture::Range range) {
  const int half_width = (decoded.width + 1) / 2;
  const int half_height = (decoded.height + 1) / 2;
  return {plane(decoded, 0, decoded.width, decoded.height), plane(decoded, 1, half_width, half_height),
          plane(decoded, 2, half_width, half_height), range, share(decoded)};
}

Picture grey_of(const AVFrame& decoded, int type) {
  return Picture(plane(decoded, 0, decoded.width, decoded.height, type).clone());
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

/// swscale's context, made anew only when what it depends on changes.
struct PictureMaker::Scaler {
  using Key = std::tuple<int, int, int, int, int, int, bool>;

  ~Scaler() { sws_freeContext(context); }

  SwsContext* get(const Key& wanted) {
    if (context != nullptr && key == wanted) return context;
    sws_freeContext(context);
    key = wanted;
    const auto [width, height, from, to_width, to_height, to, full] = wanted;
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

PictureMaker::PictureMaker() : scaler_(std::make_unique<Scaler>()) {}
PictureMaker::~PictureMaker() = default;

Picture PictureMaker::operator()(const AVFrame& decoded, cv::Size size) {
  const bool full = is_full_range(decoded);
  const bool as_it_is = decoded.linesize[0] > 0 && cv::Size(decoded.width, decoded.height) == size;
  const bool planar = decoded.format == AV_PIX_FMT_YUV420P || decoded.format == AV_PIX_FMT_YUVJ420P;
  if (as_it_is && planar) return turned(planes_of(decoded, full ? Picture::Range::full : Picture::Range::limited));
  if (as_it_is && decoded.format == AV_PIX_FMT_GRAY8) return turned(grey_of(decoded, CV_8UC1));
  if (as_it_is && decoded.format == AV_PIX_FMT_GRAY16LE) return turned(grey_of(decoded, CV_16UC1));
  return turned(converted(decoded, size, full));
}

Picture PictureMaker::converted(const AVFrame& decoded, cv::Size size, bool full_range) {
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
  return planes_of(*result, full && !rgb ? Picture::Range::full : Picture::Range::limited);
}

Picture PictureMaker::turned(const Picture& picture) const {
  if (turn_ == 0 || picture.empty()) return picture;
  const int code = turn_ == 90 ? cv::ROTATE_90_CLOCKWISE : turn_ == 180 ? cv::ROTATE_180 : cv::ROTATE_90_COUNTERCLOCKWISE;
  cv::Mat luma, cb, cr;
  cv::rotate(picture.luma(), luma, code);
  if (!picture.is_colour()) return Picture(luma);
  cv::rotate(picture.cb(), cb, code);
  cv::rotate(picture.cr(), cr, code);
  return {luma, cb, cr, picture.range()};
}

}  // namespace marey::source
