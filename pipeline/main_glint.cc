// glint: `glint <verb>` runs `glint-<verb>`; for build.ninja it runs one stage (see edge.h).
#include <string>
#include <vector>

#include "pipeline/driver/dispatch.h"
#include "pipeline/driver/edge.h"

int main(int argc, char** argv) {
  if (argc > 1 && argv[1] == std::string(glint::kEdgeFlag)) {
    return glint::RunEdge(std::vector<std::string>(argv + 2, argv + argc));
  }
  return glint::Dispatch(argc, argv, GLINT_VERSION);
}
