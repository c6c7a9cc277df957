#include "marey/source/live/gige.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <memory>
#include <mutex>
#include <utility>

#include <arv.h>
#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/core/stop.h"
#include "marey/source/live/pixel_format.h"

namespace marey::source::live {
namespace {

constexpr int kBuffers = 16;  // fewer are counted as underruns when the host is busy for a moment

struct Unref {
  void operator()(gpointer object) const { g_object_unref(object); }
};
template <typename T>
using Owned = std::unique_ptr<T, Unref>;

/// Aravis reports failures through one of these.
class Failure {
 public:
  ~Failure() { g_clear_error(&error_); }
  GError** out() {
    g_clear_error(&error_);
    return &error_;
  }
  bool failed() const { return error_ != nullptr; }
  std::string why() const { return error_ != nullptr ? error_->message : "no reason told"; }

 private:
  GError* error_ = nullptr;
};

/// Searching for devices is not safe from several threads.
std::mutex& facing() {
  static std::mutex mutex;
  return mutex;
}

std::string stated(const char* text) {
  return text != nullptr ? text : "";
}

struct GigeDevice {
  std::string id, serial, address, maker, model;
};

std::vector<GigeDevice> devices_there() {
  const std::lock_guard lock(facing());
  arv_update_device_list();
  std::vector<GigeDevice> all;
  for (unsigned i = 0; i < arv_get_n_devices(); ++i)
    all.push_back({stated(arv_get_device_id(i)), stated(arv_get_device_serial_nbr(i)), stated(arv_get_device_address(i)),
                   stated(arv_get_device_vendor(i)), stated(arv_get_device_model(i))});
  return all;
}

struct GigeOptions {
  std::string required;  ///< serial number, address or Aravis's name
  std::optional<double> rate_hz, exposure_ms, gain;
  int width = 0, height = 0;
  double packet_delay_us = 0;
  std::string trigger;
  bool ptp = false;
};

GigeOptions gige_options(const Address& address, const Opening& opening) {
  GigeOptions required{.required = address.location, .rate_hz = opening.rate_hz, .exposure_ms = {}, .gain = {}, .trigger = {}};
  AddressOptions options(address);
  double rate = opening.rate_hz.value_or(0), exposure = 0, gain = -1;
  options.size("size", required.width, required.height);
  options.number("rate", rate, 0.1, 10000);
  options.number("exposure", exposure, 0.001, 10000);
  options.number("gain", gain, 0, 1000);
  options.number("packet_delay", required.packet_delay_us, 0, 1e6);
  options.text("trigger", required.trigger);
  options.flag("ptp", required.ptp);
  options.done();
  if (rate > 0) required.rate_hz = rate;
  if (exposure > 0) required.exposure_ms = exposure;
  if (gain >= 0) required.gain = gain;
  if (required.required.empty()) throw Error("{}: names no camera; write gige:SERIAL (marey cameras lists them)", address.text);
  return required;
}

std::string id_of(const std::string& required) {
  std::vector<std::string> found;
  std::string others;
  for (const GigeDevice& device : devices_there()) {
    if (device.id == required || device.serial == required || device.address == required) found.push_back(device.id);
    others += fmt::format("{}{}", others.empty() ? "" : ", ", device.serial);
  }
  if (found.size() > 1) throw Error("gige:{}: {} cameras have this serial number; name them by address", required, found.size());
  if (found.empty())
    throw Error("gige:{}: there is no such camera now; {}", required, others.empty() ? "none answers" : "there are: " + others);
  return found.front();
}

std::vector<ControlRange> controls_of(ArvCamera& camera) {
  std::vector<ControlRange> has;
  Failure failure;
  double minimum = 0, maximum = 0;
  arv_camera_get_exposure_time_bounds(&camera, &minimum, &maximum, failure.out());
  if (!failure.failed())
    has.push_back({Control::exposure, minimum / 1000, maximum / 1000, arv_camera_get_exposure_time(&camera, nullptr) / 1000});
  arv_camera_get_gain_bounds(&camera, &minimum, &maximum, failure.out());
  if (!failure.failed()) has.push_back({Control::gain, minimum, maximum, arv_camera_get_gain(&camera, nullptr)});
  return has;
}

class GigeCamera final : public Connection {
 public:
  explicit GigeCamera(const GigeOptions& options) : name_("gige:" + options.required) {
    Failure failure;
    {
      const std::string id = id_of(options.required);
      const std::lock_guard lock(facing());
      camera_.reset(arv_camera_new(id.c_str(), failure.out()));
    }
    if (camera_ == nullptr) throw Error("{}: cannot be opened ({}); another program may have it", name_, failure.why());
    configure(options);
    g_signal_connect(arv_camera_get_device(camera_.get()), "control-lost", G_CALLBACK(on_lost), &lost_);
    begin();
  }
  ~GigeCamera() override {
    arv_camera_stop_acquisition(camera_.get(), nullptr);
    stream_.reset();
    g_signal_handlers_disconnect_by_data(arv_camera_get_device(camera_.get()), &lost_);
  }

