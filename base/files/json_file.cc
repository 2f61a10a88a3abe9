#include "base/files/json_file.h"

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/text/json_depth.h"

namespace glint {

Json ReadJsonFile(const std::filesystem::path& file, const std::string& remedy,
                  std::size_t limit_bytes) {
  const std::string text = ReadTextFile(file, limit_bytes);
  const int depth = JsonDepth(text);
  if (depth > kMostJsonDepth) {
    throw UserError(file, "",
                    "brackets nested " + std::to_string(depth) + " deep, more than " +
                        std::to_string(kMostJsonDepth),
                    remedy);
  }
  try {
    return Json::parse(text);
  } catch (const nlohmann::json::exception& error) {
    throw UserError(file, "", "text that is not JSON (" + std::string(error.what()) + ")", remedy);
  }
}

}  // namespace glint
