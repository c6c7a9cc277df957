// Phones as cameras: their browser opens a page of phone_server.h and sends what the phone's camera sees.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "marey/core/rig.h"
#include "marey/source/live/address.h"
#include "marey/source/live/connection.h"
#include "marey/source/live/phone_server.h"

namespace marey::source::live {

inline constexpr int kPhonePort = 8443;

/// A camera that a phone is, under `name` on the server's page. The page waits for phones as long as what is returned, or a
/// connection of it, lives. Throws Error if the name is another phone's.
Connect connect_phone(const std::string& name, std::shared_ptr<PhoneServer> server);

/// The page that "phone:left?port=8443" is on. Throws Error as `connect_phone` does, and for an address that names no phone.
std::shared_ptr<PhoneServer> phone_server_of(const Address& address);
/// The pages of the rig's cameras that are phones, each once.
std::vector<std::shared_ptr<PhoneServer>> phone_servers_of(const Rig& rig);

}  // namespace marey::source::live
