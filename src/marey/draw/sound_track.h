#pragma once

#include <cstdint>
#include <memory>
#include <string>

struct AVCodecParameters;
struct AVFormatContext;
struct AVPacket;

namespace marey::draw {

/// The sound of a video as its packets are, nothing decoded. Times count from the video's first image.
class SoundTrack {
 public:
  /// Nothing if the video cannot be read, has no sound, or one that an MP4 does not hold.
  static std::unique_ptr<SoundTrack> of(const std::string& video);

  const AVCodecParameters& parameters() const;
  int ticks_a_second() const { return kTicks; }

  /// The next packet, in ticks; those before the first image are skipped. False at the end.
  bool next(AVPacket& packet);

 private:
  static constexpr int kTicks = 90'000;

  struct Close {
    void operator()(AVFormatContext* format) const;
  };
  SoundTrack() = default;

  std::unique_ptr<AVFormatContext, Close> video_;
  int stream_ = -1;
  std::int64_t begin_ = 0;  // ticks, of the first image
};

}  // namespace marey::draw
