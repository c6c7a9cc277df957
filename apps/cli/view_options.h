#pragma once

#include "command_line.h"
#include "viewer/web_server.h"

namespace marey::cli {

/// --listen and --port, of every command that shows a page.
void add_listen_address(Command& command, viewer::ListenAddress& location);

/// Returns when the command is asked to stop.
void wait_for_stop();

}  // namespace marey::cli
