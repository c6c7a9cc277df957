// Phones as cameras: their browser opens a page of phone_server.h and sends what the phone's camera sees.
#pragma once

#include <functional>
#include <string>

#include "marey/source/live/connection.h"

namespace marey::source::live {

inline constexpr int kPhonePort = 8443;

/// A camera that a phone is, under `name` on the page of that port. The page waits for phones as long as what is returned, or a
/// connection of it, lives. Throws Error if the port cannot be had, or the name is another phone's.
Connect connect_phone(const std::string& name, int port = kPhonePort);

}  // namespace marey::source::live
