// Exposure and gain of a camera while it gives images: between the one who asks for them and the thread that reads the camera.
#pragma once

#include <map>
#include <mutex>
#include <string>
#include <string_view>
#include <vector>

namespace marey::source::live {

/// ms; the camera's own unit; grey level that a marker's pixels pass where the camera finds them itself, 0: automatic.
enum class Control { exposure, gain, threshold };

/// "exposure", "gain", "threshold".
std::string_view to_string(Control control);

/// What a camera has, and between what it can be set.
struct ControlRange {
  Control control = Control::exposure;
  double minimum = 0, maximum = 0, now = 0;
};

class Connection;

class CameraControls {
 public:
  using Values = std::map<Control, double>;

  /// What is set as soon as the camera is there, and again whenever it comes back.
  explicit CameraControls(Values required = {}) : required_(std::move(required)) {}

  // From any thread.
  void request(Control control, double value);
  /// Whether a requested value is not set yet.
  bool waits() const;
  /// None where the camera has none, or was not there yet.
  std::vector<ControlRange> has() const;
  /// The values requested and accepted.
  Values taken() const;
  /// Why the last that was asked for was not taken, without the camera's name; empty if it was.
  std::string refused() const;

  // From the thread that reads the camera.
  /// It is connected.
  void begin(Connection& camera);
  /// Sets the values requested since the last call.
  void apply(Connection& camera);

 private:
  Values set(Connection& camera, const Values& values);

  mutable std::mutex mutex_;
  Values required_, fresh_, taken_;
  std::vector<ControlRange> has_;
  std::string refused_;
  bool setting_ = false;  // fresh until just now
};

}  // namespace marey::source::live
