#include "datasets/synth/disturbance.h"

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "base/errors/errors.h"
#include "datasets/procedural/material.h"
#include "datasets/synth/view_set.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

double AngleBetween_deg(const Vec3d& a, const Vec3d& b) {
  const double dot = a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
  const double lengths = std::hypot(a[0], a[1], a[2]) * std::hypot(b[0], b[1], b[2]);
  return std::acos(std::min(1.0, dot / lengths)) * 180 / std::numbers::pi;
}

// Every file below a folder but run.json, which has times.
std::string AllBytes(const fs::path& folder) {
  std::vector<fs::path> files;
  for (const auto& entry : fs::recursive_directory_iterator(folder)) {
    if (entry.is_regular_file() && entry.path().filename() != "run.json")
      files.push_back(entry.path());
  }
  std::sort(files.begin(), files.end());
  std::string bytes;
  for (const fs::path& file : files) {
    bytes += fs::relative(file, folder).string() + "\n" + test::ReadAll(file);
  }
  return bytes;
}

TEST(Disturbance, OfStrengthZeroChangesNoByte) {
  const test::TemporaryFolder folder;
  const MaterialSource material{"m", MakeMaterial(5, 24, 24)};
  CommonOptions common;
  common.threads = 1;
  ViewSetOptions plain, zero, some;
  plain.count = zero.count = some.count = 3;
  zero.disturbance = {0, 0, 0, {}};
  some.disturbance.registration_texel = 0.1;
  WriteViewSet(folder.path() / "plain", material, plain, common);
  WriteViewSet(folder.path() / "zero", material, zero, common);
  WriteViewSet(folder.path() / "some", material, some, common);
  EXPECT_EQ(AllBytes(folder.path() / "plain"), AllBytes(folder.path() / "zero"));
  EXPECT_NE(AllBytes(folder.path() / "plain"), AllBytes(folder.path() / "some"));
  EXPECT_NE(test::ReadAll(folder.path() / "some/glint/rectify/manifest.json")
                .find("\"registration-texel\": 0.1"),
            std::string::npos);
}

TEST(Disturbance, LightsAreOffByTheAngleAndTheManifestDoesNotKnow) {
  for (const std::string rule : {"dir", "photo"}) {
    ViewSetOptions options;
    options.rule = rule;
    options.count = 8;
    const PlannedViews plain = PlanViews(options, 4, 16, 16);
    options.disturbance.light_off_deg = 5;
    const PlannedViews off = PlanViews(options, 4, 16, 16);
    double azimuths_differ = 0;
    for (size_t i = 0; i < off.views.size(); ++i) {
      EXPECT_EQ(off.views[i].light_in_sample_mm, plain.views[i].light_in_sample_mm);
      EXPECT_EQ(off.taken[i].camera_in_sample_mm, plain.views[i].camera_in_sample_mm);
      const Vec3d& is = off.taken[i].light_in_sample_mm;
      const Vec3d& said = off.views[i].light_in_sample_mm;
      EXPECT_NEAR(AngleBetween_deg(is, said), 5, 1e-6);
      EXPECT_NEAR(std::hypot(is[0], is[1], is[2]), std::hypot(said[0], said[1], said[2]), 1e-9);
      azimuths_differ += std::abs((is[0] - said[0]) - (off.taken[0].light_in_sample_mm[0] -
                                                       off.views[0].light_in_sample_mm[0]));
    }
    EXPECT_GT(azimuths_differ, 0.01);
  }
}

TEST(Disturbance, EnvironmentIsInPercentOfTheFlashOnAWhitePlane) {
  SvbrdfMaps white(32, 32);
  for (const int p : {kNormalZ, kDiffuseR, kDiffuseG, kDiffuseB, kRoughness}) {
    std::fill(white.plane(p).begin(), white.plane(p).end(), 1.0f);
  }
  for (const std::string rule : {"dir", "photo"}) {
    ViewSetOptions options;
    options.rule = rule;
    options.bits = "float";
    const auto mean = [&] {
      const auto image = RenderPlannedView(white, PlanViews(options, 2, 32, 32), 0, options, 1);
      double sum = 0;
      for (const float value : image.rgb) sum += value;
      return sum / static_cast<double>(image.rgb.size());
    };
    const double flash = mean();
    options.disturbance.environment_percent = 10;
    // Dielectrics without specular albedo still gain up to a twentieth by Fresnel at the horizon.
    EXPECT_NEAR(mean() / flash, 1.10, 0.006) << rule;
    EXPECT_GE(mean() / flash, 1.0999) << rule;
  }
}

TEST(Disturbance, RegistrationMovesCornersByItsStrength) {
  Disturbance disturbance;
  disturbance.registration_texel = 0.5;
  double squares = 0;
  constexpr int kViews = 500;
  for (int i = 0; i < kViews; ++i) {
    const CornerShifts shifts = DrawDisturbance(disturbance, 7, i).shifts;
    for (int k = 0; k < 4; ++k) {
      squares += shifts.column[k] * shifts.column[k] + shifts.row[k] * shifts.row[k];
    }
  }
  EXPECT_NEAR(std::sqrt(squares / (4 * kViews)), 0.5, 0.02);
}

TEST(PlanViews, WithoutATopViewAllCamerasAreTilted) {
  ViewSetOptions options;
  options.count = 40;
  options.least_tilt_deg = 45;
  const PlannedViews planned = PlanViews(options, 1, 16, 16);
  for (const View& view : planned.views) {
    const double tilt = AngleBetween_deg(view.camera_in_sample_mm, {0, 0, 1});
    EXPECT_GE(tilt, 45);
    EXPECT_LE(tilt, 55);
  }
  options.rule = "photo";
  EXPECT_THROW(PlanViews(options, 1, 16, 16), UserError);
}

TEST(PlanViews, ExposureIsKnownAndMultipliesRadiance) {
  const SvbrdfMaps maps = MakeMaterial(3, 16, 16);
  ViewSetOptions options;
  options.bits = "float";
  const auto plain = RenderPlannedView(maps, PlanViews(options, 1, 16, 16), 1, options, 1);
  options.exposure_stops = -3;
  const PlannedViews planned = PlanViews(options, 1, 16, 16);
  EXPECT_EQ(planned.views[1].exposure, 0.125);
  const auto dark = RenderPlannedView(maps, planned, 1, options, 1);
  for (size_t i = 0; i < dark.rgb.size(); ++i) {
    ASSERT_NEAR(dark.rgb[i], plain.rgb[i] / 8, 1e-6 * plain.rgb[i] + 1e-9);
  }
}

}  // namespace
}  // namespace glint
