// Which web pages may open a WebSocket to a stream. Browsers let any page open one to this host: a page of a foreign origin is
// refused by its Origin, a foreign name for this host (DNS rebinding) by its Host.
#pragma once

#include <string_view>
#include <vector>

#include "marey/net/http.h"

namespace marey::stream {

/// Whether a page of that origin may read measurements on this host: none, a local one, a file, Foxglove's own.
bool is_trusted_origin(std::string_view origin);
/// Whether it names this host by address, or as localhost.
bool is_plain_host(std::string_view host);

/// Opens the WebSocket, or says why not. Of `protocols` the first that the client speaks; any, or none, if the list is empty.
net::HttpAnswer answer_to_upgrade(const net::HttpRequest& request, const std::vector<std::string_view>& protocols = {});

}  // namespace marey::stream
