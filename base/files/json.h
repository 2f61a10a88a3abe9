// Manifests keep the order in which fields were written, so that files compare byte for byte.
#pragma once

#include <nlohmann/json.hpp>

namespace glint {
using Json = nlohmann::ordered_json;
}
