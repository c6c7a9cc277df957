#include "access.h"

#include <algorithm>
#include <utility>

#include <fmt/format.h>

#include "marey/net/token.h"

namespace marey::viewer {
namespace {

/// "127.0.0.1" of "127.0.0.1:8780", "[::1]" of "[::1]:8780".
std::string_view without_port(std::string_view host) {
  const std::size_t colon = host.rfind(':');
  if (colon == std::string_view::npos) return host;
  const std::size_t bracket = host.rfind(']');
  if (bracket != std::string_view::npos && bracket > colon) return host;
  const std::string_view port = host.substr(colon + 1);
  const bool digits = std::all_of(port.begin(), port.end(), [](char c) { return c >= '0' && c <= '9'; });
  return digits ? host.substr(0, colon) : host;
}

bool is_address(std::string_view host) {
  if (host.size() > 2 && host.front() == '[' && host.back() == ']') {
    host = host.substr(1, host.size() - 2);
    const auto part = [](char c) {
      return (c >= '0' && c <= '9') || (c >= 'a' && c <= 'f') || (c >= 'A' && c <= 'F') || c == ':' || c == '.';
    };
    return std::all_of(host.begin(), host.end(), part);
  }
  const auto part = [](char c) { return (c >= '0' && c <= '9') || c == '.'; };
  return std::count(host.begin(), host.end(), '.') == 3 && std::all_of(host.begin(), host.end(), part);
}

std::string_view cookie_value(std::string_view cookies, std::string_view name) {
  while (!cookies.empty()) {
    const std::size_t end = std::min(cookies.find(';'), cookies.size());
    std::string_view one = cookies.substr(0, end);
    cookies.remove_prefix(std::min(end + 1, cookies.size()));
    while (!one.empty() && one.front() == ' ') one.remove_prefix(1);
    if (one.size() > name.size() && one.starts_with(name) && one[name.size()] == '=') return one.substr(name.size() + 1);
  }
  return {};
}

}  // namespace

Access::Access(std::string token, std::string cookie, std::vector<std::string> hosts)
    : token_(std::move(token)), cookie_(std::move(cookie)), hosts_(std::move(hosts)) {}

bool Access::is_this_machine(std::string_view host) const {
  const std::string_view name = without_port(host);
  return name == "localhost" || is_address(name) || std::find(hosts_.begin(), hosts_.end(), name) != hosts_.end();
}

Access::Verdict Access::check(const net::HttpRequest& head) const {
  if (!is_this_machine(head.host)) return {403, "this address is not a name of the machine that is asked", false};
  if (!head.origin.empty() && head.origin != "http://" + head.host) return {403, "asked by a page of another site", false};
  if (head.upgrade && head.origin.empty() && head.authorization.empty())
    return {403, "a WebSocket is opened by our own page, which says its Origin, or with an Authorization", false};
  const std::string_view linked = net::query_value(head.target, "token");
  if (net::same_secret(linked, token_)) return {200, {}, true};
  if (net::same_secret(cookie_value(head.cookie, cookie_), token_)) return {200, {}, false};
  constexpr std::string_view kScheme = "token ";
  if (head.authorization.starts_with(kScheme) &&
      net::same_secret(std::string_view(head.authorization).substr(kScheme.size()), token_))
    return {200, {}, false};
  return {401, "open the whole address that marey printed, with its token", false};
}

std::string Access::set_cookie() const {
  return fmt::format("{}={}; Path=/; HttpOnly; SameSite=Strict", cookie_, token_);
}

}  // namespace marey::viewer
