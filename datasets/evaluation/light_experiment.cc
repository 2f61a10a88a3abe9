#include "datasets/evaluation/light_experiment.h"

#include <fmt/format.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <cmath>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/formats/svbrdf_file.h"
#include "base/programs/subprocess.h"
#include "datasets/looks/view_error.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

const fs::path kManifest = "glint/calib/manifest.json";

Json JsonOf(const Table1Row& row) {
  return {{"diffuse", row.maps.diffuse},       {"specular", row.maps.specular},
          {"roughness", row.maps.roughness},   {"normal", row.maps.normal},
          {"map_average", row.maps.average()}, {"render", row.render}};
}

Table1Row RowFromJson(const fs::path& file, const Json& json, const std::string& name) {
  const Json& object = RequireField(file, json, "result", name);
  const auto number = [&](const char* field) { return RequireNumber(file, object, name, field); };
  return {{number("diffuse"), number("specular"), number("roughness"), number("normal")},
          number("render")};
}

void Run(const std::string& program, const fs::path& capture, const fs::path& log, int threads,
         std::vector<std::string> more) {
  std::vector<std::string> arguments = {SiblingProgram(program).string(), capture.string(),
                                        "--threads", std::to_string(threads)};
  arguments.insert(arguments.end(), more.begin(), more.end());
  RunToLog(arguments, log);
}

class SeedRun {
 public:
  SeedRun(const LightExperimentOptions& options, int seed, int threads)
      : options_(options),
        seed_(seed),
        threads_(threads),
        folder_(options.work / fmt::format("seed_{:03}", seed)),
        capture_(folder_ / "capture") {}

  LightSeedResult Result(bool maps) {
    LightSeedResult result;
    result.seed = seed_;
    const Json light = Kept("light.json", Json::object(), [&] {
      Shoot();
      Calibrate("board");
      return Json{{"light", ToJson(CompareLight(Truth(), capture_ / kManifest))}};
    });
    result.light = LightErrorsFromJson(folder_ / "light.json", light.at("light"));
    if (!maps) return result;
    const Json arguments = {{"fit", options_.fit_arguments}, {"refine", options_.refine_arguments}};
    const Json rows = Kept("maps.json", arguments, [&] {
      Shoot();
      Json json;
      for (const char* light_of : {"board", "camera"}) json[light_of] = JsonOf(Maps(light_of));
      return json;
    });
    result.has_maps = true;
    result.board = RowFromJson(folder_ / "maps.json", rows, "board");
    result.camera = RowFromJson(folder_ / "maps.json", rows, "camera");
    return result;
  }

 private:
  // What makes a capture another one.
  Json CaptureSettings() const {
    const CapturePlanOptions& plan = options_.capture.plan;
    return {{"photos", plan.photos},         {"megapixels", plan.megapixels},
            {"vignetting", plan.vignetting}, {"exposure_ev", plan.exposure_ev},
            {"ambient", plan.ambient},       {"resolution", options_.resolution}};
  }

  // A result that is there with the same settings; else `make`'s.
  template <class F>
  Json Kept(const char* name, Json settings, F&& make) {
    settings.update(CaptureSettings());
    const fs::path file = folder_ / name;
    if (fs::exists(file) && !options_.again) {
      const Json json = Json::parse(ReadTextFile(file), nullptr, false);
      if (json.is_object() && json.value("settings", Json()) == settings) return json;
    }
    Json json = make();
    json["settings"] = settings;
    WriteFileAtomically(file, json.dump(1) + "\n");
    return json;
  }

  void Shoot() {
    const fs::path done = folder_ / "capture.json";
    if (fs::exists(capture_ / "capture.toml") && fs::exists(done) &&
        Json::parse(ReadTextFile(done), nullptr, false) == CaptureSettings()) {
      return;
    }
    fs::create_directories(folder_);
    SyntheticCaptureOptions options = options_.capture;
    options.plan.seed = static_cast<std::uint64_t>(seed_);
    options.resolution_px = options_.resolution;
    options.overwrite = true;
    const MaterialSource material =
        LoadMaterial("procedural:" + std::to_string(1000000000 + seed_), options_.resolution);
    WriteSyntheticCapture(capture_, material, options, threads_);
    WriteFileAtomically(done, CaptureSettings().dump(1) + "\n");
  }

