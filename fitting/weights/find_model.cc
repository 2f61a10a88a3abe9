#include "fitting/weights/find_model.h"

#include <cstdlib>
#include <stdexcept>
#include <vector>

namespace glint {

std::filesystem::path FindModel(const std::string& name, const std::filesystem::path& given) {
  namespace fs = std::filesystem;
  std::error_code ignored;
  if (!given.empty()) {
    if (fs::exists(given, ignored)) return given;
    throw std::runtime_error(given.string() + ": weights: found no such file; give the path of a " +
                             name + " or leave the option out");
  }
  std::vector<fs::path> places;
  if (const char* folder = std::getenv("GLINT_MODELS")) places.emplace_back(folder);
  const fs::path program = fs::read_symlink("/proc/self/exe", ignored);
  if (!program.empty()) {
    places.push_back(program.parent_path().parent_path() / "share/glint/models");
    places.push_back(program.parent_path().parent_path().parent_path() / "fitting/models");
  }
  places.emplace_back(GLINT_MODELS_SOURCE_DIR);
  std::string looked;
  for (const fs::path& place : places) {
    if (fs::exists(place / name, ignored)) return place / name;
    looked += (looked.empty() ? "" : ", ") + place.string();
  }
  throw std::runtime_error(name + ": weights: found in none of " + looked +
                           "; set GLINT_MODELS to the folder that holds it");
}

}  // namespace glint
