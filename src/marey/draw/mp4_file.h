#pragma once

#include <cstdint>
#include <memory>
#include <string>

#include "marey/draw/movie_writer.h"
#include "marey/draw/sound_track.h"
#include "marey/files/whole_file.h"

struct AVCodecContext;
struct AVCodecParameters;
struct AVFormatContext;
struct AVPacket;

namespace marey::draw {

/// One stream of H.264 in an MP4, and in the finished one a video's sound beside it. It is written as fragments of a quarter of a
/// second, so that at any time the output can be read; `finish` rewrites it without encoding again as an ordinary MP4 whose
/// index comes first.
class Mp4File {
 public:
  /// `codec` is open; `sound_of` is a video whose sound goes along, empty: none. Throws Error if the file cannot be written.
  Mp4File(const std::string& path, const AVCodecContext& codec, MovieWriter::Keep keep, std::string sound_of = {});
  /// Without `finish`, keeps the fragments or removes them.
  ~Mp4File();
  Mp4File(const Mp4File&) = delete;
  Mp4File& operator=(const Mp4File&) = delete;

  /// Times are in the codec's time base, `duration` too. Throws Error if the disk is full.
  void write(AVPacket& packet);
  void finish();

 private:
  struct CloseFormat {
    void operator()(AVFormatContext* format) const;
  };
  struct CloseInput {
    void operator()(AVFormatContext* format) const;
  };
  struct FreeParameters {
    void operator()(AVCodecParameters* parameters) const;
  };
  using Output = std::unique_ptr<AVFormatContext, CloseFormat>;
  using Input = std::unique_ptr<AVFormatContext, CloseInput>;

  /// Of the ordinary MP4's index, an upper bound.
  struct IndexSize {
    std::int64_t packets = 0, key_frames = 0, time_changes = 0, bytes = 0;
    std::int64_t last_duration = 0, last_dts = 0, last_step = 0, last_lag = 0;

    void add(const AVPacket& packet);
    std::int64_t bound() const;
  };

  Output open(const std::string& path, const AVCodecParameters& parameters) const;
  Input read_fragments() const;
  void rewrite(const std::string& to) const;
  void copy_packets(AVFormatContext& input, AVFormatContext& output, SoundTrack* sound) const;
  void copy_sound(SoundTrack& sound, AVPacket& packet, std::int64_t until, AVFormatContext& output) const;
  void close(Output& output) const;
  void check(int code) const;

  std::string path_;
  MovieWriter::Keep keep_;
  UnfinishedFile file_;
  std::string fragments_path_, sound_of_;
  std::unique_ptr<AVCodecParameters, FreeParameters> parameters_;
  int ticks_a_second_, rate_num_, rate_den_;
  IndexSize index_;
  Output fragments_;
};

}  // namespace marey::draw
