// How long the light calibration and the rectification of a capture take, beside the decoding of
// its photographs: bench_light CAPTURE [texels]. The capture must have been calibrated
// (glint-calib). One thread, processor time, so that other work on the machine does not count.
#include <fmt/format.h>

#include <cstdlib>
#include <ctime>
#include <exception>
#include <vector>

#include "base/formats/calibration.h"
#include "base/formats/capture.h"
#include "base/photos/photo.h"
#include "calib/corners/detector.h"
#include "calib/light/light.h"
#include "calib/light/paper.h"
#include "rectify/views/rectify_photo.h"

namespace glint {
namespace {

double Now_s() {
  timespec now;
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + 1e-9 * static_cast<double>(now.tv_nsec);
}

struct Times {
  double decode = 0, detect = 0, sample = 0, solve = 0, linearise = 0, resample = 0;
};

// Runs `work` and adds its processor time to `total`.
template <class F>
auto Timed(double* total, F&& work) {
  const double start = Now_s();
  auto result = work();
  *total += Now_s() - start;
  return result;
}

int Measure(const std::filesystem::path& folder, int texels) {
  const Capture capture = ReadCapture(folder);
  const Calibration calibration = ReadCalibration(capture.work() / "calib/manifest.json");
  SamplePlane plane;
  plane.width = plane.height = texels;
  plane.width_mm = capture.sample_size_mm[0];
  plane.height_mm = capture.sample_size_mm[1];
  Times times;
  LightProblem problem;
  const std::vector<PaperSpot> spots =
      Timed(&times.sample, [&] { return PaperSpots(capture.board); });
  problem.cameras = calibration.cameras;
  double pixels = 0;
  for (const CalibratedPhoto& calibrated : calibration.photos) {
    const std::filesystem::path file = capture.folder / calibrated.photo;
    Photo photo = Timed(&times.decode, [&] { return ReadPhoto(file); });
    pixels += static_cast<double>(photo.image.pixels());
    const Encoding encoding = ResolveEncoding(capture.encoding, file, photo);
    const BoardDetection detection =
        Timed(&times.detect, [&] { return DetectBoard(GrayFromPhoto(photo), capture.board); });
    LightPhoto light;
    light.name = calibrated.photo;
    light.camera = calibrated.camera;
    light.camera_from_sample = calibrated.camera_from_sample;
    light.clips = !photo.is_float();
    light.samples = Timed(&times.sample, [&] {
      return SamplePaper(photo, encoding, capture.board, spots, detection.corners);
    });
    problem.photos.push_back(std::move(light));
    const LinearPhoto linear =
        Timed(&times.linearise, [&] { return LinearPhoto(std::move(photo), encoding); });
    const Camera& camera = calibration.cameras[calibrated.camera];
    ResampleOptions options;
    options.vignetting = camera;
    ViewCounts counts;
    Timed(&times.resample, [&] {
      return RectifyPhoto(linear, CameraProjection(camera, calibrated.camera_from_sample), plane,
                          options, {}, file, &counts);
    });
  }
  const LightEstimate light = Timed(&times.solve, [&] { return EstimateLight(problem); });
  const double ours = times.sample + times.solve + times.linearise + times.resample;
  fmt::print(
      "{} photographs, {:.1f} MP each, views of {} x {}; processor seconds on one thread\n"
      "decoding             {:8.2f}\nlight: paper sampled {:8.2f}\nlight: solved        {:8.2f}  "
      "({} spots, {})\nrectify: linearised  {:8.2f}\nrectify: resampled   {:8.2f}\n(board found    "
      " "
      "    {:8.2f}, not counted)\nlight and rectification / decoding: {:.2f} (target: less than "
      "6)\n",
      problem.photos.size(), pixels / 1e6 / static_cast<double>(problem.photos.size()), texels,
      texels, times.decode, times.sample, times.solve, light.inliers,
      light.known ? "solved" : light.problem, times.linearise, times.resample, times.detect,
      ours / times.decode);
  return ours < 6 * times.decode ? 0 : 1;
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) {
  if (argc < 2) {
    fmt::print(stderr, "usage: bench_light CAPTURE [texels]\n");
    return 2;
  }
  try {
    return glint::Measure(argv[1], argc > 2 ? std::atoi(argv[2]) : 1024);
  } catch (const std::exception& error) {
    fmt::print(stderr, "{}\n", error.what());
    return 2;
  }
}
