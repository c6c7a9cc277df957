#pragma once

#include <cstdint>
#include <memory>
#include <string>

struct AVCodecParameters;
struct AVFormatContext;
struct AVPacket;

namespace marey::draw {

/// The sound of a film as its packets are, nothing decoded. Times count from the film's first picture.
class SoundTrack {
 public:
  /// Nothing where the film cannot be read, has no sound, or one that an MP4 does not hold.
  static std::unique_ptr<SoundTrack> of(const std::string& film);

  const AVCodecParameters& parameters() const;
  int ticks_a_second() const { return kTicks; }

  /// The next packet, in ticks; those before the first picture are passed over. False at the end.
  bool next(AVPacket& packet);

 private:
  static constexpr int kTicks = 90'000;

  struct Close {
    void operator()(AVFormatContext* format) const;
  };
  SoundTrack() = default;

  std::unique_ptr<AVFormatContext, Close> film_;
  int stream_ = -1;
  std::int64_t begin_ = 0;  // ticks, of the first picture
};

}  // namespace marey::draw
