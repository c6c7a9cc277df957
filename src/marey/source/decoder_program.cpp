// The decoder of a build without FFmpeg's libraries (MAREY_FFMPEG=OFF): a Python wheel that would carry them is four times as
// large, and under another licence. It asks the programs `ffprobe` and `ffmpeg`, where they are installed: what a video is, then
// its images as raw bytes through a pipe. Their times come out of ffmpeg's log (its filter `showinfo`), which a thread reads
// beside. What is damaged is skipped by ffmpeg and not counted.
#include <array>
#include <cerrno>
#include <charconv>
#include <condition_variable>
#include <cstring>
#include <deque>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/files/limits.h"
#include "marey/source/decoder.h"

extern char** environ;

namespace marey::source {
namespace {

/// A program whose standard output and error are read.
class Program {
 public:
  explicit Program(const std::vector<std::string>& words) {
    std::array<int, 2> out{}, err{};
    if (pipe2(out.data(), O_CLOEXEC) != 0 || pipe2(err.data(), O_CLOEXEC) != 0) throw Error("no pipe: {}", std::strerror(errno));
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_addopen(&actions, 0, "/dev/null", O_RDONLY, 0);
    posix_spawn_file_actions_adddup2(&actions, out[1], 1);
    posix_spawn_file_actions_adddup2(&actions, err[1], 2);
    std::vector<char*> arguments;
    for (const std::string& word : words) arguments.push_back(const_cast<char*>(word.c_str()));
    arguments.push_back(nullptr);
    const int failed = posix_spawnp(&process_, arguments[0], &actions, nullptr, arguments.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(out[1]), close(err[1]);
    out_ = out[0], err_ = err[0];
    if (failed == 0) return;
    process_ = -1;
    shut();
    throw Error(
        "{} cannot be started ({}); this build of Marey reads videos by it: install the package ffmpeg, or give frames as arrays",
        words.front(), std::strerror(failed));
  }
  ~Program() {
    if (process_ > 0) kill(process_, SIGKILL);
    wait();
    shut();
  }
  Program(const Program&) = delete;
  Program& operator=(const Program&) = delete;

  int out() const { return out_; }
  int err() const { return err_; }
  void end() const {
    if (process_ > 0) kill(process_, SIGKILL);
  }
  /// Its exit status.
  int wait() {
    if (process_ <= 0) return status_;
    while (waitpid(process_, &status_, 0) < 0 && errno == EINTR) continue;
    process_ = -1;
    return status_;
  }

 private:
  void shut() const {
    close(out_);
    close(err_);
  }

  pid_t process_ = -1;
  int out_ = -1, err_ = -1, status_ = 0;
};

std::string read_text(int file) {
  std::string text;
  std::array<char, 4096> bytes{};
  for (;;) {
    const ssize_t count = read(file, bytes.data(), bytes.size());
    if (count < 0 && errno == EINTR) continue;
    if (count <= 0) return text;
    text.append(bytes.data(), static_cast<std::size_t>(count));
  }
}

std::optional<double> number_in(const std::string& text) {
  double value = 0;
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc{} || end != text.data() + text.size()) return std::nullopt;
  return value;
}

/// "30000/1001"; nothing for "0/0".
std::optional<double> ratio_in(const std::string& text) {
  const std::size_t slash = text.find('/');
  if (slash == std::string::npos) return number_in(text);
  const auto above = number_in(text.substr(0, slash)), below = number_in(text.substr(slash + 1));
  if (!above || !below || !(*above > 0) || !(*below > 0)) return std::nullopt;
  return *above / *below;
}

using Facts = std::map<std::string, std::string>;

Facts facts_of(const std::string& path) {
  Program probe(
      {"ffprobe", "-v", "error", "-select_streams", "v:0", "-show_entries",
       "stream=width,height,pix_fmt,color_range,avg_frame_rate,r_frame_rate,nb_frames,duration,time_base:stream_side_data=rotation:"
       "format=duration",
       "-of", "default=noprint_wrappers=1", "file:" + path});
  const std::string stated = read_text(probe.out());
  std::string why = read_text(probe.err());
  probe.wait();
  Facts facts;
  for (std::size_t begin = 0; begin < stated.size();) {
    const std::size_t end = std::min(stated.find('\n', begin), stated.size());
    const std::string line = stated.substr(begin, end - begin);
    if (const std::size_t equals = line.find('='); equals != std::string::npos && line.substr(equals + 1) != "N/A")
      facts.try_emplace(line.substr(0, equals), line.substr(equals + 1));
    begin = end + 1;
  }
  if (facts.contains("width") && facts.contains("height")) return facts;
  if (const std::size_t line = why.find('\n'); line != std::string::npos) why.resize(line);
  throw Error("{}: cannot be read as a video or image{}{}", path, why.empty() ? "" : ": ", why);
}

}  // namespace

struct Decoder::Parts {
  explicit Parts(const std::string& path) : facts(facts_of(path)) {
    size = {static_cast<int>(*number_in(facts["width"])), static_cast<int>(*number_in(facts["height"]))};
    const int turn = static_cast<int>(number_in(facts["rotation"]).value_or(0));
    if (turn % 180 != 0) std::swap(size.width, size.height);
    if (size.area() <= 0 || static_cast<std::size_t>(size.area()) > Limits::in_force().image_px)
      throw Error("{}: its images have {}x{} px, more than the limit picture_px", path, size.width, size.height);
    grey = facts["pix_fmt"].starts_with("gray");
    const bool full = facts["color_range"] == "pc" || facts["pix_fmt"].starts_with("yuvj");
    range = full ? Image::Range::full : Image::Range::limited;
    // rawvideo's planes: the conversion from RGB and to 8 bits is ffmpeg's own.
    program.emplace(std::vector<std::string>{"ffmpeg", "-hide_banner", "-nostats", "-loglevel", "info", "-i", "file:" + path,
                                             "-map", "0:v:0", "-vf", "showinfo=checksum=0", "-fps_mode", "passthrough", "-f",
                                             "rawvideo", "-pix_fmt",
                                             grey   ? "gray"
                                             : full ? "yuvj420p"
                                                    : "yuv420p",
                                             "pipe:1"});
    listener = std::thread([this] { listen(); });
  }
  ~Parts() {
    program->end();
    if (listener.joinable()) listener.join();
  }

