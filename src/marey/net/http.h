// A request of HTTP as a server sees it, and what it answers.
#pragma once

#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace marey::net {

/// Fields are empty if the request has none of that name.
struct HttpRequest {
  std::string method = {};
  std::string target = {};  ///< "/scene?token=…"
  std::string host = {};    ///< "127.0.0.1:8780"
  std::string origin = {};
  std::string cookie = {};
  std::string authorization = {};
  std::vector<std::string> protocols = {};  ///< sub-protocols of a WebSocket that the client speaks
  bool upgrade = false;                     ///< to a WebSocket
};

struct HttpAnswer {
  int status = 200;
  std::string type = "text/plain; charset=utf-8";
  std::shared_ptr<const std::string> body = nullptr;
  std::vector<std::pair<std::string, std::string>> fields = {};
  bool keep = true;           ///< the connection stays open, if the client wants that
  bool upgrade = false;       ///< the WebSocket that was asked for is opened; nothing of the above counts
  std::string protocol = {};  ///< its sub-protocol; empty for none
};

/// A refusal with one sentence, after which the connection is closed.
HttpAnswer refusal(int status, const std::string& message_text);

}  // namespace marey::net
