#include "fitting/refine/refine_stage.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <optional>
#include <utility>

#include "base/formats/rectified_set.h"
#include "base/formats/svbrdf_file.h"
#include "base/images/image.h"
#include "fitting/refine/point_spread.h"
#include "fitting/refine/sample_source.h"
#include "fitting/render/render_environment.h"
#include "fitting/view_correction/corrections_json.h"
#include "tests/fitting/refine/synthetic_scene.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using test::ReadAll;

constexpr int kSize = 24;

// A capture as rectify and fit leave it: a fit of half the size, light found 2× too weak.
// What is said of the lights: how far aside of the true ones they stand, and how well that is
// known.
struct SaidOfLights {
  double aside_mm = 0;
  std::optional<double> sd_mm;
};

// A photograph that lies out of focus by so much more than the others.
struct OutOfFocus {
  size_t view = 0;
  double variance = 0;  // texels²
};

void WriteCapture(const fs::path& folder, int views = 3,
                  const EnvironmentLighting& environment = {}, const SaidOfLights& said = {},
                  const OutOfFocus& blurred = {},
                  const std::function<void(RectifiedSet* set)>& restate = {}) {
  test::WriteAll(folder / "capture.toml",
                 "[sample]\nsize_mm = [2, 2]\n[photos]\nfiles = [\"photos/*.png\"]\n");
  test::WriteAll(folder / "photos/0.png", "refine reads rectified views only");
  test::SyntheticScene scene = test::Photograph(test::QuarteredMaps(kSize, 1), views, 8);
  for (size_t i = 0; i < scene.views.size(); ++i) {
    AddEnvironmentLighting(environment, scene.truth, scene.plane, scene.views[i], scene.convention,
                           scene.photographs[i].data());
  }
  Json names = Json::array();
  CommonOptions common;
  common.threads = 1;
  const OptionSet none;
  {
    RectifiedSet set;
    set.plane = scene.plane;
    set.convention = scene.convention;
    set.light_power_known = said.sd_mm.has_value();
    set.light_sd_mm = said.sd_mm;
    Stage stage(folder / "glint/rectify", {"rectify", 1}, none, common, {});
    for (size_t i = 0; i < scene.views.size(); ++i) {
      RectifiedView view;
      view.name = "view_00" + std::to_string(i);
      names.push_back(view.name);
      view.file = view.name + ".exr";
      view.photo = "photos/" + std::to_string(i) + ".png";
      view.view = scene.views[i];
      for (double& power : view.view.light_rgb) power /= 2.0;
      view.view.light_in_sample_mm[0] += said.aside_mm;
      RectifiedImage image;
      image.width = image.height = kSize;
      image.rgb = scene.photographs[i];
      if (blurred.variance > 0) {
        view.pixels_per_texel = 2;
        view.blur_px = 0.6;
        if (i == blurred.view) {
          view.blur_px = std::hypot(0.6, 2 * std::sqrt(blurred.variance));
          image.rgb = PointSpread(blurred.variance).Blurred(image.rgb, kSize, kSize);
        }
      }
      set.views.push_back(view);
      image.mask = scene.masks[i];
      WriteRectifiedImage(stage.Output(view.file), image, set, view);
    }
    if (restate) restate(&set);
    stage.Commit(ToJson(set), Json::object());
  }
  Stage stage(folder / "glint/fit", {"fit", 1}, none, common, {});
  const SvbrdfMaps start =
      ResampleSvbrdf(test::DisturbedMaps(scene.truth, 0.5f, 2), kSize / 2, kSize / 2);
  WriteSvbrdf(stage.Output("svbrdf.exr"), start, scene.convention);
  stage.Commit({{"convention", ToString(scene.convention)},
                {"light_scale_rgb", {2.0, 2.0, 2.0}},
                {"views", names},
                {"method", "latent"}},
               Json::object());
}

test::Outcome Refine(const fs::path& folder, std::vector<std::string> more = {}) {
  std::vector<std::string> command = {std::string(GLINT_BIN_DIR) + "/glint-refine",
                                      folder.string()};
  command.insert(command.end(), more.begin(), more.end());
  return test::RunProgram(command);
}

