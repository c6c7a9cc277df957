#include "marey/stream/server.h"

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <thread>
#include <utility>

#include <arpa/inet.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/uio.h>

#include "marey/core/error.h"

namespace marey::stream {

void Outbox::answer(std::string bytes) {
  unread_ += bytes.size();
  waiting_.push_back({.head = std::move(bytes), .body = nullptr});
  flush();
  if (unread_ > kMostUnread) gone_ = true;
}

void Outbox::frame(std::string head, std::shared_ptr<const std::string> body) {
  if (gone_ || ending_) return;
  if (frames_ >= kMostFrames) {
    const auto first = waiting_.begin() + (begun_ > 0 ? 1 : 0);
    const auto oldest = std::find_if(first, waiting_.end(), [](const Message& message) { return message.body != nullptr; });
    if (oldest == waiting_.end()) return;
    waiting_.erase(oldest);
    --frames_;
    ++dropped_;
  }
  waiting_.push_back({.head = std::move(head), .body = std::move(body)});
  ++frames_;
  flush();
}

void Outbox::flush() {
  while (!waiting_.empty() && !gone_) {
    const Message& first = waiting_.front();
    const std::string_view body = first.body == nullptr ? std::string_view() : std::string_view(*first.body);
    const std::string_view head = std::string_view(first.head).substr(std::min(begun_, first.head.size()));
    const std::string_view rest = body.substr(begun_ - std::min(begun_, first.head.size()));
    std::array<iovec, 2> parts{{{const_cast<char*>(head.data()), head.size()}, {const_cast<char*>(rest.data()), rest.size()}}};
    msghdr message{};
    message.msg_iov = parts.data();
    message.msg_iovlen = parts.size();
    const ssize_t taken = sendmsg(socket_.get(), &message, MSG_NOSIGNAL | MSG_DONTWAIT);
    if (taken < 0) {
      gone_ = errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR && errno != ENOBUFS;
      return;
    }
    begun_ += static_cast<std::size_t>(taken);
    if (begun_ < first.head.size() + body.size()) return;
    if (first.body == nullptr) {
      unread_ -= first.head.size();
    } else {
      --frames_;
      ++sent_;
    }
    waiting_.pop_front();
    begun_ = 0;
  }
}

Server::Server(Loop& loop, Address at, const std::string& what, std::size_t most_clients, std::size_t most_bytes, Make make)
    : loop_(loop),
      at_(at),
      listener_(listen_at(at_, what)),
      most_clients_(most_clients),
      most_bytes_(most_bytes),
      make_(std::move(make)) {
  loop_.watch(listener_.get(), [this](Loop::Events) { accept_all(); });
}

Server::~Server() {
  const std::scoped_lock lock(loop_.mutex());
  loop_.forget(listener_.get());
  for (Client& client : clients_) loop_.forget(client.out.socket_.get());
}

void Server::accept_all() {
  for (;;) {
    sockaddr_in from{};
    socklen_t size = sizeof from;
    Descriptor socket(accept4(listener_.get(), reinterpret_cast<sockaddr*>(&from), &size, SOCK_NONBLOCK | SOCK_CLOEXEC));
    if (!socket) {
      // Without a descriptor for it the client stays in line: to look again at once would turn in circles.
      if (errno == EMFILE || errno == ENFILE || errno == ENOMEM || errno == ENOBUFS) loop_.rest(listener_.get(), true);
      return;
    }
    if (clients_.size() >= most_clients_) {
      ++counts_.refused;
      continue;
    }
    const int on = 1;
    setsockopt(socket.get(), IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    setsockopt(socket.get(), SOL_SOCKET, SO_KEEPALIVE, &on, sizeof on);
    const int sent_ahead = 1 << 17;  // what the system holds for a client that reads nothing is stale when it reads again
    setsockopt(socket.get(), SOL_SOCKET, SO_SNDBUF, &sent_ahead, sizeof sent_ahead);
    const int descriptor = socket.get();
    const Address peer{.host = ntohl(from.sin_addr.s_addr), .port = ntohs(from.sin_port)};
    Client& client = clients_.emplace_back(Client{Outbox(std::move(socket)), make_(peer), {}});
    ++counts_.clients;
    loop_.watch(descriptor, [this, &client](Loop::Events events) { handle(client, events); });
    client.session->joined(client.out);
    settle(client);
  }
}

void Server::handle(Client& client, Loop::Events events) {
  if (events.writable) client.out.flush();
  if (events.readable) read(client);
  settle(client);
}

void Server::read(Client& client) {
  std::array<char, 16384> came;
  const ssize_t got = recv(client.out.socket_.get(), came.data(), came.size(), 0);
  if (got == 0 || (got < 0 && errno != EAGAIN && errno != EWOULDBLOCK && errno != EINTR)) client.out.gone_ = true;
  if (got <= 0 || client.out.ending_) return;
  client.unread.append(came.data(), static_cast<std::size_t>(got));
  try {
    while (!client.unread.empty() && !client.out.over()) {
      const std::size_t done = client.session->received(client.unread, client.out);
      if (done == 0) break;
      client.unread.erase(0, done);
    }
    if (client.unread.size() > most_bytes_) throw Error("{} bytes that make no message", client.unread.size());
  } catch (const Error& complaint) {
    counts_.last_complaint = complaint.what();
    ++counts_.sent_off;
    client.out.end();  // what explains it goes out before
    client.unread.clear();
    if (!client.out.empty()) return;
    client.out.gone_ = true;
  }
}

bool Server::settle(Client& client) {
  if (client.out.unread_ > Outbox::kMostUnread) {
    ++counts_.sent_off;
    counts_.last_complaint = "left its answers unread";
  }
  if (client.out.over()) {
    remove(client);
    return false;
  }
  loop_.want_to_write(client.out.socket_.get(), !client.out.empty());
  return true;
}

void Server::remove(Client& client) {
  loop_.forget(client.out.socket_.get());
  counts_.sent += client.out.sent_;
  counts_.dropped += client.out.dropped_ + static_cast<std::int64_t>(client.out.frames_);
  const auto it = std::find_if(clients_.begin(), clients_.end(), [&](const Client& each) { return &each == &client; });
  clients_.erase(it);
}

void Server::each(const std::function<void(Session&, Outbox&)>& what) {
  for (auto it = clients_.begin(); it != clients_.end();) {
    Client& client = *it++;
    what(*client.session, client.out);
    settle(client);
  }
}

Server::Counts Server::counts() const {
  Counts now = counts_;
  now.now = std::ssize(clients_);
  for (const Client& client : clients_) {
    now.sent += client.out.sent_;
    now.dropped += client.out.dropped_;
  }
  return now;
}

void Server::tick() {
  loop_.rest(listener_.get(), false);
  each([](Session& session, Outbox& out) { session.tick(out); });
}

void Server::drain(int ms) {
  const auto until = std::chrono::steady_clock::now() + std::chrono::milliseconds(ms);
  for (;;) {
    {
      const std::scoped_lock lock(loop_.mutex());
      if (std::all_of(clients_.begin(), clients_.end(), [](const Client& client) { return client.out.empty(); })) return;
    }
    if (std::chrono::steady_clock::now() >= until) return;
    std::this_thread::sleep_for(std::chrono::milliseconds(2));
  }
}

}  // namespace marey::stream
