// Photographs and advice as pages read them.
#pragma once

#include <map>
#include <string>

#include "base/files/json.h"
#include "pipeline/studio/captures/photo_list.h"
#include "pipeline/studio/photographs/advise.h"
#include "pipeline/studio/photographs/check_queue.h"

namespace glint {

// Of a photograph that waits for its check: what is not known is null.
Json WaitingPhotoJson(const StudioPhoto& photo);
// Adds what the check has found; `thumbnail` is the address of its small picture.
void AddCheck(const CheckedPhoto& checked, const std::string& thumbnail, Json* json);
// Adds how good it is among the others; `ids` by name.
void AddVerdict(const PhotoVerdict& verdict, const std::map<std::string, std::string>& ids,
                Json* json);

Json AdviceJson(const StudioAdvice& advice);

}  // namespace glint
