#include "marey/draw/mp4_file.h"

#include <cstdlib>
#include <filesystem>
#include <utility>

#include "marey/core/error.h"
#include "marey/files/c_deleter.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
#include <libavutil/opt.h>
}

namespace marey::draw {
namespace {

using ReadPacket = std::unique_ptr<AVPacket, CDeleter<AVPacket, av_packet_free>>;

constexpr std::int64_t kFragment = 250'000;  // µs: what a killed program loses, beside what the encoder holds

}  // namespace

void Mp4File::CloseFormat::operator()(AVFormatContext* format) const {
  avio_closep(&format->pb);
  avformat_free_context(format);
}

void Mp4File::CloseInput::operator()(AVFormatContext* format) const {
  avformat_close_input(&format);
}

void Mp4File::FreeParameters::operator()(AVCodecParameters* parameters) const {
  avcodec_parameters_free(&parameters);
}

void Mp4File::IndexSize::add(const AVPacket& packet) {
  const std::int64_t step = packet.dts - last_dts, lag = packet.pts - packet.dts;
  if (step != last_step) ++time_changes;
  if (lag != last_lag) ++time_changes;
  if ((packet.flags & AV_PKT_FLAG_KEY) != 0) ++key_frames;
  ++packets;
  bytes += packet.size;
  last_duration = packet.duration;
  last_dts = packet.dts, last_step = step, last_lag = lag;
}

/// The tables of an MP4: a size of each packet, a run of equal times, a key frame, and the chunks, which FFmpeg joins up to 1 MB:
/// of two that follow each other the sum is more.
std::int64_t Mp4File::IndexSize::bound() const {
  constexpr std::int64_t kHeaders = 4096, kJoined = 1 << 20;
  return kHeaders + 4 * packets + 8 * time_changes + 4 * key_frames + 20 * (2 * bytes / kJoined + 2);
}

Mp4File::Mp4File(const std::string& path, const AVCodecContext& codec, MovieWriter::Keep keep, std::string sound_of)
    : path_(path), keep_(keep), file_(path), sound_of_(std::move(sound_of)), parameters_(allocated(avcodec_parameters_alloc())) {
  check(avcodec_parameters_from_context(parameters_.get(), &codec));
  ticks_a_second_ = codec.time_base.den;
  rate_num_ = codec.framerate.num, rate_den_ = codec.framerate.den;
  fragments_path_ = keep == MovieWriter::Keep::always ? file_.target_path() : file_.temporary_path();
  // What reads an older file of that name continues reading it.
  std::error_code ignored;
  if (keep == MovieWriter::Keep::always) std::filesystem::remove(fragments_path_, ignored);
  fragments_ = open(fragments_path_, *parameters_);
  fragments_->flush_packets = 1;
  av_opt_set(fragments_->priv_data, "movflags", "+delay_moov+default_base_moof", 0);
  av_opt_set_int(fragments_->priv_data, "frag_duration", kFragment, 0);
  check(avformat_write_header(fragments_.get(), nullptr));
}

Mp4File::~Mp4File() {
  if (fragments_ != nullptr && keep_ == MovieWriter::Keep::always) av_write_trailer(fragments_.get());
}

Mp4File::Output Mp4File::open(const std::string& path, const AVCodecParameters& parameters) const {
  AVFormatContext* opened = nullptr;
  check(avformat_alloc_output_context2(&opened, nullptr, "mp4", ("file:" + path).c_str()));
  Output output(opened);
  AVStream* const stream = allocated(avformat_new_stream(opened, nullptr));
  check(avcodec_parameters_copy(stream->codecpar, &parameters));
  stream->codecpar->codec_tag = 0;
  stream->time_base = {1, ticks_a_second_};
  stream->avg_frame_rate = {rate_num_, rate_den_};
  check(avio_open(&opened->pb, opened->url, AVIO_FLAG_WRITE));
  return output;
}

void Mp4File::write(AVPacket& packet) {
  index_.add(packet);
  packet.stream_index = 0;
  av_packet_rescale_ts(&packet, {1, ticks_a_second_}, fragments_->streams[0]->time_base);
  check(av_write_frame(fragments_.get(), &packet));
  check(fragments_->pb->error);
}

void Mp4File::close(Output& output) const {
  check(av_write_trailer(output.get()));
  avio_flush(output->pb);
  check(output->pb->error);
  check(avio_closep(&output->pb));
  output.reset();
}

void Mp4File::finish() {
  close(fragments_);
  const bool directly = keep_ == MovieWriter::Keep::always;
  const std::string ordinary = directly ? file_.temporary_path() : file_.further_temporary_path();
  std::error_code ignored;
  try {
    rewrite(ordinary);
    if (!directly) std::filesystem::rename(ordinary, file_.temporary_path());
  } catch (const std::exception&) {  // no room for both: the fragments are the whole video too, only slower to seek in
    std::filesystem::remove(ordinary, ignored);
    if (directly) return;
  }
  file_.finish();
}

void Mp4File::rewrite(const std::string& to) const {
  const Input input = index_.packets > 0 ? read_fragments() : nullptr;
  // Packets of an MP4 have their lengths before them, and the parameters say so; an encoder's have start codes.
  Output output = open(to, input != nullptr ? *input->streams[0]->codecpar : *parameters_);
  const auto sound = input != nullptr && !sound_of_.empty() ? SoundTrack::of(sound_of_) : nullptr;
  if (sound != nullptr) {
    AVStream* const stream = allocated(avformat_new_stream(output.get(), nullptr));
    check(avcodec_parameters_copy(stream->codecpar, &sound->parameters()));
    stream->codecpar->codec_tag = 0;
    stream->time_base = {1, sound->ticks_a_second()};
    av_opt_set(output->priv_data, "movflags", "+faststart", 0);  // the index's size is known at the end
  } else {
    av_opt_set_int(output->priv_data, "moov_size", index_.bound(), 0);
  }
  check(avformat_write_header(output.get(), nullptr));
  if (input != nullptr) copy_packets(*input, *output, sound.get());
  close(output);
}

Mp4File::Input Mp4File::read_fragments() const {
  AVFormatContext* opened = allocated(avformat_alloc_context());
  opened->flags |= AVFMT_FLAG_NOPARSE | AVFMT_FLAG_NOFILLIN;  // the packets as they were written
  check(avformat_open_input(&opened, ("file:" + fragments_path_).c_str(), av_find_input_format("mp4"), nullptr));
  Input input(opened);
  if (input->nb_streams != 1) throw Error("{}: has no stream", fragments_path_);
  return input;
}

/// The sound up to `until`, in its ticks; `packet` holds the packet read beyond.
void Mp4File::copy_sound(SoundTrack& sound, AVPacket& packet, std::int64_t until, AVFormatContext& output) const {
  for (;;) {
    if (packet.data == nullptr && !sound.next(packet)) return;
    if (packet.dts > until) return;
    packet.pos = -1;
    packet.stream_index = 1;
    av_packet_rescale_ts(&packet, {1, sound.ticks_a_second()}, output.streams[1]->time_base);
    check(av_write_frame(&output, &packet));
    check(output.pb->error);
    av_packet_unref(&packet);
  }
}

void Mp4File::copy_packets(AVFormatContext& input, AVFormatContext& output, SoundTrack* sound) const {
  const ReadPacket packet(allocated(av_packet_alloc())), received(allocated(av_packet_alloc()));
  for (std::int64_t i = 0; i < index_.packets; ++i) {
    check(av_read_frame(&input, packet.get()));
    packet->pos = -1;
    packet->duration = index_.last_duration;  // counts of the last one alone
    av_packet_rescale_ts(packet.get(), input.streams[0]->time_base, output.streams[0]->time_base);
    const std::int64_t shown = packet->dts;
    check(av_write_frame(&output, packet.get()));
    check(output.pb->error);
    av_packet_unref(packet.get());
    if (sound == nullptr) continue;
    const std::int64_t until = av_rescale_q(shown, output.streams[0]->time_base, {1, sound->ticks_a_second()});
    copy_sound(*sound, *received, until, output);
  }
}

void Mp4File::check(int code) const {
  if (code >= 0) return;
  char text[AV_ERROR_MAX_STRING_SIZE] = {};
  av_strerror(code, text, sizeof text);
  throw Error("{}: cannot be written ({})", path_, text);
}

}  // namespace marey::draw
