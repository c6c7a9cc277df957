#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "marey/core/ground_recording.h"
#include "marey/core/whole_file.h"

namespace marey::format::match {

/// People on the ground as CSV: frame,time,id,label,team,x,y,vx,vy,state,cameras. Frames count from 0; s, m, m/s; one row a person
/// and instant, by frame and id; state is observed or predicted; cameras are the names of those that saw the person, a space
/// between.
///
/// Reading asks for id, x, y and frame or time only, found by the header in any order, so that other tools' files may be brought.
/// Without time it is frame / rate_hz; without frame they are numbered by the median time between instants. Velocities that are
/// missing are 0. Throws Error, with the line, where something is not as it should be.
GroundRecording read_ground(const std::string& path, double rate_hz = 25);

/// The same from text; `name` is what messages call it.
GroundRecording parse_ground(std::string_view text, const std::string& name, double rate_hz = 25);

/// Writes such a file as it comes, so that memory does not grow with its length. Throws Error where the place is full.
class GroundWriter {
 public:
  GroundWriter(const std::string& path, std::vector<std::string> cameras);

  /// `person` is who `sample` is of; its index there is passed over. Rows come by frame, then by id.
  void write(const GroundRecording::Sample& sample, const GroundRecording::Person& person);

  /// Without it nothing is left behind.
  void finish();

 private:
  WholeFile file_;
  std::vector<std::string> cameras_;
  std::string text_, seen_by_;
};

/// Writes the file, whole or not at all. Throws Error where that cannot be.
void write_ground(const GroundRecording& recording, const std::string& path);

}  // namespace marey::format::match
