// Tone curves that are known come back from series that were taken with them.
#include "calib/response/response.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <random>

#include "base/errors/errors.h"
#include "base/linearize/encoding.h"
#include "calib/response/sample_photos.h"
#include "tests/support/data_folder.h"
#include "tests/support/message_of.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using Curve = std::function<double(double)>;  // stored value to linear

double Gamma22(double v) { return std::pow(v, 2.2); }
double Srgb(double v) { return LinearFromEncoded(Encoding::kSrgb, static_cast<float>(v)); }
// A phone's: contrast raised in the middle, a soft shoulder.
double Phone(double v) {
  return std::pow(v, 2.0) * (1 + 0.9 * v * v * v * v) / 1.9 * (0.75 + 0.25 * v);
}

double Stored(const Curve& curve, double linear) {
  double low = 0, high = 1;
  for (int i = 0; i < 50; ++i) {
    const double middle = 0.5 * (low + high);
    (curve(middle) < linear ? low : high) = middle;
  }
  return 0.5 * (low + high);
}

// Spots from dark to bright, exposures a stop apart that are told as `told` times what they were.
ResponseProblem Series(const Curve& curve, double noise, double wrong_exposures = 0) {
  std::mt19937 random(7);  // its numbers, unlike those of distributions, are standardised
  const auto normal = [&] {
    double sum = -6;
    for (int i = 0; i < 12; ++i) sum += random() / 4294967296.0;
    return sum;
  };
  ResponseProblem problem;
  problem.spots = 150;
  std::vector<double> true_exposures;
  for (int j = 0; j < 9; ++j) {
    problem.exposures.push_back(std::exp2(j));
    true_exposures.push_back(std::exp2(j) * (1 + wrong_exposures * normal()));
  }
  for (int i = 0; i < problem.spots; ++i) {
    const double radiance = 0.003 * std::pow(100.0, i / 149.0);
    for (int j = 0; j < 9; ++j) {
      const double v =
          std::min(1.0, Stored(curve, std::min(1.0, radiance * true_exposures[j] / 8)));
      problem.observations.push_back({i, j, std::round(255 * v + noise * normal()) / 255});
    }
  }
  return problem;
}

// Largest relative difference from the truth over what was seen, the scale taken at the middle.
double WorstError(const ResponseEstimate& estimate, const Curve& truth) {
  const double scale = truth(128 / 255.0) / estimate.linear[128];
  double worst = 0;
  for (int code = 12; code <= 245; ++code) {
    worst = std::max(worst, std::abs(scale * estimate.linear[code] / truth(code / 255.0) - 1));
  }
  return worst;
}

TEST(Response, KnownCurvesComeBack) {
  for (const auto& [name, curve] :
       {std::pair<const char*, Curve>{"gamma", Gamma22}, {"sRGB", Srgb}, {"phone", Phone}}) {
    const ResponseEstimate estimate = EstimateResponse(Series(curve, 0.7));
    EXPECT_LT(WorstError(estimate, curve), 0.03) << name;
    EXPECT_LT(255 * estimate.rms, 1.0) << name;
  }
}

TEST(Response, ExposuresThatWereRoundedAreCorrected) {
  const ResponseProblem series = Series(Srgb, 0.5, 0.02);
  ResponseOptions exact;
  exact.exposure_sigma = 0;
  const ResponseEstimate free = EstimateResponse(series), held = EstimateResponse(series, exact);
  EXPECT_LT(free.rms, 0.7 * held.rms);
  EXPECT_LT(WorstError(free, Srgb), 0.05);
}

TEST(Response, TheCurveRisesWhateverItIsGiven) {
  ResponseProblem nonsense = Series(Srgb, 0.5);
  for (ResponseObservation& o : nonsense.observations) o.stored = 1 - o.stored;
  const ResponseEstimate estimate = EstimateResponse(nonsense);
  for (int code = 1; code < 256; ++code) {
    ASSERT_GT(estimate.linear[code], estimate.linear[code - 1]) << code;
  }
  EXPECT_GT(255 * estimate.rms, 3);  // and the residual tells
}

TEST(Response, TooFewSpotsAreRefused) {
  ResponseProblem few = Series(Srgb, 0.5);
  few.observations.resize(8);
  EXPECT_THAT(test::MessageOf<ComputationError>([&] { EstimateResponse(few); }),
              HasSubstr("series"));
}

TEST(Response, GreyPatchesAreASeriesToo) {
  const test::TemporaryFolder folder;
  Image image(320, 40, {"R", "G", "B"});
  std::string patches;
  for (int p = 0; p < 20; ++p) {
    const double reflectance = 0.02 * std::pow(45.0, p / 19.0);
    for (int c = 0; c < 3; ++c) {
      for (int y = 0; y < 40; ++y) {
        for (int x = 16 * p; x < 16 * (p + 1); ++x) {
          image.channel(c)[static_cast<size_t>(y) * 320 + x] =
              static_cast<float>(Stored(Phone, reflectance));
        }
      }
    }
    patches +=
        (p == 0 ? "" : ",") + ("{\"x\":" + std::to_string(16 * p + 2)) +
        ",\"y\":5,\"width\":12,\"height\":30,\"reflectance\":" + std::to_string(reflectance) + "}";
  }
  WritePng(folder / "grey.png", image);
  folder.Write("patches.json", "{\"patches\":[" + patches + "]}");
  ResponseOptions options;
  options.exposure_sigma = 0;
  const auto problems = SamplePatches({folder / "grey.png"}, ReadPatches(folder / "patches.json"));
  EXPECT_LT(WorstError(EstimateResponse(problems[1], options), Phone), 0.08);
}

TEST(Response, SeriesOfOneExposureIsRefused) {
  const test::TemporaryFolder folder;
  WritePng(folder / "a.png", Image(64, 64, {"R", "G", "B"}));
  EXPECT_THAT(test::MessageOf<UserError>([&] { SampleSeries({folder / "a.png"}, {}); }),
              HasSubstr("--exposures"));
  EXPECT_THAT(test::MessageOf<UserError>([&] {
                SampleSeries({folder / "a.png", folder / "a.png"}, {1, 1});
              }),
              HasSubstr("same exposure"));
}

TEST(Response, APhonesPaletteHasACurve) {
  std::vector<fs::path> photos;
  for (int i = 1; i <= 10; ++i) {
    const std::string number = (i < 10 ? "0" : "") + std::to_string(i);
    photos.push_back(test::DataFolder() / "captures/towel-flash-ambient/photos/colorcard_low" /
                     (number + ".jpg"));
  }
  if (!fs::exists(photos[0])) GTEST_SKIP() << "no data";
  const ResponseProblems problems = SampleSeries(photos, {});
  const ResponseEstimate estimate = EstimateResponse(problems[1]);
  EXPECT_LT(255 * estimate.rms, 4);
  EXPECT_GT(estimate.span, 30);
}

}  // namespace
}  // namespace glint