  void Calibrate(const std::string& light) const {
    Run("glint-calib", capture_, folder_ / "log.txt", threads_, {"--light", light, "--force"});
  }

  Calibration Truth() const { return ReadCalibration(capture_ / "truth/calib/manifest.json"); }

  Table1Row Maps(const std::string& light) const {
    const fs::path log = folder_ / "log.txt";
    Calibrate(light);
    Run("glint-rectify", capture_, log, threads_, {});
    Run("glint-fit", capture_, log, threads_, options_.fit_arguments);
    Run("glint-refine", capture_, log, threads_, options_.refine_arguments);
    const FittedMaps fit = ReadFittedMaps(capture_ / "glint/refine");
    const SvbrdfMaps truth = ReadSvbrdf(capture_ / "truth/svbrdf.exr");
    const SvbrdfMaps estimate = ToUnitWeight(fit.maps, fit.convention);
    return EvaluateMaps(ResampleSvbrdf(estimate, truth.width, truth.height), truth, threads_);
  }

  const LightExperimentOptions& options_;
  int seed_, threads_;
  fs::path folder_, capture_;
};

// Share of the cases of a quantity (all: "") within their own three σ, and how many there are.
std::pair<double, int> CoverageOf(const std::vector<LightSeedResult>& seeds,
                                  const std::string& quantity) {
  int within = 0, all = 0;
  for (const LightSeedResult& seed : seeds) {
    for (const LightCase& one : seed.light.cases) {
      if (!quantity.empty() && one.quantity != quantity) continue;
      ++all;
      within += one.WithinThreeSigma();
    }
  }
  return {all > 0 ? 100.0 * within / all : 0, all};
}

// Root mean square of error / σ over the cases of a quantity: 1 where σ means what it says.
double Reduced(const std::vector<LightSeedResult>& seeds, const std::string& quantity) {
  double squares = 0;
  int count = 0;
  for (const LightSeedResult& seed : seeds) {
    for (const LightCase& one : seed.light.cases) {
      if (one.quantity != quantity || one.sigma <= 0) continue;
      squares += one.error * one.error / (one.sigma * one.sigma);
      ++count;
    }
  }
  return count > 0 ? std::sqrt(squares / count) : 0;
}

struct Quantity {
  const char *name, *label;
  double LightErrors::*error;
  double limit;
};
constexpr Quantity kQuantities[] = {
    {"flash", "flash position, mm", &LightErrors::flash_mm, 2},
    {"vignetting", "vignetting, % of full scale", &LightErrors::vignetting_percent, 1},
    {"exposure", "worst relative exposure, %", &LightErrors::exposure_percent, 1},
    {"ambient", "ambient, % of itself", &LightErrors::ambient_percent, 20}};

std::pair<double, double> MeanAndLargest(const std::vector<LightSeedResult>& seeds,
                                         double LightErrors::*error) {
  double sum = 0, largest = 0;
  for (const LightSeedResult& seed : seeds) {
    sum += seed.light.*error;
    largest = std::max(largest, seed.light.*error);
  }
  return {sum / std::max<size_t>(1, seeds.size()), largest};
}

std::string MapTable(const std::vector<LightSeedResult>& seeds) {
  std::string text =
      "\n| seed | map average, board | camera | render, board | camera | camera/board, render |\n"
      "|---|---|---|---|---|---|\n";
  double sums[4] = {0, 0, 0, 0};
  int count = 0;
  for (const LightSeedResult& seed : seeds) {
    if (!seed.has_maps) continue;
    ++count;
    const double values[4] = {seed.board.maps.average(), seed.camera.maps.average(),
                              seed.board.render, seed.camera.render};
    for (int i = 0; i < 4; ++i) sums[i] += values[i];
    text += fmt::format("| {} | {:.5f} | {:.5f} | {:.6f} | {:.6f} | {:.1f} |\n", seed.seed,
                        values[0], values[1], values[2], values[3], values[3] / values[2]);
  }
  if (count == 0) return "";
  return text + fmt::format("| mean | {:.5f} | {:.5f} | {:.6f} | {:.6f} | {:.1f} |\n",
                            sums[0] / count, sums[1] / count, sums[2] / count, sums[3] / count,
                            sums[3] / sums[2]);
}

}  // namespace

