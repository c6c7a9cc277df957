// What a task takes of memory and time, from measurements (docs/batch.md; `bench/batch.py MAREY memory` compares).
#include <algorithm>
#include <array>
#include <cctype>
#include <charconv>
#include <cmath>
#include <filesystem>
#include <fstream>
#include <set>
#include <string_view>

#include "marey/core/error.h"
#include "marey/core/time.h"
#include "marey/source/open_source.h"

#include "batch_plan.h"

namespace marey::cli {
namespace {

namespace fs = std::filesystem;

constexpr double kMega = 1e6;

struct CostModel {
  double program_mb;     ///< the program twice: the one that works, and the one that waits for it
  double camera_mb;      ///< a decoder, a queue
  double pixel_bytes;    ///< of a camera's image: eight frames that are read ahead, the background, the detector's own
  double learned_bytes;  ///< of a pixel of each frame that the background is learned from
  double frame_bytes;    ///< that stay until the end of the recording
  double input_bytes;    ///< of a byte of a text that is read as a whole
  double pixel_ns;       ///< to decode and process a pixel
  double frame_ns;       ///< of an instant, whatever its images
  double input_ns;       ///< of a byte of a text
};

/// Of one thread.
CostModel model_of(const std::string& job) {
  if (job == "ground") return {90, 3, 48, 3.2, 7200, 0, 7, 3e5, 0};        // frames with 25 people
  if (job == "reconstruct") return {91, 2, 14.3, 0, 45000, 0, 9, 3e5, 0};  // frames with 50 markers
  if (job == "measure") return {82, 0, 0, 0, 0, 1.3, 0, 0, 12};
  return {96, 3, 24, 3.2, 0, 0, 5, 1e6, 0};
}

/// How many frames of a video the background is learned from (pipeline::corridor::Feed::sample_beginning): up to 30, evenly out of
/// the first 30 seconds, of which 300 frames are read at most.
double learned_frames(const SourceInfo& video) {
  constexpr double kLearned = 30, kSeconds = 30, kRead = 300;
  if (!video.frame_count) return kLearned;
  const double span = std::min(kSeconds * video.rate_hz.value_or(kDefaultRate), kRead);
  const double step = std::max(1.0, std::floor(span / kLearned));
  return std::min(kLearned, std::ceil(static_cast<double>(*video.frame_count) / step));
}

/// The last frame of detections, a text in which each line begins with its frame; 0 where it is not one.
double frames_of_boxes(const std::string& path) {
  constexpr std::streamoff kTail = 400;  // bytes: more than a line
  std::ifstream file(path, std::ios::binary);
  file.seekg(0, std::ios::end);
  const std::streamoff size = file.tellg();
  file.seekg(std::max<std::streamoff>(0, size - kTail));
  std::array<char, kTail> tail{};
  file.read(tail.data(), std::min(size, kTail));
  std::string_view text(tail.data(), static_cast<std::size_t>(std::max<std::streamsize>(0, file.gcount())));
  while (text.ends_with('\n')) text.remove_suffix(1);
  text.remove_prefix(text.rfind('\n') + 1);  // npos + 1: the only line
  double frame = 0;
  std::from_chars(text.data(), text.data() + text.size(), frame);
  return std::clamp(frame, 0.0, 1e8);
}

/// Adds what one of a task's files takes; `frames` becomes those of the longest.
void add_input(const std::string& path, const CostModel& model, double& mb, double& ns, double& frames) {
  std::error_code error;
  const auto bytes = static_cast<double>(fs::file_size(path, error));
  if (!error) mb += model.input_bytes * bytes / kMega, ns += model.input_ns * bytes;
  if (is_video(path)) {
    const SourceInfo info = source::open_source(path)->info();
    const auto count = static_cast<double>(info.frame_count.value_or(0));
    frames = std::max(frames, count);
    mb += model.camera_mb + (model.pixel_bytes + model.learned_bytes * learned_frames(info)) * info.size.area() / kMega;
    ns += model.pixel_ns * count * info.size.area();
  } else if (model.frame_bytes > 0 && fs::path(path).extension() == ".txt") {
    frames = std::max(frames, frames_of_boxes(path));
  }
}

}  // namespace

bool is_video(const fs::path& path) {
  static const std::set<std::string> endings{".mp4",  ".avi",  ".mov", ".mkv", ".m4v", ".mpg",
                                             ".mpeg", ".webm", ".ts",  ".mts", ".wmv", ".mxf"};
  std::string ending = path.extension().string();
  std::transform(ending.begin(), ending.end(), ending.begin(), [](unsigned char c) { return static_cast<char>(std::tolower(c)); });
  return endings.contains(ending);
}

TaskCosts expected_costs(const std::string& job, const std::vector<std::string>& inputs) {
  const CostModel model = model_of(job);
  double mb = model.program_mb, ns = 0, frames = 0;
  for (const std::string& path : inputs) {
    try {
      add_input(path, model, mb, ns, frames);
    } catch (const Error&) {
      continue;  // the task will say what is wrong with it
    }
  }
  return {static_cast<int>(mb + model.frame_bytes * frames / kMega), 1e-9 * (ns + model.frame_ns * frames)};
}

int memory_with_threads(int mb, int threads) {
  constexpr double kFurtherThread = 0.06;  // images that a decoder has in work, and each thread's own
  return static_cast<int>(mb * (1 + kFurtherThread * (threads - 1)));
}

}  // namespace marey::cli
