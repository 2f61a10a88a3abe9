// glint-response: a camera's tone curve from an exposure series or from grey patches.
#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include "base/errors/errors.h"
#include "base/linearize/response_curve.h"
#include "base/programs/program.h"
#include "calib/response/response.h"
#include "calib/response/response_picture.h"
#include "calib/response/sample_photos.h"

namespace glint {
namespace {

constexpr const char* kChannels[] = {"R", "G", "B"};

struct Settings {
  std::filesystem::path out = "response.json";
  std::vector<std::string> photos;
  std::vector<double> exposures;
  std::filesystem::path patches;
  bool one_curve = false;
  double exposure_sigma = 0.02;
};

std::vector<std::filesystem::path> Files(const Settings& settings) {
  if (settings.photos.empty()) {
    throw UserError("--photos: found none; give the photographs of a series: --photos a.jpg b.jpg");
  }
  if (!settings.exposures.empty() && settings.exposures.size() != settings.photos.size()) {
    throw UserError(fmt::format("--exposures: found {} numbers for {} photographs; give one each",
                                settings.exposures.size(), settings.photos.size()));
  }
  for (const double exposure : settings.exposures) {
    if (exposure > 0 && exposure < 1e9) continue;
    throw UserError(fmt::format("--exposures: found {}; give numbers greater than 0", exposure));
  }
  return {settings.photos.begin(), settings.photos.end()};
}

// All channels as one: spots of the three get numbers of their own.
ResponseProblem Joined(const ResponseProblems& problems) {
  ResponseProblem joined = problems[0];
  for (int c = 1; c < 3; ++c) {
    for (ResponseObservation observation : problems[c].observations) {
      observation.spot += joined.spots;
      joined.observations.push_back(observation);
    }
    joined.spots += problems[c].spots;
  }
  return joined;
}

std::vector<ResponseEstimate> Estimate(const Settings& settings) {
  const auto files = Files(settings);
  ResponseOptions options;
  const bool by_patches = !settings.patches.empty();
  options.exposure_sigma = by_patches ? 0 : settings.exposure_sigma;
  const ResponseProblems problems = by_patches ? SamplePatches(files, ReadPatches(settings.patches))
                                               : SampleSeries(files, settings.exposures);
  if (settings.one_curve) {
    return std::vector<ResponseEstimate>(3, EstimateResponse(Joined(problems), options));
  }
  std::vector<ResponseEstimate> estimates;
  for (const ResponseProblem& problem : problems) {
    estimates.push_back(EstimateResponse(problem, options));
  }
  return estimates;
}

Json Facts(const ResponseEstimate& estimate) {
  return {{"residual_8bit", 255 * estimate.rms},
          {"residual_8bit_gamma22", 255 * estimate.usual_rms},
          {"sigma_relative", estimate.sigma},
          {"observations", estimate.observations},
          {"spots", estimate.spots},
          {"exposure_span", estimate.span},
          {"seen_8bit", {255 * estimate.lowest, 255 * estimate.highest}},
          {"exposures", estimate.exposures}};
}

std::string Text(const ResponseEstimate& e, const std::string& name) {
  return fmt::format(
      "  {:<3} residual {:.2f} of 255 (gamma 2.2: {:.2f}), {} values of {} spots, seen from {:.0f} "
      "to {:.0f}, uncertain by {:.1f} % at most\n",
      name, 255 * e.rms, 255 * e.usual_rms, e.observations, e.spots, 255 * e.lowest,
      255 * e.highest, 100 * e.sigma);
}

ProgramResult Run(const Settings& settings) {
  const std::vector<ResponseEstimate> estimates = Estimate(settings);
  ResponseCurve curve;
  Json facts;
  std::string text = "response: " + settings.out.string() + "\n";
  for (int c = 0; c < 3; ++c) {
    curve.linear[c] = estimates[c].linear;
    facts["estimate"][kChannels[c]] = Facts(estimates[c]);
    if (c == 0 || !settings.one_curve) {
      text += Text(estimates[c], settings.one_curve ? "all" : kChannels[c]);
    }
    if (estimates[c].highest < 0.85 || estimates[c].lowest > 0.15) {
      spdlog::warn(
          "{}: only stored values from {:.0f} to {:.0f} were observed; outside that range the "
          "curve is extrapolated: add darker and brighter exposures",
          kChannels[c], 255 * estimates[c].lowest, 255 * estimates[c].highest);
    }
  }
  WriteResponseCurve(settings.out, curve, facts);
  std::filesystem::path picture = settings.out;
  picture.replace_extension(".png");
  WritePng(picture, ResponsePicture(curve));
  text += "picture: " + picture.string() + "\nname it in capture.toml: [radiometry] encoding = \"" +
          settings.out.filename().string() + "\"\n";
  Json json = {{"file", settings.out.generic_string()}, {"picture", picture.generic_string()}};
  json.update(facts);
  return {text, json};
}

}  // namespace
}  // namespace glint

int main(int argc, char** argv) {
  glint::Settings settings;
  glint::OptionSet set;
  set.AddPositional("out", &settings.out,
                    "file to write the curve to; to use it, set encoding under [radiometry] in "
                    "capture.toml to this path",
                    true);
  set.Add("photos", &settings.photos, "photographs of one static scene at several exposures");
  set.Add("exposures", &settings.exposures,
          "relative exposure of each photograph; if omitted, from EXIF");
  set.Add("patches", &settings.patches,
          "grey patches of known reflectance in the photographs (JSON; see docs/capture.md), "
          "instead of a series");
  set.Add("one-curve", &settings.one_curve, "the same curve for R, G and B");
  set.AddRange("exposure-sigma", &settings.exposure_sigma, 0, 0.5,
               "relative standard deviation of the exposures; 0: exact");
  const glint::ProgramInfo info{
      "glint-response",
      "Estimates a camera's tone curve from an exposure series or from grey patches.",
      GLINT_VERSION, "Example: glint response wood/response.json --photos series/*.jpg"};
  return glint::RunProgram(argc, argv, info, &set,
                           [&](const glint::CommonOptions&) { return glint::Run(settings); });
}