SyntheticCaptureOptions PhoneCapture() {
  SyntheticCaptureOptions capture;
  capture.plan.megapixels = 3;
  capture.plan.nearest_mm = 210;  // the frame fills the picture
  capture.plan.farthest_mm = 270;
  capture.plan.flash_offset_mm = {15, 0, 0};
  capture.plan.vignetting = 0.3;
  capture.plan.exposure_ev = 1;
  capture.plan.exif_error = 0.03;
  capture.plan.ambient = 0.03;
  capture.plan.paper_level = 1.0;
  capture.jpeg_quality = 92;
  capture.tell_flash = false;
  return capture;
}

std::string LightExperimentResult::Text() const {
  std::string text =
      "| quantity | mean error | largest | target | within 3σ, % of cases | RMS of error/σ |\n"
      "|---|---|---|---|---|---|\n";
  for (const Quantity& quantity : kQuantities) {
    const auto [mean, largest] = MeanAndLargest(seeds, quantity.error);
    const auto [percent, count] = CoverageOf(seeds, quantity.name);
    text +=
        fmt::format("| {} | {:.3f} | {:.3f} | {} | {:.1f} of {} | {:.2f} |\n", quantity.label, mean,
                    largest, quantity.limit, percent, count, Reduced(seeds, quantity.name));
  }
  const auto [percent, count] = CoverageOf(seeds, "");
  text += fmt::format("\n{} captures; all cases within 3σ: {:.1f} % of {}\n", seeds.size(), percent,
                      count);
  return text + MapTable(seeds);
}

std::string LightExperimentResult::Csv() const {
  std::string text =
      "seed,flash_mm,vignetting_percent,exposure_percent,ambient_percent,power_percent,"
      "residual_percent,within_3_sigma_percent,map_board,map_camera,render_board,render_camera\n";
  for (const LightSeedResult& seed : seeds) {
    const LightErrors& light = seed.light;
    text += fmt::format("{},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}", seed.seed,
                        light.flash_mm, light.vignetting_percent, light.exposure_percent,
                        light.ambient_percent, light.power_percent, light.residual_percent,
                        CoverageOf({seed}, "").first);
    text += seed.has_maps
                ? fmt::format(",{:.6g},{:.6g},{:.6g},{:.6g}\n", seed.board.maps.average(),
                              seed.camera.maps.average(), seed.board.render, seed.camera.render)
                : ",,,,\n";
  }
  return text;
}

Json LightExperimentResult::ToJson() const {
  Json json = {{"seeds", Json::array()}, {"summary", Json::object()}};
  for (const LightSeedResult& seed : seeds) {
    Json entry = {{"seed", seed.seed}, {"light", glint::ToJson(seed.light)}};
    if (seed.has_maps) {
      entry["board"] = JsonOf(seed.board);
      entry["camera"] = JsonOf(seed.camera);
    }
    json["seeds"].push_back(entry);
  }
  for (const Quantity& quantity : kQuantities) {
    const auto [mean, largest] = MeanAndLargest(seeds, quantity.error);
    const auto [percent, count] = CoverageOf(seeds, quantity.name);
    json["summary"][quantity.name] = {{"mean", mean},
                                      {"largest", largest},
                                      {"wanted", quantity.limit},
                                      {"within_3_sigma_percent", percent},
                                      {"cases", count},
                                      {"rms_of_error_over_sigma", Reduced(seeds, quantity.name)}};
  }
  json["summary"]["within_3_sigma_percent"] = CoverageOf(seeds, "").first;
  return json;
}

LightExperimentResult RunLightExperiment(const LightExperimentOptions& options, int threads) {
  LightExperimentResult result;
  for (int i = 0; i < options.seeds; ++i) {
    SeedRun run(options, options.first_seed + i, threads);
    result.seeds.push_back(run.Result(i < options.map_seeds));
    const LightErrors& light = result.seeds.back().light;
    spdlog::info(
        "seed {}: flash {:.2f} mm, vignetting {:.2f} %, exposure {:.2f} %, ambient {:.1f} %",
        options.first_seed + i, light.flash_mm, light.vignetting_percent, light.exposure_percent,
        light.ambient_percent);
  }
  WriteFileAtomically(options.work / "light.csv", result.Csv());
  WriteFileAtomically(options.work / "light.json", result.ToJson().dump(1) + "\n");
  return result;
}

}  // namespace glint