  const SourceInfo& info() const override { return info_; }

  std::vector<ControlRange> controls() override { return controls_of(*camera_); }

  void set(Control control, double value) override {
    ArvCamera* camera = camera_.get();
    if (control == Control::exposure) {
      demand("that exposure", [&](GError** e) { arv_camera_set_exposure_time(camera, 1000 * value, e); });
    } else {
      demand("that gain", [&](GError** e) { arv_camera_set_gain(camera, value, e); });
    }
  }

  Came next(Shot& shot) override {
    if (lost_) throw Error("{}: is gone", name_);
    ArvBuffer* buffer = arv_stream_timeout_pop_buffer(stream_.get(), static_cast<guint64>(kStopSlice.count()) * 1000);
    if (buffer == nullptr) return Came::nothing;
    const bool whole = arv_buffer_get_status(buffer) == ARV_BUFFER_STATUS_SUCCESS && read(*buffer, shot);
    arv_stream_push_buffer(stream_.get(), buffer);
    return whole ? Came::frame : Came::damaged;
  }

 private:
  static void on_lost(ArvDevice*, std::atomic<bool>* lost) { *lost = true; }

  /// Throws Error if the camera refuses the requested values.
  template <typename Set>
  void demand(const char* what, const Set& set) {
    Failure failure;
    set(failure.out());
    if (failure.failed()) throw Error("{}: does not take {} ({})", name_, what, failure.why());
  }

  void configure(const GigeOptions& options) {
    ArvCamera* camera = camera_.get();
    demand("Mono8 images", [&](GError** e) { arv_camera_set_pixel_format(camera, ARV_PIXEL_FORMAT_MONO_8, e); });
    if (options.width > 0)
      demand("that size", [&](GError** e) { arv_camera_set_region(camera, 0, 0, options.width, options.height, e); });
    if (options.rate_hz) demand("that rate", [&](GError** e) { arv_camera_set_frame_rate(camera, *options.rate_hz, e); });
    if (options.exposure_ms) set(Control::exposure, *options.exposure_ms);
    if (options.gain) set(Control::gain, *options.gain);
    if (!options.trigger.empty())
      demand("that trigger", [&](GError** e) { arv_camera_set_trigger(camera, options.trigger.c_str(), e); });
    if (options.ptp) enable_ptp();
    if (arv_camera_is_gv_device(camera)) {
      arv_camera_gv_auto_packet_size(camera, nullptr);  // where the network does not specify, the camera's own stays
      if (options.packet_delay_us > 0)
        demand("that packet delay",
               [&](GError** e) { arv_camera_gv_set_packet_delay(camera, static_cast<gint64>(1000 * options.packet_delay_us), e); });
    }
    info_.name = name_;
    int x = 0, y = 0;
    demand("being asked for its size",
           [&](GError** e) { arv_camera_get_region(camera, &x, &y, &info_.size.width, &info_.size.height, e); });
    Failure unknown;
    const double rate = arv_camera_get_frame_rate(camera, unknown.out());
    if (!unknown.failed() && rate > 0) info_.rate_hz = rate;
  }

  /// It has two names, by the camera's age.
  void enable_ptp() {
    ArvDevice* device = arv_camera_get_device(camera_.get());
    Failure failure;
    arv_device_set_boolean_feature_value(device, "PtpEnable", TRUE, failure.out());
    if (failure.failed()) arv_device_set_boolean_feature_value(device, "GevIEEE1588", TRUE, failure.out());
    if (failure.failed()) throw Error("{}: has no PTP ({}); omit ptp", name_, failure.why());
  }

