#include "marey/source/live/v4l2.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <cmath>
#include <cstring>
#include <set>
#include <utility>

#include <fmt/format.h>
#include <linux/videodev2.h>

#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/source/live/jpeg_decoder.h"
#include "marey/source/live/pixel_format.h"

namespace marey::source::live {
namespace {

constexpr unsigned kBuffers = 4;
constexpr std::array<std::pair<const char*, std::uint32_t>, 3> kFormats{
    {{"GREY", V4L2_PIX_FMT_GREY}, {"YUYV", V4L2_PIX_FMT_YUYV}, {"MJPG", V4L2_PIX_FMT_MJPEG}}};

struct SetControl {
  Control control;
  std::uint32_t id;
  double unit;  ///< of ours
};
constexpr std::array<SetControl, 2> kControls{
    {{Control::exposure, V4L2_CID_EXPOSURE_ABSOLUTE, 0.1}, {Control::gain, V4L2_CID_GAIN, 1}}};

std::string letters(std::uint32_t format) {
  std::string text;
  for (int i = 0; i < 4; ++i) text += static_cast<char>(format >> (8 * i) & 0x7f);
  return text.substr(0, text.find_last_not_of(' ') + 1);
}

template <typename T>
T blank() {
  T value;
  std::memset(&value, 0, sizeof value);
  return value;
}

std::string text_of(const unsigned char* bytes, std::size_t maximum) {
  const auto* text = reinterpret_cast<const char*>(bytes);
  return {text, strnlen(text, maximum)};
}

/// An open device; closed when it is gone.
class Device {
 public:
  Device(Kernel& kernel, const std::string& path) : kernel_(kernel), path_(path), file_(kernel.open(path)) {
    if (file_ == -ENOENT) throw Error("{}: there is no such camera now; plug it in", path);
    if (file_ == -EBUSY) throw Error("{}: another program uses it; end that", path);
    if (file_ == -EACCES) throw Error("{}: may not be opened; add yourself to the group video", path);
    if (file_ < 0) throw Error("{}: cannot be opened ({})", path, std::strerror(-file_));
  }
  ~Device() { kernel_.close(file_); }
  Device(const Device&) = delete;
  Device& operator=(const Device&) = delete;

  int file() const { return file_; }
  int call_device(unsigned long request, void* argument) const { return kernel_.control(file_, request, argument); }
  void demand(unsigned long request, void* argument, const char* what) const {
    const int answer = call_device(request, argument);
    if (answer == -EBUSY) throw Error("{}: another program uses it; end that", path_);
    if (answer < 0) throw Error("{}: {} ({})", path_, what, std::strerror(-answer));
  }

 private:
  Kernel& kernel_;
  std::string path_;
  int file_;
};

bool gives_images(const v4l2_capability& can) {
  const std::uint32_t caps = (can.capabilities & V4L2_CAP_DEVICE_CAPS) != 0 ? can.device_caps : can.capabilities;
  return (caps & V4L2_CAP_VIDEO_CAPTURE) != 0 && (caps & V4L2_CAP_STREAMING) != 0;
}

std::vector<std::uint32_t> formats_of(const Device& device) {
  std::vector<std::uint32_t> formats;
  for (std::uint32_t i = 0; i < 64; ++i) {
    auto description = blank<v4l2_fmtdesc>();
    description.index = i;
    description.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    if (device.call_device(VIDIOC_ENUM_FMT, &description) < 0) break;
    formats.push_back(description.pixelformat);
  }
  return formats;
}

std::uint32_t choose_format(const Device& device, const V4l2Options& options) {
  const std::vector<std::uint32_t> has = formats_of(device);
  std::string known;
  for (const auto& [name, code] : kFormats) {
    const bool there = std::find(has.begin(), has.end(), code) != has.end();
    if (there && (options.format.empty() || options.format == name)) return code;
    if (there) known += fmt::format("{}{}", known.empty() ? "" : ", ", name);
  }
  if (known.empty()) throw Error("{}: gives neither GREY nor YUYV nor MJPG, which are read", options.device);
  throw Error("{}: has no format {}; it has {}", options.device, options.format, known);
}

class V4l2Camera final : public Connection {
 public:
  V4l2Camera(V4l2Options options, std::shared_ptr<Kernel> kernel, LiveTime& time)
      : options_(std::move(options)), kernel_(std::move(kernel)), time_(time), device_(*kernel_, options_.device) {
    auto can = blank<v4l2_capability>();
    device_.demand(VIDIOC_QUERYCAP, &can, "is not a camera");
    if (!gives_images(can)) throw Error("{}: gives no images; cameras have several names, try the next one", options_.device);
    info_.name = options_.device;
    set_format();
    set_rate();
    if (options_.exposure_ms) set(Control::exposure, *options_.exposure_ms);
    if (options_.gain) set(Control::gain, *options_.gain);
    try {
      begin();
    } catch (...) {
      release();
      throw;
    }
  }
  ~V4l2Camera() override { release(); }

