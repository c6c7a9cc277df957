#include "access.h"

#include <algorithm>
#include <array>
#include <utility>

#include <fmt/format.h>
#include <sys/random.h>

#include "marey/core/error.h"

namespace marey::viewer {
namespace {

/// In a time that does not specify how much of it is right.
bool same_secret(std::string_view a, std::string_view b) {
  if (a.size() != b.size()) return false;
  unsigned different = 0;
  for (std::size_t i = 0; i < a.size(); ++i) different |= static_cast<unsigned char>(a[i] ^ b[i]);
  return different == 0;
}

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

std::string_view path_of(std::string_view target) {
  return target.substr(0, target.find('?'));
}

std::string_view query_value(std::string_view target, std::string_view name) {
  const std::size_t mark = target.find('?');
  std::string_view query = mark == std::string_view::npos ? std::string_view() : target.substr(mark + 1);
  while (!query.empty()) {
    const std::size_t end = std::min(query.find('&'), query.size());
    const std::string_view one = query.substr(0, end);
    query.remove_prefix(std::min(end + 1, query.size()));
    if (one.size() > name.size() && one.starts_with(name) && one[name.size()] == '=') return one.substr(name.size() + 1);
  }
  return {};
}

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
  const std::string_view linked = query_value(head.target, "token");
  if (same_secret(linked, token_)) return {200, {}, true};
  if (same_secret(cookie_value(head.cookie, cookie_), token_)) return {200, {}, false};
  constexpr std::string_view kScheme = "token ";
  if (head.authorization.starts_with(kScheme) && same_secret(std::string_view(head.authorization).substr(kScheme.size()), token_))
    return {200, {}, false};
  return {401, "open the whole address that marey printed, with its token", false};
}

std::string Access::set_cookie() const {
  return fmt::format("{}={}; Path=/; HttpOnly; SameSite=Strict", cookie_, token_);
}

std::string new_token() {
  std::array<unsigned char, 24> bytes{};
  if (getrandom(bytes.data(), bytes.size(), 0) != static_cast<ssize_t>(bytes.size()))
    throw Error("the system gives no random numbers, and without a token the viewer would be open to every person");
  return fmt::format("{:02x}", fmt::join(bytes, ""));
}

}  // namespace marey::viewer
