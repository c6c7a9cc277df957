// Who may talk to the viewer. A page of any other site that is open in the same browser can reach every port of this machine, and
// browsers hold WebSockets to no same-origin policy: so every request must name this machine as its Host (against DNS rebinding),
// come from our own page where it says where it comes from (Origin), and bring the token.
#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "marey/net/http.h"

namespace marey::viewer {

class Access {
 public:
  struct Verdict {
    int status = 200;          ///< 200, or what a refusal says
    std::string message_text;  ///< of a refusal
    bool by_link = false;      ///< the token stood in the address: the answer is to set the cookie
  };

  /// `cookie` is the cookie's name, another one for each port, since browsers do not distinguish ports. `hosts` are names of this
  /// machine beside "localhost"; addresses in digits are taken always, for no name server stands behind them.
  Access(std::string token, std::string cookie, std::vector<std::string> hosts);

  Verdict check(const net::HttpRequest& head) const;
  const std::string& token() const { return token_; }
  /// The line that makes the browser bring the token from now on.
  std::string set_cookie() const;

 private:
  bool is_this_machine(std::string_view host) const;

  std::string token_, cookie_;
  std::vector<std::string> hosts_;
};

}  // namespace marey::viewer
