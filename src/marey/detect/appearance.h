// A person's appearance: the colour of the shirt, and of what the legs wear.
//
// Of the person's box the rows between a fifth and half its height down are used: chest and belly, between the head and the
// shorts. Of those the pixels in the middle, and of those the ones that the background model says are not the scene. The median of
// their colours is the shirt's, whatever arms, numbers and a little grass are in between. The planes of the video are read as they
// are, at the chroma's half size, on a grid of a hundred places at most: nothing is converted but those.
// Cost: some microseconds a person, whatever the size.
#pragma once

#include <cstddef>
#include <optional>
#include <span>

#include "marey/core/appearance.h"
#include "marey/core/detection.h"
#include "marey/core/foreground.h"
#include "marey/core/image.h"

namespace marey::detect {

/// The colour of the upper body of the person that detections[which] shows. Where others share the region, what lies in the box of
/// a person who stands nearer is omitted, and the rest is trusted less; likewise where no foreground is given, and the middle of
/// the chest alone is used. Nothing if the image is grey, the head is outside the image, or too few pixels are seen.
std::optional<Appearance> upper_body(const Image& image, const Foreground& foreground, std::span<const Detection> detections,
                                     std::size_t which);

/// The same of the legs, from below the hips to the knees: trousers, skirt or shorts. Nothing if the feet are outside the
/// image, or without a foreground: the scene shows between the legs.
std::optional<Appearance> lower_body(const Image& image, const Foreground& foreground, std::span<const Detection> detections,
                                     std::size_t which);

/// The same from below the knees to above the shoes: socks or trousers. Legs are apart in mid stride: searched over the whole
/// width.
std::optional<Appearance> shanks(const Image& image, const Foreground& foreground, std::span<const Detection> detections,
                                 std::size_t which);

}  // namespace marey::detect
