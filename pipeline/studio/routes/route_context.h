// What routes need to answer.
#pragma once

#include <functional>
#include <string>
#include <vector>

#include "pipeline/studio/access/access.h"
#include "pipeline/studio/access/phone_links.h"
#include "pipeline/studio/workspace/workspace.h"

namespace glint {

using Segments = std::vector<std::string>;  // of a path

struct RouteContext {
  Workspace* workspace;
  PhoneLinks* phones;
  std::string files_secret;        // in the addresses of results
  std::function<Door()> lan;       // the door for phones, as it is
  std::function<Door()> open_lan;  // the same, opened where it is not; throws HttpError 503
};

}  // namespace glint