TEST(RefineStage, WritesMapsConfidenceAndManifestOfTheViewsSize) {
  const test::TemporaryFolder folder;
  WriteCapture(folder.path());
  // Three photographs do not tell that the curve is straight.
  const test::Outcome outcome = Refine(folder.path(), {"--toe", "0", "--shoulder", "0"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const fs::path result = folder.path() / "glint/refine";
  const Manifest manifest = ReadManifest(result / "manifest.json", "refine");
  VerifyOutputs(result / "manifest.json", manifest);
  // Fit's, times what refinement found beside it.
  const double power = manifest.metrics["light_power"]["factor"];
  EXPECT_NE(power, 1);
  EXPECT_EQ(manifest.data["light_scale_rgb"], Json({2 * power, 2 * power, 2 * power}));
  EXPECT_EQ(manifest.data["method"], "refined");
  EXPECT_EQ(manifest.data["views"].size(), 3u);
  EXPECT_LT(manifest.metrics["cost_after"], manifest.metrics["cost_before"]);
  EXPECT_EQ(ReadSvbrdf(result / "svbrdf.exr").width, kSize);
  const Image confidence = ReadExr(result / "confidence.exr");
  for (const char* channel : {"normal.X", "normal.Y", "diffuse.G", "specular.B", "roughness.Y"}) {
    EXPECT_GE(confidence.ChannelIndex(channel), 0) << channel;
  }
  // The light's scale was applied: with it the photographs are explained.
  EXPECT_LT(manifest.metrics["log_l1"], 0.05);
}

TEST(RefineStage, DoesNothingWhenUpToDateAndRunsAgainForAnotherOption) {
  const test::TemporaryFolder folder;
  WriteCapture(folder.path());
  ASSERT_EQ(Refine(folder.path()).code, 0);
  const fs::path manifest = folder.path() / "glint/refine/manifest.json";
  const std::string first = ReadAll(manifest);
  const auto written = fs::last_write_time(manifest);
  ASSERT_EQ(Refine(folder.path()).code, 0);
  EXPECT_EQ(fs::last_write_time(manifest), written);
  ASSERT_EQ(Refine(folder.path(), {"--prior", "10"}).code, 0);
  EXPECT_NE(ReadAll(manifest), first);
}

TEST(RefineStage, KeepsViewsBack) {
  const test::TemporaryFolder folder;
  WriteCapture(folder.path());
  ASSERT_EQ(Refine(folder.path(), {"--exclude", "view_001"}).code, 0);
  const Manifest manifest = ReadManifest(folder.path() / "glint/refine/manifest.json", "refine");
  EXPECT_EQ(manifest.data["views"], Json({"view_000", "view_002"}));
}

TEST(RefineStage, AFlashThatWasMeasuredMovesNoFurtherThanItsAccuracyAllows) {
  const auto largest_offset_mm = [](const SaidOfLights& said) {
    const test::TemporaryFolder folder;
    WriteCapture(folder.path(), 9, {}, said);
    const test::Outcome outcome = Refine(folder.path(), {"--correct-views", "always"});
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    const fs::path file = folder.path() / "glint/refine/manifest.json";
    double largest = 0;
    for (const auto& [name, correction] :
         ReadCorrections(file, ReadManifest(file, "refine").data)) {
      const Vec3d& offset = correction.light_offset_mm;
      largest = std::max(largest, std::hypot(offset[0], offset[1], offset[2]));
    }
    return largest;
  };
  EXPECT_GT(largest_offset_mm({0.6, 1.0}), 0.3);
  EXPECT_LT(largest_offset_mm({0.6, 0.002}), 0.02);
}

TEST(RefineStage, EnvironmentLightingThatIsFoundStandsInTheManifest) {
  const test::TemporaryFolder folder;
  WriteCapture(folder.path(), 9, {{{0.1, 0.1, 0.12}, {0, 0, 0}, {0, 0, 0}, {0.05, 0.05, 0.05}}});
  const test::Outcome outcome = Refine(folder.path(), {"--correct-views", "always"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("ambient illumination found"), std::string::npos) << outcome.out;
  const fs::path file = folder.path() / "glint/refine/manifest.json";
  const Manifest manifest = ReadManifest(file, "refine");
  EXPECT_EQ(manifest.metrics["correction"]["views_moved"], false);
  const auto corrections = ReadCorrections(file, manifest.data);
  ASSERT_EQ(corrections.size(), 9u);
  for (const auto& [name, correction] : corrections) {  // what environment lighting leaves is small
    EXPECT_FALSE(correction.shifts.any()) << name;
    EXPECT_NEAR(correction.exposure, 1, 0.03) << name;
    const Vec3d& offset = correction.light_offset_mm;
    EXPECT_LT(std::hypot(offset[0], offset[1], offset[2]), 3) << name;
  }
  const Vec3d irradiance = ReadEnvironmentLighting(file, manifest.data).PlaneIrradiance();
  for (size_t c = 0; c < 3; ++c) EXPECT_NEAR(irradiance[c], c == 2 ? 0.38 : 0.31, 0.15);
}

// Toe and shoulder, of photographs restated so.
std::pair<double, double> CurveFound(const std::function<void(RectifiedSet* set)>& restate) {
  const test::TemporaryFolder folder;
  WriteCapture(folder.path(), 3, {}, {}, {}, restate);
  const test::Outcome outcome = Refine(folder.path());
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  const Manifest manifest = ReadManifest(folder.path() / "glint/refine/manifest.json", "refine");
  const Json& light = manifest.data["shared_light"];
  EXPECT_EQ(manifest.metrics["curve"]["toe"], light["toe"]);
  return {light["toe"], light["shoulder"]};
}

TEST(RefineStage, OnlyPhotographsThatACameraEncodedHaveACurve) {
  const auto [toe, shoulder] = CurveFound({});
  EXPECT_NE(toe, 0);
  EXPECT_NE(shoulder, 0);
  // Of light of known power the bright part of the curve is known.
  const auto calibrated = CurveFound([](RectifiedSet* set) { set->light_power_known = true; });
  EXPECT_NE(calibrated.first, 0);
  EXPECT_EQ(calibrated.second, 0);
  const std::pair<double, double> straight{0, 0};
  EXPECT_EQ(CurveFound([](RectifiedSet* set) { set->fixed_camera = true; }), straight);
  EXPECT_EQ(CurveFound([](RectifiedSet* set) {
              for (RectifiedView& view : set->views) view.linear = true;
            }),
            straight);
  EXPECT_EQ(CurveFound([](RectifiedSet* set) { set->views[1].ldr = false; }), straight);
}

TEST(RefineStage, ThreadsDoNotChangeABytes) {
  const test::TemporaryFolder folder;
  WriteCapture(folder.path() / "a");
  WriteCapture(folder.path() / "b");
  ASSERT_EQ(Refine(folder.path() / "a", {"--threads", "1"}).code, 0);
  ASSERT_EQ(Refine(folder.path() / "b", {"--threads", "3"}).code, 0);
  for (const char* file : {"manifest.json", "svbrdf.exr", "confidence.exr"}) {
    EXPECT_EQ(ReadAll(folder.path() / "a/glint/refine" / file),
              ReadAll(folder.path() / "b/glint/refine" / file))
        << file;
  }
}

TEST(RefineStage, RowsInMemoryDoNotChangeAByteOfTheMaps) {
  const test::TemporaryFolder folder;
  const auto maps = [&](const std::string& name, const std::vector<std::string>& more) {
    WriteCapture(folder.path() / name);
    EXPECT_EQ(Refine(folder.path() / name, more).code, 0);
    const fs::path result = folder.path() / name / "glint/refine";
    return ReadAll(result / "svbrdf.exr") + ReadAll(result / "confidence.exr");
  };
  const std::string whole = maps("whole", {"--estimation-size", "16"});
  EXPECT_EQ(maps("few", {"--estimation-size", "16", "--rows-at-once", "3"}), whole);
}

TEST(RefineStage, PartsInAnyOrderJoinToTheBytesOfTheWhole) {
  const test::TemporaryFolder folder;
  for (const char* name : {"whole", "parts"}) WriteCapture(folder.path() / name);
  const fs::path whole = folder.path() / "whole", parts = folder.path() / "parts";
  ASSERT_EQ(Refine(whole, {"--estimation-size", "16"}).code, 0);
  for (const char* part : {"3/5", "1/5", "5/5", "2/5", "4/5"}) {
    const test::Outcome outcome = Refine(parts, {"--part", part, "--rows-at-once", "2", "--threads",
                                                 "3", "--estimation-size", "16"});
    ASSERT_EQ(outcome.code, 0) << outcome.err;
  }
  EXPECT_FALSE(fs::exists(parts / "glint/refine"));
  const test::Outcome outcome = Refine(parts, {"--join", "5", "--estimation-size", "16"});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  for (const char* file : {"manifest.json", "svbrdf.exr", "confidence.exr"}) {
    EXPECT_EQ(ReadAll(parts / "glint/refine" / file), ReadAll(whole / "glint/refine" / file))
        << file;
  }
  EXPECT_FALSE(fs::exists(parts / "glint/refine-3of5"));
}

// What corrections move at the parts' borders, and environment lighting, are the whole's.
TEST(RefineStage, PartsOfCorrectedViewsJoinToTheBytesOfTheWhole) {
  const test::TemporaryFolder folder;
  for (const char* name : {"whole", "parts"}) {
    WriteCapture(folder.path() / name, 9,
                 {{{0.1, 0.1, 0.12}, {0, 0, 0}, {0, 0, 0}, {0.05, 0.05, 0.05}}});
  }
  const std::vector<std::string> always = {"--correct-views", "always"};
  const auto with = [&](std::vector<std::string> more) {
    more.insert(more.end(), always.begin(), always.end());
    return more;
  };
  ASSERT_EQ(Refine(folder.path() / "whole", always).code, 0);
  for (const char* part : {"2/2", "1/2"}) {
    ASSERT_EQ(Refine(folder.path() / "parts", with({"--part", part})).code, 0);
  }
  ASSERT_EQ(Refine(folder.path() / "parts", with({"--join", "2"})).code, 0);
  const fs::path result = folder.path() / "parts/glint/refine";
  EXPECT_EQ(ReadManifest(result / "manifest.json", "refine").metrics["correction"]["taken"], true);
  for (const char* file : {"manifest.json", "svbrdf.exr", "confidence.exr"}) {
    EXPECT_EQ(ReadAll(result / file), ReadAll(folder.path() / "whole/glint/refine" / file)) << file;
  }
}

TEST(RefineStage, PartsThatAreMissingOrOfOtherOptionsAreNotJoined) {
  const test::TemporaryFolder folder;
  WriteCapture(folder.path());
  ASSERT_EQ(Refine(folder.path(), {"--part", "1/2"}).code, 0);
  ASSERT_EQ(Refine(folder.path(), {"--part", "2/2", "--prior", "2"}).code, 0);
  const test::Outcome outcome = Refine(folder.path(), {"--join", "2"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("--part 2/2"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(folder.path() / "glint/refine"));
  ASSERT_EQ(Refine(folder.path(), {"--part", "2/2"}).code, 0);
  EXPECT_EQ(Refine(folder.path(), {"--join", "2"}).code, 0);
}

TEST(RefineStage, AResultOfTheWholeLeavesNoPartsAndNeedsNone) {
  const test::TemporaryFolder folder;
  WriteCapture(folder.path());
  ASSERT_EQ(Refine(folder.path(), {"--part", "1/3"}).code, 0);
  ASSERT_TRUE(fs::exists(folder.path() / "glint/refine-1of3"));
  ASSERT_EQ(Refine(folder.path()).code, 0);
  EXPECT_FALSE(fs::exists(folder.path() / "glint/refine-1of3"));
  const test::Outcome outcome = Refine(folder.path(), {"--part", "2/3"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE(outcome.out.find("no part is needed"), std::string::npos) << outcome.out;
  EXPECT_FALSE(fs::exists(folder.path() / "glint/refine-2of3"));
}

// As if it had been computed on another processor.
TEST(RefineStage, APartOfAnotherEstimateIsNotJoined) {
  const test::TemporaryFolder folder;
  WriteCapture(folder.path());
  for (const char* part : {"1/2", "2/2"})
    ASSERT_EQ(Refine(folder.path(), {"--part", part}).code, 0);
  const fs::path file = folder.path() / "glint/refine-2of2/manifest.json";
  Manifest manifest = ReadManifest(file);
  manifest.data["estimate"] = "another";
  test::WriteAll(file, ToJson(manifest).dump());
  const test::Outcome outcome = Refine(folder.path(), {"--join", "2"});
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("data.estimate"), std::string::npos) << outcome.err;
  EXPECT_FALSE(fs::exists(folder.path() / "glint/refine"));
}

TEST(RefineStage, PartsAreNotForCaptureToml) {
  const test::TemporaryFolder folder;
  WriteCapture(folder.path());
  const fs::path toml = folder.path() / "capture.toml";
  test::WriteAll(toml, ReadAll(toml) + "[refine]\npart = \"1/2\"\n");
  const test::Outcome outcome = Refine(folder.path());
  EXPECT_EQ(outcome.code, 2);
  EXPECT_NE(outcome.err.find("command line"), std::string::npos) << outcome.err;
}

TEST(RefineStage, WrongPartsAreRefused) {
  const test::TemporaryFolder folder;
  WriteCapture(folder.path());
  for (const char* part : {"0/2", "3/2", "2", "1/", "/2", "1/2/3", "a/b", "1/9999", "1/25"}) {
    const test::Outcome outcome = Refine(folder.path(), {"--part", part});
    EXPECT_EQ(outcome.code, 2) << part;
    EXPECT_NE(outcome.err.find("--part"), std::string::npos) << outcome.err;
  }
  EXPECT_EQ(Refine(folder.path(), {"--part", "1/2", "--join", "2"}).code, 2);
}

// Rows, thinned out texels and displaced pictures are those of the whole.
TEST(SampleSource, GivesPartsOfTheCorrectedWhole) {
  const test::TemporaryFolder folder;
  WriteCapture(folder.path());
  const RectifiedSet set = ReadRectifiedSet(folder.path() / "glint/rectify/manifest.json");
  SampleSource source(set, set.views, {2, 2, 2}, folder.path() / "glint/fit/svbrdf.exr", {});
  ViewCorrections corrections;
  corrections.views.resize(set.views.size());
  for (int k = 0; k < 4; ++k) {
    corrections.views[1].shifts.row[k] = 0.7 * k - 1.3;
    corrections.views[1].shifts.column[k] = 0.4 - 0.3 * k;
  }
  corrections.systematic_sd = {.diffuse = 0.1, .specular = 0.2, .roughness = 0.3, .slope = 0.4};
  source.Correct(corrections);
  const SampleSource::Part whole = source.Rows(0, kSize, 2);
  const auto same = [&](const SampleSource::Part& part, int first, int stride) {
    const SamplePlane& plane = part.photographs.plane;
    EXPECT_EQ(part.photographs.systematic_sd, corrections.systematic_sd);
    for (size_t v = 0; v < set.views.size(); ++v) {
      const Photograph &all = whole.photographs.photographs[v],
                       &some = part.photographs.photographs[v];
      EXPECT_EQ(some.view.light_rgb[0], 2 * set.views[v].view.light_rgb[0]);
      for (int row = 0; row < plane.height; ++row) {
        for (int column = 0; column < plane.width; ++column) {
          const auto i = static_cast<size_t>(row) * plane.width + column;
          const auto j = static_cast<size_t>(first + stride * row) * kSize +
                         (stride > 1 ? first : 0) + stride * column;
          EXPECT_EQ(some.mask[i], all.mask[j]) << v << " " << i;
          EXPECT_EQ(some.rgb[some.mask.size() + i], all.rgb[all.mask.size() + j]) << v << " " << i;
          EXPECT_EQ(part.start.plane(kRoughness)[i], whole.start.plane(kRoughness)[j]);
        }
      }
    }
  };
  same(source.Rows(4, 5, 1), 4, 1);
  same(source.Every(3, 2), 1, 3);
}

TEST(RefineStage, BadInputEndsWith2AndKeepsTheEarlierResult) {
  const test::TemporaryFolder folder;
  WriteCapture(folder.path());
  ASSERT_EQ(Refine(folder.path()).code, 0);
  const fs::path manifest = folder.path() / "glint/refine/manifest.json";
  const std::string before = ReadAll(manifest);
  const auto refused = [&](const std::vector<std::string>& arguments, const std::string& word) {
    const test::Outcome outcome = Refine(folder.path(), arguments);
    EXPECT_EQ(outcome.code, 2) << outcome.err;
    EXPECT_NE(outcome.err.find(word), std::string::npos) << outcome.err;
    EXPECT_EQ(ReadAll(manifest), before);
  };
  refused({"--exclude", "view_009"}, "view_009");
  refused({"--exclude", "view_000,view_001,view_002"}, "view");
  refused({"--robust-scale", "0"}, "robust-scale");
  refused({"--from", "nowhere.exr"}, "nowhere.exr");
  fs::resize_file(folder.path() / "glint/rectify/view_001.exr", 300);
  refused({}, "view_001.exr");
  fs::remove(folder.path() / "glint/fit/manifest.json");
  refused({}, "fit/manifest.json");
}

double ReliefError(const fs::path& folder) {
  return test::MeanSquare(ReadSvbrdf(folder / "glint/refine/svbrdf.exr"),
                          test::QuarteredMaps(kSize, 1), kNormalX, kNormalY);
}

TEST(RefineStage, APhotographOutOfFocusIsNamedAndDoesLittleHarm) {
  const test::TemporaryFolder folder;
  WriteCapture(folder.path(), 7, {}, {.sd_mm = 0.01}, {.view = 4, .variance = 1.0});
  const test::Outcome outcome = Refine(folder.path());
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_NE((outcome.out + outcome.err).find("photos/4.png (counts for"), std::string::npos);
  const Manifest manifest = ReadManifest(folder.path() / "glint/refine/manifest.json", "refine");
  const Json& blurred = manifest.metrics["blurred_views"];
  ASSERT_EQ(blurred.size(), 1u) << blurred;
  EXPECT_EQ(blurred[0]["name"], "view_004");
  EXPECT_LT(blurred[0]["weight"], 0.5);
  const double error = ReliefError(folder.path());
  ASSERT_EQ(Refine(folder.path(), {"--no-measured-blur", "--no-share-detail"}).code, 0);
  EXPECT_LT(error, 0.25 * ReliefError(folder.path()));
}

TEST(RefineStage, RowsThreadsAndPartsDoNotChangeAByteOfABlurredCapture) {
  const test::TemporaryFolder folder;
  const auto written = [&](const std::string& name) {
    WriteCapture(folder.path() / name, 5, {}, {.sd_mm = 0.01}, {.view = 3, .variance = 1.0});
    return folder.path() / name;
  };
  const auto maps = [](const fs::path& capture) {
    return ReadAll(capture / "glint/refine/svbrdf.exr") +
           ReadAll(capture / "glint/refine/confidence.exr");
  };
  const fs::path whole = written("whole"), few = written("few"), parts = written("parts");
  ASSERT_EQ(Refine(whole, {"--threads", "3"}).code, 0);
  const Manifest manifest = ReadManifest(whole / "glint/refine/manifest.json", "refine");
  ASSERT_EQ(manifest.metrics["blurred_views"].size(), 1u);
  ASSERT_EQ(Refine(few, {"--rows-at-once", "5", "--threads", "1"}).code, 0);
  EXPECT_EQ(maps(few), maps(whole));
  ASSERT_EQ(Refine(parts, {"--part", "1/2"}).code, 0);
  ASSERT_EQ(Refine(parts, {"--part", "2/2"}).code, 0);
  ASSERT_EQ(Refine(parts, {"--join", "2"}).code, 0);
  EXPECT_EQ(maps(parts), maps(whole));
}

TEST(RefineStage, StartsFromMapsOfAnotherProgram) {
  const test::TemporaryFolder folder;
  WriteCapture(folder.path());
  const fs::path maps = folder.path() / "mine.exr";
  fs::copy_file(folder.path() / "glint/fit/svbrdf.exr", maps);
  fs::remove_all(folder.path() / "glint/fit");
  const test::Outcome outcome = Refine(folder.path(), {"--from", maps.string()});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
}

}  // namespace
}  // namespace glint