  const SourceInfo& info() const override { return info_; }

  std::vector<ControlRange> controls() override {
    std::vector<ControlRange> has;
    for (const auto& [control, id, unit] : kControls) {
      auto query = blank<v4l2_queryctrl>();
      query.id = id;
      if (device_.call_device(VIDIOC_QUERYCTRL, &query) < 0 || (query.flags & V4L2_CTRL_FLAG_DISABLED) != 0) continue;
      v4l2_control now{.id = id, .value = query.default_value};
      device_.call_device(VIDIOC_G_CTRL, &now);
      has.push_back({control, unit * query.minimum, unit * query.maximum, unit * now.value});
    }
    return has;
  }

  void set(Control control, double value) override {
    if (control == Control::exposure) set_control(V4L2_CID_EXPOSURE_AUTO, V4L2_EXPOSURE_MANUAL);
    for (const auto& [each, id, unit] : kControls) {
      if (each == control) set_control(id, value / unit);
    }
  }

  Came next(Shot& shot) override {
    const int ready = kernel_->wait(device_.file(), static_cast<int>(kStopSlice.count()));
    if (ready == 0) return Came::nothing;
    auto buffer = blank<v4l2_buffer>();
    buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    buffer.memory = V4L2_MEMORY_MMAP;
    const int got = ready < 0 ? ready : device_.call_device(VIDIOC_DQBUF, &buffer);
    if (got == -EAGAIN) return Came::nothing;
    if (got == -EIO) return Came::damaged;  // the driver has lost a frame, and continues
    if (got < 0) throw Error("{}: is gone ({})", options_.device, std::strerror(-got));
    if (buffer.index >= buffers_.size()) throw Error("{}: the driver names a buffer that is not there", options_.device);
    const bool whole = (buffer.flags & V4L2_BUF_FLAG_ERROR) == 0 && read(buffer, shot);
    device_.demand(VIDIOC_QBUF, &buffer, "takes no buffer back");
    return whole ? Came::frame : Came::damaged;
  }

 private:
  struct Buffer {
    void* memory = nullptr;
    std::size_t length = 0;
  };

  void set_format() {
    auto format = blank<v4l2_format>();
    format.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    device_.demand(VIDIOC_G_FMT, &format, "does not specify what it gives");
    format.fmt.pix.pixelformat = choose_format(device_, options_);
    format.fmt.pix.field = V4L2_FIELD_ANY;
    format.fmt.pix.bytesperline = 0;
    if (options_.width > 0) {
      format.fmt.pix.width = static_cast<std::uint32_t>(options_.width);
      format.fmt.pix.height = static_cast<std::uint32_t>(options_.height);
    }
    const std::uint32_t required = format.fmt.pix.pixelformat;
    device_.demand(VIDIOC_S_FMT, &format, "does not take that format");
    const v4l2_pix_format& pix = format.fmt.pix;
    if (pix.pixelformat != required)
      throw Error("{}: gives {}, not {}", options_.device, letters(pix.pixelformat), letters(required));
    info_.size = {static_cast<int>(pix.width), static_cast<int>(pix.height)};
    if (options_.width > 0 && info_.size != cv::Size(options_.width, options_.height))
      throw Error("{}: has no size {}x{}; the nearest is {}x{} (marey cameras lists them)", options_.device, options_.width,
                  options_.height, info_.size.width, info_.size.height);
    format_ = required;
    stride_ = pix.bytesperline > 0 ? pix.bytesperline : pix.width * (required == V4L2_PIX_FMT_YUYV ? 2 : 1);
  }

