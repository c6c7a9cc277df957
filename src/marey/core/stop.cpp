#include "marey/core/stop.h"

#include <utility>

namespace marey {
namespace {

thread_local const std::stop_token* innermost_token = nullptr;

}  // namespace

StopScope::StopScope(std::stop_token token) : token_(std::move(token)), outer_(std::exchange(innermost_token, &token_)) {}

StopScope::~StopScope() {
  innermost_token = outer_;
}

const std::stop_token& StopScope::current() {
  static const std::stop_token never;
  return innermost_token != nullptr ? *innermost_token : never;
}

void stop_point() {
  if (StopScope::current().stop_requested()) throw Stopped();
}

}  // namespace marey