  /// Keeps the times that ffmpeg's log states, in the order of the images.
  void listen() {
    std::string line;
    std::array<char, 4096> bytes{};
    for (;;) {
      const ssize_t count = read(program->err(), bytes.data(), bytes.size());
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) break;
      for (const char c : std::string_view(bytes.data(), static_cast<std::size_t>(count))) {
        if (c != '\n') {
          line += c;
          continue;
        }
        take(line);
        line.clear();
      }
    }
    const std::lock_guard lock(guard);
    silent = true;
    changed.notify_all();
  }

  void take(const std::string& line) {
    if (const std::size_t at = line.find("config in time_base: "); at != std::string::npos) {
      const std::size_t begin = at + std::strlen("config in time_base: ");
      tick_s = ratio_in(line.substr(begin, line.find(',', begin) - begin)).value_or(0);
      return;
    }
    const std::size_t number = line.find("] n:"), stamp = line.find(" pts:");
    if (number == std::string::npos || stamp == std::string::npos) return;
    const std::size_t begin = line.find_first_not_of(' ', stamp + 5);
    const auto ticks = number_in(line.substr(begin, line.find(' ', begin) - begin));
    const std::lock_guard lock(guard);
    stamps.push_back(ticks && tick_s > 0 ? std::optional(std::llround(*ticks * tick_s * 1e9)) : std::nullopt);
    changed.notify_all();
  }

  std::optional<std::int64_t> next_stamp() {
    std::unique_lock lock(guard);
    changed.wait(lock, [&] { return silent || !stamps.empty(); });
    if (stamps.empty()) return std::nullopt;
    const auto stamp = stamps.front();
    stamps.pop_front();
    return stamp;
  }

  /// False at the end.
  bool fill(std::uint8_t* data, std::size_t bytes) {
    for (std::size_t done = 0; done < bytes;) {
      const ssize_t count = read(program->out(), data + done, bytes - done);
      if (count < 0 && errno == EINTR) continue;
      if (count <= 0) return false;
      done += static_cast<std::size_t>(count);
    }
    return true;
  }

  Facts facts;
  cv::Size size;
  bool grey = false;
  Image::Range range = Image::Range::limited;
  std::optional<Program> program;
  std::thread listener;
  std::mutex guard;
  std::condition_variable changed;
  std::deque<std::optional<std::int64_t>> stamps;
  bool silent = false;
  double tick_s = 0;
  bool ended = false;
  Trouble trouble;
};

Decoder::Decoder(const std::string& path, int /*threads*/) : parts_(std::make_unique<Parts>(path)) {}
Decoder::~Decoder() = default;

cv::Size Decoder::size() const {
  return parts_->size;
}
std::optional<double> Decoder::rate_hz() const {
  const auto mean = ratio_in(parts_->facts["avg_frame_rate"]);
  return mean ? mean : ratio_in(parts_->facts["r_frame_rate"]);
}
std::optional<std::int64_t> Decoder::frame_count() const {
  const auto count = number_in(parts_->facts["nb_frames"]);
  return count ? std::optional(static_cast<std::int64_t>(*count)) : std::nullopt;
}
std::optional<double> Decoder::duration_s() const {
  return number_in(parts_->facts["duration"]);
}
const Decoder::Trouble& Decoder::trouble() const {
  return parts_->trouble;
}

std::optional<Decoder::Decoded> Decoder::next() {
  if (parts_->ended) return std::nullopt;
  const cv::Size size = parts_->size, half((size.width + 1) / 2, (size.height + 1) / 2);
  const auto luma = static_cast<std::size_t>(size.area()), chroma = static_cast<std::size_t>(half.area());
  auto bytes = std::make_shared<std::vector<std::uint8_t>>(parts_->grey ? luma : luma + 2 * chroma);
  if (!parts_->fill(bytes->data(), bytes->size())) {
    parts_->ended = true;
    if (parts_->program->wait() != 0) parts_->trouble.broken = "ffmpeg ended with an error";
    return std::nullopt;
  }
  std::uint8_t* data = bytes->data();
  Decoded decoded{.image = {}, .stamp_ns = parts_->next_stamp()};
  if (parts_->grey) {
    decoded.image = Image(cv::Mat(size, CV_8UC1, data).clone());
  } else {
    decoded.image = Image(cv::Mat(size, CV_8UC1, data), cv::Mat(half, CV_8UC1, data + luma),
                          cv::Mat(half, CV_8UC1, data + luma + chroma), parts_->range, bytes);
  }
  return decoded;
}

}  // namespace marey::source