  void set_rate() {
    auto parameters = blank<v4l2_streamparm>();
    parameters.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    v4l2_fract& period = parameters.parm.capture.timeperframe;
    if (options_.rate_hz) {
      period.numerator = 1000;
      period.denominator = static_cast<std::uint32_t>(std::lround(*options_.rate_hz * 1000));
      device_.call_device(VIDIOC_S_PARM, &parameters);
    } else if (device_.call_device(VIDIOC_G_PARM, &parameters) < 0) {
      return;
    }
    if (period.numerator > 0 && period.denominator > 0) info_.rate_hz = static_cast<double>(period.denominator) / period.numerator;
  }

  void set_control(std::uint32_t which, double value) {
    v4l2_control control{.id = which, .value = static_cast<std::int32_t>(std::lround(std::clamp(value, -1e9, 1e9)))};
    device_.demand(VIDIOC_S_CTRL, &control, "does not take that exposure or gain; marey cameras lists what it takes");
  }

  void begin() {
    auto request = blank<v4l2_requestbuffers>();
    request.count = kBuffers;
    request.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    request.memory = V4L2_MEMORY_MMAP;
    device_.demand(VIDIOC_REQBUFS, &request, "has no memory for frames");
    for (std::uint32_t i = 0; i < request.count; ++i) {
      auto buffer = blank<v4l2_buffer>();
      buffer.index = i;
      buffer.type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
      buffer.memory = V4L2_MEMORY_MMAP;
      device_.demand(VIDIOC_QUERYBUF, &buffer, "does not specify where its frames lie");
      void* memory = kernel_->map(device_.file(), buffer.length, buffer.m.offset);
      if (memory == nullptr) throw Error("{}: its frames cannot be mapped into memory", options_.device);
      buffers_.push_back({memory, buffer.length});
      device_.demand(VIDIOC_QBUF, &buffer, "takes no buffer");
    }
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    device_.demand(VIDIOC_STREAMON, &type, "does not begin; a hub carries only this many cameras: try a smaller size or MJPG");
  }

  void release() {
    int type = V4L2_BUF_TYPE_VIDEO_CAPTURE;
    device_.call_device(VIDIOC_STREAMOFF, &type);
    for (const Buffer& buffer : buffers_) kernel_->unmap(buffer.memory, buffer.length);
    buffers_.clear();
  }

  /// False where the image is not whole.
  bool read(const v4l2_buffer& buffer, Shot& shot) {
    const Buffer& own = buffers_[buffer.index];
    const std::span bytes(static_cast<const std::uint8_t*>(own.memory), std::min<std::size_t>(own.length, buffer.bytesused));
    Image& image = shot.given.frame.image;
    if (format_ == V4L2_PIX_FMT_MJPEG) {
      image = jpeg_.decode(bytes);
    } else {
      image = unpack(format_ == V4L2_PIX_FMT_GREY ? Packing::grey : Packing::yuyv, bytes, info_.size, stride_).value_or(Image());
    }
    // Numbers have 32 bits; they may begin anywhere.
    const auto step = static_cast<std::int32_t>(buffer.sequence - static_cast<std::uint32_t>(sequence_));
    sequence_ = sequence_ < 0 ? buffer.sequence : sequence_ + step;
    shot.sequence = sequence_;
    if ((buffer.flags & V4L2_BUF_FLAG_TIMESTAMP_MASK) == V4L2_BUF_FLAG_TIMESTAMP_MONOTONIC) {
      const Duration stamp = std::chrono::seconds(buffer.timestamp.tv_sec) + std::chrono::microseconds(buffer.timestamp.tv_usec);
      shot.taken = time_.now() - (kernel_->now() - stamp);
    }
    return !image.empty();
  }

