#pragma once

#include "marey/core/recording.h"

namespace marey::edit {

/// The recording with the edits applied that its head says; it then has none, for they are in it. Throws Error if an edit cannot
/// be replayed.
Recording edited(Recording recorded);

}  // namespace marey::edit
