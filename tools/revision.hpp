// Which Myriad this is.
#pragma once

namespace myriad::tools {

extern const char* const version;       // of the project
extern const char* const git_revision;  // at the time of configuring; "unknown" outside a git checkout

}  // namespace myriad::tools
