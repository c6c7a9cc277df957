// What phones connect to: a page that opens the phone's camera and sends its images as they are taken, each with the time by the
// phone's own clock, which is compared with the clock here by round trips (node_clock.h).
//
// A phone sends binary messages: the time it took the image (8 bytes, a double of ms by its clock), the image's number (4 bytes),
// how many it could not send (4 bytes), all little-endian, then a JPEG; and text: "clock N MS", the answer to "clock N", and
// "state TEXT", what its user ought to know here too ("battery 18 %"), and "size 1280x720", that of its images, which every page of
// this camera is given from then on. A page names itself by a word of its own: on a new line it continues its numbers.
#pragma once

#include <chrono>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "marey/core/time.h"

namespace marey::source::live {

struct PhoneImage {
  std::string message;             ///< as it came; `jpeg` shows a part of it
  std::optional<Timestamp> taken;  ///< by std::chrono::steady_clock; nothing before the phone's clock is known
  std::int64_t sequence =
      0;  ///< by the phone's count, which continues when another one takes its place: a gap is images that did not come

  std::span<const std::uint8_t> jpeg() const;
};

/// The state of one phone.
struct PhoneState {
  std::string camera;
  bool connected = false;
  std::string stated;         ///< by the phone itself: its battery, that it was turned; empty: nothing
  std::int64_t images = 0;    ///< that came
  std::int64_t not_sent = 0;  ///< that the phone took and could not send
  double clock_s = 0;         ///< what its clock may be off here; 0: not known yet
};

class PhoneServer {
 public:
  /// The one of this port, begun by the first who asks and ended by the last. Throws Error if the port cannot be had.
  static std::shared_ptr<PhoneServer> at(int port);
  /// All that there are now.
  static std::vector<std::shared_ptr<PhoneServer>> all();

  explicit PhoneServer(int port);
  ~PhoneServer();
  PhoneServer(const PhoneServer&) = delete;
  PhoneServer& operator=(const PhoneServer&) = delete;

  /// A camera that a phone may be, until `forget`. Throws Error for a name that is there already.
  void offer(const std::string& camera);
  void forget(const std::string& camera);
  bool is_connected(const std::string& camera) const;
  /// The oldest image that was not taken yet; waits for it. Nothing if none came within `wait`, or the phone has gone.
  std::optional<PhoneImage> next(const std::string& camera, std::chrono::milliseconds wait);

  /// "https://192.168.1.5:8443/?token=…", which opens the page on a phone of the same network.
  std::string address() const;
  /// Of the certificate that the phone's browser asks about.
  const std::string& fingerprint() const;
  std::vector<PhoneState> states() const;
  /// Without TLS, on this host alone; for tests.
  int plain_port() const;

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace marey::source::live
