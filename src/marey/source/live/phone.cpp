#include "marey/source/live/phone.h"

#include <algorithm>
#include <memory>
#include <optional>
#include <utility>

#include "marey/core/error.h"
#include "marey/core/rig.h"
#include "marey/core/stop.h"
#include "marey/files/source_name.h"
#include "marey/source/live/jpeg_decoder.h"
#include "marey/source/live/phone_server.h"

namespace marey::source::live {
namespace {

/// A name on the page, as long as it is read.
class PhoneOffer {
 public:
  PhoneOffer(std::shared_ptr<PhoneServer> server, std::string name) : server_(std::move(server)), name_(std::move(name)) {
    server_->offer(name_);
  }
  ~PhoneOffer() { server_->forget(name_); }
  PhoneOffer(const PhoneOffer&) = delete;
  PhoneOffer& operator=(const PhoneOffer&) = delete;

  const std::string& name() const { return name_; }
  bool is_connected() const { return server_->is_connected(name_); }
  std::optional<PhoneImage> next(std::chrono::milliseconds wait) { return server_->next(name_, wait); }

 private:
  std::shared_ptr<PhoneServer> server_;
  std::string name_;
};

class PhoneCamera final : public Connection {
 public:
  PhoneCamera(std::shared_ptr<PhoneOffer> offer, LiveTime& time) : offer_(std::move(offer)), time_(time) {
    info_.name = "phone " + offer_->name();
  }

  const SourceInfo& info() const override { return info_; }
  bool continues_numbers() const override { return true; }

  Came next(Shot& shot) override {
    const auto image = offer_->next(kStopSlice);
    if (!image) {
      if (!offer_->is_connected()) throw Error("phone {}: has gone; open its page again", offer_->name());
      return Came::nothing;
    }
    shot.sequence = image->sequence;
    if (image->taken) {
      const auto age = std::chrono::steady_clock::now().time_since_epoch() - image->taken->time_since_epoch();
      shot.taken = time_.now() - std::chrono::duration_cast<Duration>(age);
    }
    shot.given.frame.image = decoder_.decode(image->jpeg());
    if (shot.given.frame.image.empty()) return Came::damaged;
    if (info_.size.empty()) info_.size = shot.given.frame.image.size();
    return shot.given.frame.image.size() == info_.size ? Came::frame : Came::damaged;  // it was turned: the page says so
  }

 private:
  std::shared_ptr<PhoneOffer> offer_;
  LiveTime& time_;
  SourceInfo info_;
  JpegDecoder decoder_;
};

}  // namespace

Connect connect_phone(const std::string& name, std::shared_ptr<PhoneServer> server) {
  auto offer = std::make_shared<PhoneOffer>(std::move(server), name);
  return [offer](LiveTime& time, const std::stop_token&) -> std::unique_ptr<Connection> {
    if (!offer->is_connected()) throw Error("phone {}: no phone has opened the page yet", offer->name());
    return std::make_unique<PhoneCamera>(offer, time);
  };
}

std::shared_ptr<PhoneServer> phone_server_of(const Address& address) {
  int port = kPhonePort;
  AddressOptions options(address);
  options.whole("port", port, 0, 65535);
  options.done();
  if (address.location.empty() || std::any_of(address.location.begin(), address.location.end(), unfit_for_camera_name))
    throw Error("{}: write phone:NAME, with a name of letters, digits, - and _", address.text);
  return PhoneServer::at(port);
}

std::vector<std::shared_ptr<PhoneServer>> phone_servers_of(const Rig& rig) {
  std::vector<std::shared_ptr<PhoneServer>> servers;
  for (const RigCamera& camera : rig.cameras) {
    if (scheme_of(camera.source) != "phone") continue;
    auto server = phone_server_of(parse_address(camera.source));
    if (std::find(servers.begin(), servers.end(), server) == servers.end()) servers.push_back(std::move(server));
  }
  return servers;
}

}  // namespace marey::source::live
