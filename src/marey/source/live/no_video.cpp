// What stands in for FFmpeg and libjpeg-turbo where the library is built without them (MAREY_FFMPEG=OFF, as for the Python wheel).
#include "marey/core/error.h"
#include "marey/source/live/jpeg_decoder.h"
#include "marey/source/live/network_stream.h"

namespace marey::source::live {

Connect connect_network(const NetworkOptions& options) {
  throw Error("{}: cameras on a network are read by FFmpeg, which this build of Marey is without", options.url);
}

struct JpegDecoder::Parts {};

JpegDecoder::JpegDecoder() = default;
JpegDecoder::~JpegDecoder() = default;

Image JpegDecoder::decode(std::span<const std::uint8_t>) {
  throw Error("this camera sends JPEG images, which this build of Marey cannot decode: ask it for raw ones");
}

}  // namespace marey::source::live
