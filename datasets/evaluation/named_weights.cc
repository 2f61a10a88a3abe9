#include "datasets/evaluation/named_weights.h"

#include "base/errors/errors.h"

namespace glint {

namespace fs = std::filesystem;

std::vector<NamedWeights> ReadNamedWeights(const std::vector<std::string>& texts) {
  std::vector<NamedWeights> all;
  for (const std::string& text : texts) {
    const size_t equals = text.find('=');
    if (equals == 0 || equals == std::string::npos || equals + 1 == text.size()) {
      throw UserError("weights: found \"" + text + "\"; write NAME=FILE");
    }
    const std::string name = text.substr(0, equals);
    const fs::path file = fs::absolute(text.substr(equals + 1));
    if (name.find('/') != std::string::npos) {
      throw UserError("weights: found the name \"" + name + "\"; use one without '/'");
    }
    if (!fs::is_regular_file(file)) {
      throw UserError(file, "weights", "no such file", "name a file of weights");
    }
    all.push_back({name, file});
  }
  return all;
}

}  // namespace glint