  V4l2Options options_;
  std::shared_ptr<Kernel> kernel_;
  LiveTime& time_;
  Device device_;
  SourceInfo info_;
  std::uint32_t format_ = 0;
  std::size_t stride_ = 0;
  std::vector<Buffer> buffers_;
  JpegDecoder jpeg_;
  std::int64_t sequence_ = -1;
};

std::vector<double> rates_of(const Device& device, std::uint32_t format, cv::Size size) {
  std::vector<double> rates;
  for (std::uint32_t i = 0; i < 32; ++i) {
    auto interval = blank<v4l2_frmivalenum>();
    interval.index = i;
    interval.pixel_format = format;
    interval.width = static_cast<std::uint32_t>(size.width);
    interval.height = static_cast<std::uint32_t>(size.height);
    if (device.call_device(VIDIOC_ENUM_FRAMEINTERVALS, &interval) < 0) break;
    const v4l2_fract& period = interval.type == V4L2_FRMIVAL_TYPE_DISCRETE ? interval.discrete : interval.stepwise.min;
    if (period.numerator > 0) rates.push_back(static_cast<double>(period.denominator) / period.numerator);
    if (interval.type != V4L2_FRMIVAL_TYPE_DISCRETE) break;
  }
  std::sort(rates.rbegin(), rates.rend());
  return rates;
}

void add_modes(const Device& device, FoundCamera& camera) {
  for (const std::uint32_t format : formats_of(device)) {
    for (std::uint32_t i = 0; i < 64; ++i) {
      auto each = blank<v4l2_frmsizeenum>();
      each.index = i;
      each.pixel_format = format;
      if (device.call_device(VIDIOC_ENUM_FRAMESIZES, &each) < 0) break;
      const bool discrete = each.type == V4L2_FRMSIZE_TYPE_DISCRETE;
      const cv::Size size(static_cast<int>(discrete ? each.discrete.width : each.stepwise.max_width),
                          static_cast<int>(discrete ? each.discrete.height : each.stepwise.max_height));
      camera.modes.push_back({letters(format), size, rates_of(device, format, size)});
      if (!discrete) break;
    }
  }
}

void add_controls(const Device& device, FoundCamera& camera) {
  for (const std::uint32_t id : {V4L2_CID_BRIGHTNESS, V4L2_CID_GAIN, V4L2_CID_EXPOSURE_AUTO, V4L2_CID_EXPOSURE_ABSOLUTE}) {
    auto query = blank<v4l2_queryctrl>();
    query.id = id;
    if (device.call_device(VIDIOC_QUERYCTRL, &query) < 0 || (query.flags & V4L2_CTRL_FLAG_DISABLED) != 0) continue;
    v4l2_control now{.id = id, .value = query.default_value};
    device.call_device(VIDIOC_G_CTRL, &now);
    camera.controls.push_back({text_of(query.name, sizeof query.name), static_cast<double>(query.minimum),
                               static_cast<double>(query.maximum), static_cast<double>(now.value)});
  }
}

}  // namespace

V4l2Options v4l2_options(const Address& address, std::optional<double> rate_hz) {
  V4l2Options required{.device = address.location, .rate_hz = rate_hz, .format = {}, .exposure_ms = {}, .gain = {}};
  AddressOptions options(address);
  double rate = rate_hz.value_or(0), exposure = 0, gain = -1;
  options.size("size", required.width, required.height);
  options.number("rate", rate, 0.1, 10000);
  options.text("format", required.format);
  options.number("exposure", exposure, 0.01, 10000);
  options.number("gain", gain, 0, 1e6);
  options.done();
  if (rate > 0) required.rate_hz = rate;
  if (exposure > 0) required.exposure_ms = exposure;
  if (gain >= 0) required.gain = gain;
  if (required.device.empty()) throw Error("{}: names no device; write v4l2:/dev/video0", address.text);
  const auto known = [&](const auto& each) { return required.format == each.first; };
  if (!required.format.empty() && std::none_of(kFormats.begin(), kFormats.end(), known))
    throw Error("{}: the format {} is not read; GREY, YUYV and MJPG are", address.text, required.format);
  return required;
}

Connect connect_v4l2(const V4l2Options& options, std::shared_ptr<Kernel> kernel) {
  return [options, kernel = std::move(kernel)](LiveTime& time, const std::stop_token&) -> std::unique_ptr<Connection> {
    return std::make_unique<V4l2Camera>(options, kernel, time);
  };
}

std::vector<FoundCamera> find_v4l2(Kernel& kernel) {
  std::vector<FoundCamera> found;
  for (const std::string& path : kernel.devices()) {
    try {
      const Device device(kernel, path);
      auto can = blank<v4l2_capability>();
      if (device.call_device(VIDIOC_QUERYCAP, &can) < 0 || !gives_images(can)) continue;
      FoundCamera camera{.source = "v4l2:" + path,
                         .name = text_of(can.card, sizeof can.card),
                         .where = text_of(can.bus_info, sizeof can.bus_info),
                         .modes = {},
                         .controls = {}};
      add_modes(device, camera);
      add_controls(device, camera);
      found.push_back(std::move(camera));
    } catch (const Error&) {
      continue;  // what cannot be opened is not there for us
    }
  }
  return found;
}

}  // namespace marey::source::live
