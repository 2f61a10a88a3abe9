// Short names of what tests/support has.
#pragma once

#include "tests/support/message_of.h"
#include "tests/support/process.h"

namespace glint {

using TempFolder = test::TemporaryFolder;
using test::MessageOf;

}  // namespace glint
