#include "marey/net/server.h"

#include <algorithm>
#include <cerrno>
#include <thread>
#include <utility>

#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>

#include "marey/core/error.h"
#include "marey/net/connection.h"

namespace marey::net {

std::size_t Session::received(std::string_view, Outbox&) {
  throw Error("speaks to a server of HTTP");
}

HttpAnswer Session::requested(const HttpRequest&) {
  return refusal(404, "there is nothing here");
}

HttpAnswer refusal(int status, const std::string& message_text) {
  return {.status = status, .body = std::make_shared<const std::string>(message_text + "\n"), .keep = false};
}

Server::Server(Loop& loop, Descriptor listener, const ServerOptions& options, Make make)
    : loop_(loop), listener_(std::move(listener)), options_(options), make_(std::move(make)) {
  const std::scoped_lock lock(loop_.mutex());
  loop_.watch(listener_.get(), [this] { return accept_all(); });
}

Server::Server(Loop& loop, Address at, const std::string& what, const ServerOptions& options, Make make)
    : Server(loop, listen_at(at, what), options, std::move(make)) {
  at_ = at;
}

Server::~Server() {
  const std::scoped_lock lock(loop_.mutex());
  loop_.forget(listener_.get());
  for (const auto& connection : connections_) {
    connection->close();
    connection->forget_session();
  }
}

bool Server::accept_all() {
  sweep();
  // Clients that have left may not be noticed yet: those in line wait for a tick, and are refused if no other client has left by
  // then.
  const bool refuses = std::exchange(full_, false) && connections_.size() >= options_.max_clients;
  for (;;) {
    if (connections_.size() >= options_.max_clients && !refuses) {
      full_ = true;
      return false;
    }
    Address peer;
    Descriptor socket = accept_from(listener_, peer);
    // Without a descriptor for it the client stays in line: another attempt at once would repeat without end.
    if (!socket) return errno != EMFILE && errno != ENFILE && errno != ENOMEM && errno != ENOBUFS;
    if (connections_.size() >= options_.max_clients) {
      ++counts_.refused;
      continue;
    }
    const int on = 1;
    setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    setsockopt(socket.get(), SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
    setsockopt(socket.get(), SOL_SOCKET, SO_SNDBUF, &options_.send_buffer, sizeof options_.send_buffer);
    connections_.push_back(make_connection(loop_, std::move(socket), options_, make_(peer)));
    ++counts_.clients;
    connections_.back()->start();
  }
}

void Server::sweep() {
  for (auto it = connections_.begin(); it != connections_.end();) {
    Connection& connection = **it;
    if (!connection.is_over()) {
      ++it;
      continue;
    }
    counts_.sent += connection.out().frames_sent();
    counts_.dropped += connection.out().frames_dropped();
    if (!connection.complaint().empty()) {
      ++counts_.disconnected;
      counts_.last_complaint = connection.complaint();
    }
    connection.forget_session();
    it = connections_.erase(it);
  }
}

void Server::each(const std::function<void(Session&, Outbox&)>& what) {
  for (const auto& connection : connections_) {
    if (!connection->is_over()) what(connection->session(), connection->out());
  }
}

Server::Counts Server::counts() const {
  Counts now = counts_;
  for (const auto& connection : connections_) {
    now.sent += connection->out().frames_sent();
    now.dropped += connection->out().frames_dropped();
    if (!connection->is_over()) ++now.now;
    if (connection->complaint().empty()) continue;
    ++now.disconnected;
    now.last_complaint = connection->complaint();
  }
  return now;
}

void Server::tick() {
  sweep();
  for (const auto& connection : connections_) connection->tick();
}

void Server::drain(int ms) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(ms);
  const auto has_all = [](const auto& connection) { return connection->is_over() || connection->out().is_empty(); };
  for (;;) {
    {
      const std::scoped_lock lock(loop_.mutex());
      if (std::all_of(connections_.begin(), connections_.end(), has_all)) return;
    }
    if (std::chrono::steady_clock::now() >= until) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

}  // namespace marey::net
