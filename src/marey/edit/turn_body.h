// Which of the poses in which it appears the same a body has: the answer of a person, where its markers do not know
// (core/body.h, OtherPose).
#pragma once

#include "marey/core/recording.h"
#include "marey/edit/operation.h"
#include "marey/edit/request.h"

namespace marey::edit {

/// What "turn racket 310:" means for this recording. Throws Error if no body is called so, or none of its poses within the frames
/// is in question.
Operation decide_turn(const Request& request, const Recording& recording);

/// Within the operation's frames the body has its other pose where it has one, and the one that it had becomes the other. Throws
/// Error if the recording has no such body.
void turn_body(Recording& recording, const Operation& operation);

}  // namespace marey::edit
