// OpenCV's reader is not used because it converts every image to BGR (half of the decoding time of a large one), counts
// time as index / rate, does not specify a file that ends from one that breaks off, and loads 244 shared libraries.
#include "marey/source/decoder.h"

#include <cmath>
#include <filesystem>
#include <new>
#include <vector>

#include <tbb/global_control.h>

#include "marey/core/error.h"
#include "marey/files/c_deleter.h"
#include "marey/files/input_file.h"
#include "marey/files/limits.h"
#include "marey/source/decoded_image.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/display.h>
}

namespace marey::source {
namespace {

using FormatPtr = std::unique_ptr<AVFormatContext, CDeleter<AVFormatContext, avformat_close_input>>;
using CodecPtr = std::unique_ptr<AVCodecContext, CDeleter<AVCodecContext, avcodec_free_context>>;
using DecodedFrame = std::unique_ptr<AVFrame, CDeleter<AVFrame, av_frame_free>>;
using PacketPtr = std::unique_ptr<AVPacket, CDeleter<AVPacket, av_packet_free>>;

/// A decoder that is out of packets may refuse this many images in a row before it is given up.
constexpr int kMaxErrorsWhileDraining = 64;

std::string reason(int code) {
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(code, text, sizeof text);
  return text;
}

/// A video that memory is missing for is not a damaged one.
void check_memory(int code) {
  if (code == AVERROR(ENOMEM)) throw std::bad_alloc();
}

/// Degrees clockwise that a camera held askew asks its images to be turned by: 0, 90, 180 or 270.
int turn_of(const AVStream& stream) {
  std::size_t size = 0;
  const std::uint8_t* data = av_stream_get_side_data(&stream, AV_PKT_DATA_DISPLAYMATRIX, &size);
  if (data == nullptr || size < 9 * sizeof(std::int32_t)) return 0;
  const double counter_clockwise = av_display_rotation_get(reinterpret_cast<const std::int32_t*>(data));
  if (!std::isfinite(counter_clockwise)) return 0;
  const int quarters = static_cast<int>(std::lround(-counter_clockwise / 90.0));
  return ((quarters % 4 + 4) % 4) * 90;
}

/// What is not a file, for FFmpeg: its own reading could not be left while a writer is silent.
class PipeBytes {
 public:
  explicit PipeBytes(const std::string& path) : file_(path) {
    auto* const buffer = static_cast<unsigned char*>(allocated(av_malloc(kBuffer)));
    io_.reset(allocated(avio_alloc_context(buffer, kBuffer, 0, this, read, nullptr, nullptr)));
    io_->seekable = 0;
  }

  AVIOContext* io() { return io_.get(); }
  bool stopped() const { return stopped_; }

 private:
  static constexpr int kBuffer = 1 << 16;

  static int read(void* self, std::uint8_t* to, int maximum) {
    auto& pipe = *static_cast<PipeBytes*>(self);
    try {
      const std::size_t got = pipe.file_.read({reinterpret_cast<char*>(to), static_cast<std::size_t>(maximum)});
      return got > 0 ? static_cast<int>(got) : AVERROR_EOF;
    } catch (const Stopped&) {
      pipe.stopped_ = true;
      return AVERROR_EXIT;
    } catch (const Error&) {
      return AVERROR(EIO);
    }
  }

  struct FreeIo {
    void operator()(AVIOContext* io) const {
      av_freep(static_cast<void*>(&io->buffer));
      avio_context_free(&io);
    }
  };

