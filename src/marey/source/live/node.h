// A camera node: cameras of another computer, by a WebSocket for each camera of each host. The node answers questions: a camera's
// name with what it knows of it and the time by its clock, an empty question with its rig, and what a camera is set to, or is to be
// set to (node_message.h); and it sends each frame of the camera that a host subscribed to. Frames that no host could take in
// time are dropped, never kept.
#pragma once

#include <cstdint>
#include <functional>
#include <memory>
#include <optional>
#include <string>

#include "marey/source/live/address.h"
#include "marey/source/live/connection.h"
#include "marey/source/live/node_message.h"

namespace marey::source::live {

inline constexpr int kNodePort = 7780;

/// node:HOST:PORT/CAMERA; without a camera all of them are meant.
struct NodeAddress {
  std::string host;
  int port = kNodePort;
  std::string camera;

  /// "node:HOST:PORT"
  std::string node() const;
};

/// Throws Error if no host is named, or the port is not one.
NodeAddress node_address(const Address& address);

/// A camera of a node. Its frames have times by the run's clock: the node's clock is asked now and then.
Connect connect_node(const NodeAddress& location);

/// The rig of a node, as text of a rig file. Throws Error if it does not answer within two seconds; Stopped.
std::string query_rig_of_node(const NodeAddress& location);

/// What a node distributes.
class NodeServer {
 public:
  /// The answer to who asks for a camera, and the rig as text: asked from another thread.
  using Answer = std::function<NodeAnswer(const std::string& camera)>;
  using RigText = std::function<std::string()>;
  /// Sets what is wished for; nothing if there is no such camera.
  using Set = std::function<std::optional<NodeControls>(const NodeQuestion&)>;

  /// Listens at `address`, an address of this machine or "0.0.0.0". Throws Error if that, or the port, cannot be had.
  /// Without `set` nothing can be set from hosts.
  NodeServer(const std::string& address, int port, Answer answer, RigText rig, Set set = {});
  ~NodeServer();
  NodeServer(const NodeServer&) = delete;
  NodeServer& operator=(const NodeServer&) = delete;

  /// To the one who listens to that camera; never waits. From one thread at a time.
  void send(const std::string& camera, const std::string& message);

 private:
  struct Parts;
  std::unique_ptr<Parts> parts_;
};

}  // namespace marey::source::live
