// Monte-Carlo check of calib's covariances: bench_scatter [draws]. Twenty photographs of a frame
// board by a 12 MP phone, corner noise of 0.15 px; every camera model, and a board whose bend is
// solved for. A ratio of 1 means that repetition scatters as predicted. FULL_OPENCV, whose radial
// terms a prior holds, a second time with lenses drawn anew for every capture.
#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>

#include "calib/validation/scatter.h"
#include "tests/calib/testing/board_scene.h"

namespace {

using namespace glint;

void Measure(CameraModel model, bool bend, int draws, bool draw_camera = false) {
  testing::SceneSettings settings;
  settings.photos = 20;
  settings.tilt_step_deg = 2;
  if (bend) settings.bend_mm = {0.6, -0.3};
  BundleOptions options;
  options.model = model;
  options.bend = bend;
  const auto scene = testing::MakeScene(testing::PhoneCamera(model), settings);
  const BundleResult truth = AdjustBundle(scene.problem, options);
  const Scatter scatter = MeasureScatter(scene.problem, truth, options, {80, 80}, settings.noise_px,
                                         draws, 1, draw_camera);
  fmt::print("\n{}{}\n{}", CameraModelName(model),
             bend          ? ", bend solved for"
             : draw_camera ? ", lenses drawn"
                           : "",
             scatter.Text());
  std::fflush(stdout);
}

}  // namespace

int main(int argc, char** argv) {
  const int draws = argc > 1 ? std::max(2, std::atoi(argv[1])) : 200;
  Measure(CameraModel::kSimpleRadial, false, draws);
  Measure(CameraModel::kRadial, false, draws);
  Measure(CameraModel::kOpenCv, false, draws);
  Measure(CameraModel::kOpenCv, true, draws);
  Measure(CameraModel::kFullOpenCv, false, draws);
  Measure(CameraModel::kFullOpenCv, false, draws, true);
}
