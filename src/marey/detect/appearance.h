// What a person wears, at a glance: the colour of the shirt.
//
// Of the person's box the rows between a fifth and a half of the way down are looked at: chest and belly, between the head and the
// shorts. Of those the pixels in the middle, and of those the ones that the background model says are not the scene. The median of
// their colours is the shirt's, whatever arms, numbers and a little grass are in between. The planes of the video are read as they
// are, at the chroma's half size, on a grid of a hundred places at most: nothing is converted but those.
// Cost: some microseconds a person, whatever the size.
#pragma once

#include <optional>

#include "marey/core/appearance.h"
#include "marey/core/detection.h"
#include "marey/core/foreground.h"
#include "marey/core/picture.h"

namespace marey {

/// The colour of the upper body of whom `detection` shows. Nothing where the picture is grey, no foreground is told, the head is
/// outside the picture, too few pixels are seen, or others share the region and the colour may be theirs.
std::optional<Appearance> upper_body(const Picture& picture, const Foreground& foreground, const Detection& detection);

}  // namespace marey