  InputFile file_;
  bool stopped_ = false;
  std::unique_ptr<AVIOContext, FreeIo> io_;
};

std::unique_ptr<PipeBytes> pipe_of(const std::string& path) {
  std::error_code error;
  const auto status = std::filesystem::status(path, error);
  if (!std::filesystem::exists(status) || std::filesystem::is_regular_file(status) || std::filesystem::is_directory(status))
    return {};
  return std::make_unique<PipeBytes>(path);
}

FormatPtr open_format(const std::string& path, PipeBytes* pipe) {
  AVFormatContext* opened = nullptr;
  if (pipe != nullptr) {
    opened = allocated(avformat_alloc_context());
    opened->pb = pipe->io();
  }
  // "file:" keeps FFmpeg from reading a protocol out of a name that holds a colon.
  if (const int code = avformat_open_input(&opened, ("file:" + path).c_str(), nullptr, nullptr); code < 0) {
    if (pipe != nullptr && pipe->stopped()) throw Stopped();
    throw Error("{}: cannot be read as a video ({}); it is of another kind, damaged, or was cut off before its index was written",
                path, reason(code));
  }
  return FormatPtr(opened);
}

std::int64_t largest_image() {
  return static_cast<std::int64_t>(Limits::in_force().image_px);
}

void check_size(const cv::Size& size, const std::string& path) {
  if (std::int64_t{size.width} * size.height <= largest_image()) return;
  throw Error("{}: its images have {} x {} px, more than {} in all (the limit picture_px); make them smaller first", path,
              size.width, size.height, largest_image());
}

/// Which streams there are. It decodes their first images, within the limit.
int find_streams(AVFormatContext& format) {
  std::vector<AVDictionary*> options(format.nb_streams, nullptr);
  for (AVDictionary*& each : options) av_dict_set_int(&each, "max_pixels", largest_image(), 0);
  const int code = avformat_find_stream_info(&format, options.data());
  for (AVDictionary*& each : options) av_dict_free(&each);
  return code;
}

struct FreeTags {
  void operator()(AVDictionary* tags) const { av_dict_free(&tags); }
};

}  // namespace

struct Decoder::Parts {
  std::unique_ptr<PipeBytes> pipe;  // outlives what reads it
  FormatPtr format;
  CodecPtr codec;
  AVStream* stream = nullptr;
  PacketPtr packet{allocated(av_packet_alloc())};
  DecodedFrame frame{allocated(av_frame_alloc())};
  ImageConverter maker;
  cv::Size coded_size;
  int turn = 0;
  bool drained = false;
  int errors_while_draining = 0;
  Trouble trouble;
  std::unique_ptr<AVDictionary, FreeTags> image_tags;  ///< of the first decoded image
  bool any_decoded = false;

