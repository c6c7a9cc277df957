// A small web server for one page, on net/server.h: its files and data by HTTP, messages to it by WebSocket.
//
// What is published waits for no page. Of each topic a page has one slot, with the newest message; a page that reads slowly gets
// fewer messages, one that stops reading costs its slots and is cut off after half a minute.
#pragma once

#include <cstdint>
#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <utility>

namespace marey::viewer {

/// Shared by all pages that get them.
using Bytes = std::shared_ptr<const std::string>;
inline Bytes bytes_of(std::string text) {
  return std::make_shared<const std::string>(std::move(text));
}

/// One open WebSocket, never given twice.
enum class PageId : std::uint64_t {};

struct WebAnswer {
  int status = 200;
  std::string type = "application/octet-stream";
  Bytes body = bytes_of({});
};

/// Where to listen.
struct ListenAddress {
  std::string listen = "127.0.0.1";  ///< an address of this machine
  std::optional<int> port = {};      ///< 0: any that is free; nothing: `kDefaultPort`, or another where that is taken
};
inline constexpr int kDefaultPort = 8780;

class WebServer {
 public:
  /// All are called on the server's own thread.
  struct Handlers {
    std::function<WebAnswer(std::string_view target)> get;
    std::function<void(PageId)> joined = {};
    std::function<void(PageId)> left = {};
    std::function<void(PageId, std::string_view text)> received = {};  ///< 4 KiB at most, whatever an untrusted client wrote
  };
  struct Message {
    int topic = 0;
    Bytes bytes;
    bool text = false;
  };
  /// Messages so far, over all pages.
  struct Count {
    std::uint64_t sent = 0, dropped = 0;
    int pages = 0;
  };

  /// Throws Error if it cannot listen there: the port is taken, the address is not one of this machine's.
  WebServer(const ListenAddress& location, Handlers handlers);
  /// Begins to answer. An earlier client waits.
  void start();
  ~WebServer();
  WebServer(const WebServer&) = delete;
  WebServer& operator=(const WebServer&) = delete;

  /// "http://127.0.0.1:8780/?token=…": a person who has it may view the page.
  std::string address() const;

  /// From any thread; never waits. To the pages for which `wants` says so, which is asked on the server's thread.
  void publish(Message message, std::function<bool(PageId)> needs = {});
  /// To one page, on the server's thread.
  void send(PageId page, Message message);
  Count count() const;

 private:
  class Core;
  std::unique_ptr<Core> core_;
};

}  // namespace marey::viewer