  void begin() {
    Failure failure;
    stream_.reset(arv_camera_create_stream(camera_.get(), nullptr, nullptr, failure.out()));
    if (stream_ == nullptr) throw Error("{}: cannot be streamed from ({})", name_, failure.why());
    if (ARV_IS_GV_STREAM(stream_.get())) {
      // A frame with a lost packet waits this long for it: about a period, not the tenth of a second that is typical.
      const double period_us = std::clamp(1e6 / info_.rate_hz.value_or(25), 5000.0, 100000.0);
      g_object_set(stream_.get(), "frame-retention", static_cast<guint>(period_us), nullptr);
    }
    const auto payload = arv_camera_get_payload(camera_.get(), failure.out());
    if (failure.failed()) throw Error("{}: does not specify how large its frames are ({})", name_, failure.why());
    for (int i = 0; i < kBuffers; ++i) arv_stream_push_buffer(stream_.get(), arv_buffer_new_allocate(payload));
    arv_camera_start_acquisition(camera_.get(), failure.out());
    if (failure.failed()) throw Error("{}: does not begin ({})", name_, failure.why());
  }

  bool read(ArvBuffer& buffer, Shot& shot) {
    int x = 0, y = 0, width = 0, height = 0;
    std::size_t length = 0;
    arv_buffer_get_image_region(&buffer, &x, &y, &width, &height);
    const auto* bytes = static_cast<const std::uint8_t*>(arv_buffer_get_data(&buffer, &length));
    if (bytes == nullptr || arv_buffer_get_image_pixel_format(&buffer) != ARV_PIXEL_FORMAT_MONO_8) return false;
    auto image = unpack(Packing::grey, {bytes, length}, {width, height}, static_cast<std::size_t>(width));
    if (!image) return false;
    shot.given.frame.image = std::move(*image);
    shot.sequence = counted(arv_buffer_get_frame_id(&buffer));
    if (const guint64 stamp = arv_buffer_get_timestamp(&buffer); stamp > 0)
      shot.device_time = Duration(static_cast<std::int64_t>(stamp));
    return true;
  }

  /// Frames of GigE Vision 1 are numbered 1 … 65535, and again; later ones have 64 bits.
  std::int64_t counted(guint64 id) {
    constexpr std::int64_t kRound = 65535;
    auto step = static_cast<std::int64_t>(id) - static_cast<std::int64_t>(last_id_);
    if (step < 0 && last_id_ <= kRound) step += kRound;
    last_id_ = id;
    return sequence_ += step;
  }

  std::string name_;
  Owned<ArvCamera> camera_;
  Owned<ArvStream> stream_;
  SourceInfo info_;
  std::atomic<bool> lost_ = false;
  guint64 last_id_ = 0;
  std::int64_t sequence_ = 0;
};

void describe(const std::string& id, FoundCamera& found) {
  const std::lock_guard lock(facing());
  const Owned<ArvCamera> camera(arv_camera_new(id.c_str(), nullptr));
  if (camera == nullptr) return;  // another program has it
  int x = 0, y = 0, width = 0, height = 0;
  Failure failure;
  arv_camera_get_region(camera.get(), &x, &y, &width, &height, failure.out());
  if (!failure.failed()) {
    FoundCamera::Mode& mode = found.modes.emplace_back();
    mode.format = stated(arv_camera_get_pixel_format_as_string(camera.get(), nullptr));
    mode.size = {width, height};
    const double rate = arv_camera_get_frame_rate(camera.get(), failure.out());
    if (!failure.failed() && rate > 0) mode.rates_hz.push_back(rate);
  }
  for (const ControlRange& control : controls_of(*camera)) {
    const char* name = control.control == Control::exposure ? "exposure (ms)" : "gain";
    found.controls.push_back({name, control.minimum, control.maximum, control.now});
  }
}

}  // namespace

std::optional<Kind> gige_kind() {
  return Kind{.schemes = {"gige"},
              .form = "gige:SERIAL?rate=100&exposure=2",
              .meaning = "a machine-vision camera, on Ethernet or USB",
              .open = [](const Address& address, const Opening& opening) -> Connect {
                return
                    [options = gige_options(address, opening)](LiveTime&, const std::stop_token&) -> std::unique_ptr<Connection> {
                      return std::make_unique<GigeCamera>(options);
                    };
              }};
}

std::vector<FoundCamera> find_gige() {
  std::vector<FoundCamera> found;
  for (const GigeDevice& device : devices_there()) {
    FoundCamera& camera = found.emplace_back();
    camera.source = "gige:" + (device.serial.empty() ? device.id : device.serial);
    camera.name = fmt::format("{} {}", device.maker, device.model);
    camera.where = device.address;
    describe(device.id, camera);
  }
  return found;
}

}  // namespace marey::source::live
