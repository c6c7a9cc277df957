#include "marey/draw/sound_track.h"

extern "C" {
#include <libavcodec/avcodec.h>
#include <libavformat/avformat.h>
}

namespace marey::draw {

void SoundTrack::Close::operator()(AVFormatContext* format) const {
  avformat_close_input(&format);
}

std::unique_ptr<SoundTrack> SoundTrack::of(const std::string& video) {
  AVFormatContext* opened = nullptr;
  if (avformat_open_input(&opened, ("file:" + video).c_str(), nullptr, nullptr) < 0) return nullptr;
  std::unique_ptr<SoundTrack> sound(new SoundTrack);
  sound->video_.reset(opened);
  if (avformat_find_stream_info(opened, nullptr) < 0) return nullptr;
  const int image = av_find_best_stream(opened, AVMEDIA_TYPE_VIDEO, -1, -1, nullptr, 0);
  sound->stream_ = av_find_best_stream(opened, AVMEDIA_TYPE_AUDIO, -1, image, nullptr, 0);
  if (image < 0 || sound->stream_ < 0) return nullptr;
  const AVOutputFormat* const mp4 = av_guess_format("mp4", nullptr, nullptr);
  if (mp4 == nullptr || avformat_query_codec(mp4, sound->parameters().codec_id, FF_COMPLIANCE_NORMAL) != 1) return nullptr;
  for (unsigned i = 0; i < opened->nb_streams; ++i) {
    if (static_cast<int>(i) != sound->stream_) opened->streams[i]->discard = AVDISCARD_ALL;
  }
  const AVStream& shown = *opened->streams[image];
  if (shown.start_time != AV_NOPTS_VALUE) sound->begin_ = av_rescale_q(shown.start_time, shown.time_base, {1, kTicks});
  return sound;
}

const AVCodecParameters& SoundTrack::parameters() const {
  return *video_->streams[stream_]->codecpar;
}

bool SoundTrack::next(AVPacket& packet) {
  while (av_read_frame(video_.get(), &packet) >= 0) {
    if (packet.stream_index == stream_ && packet.pts != AV_NOPTS_VALUE) {
      av_packet_rescale_ts(&packet, video_->streams[stream_]->time_base, {1, kTicks});
      packet.pts -= begin_;
      packet.dts = packet.dts == AV_NOPTS_VALUE ? packet.pts : packet.dts - begin_;
      if (packet.pts >= 0 && packet.dts >= 0) return true;
    }
    av_packet_unref(&packet);
  }
  return false;
}

}  // namespace marey::draw
