#include "marey/files/input_file.h"

#include <cerrno>
#include <streambuf>
#include <string_view>
#include <system_error>
#include <utility>

#include <fcntl.h>
#include <poll.h>
#include <sys/stat.h>
#include <unistd.h>

#include "marey/core/error.h"

namespace marey {
namespace {

/// What is not a text, such as /dev/zero, is one line without end.
constexpr std::size_t kLongestLine = std::size_t{1} << 24;  // bytes

[[noreturn]] void fail_to_read(const std::string& path) {
  throw Error("{}: cannot be read ({})", path, std::generic_category().message(errno));
}

}  // namespace

InputFile::InputFile(const std::string& path, std::stop_token stop) : path_(path), stop_(std::move(stop)) {
  own_ = path != "-";
  if (!own_) path_ = "standard input";
  // Without O_NONBLOCK, a pipe's opening would wait for its writer and nothing could end the wait.
  file_ = own_ ? open(path.c_str(), O_RDONLY | O_CLOEXEC | O_NONBLOCK) : STDIN_FILENO;
  if (file_ < 0) fail_to_read(path_);
  struct stat status{};
  waits_ = fstat(file_, &status) == 0 && !S_ISREG(status.st_mode) && !S_ISDIR(status.st_mode);
}

InputFile::~InputFile() {
  if (own_ && file_ >= 0) close(file_);
}

/// Until there is something to read, or the writer has gone. A pipe that never had a writer is neither.
void InputFile::wait() const {
  for (;;) {
    if (stop_.stop_requested()) throw Stopped();
    pollfd requested{file_, POLLIN, 0};
    const int ready = poll(&requested, 1, static_cast<int>(kStopSlice.count()));
    if (ready > 0) return;
    if (ready < 0 && errno != EINTR) fail_to_read(path_);
  }
}

std::size_t InputFile::read(std::span<char> room) {
  for (;;) {
    if (waits_) wait();
    const ssize_t got = ::read(file_, room.data(), room.size());
    if (got >= 0) return static_cast<std::size_t>(got);
    if (errno != EINTR && errno != EAGAIN) fail_to_read(path_);
  }
}

class InputStream::Buffer : public std::streambuf {
 public:
  explicit Buffer(const std::string& path) : file_(path), name_(path == "-" ? "standard input" : path) {}

 protected:
  int_type underflow() override {
    const std::size_t got = file_.read({bytes_.get(), kSize});
    if (got == 0) return traits_type::eof();
    measure({bytes_.get(), got});
    setg(bytes_.get(), bytes_.get(), bytes_.get() + got);
    return traits_type::to_int_type(bytes_[0]);
  }

 private:
  void measure(std::string_view piece) {
    const std::size_t last = piece.rfind('\n');
    line_ = last == std::string_view::npos ? line_ + piece.size() : piece.size() - last - 1;
    if (line_ > kLongestLine) throw Error("{}: a line has more than {} bytes; is this a text?", name_, kLongestLine);
  }

  InputFile file_;
  std::string name_;
  std::size_t line_ = 0;  // bytes of it so far
  static constexpr std::size_t kSize = std::size_t{1} << 16;
  std::unique_ptr<char[]> bytes_ =
      std::make_unique_for_overwrite<char[]>(kSize);  // to clear it takes longer than to read a small file
};

InputStream::InputStream(const std::string& path) : std::istream(nullptr) {
  try {
    buffer_ = std::make_unique<Buffer>(path);
  } catch (const Error&) {
    return;  // no buffer: the stream is bad
  }
  rdbuf(buffer_.get());
  exceptions(std::ios::badbit);  // else what the buffer throws would be swallowed
}

InputStream::~InputStream() = default;

}  // namespace marey
