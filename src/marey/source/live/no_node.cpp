// In place of node_camera.cpp and node_server.cpp where ZeroMQ is not installed.
#include "marey/core/error.h"
#include "marey/source/live/node.h"

namespace marey::source::live {
namespace {

constexpr const char* kWithoutZeroMq =
    "this build speaks to no camera nodes; libzmq3-dev and cppzmq-dev were not there when it was made";

}  // namespace

struct NodeServer::Parts {};

bool has_nodes() {
  return false;
}

Connect connect_node(const NodePlace&) {
  throw Error("{}", kWithoutZeroMq);
}

std::string ask_rig_of_node(const NodePlace&) {
  throw Error("{}", kWithoutZeroMq);
}

NodeServer::NodeServer(const std::string&, int, Answer, RigText, Set) {
  throw Error("{}", kWithoutZeroMq);
}

NodeServer::~NodeServer() = default;

void NodeServer::send(const std::string&, const std::string&) {}

}  // namespace marey::source::live
