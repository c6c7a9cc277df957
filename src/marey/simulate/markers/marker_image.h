#pragma once

#include <cstdint>
#include <span>
#include <string_view>
#include <vector>

#include <opencv2/core.hpp>

#include "marey/core/geometry.h"

namespace marey::simulate::markers {

/// What else a camera sees beside markers. Each makes a threshold fail that expects one dark background.
enum class MarkerSetting {
  levels,       ///< three to five areas of grey levels up to 120
  bar,          ///< a bar at any angle, 15 to 40 % of the image wide, up to level 110
  texture,      ///< a lit area with bumps of all sizes, and specks of 7 to 40 levels
  gradient,     ///< the ground rises by up to 100 levels from one side to the other
  vignette,     ///< a lit ground that falls off by up to 80 % towards the corners
  glow,         ///< lamps at or beyond the image's edge, with their halo
  reflections,  ///< saturated patches of no regular form, 40 to 150 px long
  compressed,   ///< areas of several levels, and what JPEG leaves of them
  everything,   ///< three of the others together
  wand,         ///< infrared, 1024 × 704: three markers on a moving wand, some pairs that touch; blur, saturation, lamps, specks
  dots,         ///< 1280 × 1024: dense particles on a grey gradient
  shaded,  ///< rows of spheres lit from aside, 2.5 to 7 px in radius, among bright lines and up to 2,000 specks, some as bright
};

/// All with the names that programs print.
struct NamedMarkerSetting {
  std::string_view name;
  MarkerSetting setting;
};
std::span<const NamedMarkerSetting> marker_settings();

/// One image and where its markers truly are.
struct MarkerImage {
  cv::Mat image;                   ///< CV_8UC1, or CV_16UC1 with `bits` of them used
  int bits = 8;                    ///< 8, 12 or 16
  std::vector<Vector<2>> markers;  ///< px, their centres; of one in motion the middle of its path
  std::vector<Vector<2>> specks;   ///< px: regions as bright as markers and smaller, which one image cannot distinguish from them
  double radius = 0;               ///< px, the mean over the markers
  double shade = 0.3;              ///< radii by which the visible part of a marker may lie off its centre
  double noise = 0;                ///< standard deviation of a pixel, as a share of white times 255
  double contrast = 0;             ///< of the faintest marker over what is around it, likewise
};

/// Draws one image from `seed`: the same one on every machine. Radii, levels, noise, blur and depth are drawn with it; every
/// marker stands out from what is around it by 40 levels of 255 and ten standard deviations of the noise at least.
MarkerImage simulate_marker_image(MarkerSetting setting, std::uint64_t seed);

}  // namespace marey::simulate::markers