  bool receive();
  void feed();
};

Decoder::Decoder(const std::string& path, int threads) : parts_(std::make_unique<Parts>()) {
  Parts& p = *parts_;
  p.pipe = pipe_of(path);
  p.format = open_format(path, p.pipe.get());
  const int streams = find_streams(*p.format);
  if (p.pipe != nullptr && p.pipe->stopped()) throw Stopped();
  if (const int code = streams; code < 0) {
    throw Error("{}: cannot be read as a video ({}); the file may be damaged", path, reason(code));
  }
  const AVCodec* codec = nullptr;
  const int stream = av_find_best_stream(p.format.get(), AVMEDIA_TYPE_VIDEO, -1, -1, &codec, 0);
  if (stream < 0 || codec == nullptr)
    throw Error("{}: holds no video that can be decoded; give a video file or a folder of images", path);
  p.stream = p.format->streams[stream];
  check_size({p.stream->codecpar->width, p.stream->codecpar->height}, path);
  p.codec.reset(allocated(avcodec_alloc_context3(codec)));
  avcodec_parameters_to_context(p.codec.get(), p.stream->codecpar);
  p.codec->log_level_offset = AV_LOG_TRACE;  // what is damaged is counted; the host program's log gets nothing of ours
  const std::size_t allowed = tbb::global_control::active_value(tbb::global_control::max_allowed_parallelism);
  p.codec->thread_count = threads > 0 ? threads : static_cast<int>(allowed);
  p.codec->max_pixels = largest_image();  // of images that change their size later too
  if (const int code = avcodec_open2(p.codec.get(), codec, nullptr); code < 0) {
    throw Error("{}: its video ({}) cannot be decoded ({})", path, codec->long_name, reason(code));
  }
  p.coded_size = {p.codec->width, p.codec->height};
  if (p.coded_size.width <= 0 || p.coded_size.height <= 0) {
    throw Error("{}: cannot be read as a video (its images have no size, or more than {} px in all: the limit picture_px)", path,
                largest_image());
  }
  check_size(p.coded_size, path);
  p.turn = turn_of(*p.stream);
  p.maker.turn_by(p.turn);
}

Decoder::~Decoder() = default;

cv::Size Decoder::size() const {
  const cv::Size coded = parts_->coded_size;
  return parts_->turn % 180 == 0 ? coded : cv::Size(coded.height, coded.width);
}

std::optional<double> Decoder::rate_hz() const {
  const AVRational guess = av_guess_frame_rate(parts_->format.get(), parts_->stream, nullptr);
  if (guess.num <= 0 || guess.den <= 0) return std::nullopt;
  return av_q2d(guess);
}

std::optional<std::int64_t> Decoder::frame_count() const {
  if (parts_->stream->nb_frames > 0) return parts_->stream->nb_frames;
  return std::nullopt;
}

std::optional<double> Decoder::duration_s() const {
  const auto rate = rate_hz();
  if (const auto count = frame_count(); count && rate) return static_cast<double>(*count) / *rate;
  const AVFormatContext& format = *parts_->format;
  if (format.duration > 0 && format.duration_estimation_method == AVFMT_DURATION_FROM_STREAM) {
    return static_cast<double>(format.duration) / AV_TIME_BASE;
  }
  return std::nullopt;
}

std::optional<std::string> Decoder::tag(const char* name) const {
  for (const AVDictionary* tags : {parts_->format->metadata, parts_->stream->metadata, parts_->image_tags.get()}) {
    if (const AVDictionaryEntry* entry = av_dict_get(tags, name, nullptr, 0)) return entry->value;
  }
  return std::nullopt;
}

const Decoder::Trouble& Decoder::trouble() const {
  return parts_->trouble;
}

std::optional<Decoder::Decoded> Decoder::next() {
  Parts& p = *parts_;
  while (p.receive()) {
    if (p.frame->decode_error_flags != 0 || (p.frame->flags & AV_FRAME_FLAG_CORRUPT) != 0) ++p.trouble.damaged;
    if (cv::Size(p.frame->width, p.frame->height) != p.coded_size) ++p.trouble.rescaled;
    if (!std::exchange(p.any_decoded, true)) p.image_tags.reset(std::exchange(p.frame->metadata, nullptr));
    Decoded result{p.maker(*p.frame, p.coded_size), std::nullopt};
    if (const std::int64_t stamp = p.frame->best_effort_timestamp; stamp != AV_NOPTS_VALUE) {
      result.stamp_ns = av_rescale_q(stamp, p.stream->time_base, AVRational{1, 1'000'000'000});
    }
    av_frame_unref(p.frame.get());
    if (!result.image.empty()) return result;
    ++p.trouble.undecodable;
  }
  return std::nullopt;
}

/// Puts the next decoded image into `frame`; false at the end.
bool Decoder::Parts::receive() {
  for (;;) {
    const int code = avcodec_receive_frame(codec.get(), frame.get());
    if (code == 0) return true;
    if (code == AVERROR_EOF) return false;
    check_memory(code);
    if (code != AVERROR(EAGAIN)) ++trouble.undecodable;
    if (drained && ++errors_while_draining > kMaxErrorsWhileDraining) return false;
    if (!drained) feed();
  }
}

/// Gives the decoder one more packet of the stream, or reports to it that there are no more.
void Decoder::Parts::feed() {
  for (;;) {
    av_packet_unref(packet.get());
    const int code = av_read_frame(format.get(), packet.get());
    check_memory(code);
    if (code < 0) {
      trouble.stopped = pipe != nullptr && pipe->stopped();
      if (code != AVERROR_EOF && !trouble.stopped) trouble.broken = reason(code);
      avcodec_send_packet(codec.get(), nullptr);
      drained = true;
      return;
    }
    if (packet->stream_index != stream->index || packet->size == 0) continue;
    const int sent = avcodec_send_packet(codec.get(), packet.get());
    if (sent == 0) return;
    check_memory(sent);
    ++trouble.undecodable;
  }
}

}  // namespace marey::source
