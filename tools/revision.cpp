#include "tools/revision.hpp"

namespace myriad::tools {

const char* const version = MYRIAD_VERSION;
const char* const git_revision = MYRIAD_REVISION;

}  // namespace myriad::tools
