// A film or a picture, through FFmpeg: whatever a file holds, reading it ends in frames of one size or in one Error.
#include <memory>

#include "marey/core/error.h"
#include "marey/core/source.h"
#include "marey/source/image_sequence.h"
#include "marey/source/video_source.h"

extern "C" {
#include <libavutil/log.h>
}

#include "fuzz.h"

using marey::fuzz::check;

namespace {

void walk(marey::Source& source) {
  const cv::Size size = source.info().size;
  check(size.width > 0 && size.height > 0);
  for (int frames = 0; frames < 200; ++frames) {
    const auto frame = source.next();
    if (!frame) return;
    check(frame->image.size() == size);
  }
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* data, std::size_t size) {
  av_log_set_level(AV_LOG_QUIET);
  const std::string& path = marey::fuzz::memory_file(marey::fuzz::text_of(data, size));
  try {
    walk(*marey::source::open_video(path));
  } catch (const marey::Error& error) {
    marey::fuzz::check_message(error.what(), path);
  }
  try {
    walk(*marey::source::open_images(path, {path}, 25));
  } catch (const marey::Error& error) {
    marey::fuzz::check_message(error.what(), path);
  }
  return 0;
}
