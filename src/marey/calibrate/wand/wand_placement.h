#pragma once

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "marey/calibrate/bundle/bundle.h"
#include "marey/calibrate/rays.h"
#include "marey/calibrate/wand/wand_marks.h"

namespace marey::calibrate::wand {

struct WandCamera {
  std::string name;
  geometry::Lens lens;
  cv::Size size;
  bundle::LensFreedom freedom = {};  ///< how far the lens may move while the rig grows
  double sigma_px = 1;               ///< how far off a marker may be, lens included
};

/// By instant and camera: the wand's markers, as far as they are known there.
using WandTable = std::vector<std::vector<std::optional<Marks>>>;

/// Places of the markers of one wand, or the bearings under which a camera sees them.
using MarkerPositions = std::array<Vector<3>, WandShape::maximum>;

/// Where the wand was at each instant, by the cameras whose poses are known so far. Only views that show all markers take part.
class WandPlacement {
 public:
  /// `table` has to outlive this.
  WandPlacement(std::vector<WandCamera> cameras, WandShape wand, const WandTable& table);

  /// Places the wand by all static cameras and see it, two at least; leaves it unplaced where their rays do not meet or the
  /// wand would be far from its length.
  void location(std::size_t instant);
  void position_all();

  /// The markers before the wand's length is asked for: nothing if the rays do not meet. Turns views of a reversible wand
  /// so that they fit to the first.
  std::optional<MarkerPositions> markers(std::size_t instant);

  void set_lens(std::size_t camera, const geometry::Lens& lens);

  std::size_t instants() const { return bearings_.size(); }
  bool observes(std::size_t instant, std::size_t camera) const { return bearings_[instant][camera].has_value(); }
  const MarkerPositions& bearings(std::size_t instant, std::size_t camera) const { return *bearings_[instant][camera]; }
  /// The pixel of a marker, counted on the wand, not as the view shows it.
  Vector<2> pixel(std::size_t instant, std::size_t camera, std::size_t marker) const;
  Vector<3> marker_at(const bundle::Body& body, std::size_t marker) const;
  double sigma(std::size_t camera) const;  ///< rad
  const WandCamera& camera(std::size_t c) const { return cameras_[c]; }
  std::size_t cameras() const { return cameras_.size(); }
  const WandShape& wand() const { return wand_; }

  std::vector<std::optional<Rigid3>> poses;         ///< by camera, camera_from_world
  std::vector<std::optional<bundle::Body>> bodies;  ///< by instant
  std::vector<std::vector<char>> rotated;           ///< by instant and camera: its view has the wand's ends vice versa

 private:
  void measure(std::size_t camera);
  SightLine line(std::size_t instant, std::size_t camera, std::size_t marker) const;
  void turn_to_fit(std::size_t instant, std::size_t first, std::size_t other);

  std::vector<WandCamera> cameras_;
  WandShape wand_;
  const WandTable& table_;
  std::vector<std::vector<std::optional<MarkerPositions>>> bearings_;
};

}  // namespace marey::calibrate::wand
