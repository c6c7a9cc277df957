#include "marey/source/live/kinds.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "marey/core/error.h"
#include "marey/source/live/gige.h"
#include "marey/source/live/network_stream.h"
#include "marey/source/live/phone.h"
#include "marey/source/live/played.h"
#include "marey/source/live/v4l2.h"
#include "marey/source/open_source.h"

namespace marey::source::live {
namespace {

Connect open_played(const Address& address, const Opening& opening) {
  PlayOptions how{.begin = opening.begin};
  AddressOptions options(address);
  double rate = opening.rate_hz.value_or(0);
  options.flag("loop", how.loop);
  options.number("rate", rate, 0.1, 10000);
  options.done();
  const std::optional<double> rate_hz = rate > 0 ? std::optional(rate) : std::nullopt;
  open_source(address.location, rate_hz);  // a file that is not there now will not come
  return play([path = address.location, rate_hz] { return open_source(path, rate_hz); }, how);
}

Connect open_network(const Address& address, const Opening& /*opening*/) {
  constexpr std::string_view kByUdp = "#udp";
  const bool udp = address.text.ends_with(kByUdp);
  if (address.location.empty()) throw Error("{}: names no host; write {}://HOST/PATH", address.text, address.scheme);
  return connect_network({.url = udp ? address.text.substr(0, address.text.size() - kByUdp.size()) : address.text, .udp = udp});
}

Connect open_phone(const Address& address, const Opening& /*opening*/) {
  return connect_phone(address.location, phone_server_of(address));
}

Connect open_v4l2(const Address& address, const Opening& opening) {
  return connect_v4l2(v4l2_options(address, opening.rate_hz));
}

}  // namespace

std::vector<FoundCamera> find_cameras() {
  std::vector<FoundCamera> found = find_v4l2(*system_kernel());
  for (FoundCamera& camera : find_gige()) found.push_back(std::move(camera));
  return found;
}

std::vector<Kind> camera_kinds() {
  std::vector<Kind> kinds{
      {.schemes = {"v4l2"},
       .form = "v4l2:/dev/video0?size=640x480&rate=30",
       .meaning = "a camera of this computer, as webcams are",
       .open = open_v4l2},
      {.schemes = {"rtsp", "rtsps", "http", "https"},
       .form = "rtsp://HOST/PATH, http://HOST/PATH",
       .meaning = "a camera on a network that sends a video",
       .open = open_network},
      {.schemes = {"phone"},
       .form = "phone:NAME?port=8443",
       .meaning = "a phone whose browser has opened the page that is printed",
       .open = open_phone},
      {.schemes = {"play"},
       .form = "play:FILE?loop",
       .meaning = "a video, or a folder of images, in real time",
       .open = open_played},
  };
  if (auto gige = gige_kind()) kinds.push_back(std::move(*gige));
  return kinds;
}

const Kind& kind_of(std::span<const Kind> kinds, const Address& address) {
  std::string known;
  for (const Kind& kind : kinds) {
    if (std::find(kind.schemes.begin(), kind.schemes.end(), address.scheme) != kind.schemes.end()) return kind;
    for (const std::string_view scheme : kind.schemes) known += fmt::format("{}{}:", known.empty() ? "" : ", ", scheme);
  }
  throw Error("{}: this build reads no {}: sources; it reads {}", address.text, address.scheme, known);
}

}  // namespace marey::source::live
