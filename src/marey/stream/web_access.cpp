#include "marey/stream/web_access.h"

#include <algorithm>
#include <cctype>
#include <string>

namespace marey::stream {
namespace {

/// Without its port.
std::string_view host_alone(std::string_view host) {
  if (host.starts_with('[')) return host.substr(0, host.find(']') + 1);
  return host.substr(0, host.find(':'));
}

}  // namespace

bool is_plain_host(std::string_view host) {
  std::string name(host_alone(host));
  for (char& c : name) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  if (name == "localhost" || (name.starts_with('[') && name.ends_with(']'))) return true;
  return !name.empty() && name.find_first_not_of("0123456789.") == std::string::npos;
}

bool is_trusted_origin(std::string_view origin) {
  if (origin.empty() || origin.starts_with("file://")) return true;
  for (const std::string_view trusted : {"https://app.foxglove.dev", "https://studio.foxglove.dev"}) {
    if (origin == trusted) return true;
  }
  for (const std::string_view scheme : {"http://", "https://"}) {
    if (!origin.starts_with(scheme)) continue;
    const std::string_view host = host_alone(origin.substr(scheme.size()));
    return host == "localhost" || host == "127.0.0.1" || host == "[::1]";
  }
  return false;
}

net::HttpAnswer answer_to_upgrade(const net::HttpRequest& request, const std::vector<std::string_view>& protocols) {
  if (!request.upgrade) return net::refusal(400, "this port speaks WebSocket alone");
  if (!is_plain_host(request.host)) return net::refusal(403, "this host is to be called by its address, or localhost");
  if (!is_trusted_origin(request.origin)) return net::refusal(403, "pages of other origins may not read this");
  if (protocols.empty()) return {.upgrade = true};
  for (const std::string_view protocol : protocols) {
    if (std::find(request.protocols.begin(), request.protocols.end(), protocol) != request.protocols.end())
      return {.upgrade = true, .protocol = std::string(protocol)};
  }
  return net::refusal(400, "none of the sub-protocols that this port speaks was asked for");
}

}  // namespace marey::stream
