#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "marey/calibrate/bundle/bundle.h"
#include "marey/calibrate/marker_line.h"
#include "marey/calibrate/rays.h"

namespace marey::calibrate {

struct StartingCamera {
  std::string name;
  geometry::Lens lens;
  cv::Size size;
  bundle::LensFreedom freedom = {};  ///< how far the lens may move while the rig grows
  double sigma_px = 1;               ///< how far off a marker may be, lens included
};

/// By instant and camera: the markers of one line, as far as they are known there.
using MarkTable = std::vector<std::vector<std::optional<Marks>>>;

/// Places of the markers of one line, or the bearings under which a camera sees them.
using MarkerPositions = std::array<Vector<3>, MarkerLine::maximum>;

/// Where the line was at each instant, by the cameras whose poses are known so far. Only views that show all markers take part.
class LinePlacement {
 public:
  /// `table` has to outlive this.
  LinePlacement(std::vector<StartingCamera> cameras, MarkerLine line, const MarkTable& table);

  /// Places the line by all static cameras that see it, two at least; leaves it unplaced where their rays do not meet or it
  /// would be far from its length.
  void location(std::size_t instant);
  void position_all();

  /// The markers before the line's length is asked for: nothing if the rays do not meet. Turns views of a reversible line
  /// so that they fit to the first.
  std::optional<MarkerPositions> markers(std::size_t instant);

  void set_lens(std::size_t camera, const geometry::Lens& lens);

  std::size_t instants() const { return bearings_.size(); }
  bool observes(std::size_t instant, std::size_t camera) const { return bearings_[instant][camera].has_value(); }
  const MarkerPositions& bearings(std::size_t instant, std::size_t camera) const { return *bearings_[instant][camera]; }
  /// The pixel of a marker, counted on the line, not as the view shows it.
  Vector<2> pixel(std::size_t instant, std::size_t camera, std::size_t marker) const;
  Vector<3> marker_at(const bundle::Body& body, std::size_t marker) const;
  double sigma(std::size_t camera) const;  ///< rad
  const StartingCamera& camera(std::size_t c) const { return cameras_[c]; }
  std::size_t cameras() const { return cameras_.size(); }
  const MarkerLine& line() const { return line_; }

  std::vector<std::optional<Rigid3>> poses;         ///< by camera, camera_from_world
  std::vector<std::optional<bundle::Body>> bodies;  ///< by instant
  std::vector<std::vector<char>> rotated;           ///< by instant and camera: its view has the line's ends vice versa

 private:
  void measure(std::size_t camera);
  SightLine sight(std::size_t instant, std::size_t camera, std::size_t marker) const;
  void turn_to_fit(std::size_t instant, std::size_t first, std::size_t other);

  std::vector<StartingCamera> cameras_;
  MarkerLine line_;
  const MarkTable& table_;
  std::vector<std::vector<std::optional<MarkerPositions>>> bearings_;
};

}  // namespace marey::calibrate
