#pragma once

#include <map>
#include <string>
#include <string_view>

#include "marey/core/ground_recording.h"

namespace marey::format::match {

/// Gathers the people of a file that names them in its own way, and puts their places in order.
class GroundBuilder {
 public:
  explicit GroundBuilder(const std::string& name) : name_(name) {}

  /// The index of whom the file calls `key`; who is new gets this label and team, and the wanted id where it is positive and free,
  /// else the next one that is.
  std::int32_t person(const std::string& key, int wanted, const std::string& label, const std::string& team);
  /// x and y in m. Throws Error, which says `where`, for what is no place on the ground near a pitch.
  void add(std::int32_t frame, double time, std::int32_t person, double x, double y, std::string_view where);
  /// By frame and id. Throws Error where a person is twice in a frame.
  GroundRecording finish();

 private:
  const std::string& name_;
  GroundRecording recording_;
  std::map<std::string, std::int32_t> index_of_;
  std::map<int, std::int32_t> by_id_;
};

/// A name that only says the number again ("Player 7", "Track_7", "7") is the number; so is none.
std::string label_of(const std::string& name, int number);

}  // namespace marey::format::match
