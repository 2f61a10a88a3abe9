#include "pipeline/report/report.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "base/errors/errors.h"
#include "base/files/files.h"
#include "base/formats/svbrdf_file.h"
#include "base/images/image.h"
#include "base/programs/stage.h"
#include "fitting/render/renderer.h"
#include "fitting/view_correction/corrections_json.h"
#include "pipeline/report/chart.h"
#include "pipeline/report/html.h"
#include "pipeline/report/metrics_html.h"
#include "pipeline/viewer/viewer_bundle.h"
#include "tests/support/process.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using testing::HasSubstr;
using testing::Not;

constexpr int kSize = 24;

SvbrdfMaps Maps() {
  SvbrdfMaps maps(kSize, kSize);
  for (size_t i = 0; i < maps.texels(); ++i) {
    const float wave = 0.5f + 0.4f * std::sin(0.3f * static_cast<float>(i));
    maps.plane(kNormalZ)[i] = 1;
    for (int c = 0; c < 3; ++c) {
      maps.plane(kDiffuseR + c)[i] = 0.6f * wave;
      maps.plane(kSpecularR + c)[i] = 0.05f;
    }
    maps.plane(kRoughness)[i] = 0.2f + 0.5f * wave;
  }
  return maps;
}

// A capture's glint/ folder with three views rendered from Maps(), of which the fit used two.
class ReportTest : public testing::Test {
 protected:
  ReportTest() {
    WriteRectify();
    WriteFit(Maps());
  }

  fs::path work() const { return folder_.path() / "glint"; }

  void WriteRectify() {
    RectifiedSet set;
    set.plane = {kSize, kSize, 100, 100, TexelSampling::kPixelCentres};
    OptionSet options;
    test::WriteAll(folder_.path() / "input", "x");
    Stage stage(work() / "rectify", {"rectify", 1}, options, CommonOptions(),
                {folder_.path() / "input"});
    for (int i = 0; i < 3; ++i) {
      RectifiedView view;
      view.name = "view_00" + std::to_string(i);
      view.file = view.name + ".exr";
      view.photo = "photos/<" + std::to_string(i) + ">.jpg";
      view.view.camera_in_sample_mm = view.view.light_in_sample_mm = {30.0 * i, 10, 300};
      view.view.light_rgb = {2e5, 2e5, 2e5};
      RectifiedImage image;
      image.width = image.height = kSize;
      image.mask.assign(kSize * kSize, 1.0f);
      image.rgb.resize(3 * kSize * kSize);
      RenderView(Maps(), set.plane, view.view, set.convention, image.rgb.data());
      WriteRectifiedImage(stage.Output(view.file), image, set, view);
      set.views.push_back(view);
    }
    stage.Commit(ToJson(set), Json::object());
  }

  void WriteFit(const SvbrdfMaps& maps, const std::string& method = "latent") {
    OptionSet options;
    Stage stage(work() / "fit", {"fit", 1}, options, CommonOptions(),
                {work() / "rectify/manifest.json"}, true);
    WriteSvbrdf(stage.Output("svbrdf.exr"), maps, ReflectanceConvention());
    Json curve = Json::array();
    for (int i = 0; i < 50; ++i) curve.push_back(1.0 / (1 + i));
    stage.Commit({{"views", {"view_000", "view_001"}},
                  {"light_scale_rgb", {1.0, 1.0, 1.0}},
                  {"method", method}},
                 {{"loss", curve}, {"seconds_per_step", 0.25}});
  }

  void WriteExport() {
    OptionSet options;
    Stage stage(work() / "export", {"export", 1}, options, CommonOptions(),
                {work() / "fit/manifest.json"}, true);
    test::WriteAll(stage.Output("oak.glb"), std::string(2000, 'x'));
    WritePng(stage.Output("oak_roughness.png"), Image(4, 4, {"Y"}));
    stage.Commit({{"name", "oak"},
                  {"materials", {{{"file", "oak.glb"}}}},
                  {"maps", {{{"file", "oak_roughness.png"}}}}},
                 Json::object());
  }

  Report Make() const {
    ReportOptions options;
    options.from = "fit";
    return MakeReport(ReadReportInput(work(), "fit"), options, 1);
  }

  test::TemporaryFolder folder_;
};

// What is larger than the page compares at is averaged, and the page says so.
TEST_F(ReportTest, LargeMapsAreComparedAtASmallerSize) {
  ReportOptions options;
  options.from = "fit";
  const ReportInput small = ReadReportInput(work(), "fit", kSize / 2);
  EXPECT_EQ(small.fit.maps.width, kSize / 2);
  const Report report = MakeReport(small, options, 1);
  const std::string half = std::to_string(kSize / 2), whole = std::to_string(kSize);
  EXPECT_THAT(report.html, HasSubstr("Compared at " + half + " × " + half + " texels."));
  EXPECT_THAT(report.html, HasSubstr(whole + "</span> texels, from"));
  EXPECT_THAT(Make().html, Not(HasSubstr("Compared at")));
  for (const Json& view : report.metrics["views"]) {
    EXPECT_LT(view["log_l1"].get<double>(), 0.05);  // the truth explains averages, too
  }
}

TEST_F(ReportTest, IsOnePageThatLoadsNothing) {
  std::string html = Make().html;
  const std::string viewer(ViewerBundle());
  if (!viewer.empty()) {  // three.js names its own pages in messages
    ASSERT_NE(html.find(viewer), std::string::npos);
    html.erase(html.find(viewer), viewer.size());
  }
  EXPECT_THAT(html, Not(HasSubstr("<script src")));
  EXPECT_THAT(html, Not(HasSubstr("http")));
  for (size_t at = html.find("src=\""); at != std::string::npos; at = html.find("src=\"", at + 1)) {
    EXPECT_EQ(html.compare(at + 5, 11, "data:image/"), 0);
  }
}

// A photograph's name cannot end the viewer's data, and where there is no viewer the page says so.
TEST_F(ReportTest, TheViewersDataIsJsonThatEndsWhereItShould) {
  const std::string html = Make().html;
  if (ViewerBundle().empty()) {
    EXPECT_THAT(html, HasSubstr("has no viewer"));
    return;
  }
  const std::string begin = "id=\"viewer-material\">";
  const size_t from = html.find(begin) + begin.size();
  const Json material = Json::parse(html.substr(from, html.find("</script>", from) - from));
  ASSERT_EQ(material["views"].size(), 3u);
  EXPECT_EQ(material["views"][0]["photo"], "photos/<0>.jpg");
  EXPECT_EQ(material["views"][2]["fitted"], false);
  EXPECT_EQ(material["size_texel"], Json({kSize, kSize}));
}

TEST_F(ReportTest, MapsThatWereNotFittedAreCalledAFirstLook) {
  EXPECT_THAT(Make().html, Not(HasSubstr("first look")));
  WriteFit(Maps(), "initial");
  EXPECT_THAT(Make().html, HasSubstr("<strong>A first look:</strong>"));
}

TEST_F(ReportTest, LinksToWhatWasExportedFromTheseMaps) {
  EXPECT_THAT(Make().html, Not(HasSubstr("../export/")));
  WriteExport();
  const std::string html = Make().html;
  EXPECT_THAT(html, HasSubstr("<h1>oak</h1>"));
  EXPECT_THAT(html, HasSubstr("<a download href=\"../export/oak.glb\">oak.glb</a> <small>2 kB"));
  EXPECT_THAT(html, HasSubstr("../export/oak_roughness.png"));
  SvbrdfMaps other = Maps();
  other.plane(kRoughness)[0] = 0.9f;
  WriteFit(other);
  EXPECT_THAT(Make().html, Not(HasSubstr("../export/")));
}

TEST_F(ReportTest, ViewsOfTheTruthHaveNoErrorAndHeldOutOnesAreMarked) {
  const Report report = Make();
  // What rounding to half floats leaves, in the mean.
  EXPECT_LT(report.metrics["fitted"]["log_l1"].get<double>(), 1.0 / 4096);
  EXPECT_EQ(report.metrics["fitted"]["photographs"], 2);
  EXPECT_EQ(report.metrics["held_out"]["photographs"], 1);
  EXPECT_EQ(report.metrics["views"][2]["fitted"], false);
  EXPECT_THAT(report.html, HasSubstr("held out"));
}

TEST_F(ReportTest, RenderingsAreComparedAsTheyLook) {
  const Report report = Make();
  const Json& view = report.metrics["views"][2];
  EXPECT_NEAR(view["ssim"].get<double>(), 1, 1e-3);
  EXPECT_NEAR(view["highlight"].get<double>(), 1, 0.01);
  EXPECT_EQ(view["contrast"].size(), 4u);
  EXPECT_TRUE(view["contrast"][0].is_null());  // 24 texels have no detail that fine
  EXPECT_NEAR(report.metrics["held_out"]["correlation"][0].get<double>(), 1, 0.01);
  EXPECT_LT(report.metrics["fitted"]["free"].get<double>(), 0.01);
  EXPECT_THAT(report.html, HasSubstr("title=\"manifest.json: metrics.views[2].ssim\""));
  EXPECT_THAT(report.html, HasSubstr("manifest.json: metrics.held_out.correlation[0]"));
  EXPECT_THAT(report.html, HasSubstr("metrics.fitted.contrast[0]\">–<"));
  EXPECT_THAT(report.html, HasSubstr("<b>highlight</b> how bright"));
  EXPECT_THAT(report.html, Not(HasSubstr(">nan<")));
}

TEST_F(ReportTest, WrongMapsShowAsErrors) {
  SvbrdfMaps wrong = Maps();
  for (float& value : wrong.plane(kDiffuseG)) value *= 0.5f;
  WriteFit(wrong);
  EXPECT_GT(Make().metrics["fitted"]["log_l1"].get<double>(), 0.05);
}

TEST_F(ReportTest, NumbersNameTheirManifestAndField) {
  const std::string html = Make().html;
  EXPECT_THAT(html,
              HasSubstr("<span title=\"../fit/manifest.json: metrics.seconds_per_step\">0.25<"));
  EXPECT_THAT(html, HasSubstr("title=\"manifest.json: metrics.views[2].log_l1\""));
  EXPECT_THAT(html, HasSubstr("title=\"../fit/manifest.json: metrics.loss\""));
}

TEST_F(ReportTest, IsTheSameBytesForAnyThreadCount) {
  const std::string one = Make().html;
  ReportOptions options;
  options.from = "fit";
  EXPECT_EQ(MakeReport(ReadReportInput(work(), "fit"), options, 3).html, one);
}

TEST_F(ReportTest, NamesFromOutsideAreEscaped) {
  const std::string html = Make().html;
  EXPECT_THAT(html, HasSubstr("photos/&lt;2&gt;.jpg"));
  EXPECT_THAT(html, Not(HasSubstr("photos/<2>.jpg")));
}

TEST_F(ReportTest, ShowsWhatCalibAdvisesOnceWithItsPictures) {
  EXPECT_THAT(Make().html, Not(HasSubstr("Capture:")));
  OptionSet options;
  Stage stage(work() / "calib", {"calib", 1}, options, CommonOptions(), {folder_.path() / "input"});
  WriteFileAtomically(stage.Output("guidance_views.svg"), "<svg/>");
  WritePng(stage.Output("guidance_coverage.png"), Image(16, 16, {"R", "G", "B"}));
  Json guidance = {{"verdict", "usable"}, {"summary", "2 photographs"}};
  guidance["advice"] = {{{"topic", "top"}, {"text", "take one <straight> from above"}}};
  guidance["views"] = {{{"photo", "a.jpg"}, {"tilt_deg", 12.5}}};
  stage.Commit(Json::object(), {{"guidance", guidance}});
  const std::string html = Make().html;
  EXPECT_THAT(html, HasSubstr("metrics.guidance.verdict\">usable<"));
  EXPECT_THAT(html,
              HasSubstr("metrics.guidance.advice[0].text\">take one &lt;straight&gt; from above<"));
  EXPECT_THAT(html, HasSubstr("metrics.guidance.views[0].tilt_deg\">12.5<"));
  EXPECT_THAT(html, HasSubstr("data:image/svg+xml;base64,PHN2Zy8+"));
  const std::string caption = "smallest angle between the surface normal and the half vector";
  ASSERT_THAT(html, HasSubstr(caption));
  EXPECT_THAT(html, Not(HasSubstr("<figcaption>guidance_coverage.png")));
  EXPECT_THAT(html, Not(HasSubstr("<h3>guidance")));
}

TEST_F(ReportTest, SaysHowFarTheChartsHeldOutPatchesAreOff) {
  EXPECT_THAT(Make().html, Not(HasSubstr("chart patches")));
  OptionSet options;
  Stage stage(work() / "calib", {"calib", 1}, options, CommonOptions(), {folder_.path() / "input"});
  WriteFileAtomically(stage.Output("residuals.json"), "{}");
  stage.Commit(Json::object(), {{"chart",
                                 {{"kind", "classic24"},
                                  {"delta_e_held_out_mean", 1.25},
                                  {"delta_e_held_out_worst", 3.5}}}});
  const std::string html = Make().html;
  EXPECT_THAT(html, HasSubstr("colour error, held-out chart patches (ΔE00, mean)"));
  EXPECT_THAT(html, HasSubstr("metrics.chart.delta_e_held_out_worst\">3.5<"));
}

TEST_F(ReportTest, ShowsWhatWasCorrectedAndTheEnvironment) {
  ViewCorrection moved;
  moved.light_offset_mm = {0, 30, 0};
  moved.exposure = 1.25;
  EnvironmentLighting environment;
  environment.radiance_rgb = {{0.1, 0.1, 0.1}, {0, 0, 0}, {0, 0, 0}, {0.05, 0.05, 0.05}};
  const auto make = [&](const Json& data, const Json& correction) {
    OptionSet options;
    Stage stage(work() / "refine", {"refine", 1}, options, CommonOptions(),
                {work() / "fit/manifest.json"}, true);
    WriteSvbrdf(stage.Output("svbrdf.exr"), Maps(), ReflectanceConvention());
    stage.Commit(data, {{"correction", correction}});
    return MakeReport(ReadReportInput(work(), "refine"), ReportOptions(), 1).html;
  };
  const Json views = {"view_000", "view_001"};
  EXPECT_THAT(make({{"views", views}}, {{"taken", false}}), Not(HasSubstr("<h2>Corrected")));

  const Json still = Json::array({JsonOf("view_000", ViewCorrection())});
  const std::string lit =
      make({{"views", views}, {"corrections", still}, {"room_light", JsonOf(environment)}},
           {{"taken", true}, {"ambient_of_flash", 0.0375}});
  EXPECT_THAT(lit, HasSubstr("metrics.correction.ambient_of_flash\">0.0375<"));
  EXPECT_THAT(lit, HasSubstr("the surroundings as seen from the sample"));
  EXPECT_THAT(lit, Not(HasSubstr("light turned")));

  const Json corrections =
      Json::array({JsonOf("view_000", ViewCorrection()), JsonOf("view_001", moved)});
  const std::string turned =
      make({{"views", views}, {"corrections", corrections}}, {{"taken", true}});
  EXPECT_THAT(turned, HasSubstr("light turned"));
  EXPECT_THAT(turned, HasSubstr("data.corrections[1].exposure\">1.25<"));
  EXPECT_THAT(turned, Not(HasSubstr("the surroundings as seen from the sample")));
}

TEST_F(ReportTest, ADamagedResultIsRefused) {
  test::WriteAll(work() / "fit/svbrdf.exr", "damaged");
  EXPECT_THROW(ReadReportInput(work(), "fit"), UserError);
}

// RFC 4648, section 10.
TEST(HtmlTest, Base64AgreesWithTheStandard) {
  EXPECT_EQ(Base64(""), "");
  EXPECT_EQ(Base64("f"), "Zg==");
  EXPECT_EQ(Base64("fo"), "Zm8=");
  EXPECT_EQ(Base64("foo"), "Zm9v");
  EXPECT_EQ(Base64("foobar"), "Zm9vYmFy");
  EXPECT_EQ(Base64("\xff\xfe\xfd"), "//79");
}

TEST(ChartTest, LeavesOutWhatIsNotFinite) {
  Chart chart;
  chart.lines = {{"a", {0, 1, 2, 3}, {1, std::nan(""), INFINITY, 2}}};
  const std::string svg = ChartSvg(chart);
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
  EXPECT_THAT(svg, Not(HasSubstr("inf")));
  EXPECT_EQ(ChartSvg({"", "", {{"a", {0}, {1}}}, true}), "");
}

TEST(ChartTest, AConstantLineIsDrawn) {
  const std::string svg = ChartSvg({"t", "x", {{"a", {0, 1}, {0, 0}}}, true});
  EXPECT_THAT(svg, HasSubstr("polyline"));
  EXPECT_THAT(svg, Not(HasSubstr("nan")));
}

TEST(MetricsTest, ShowsEveryNumberWhateverItsPlace) {
  const Json metrics = Json::parse(R"({"a": 1.5, "deep": {"b": 2.5, "c": {"d": 3.5}},
      "list": [4.5, 5.5], "photos": [{"name": "x", "rms": 6.5}, {"name": "y", "rms": 7.5}],
      "cameras": [{"p": {"fx": {"value": 8.5, "sigma": 9.5}}, "covariance": [[10.5]]}]})");
  const std::string html = MetricsHtml(metrics, {"m.json", "metrics"});
  for (const char* number : {"1.5", "2.5", "3.5", "4.5, 5.5", "6.5", "7.5", "8.5", "9.5", "10.5"}) {
    EXPECT_THAT(html, HasSubstr(">" + std::string(number) + "<")) << html;
  }
  EXPECT_THAT(html, HasSubstr("m.json: metrics.deep.c.d"));
  EXPECT_THAT(html, HasSubstr("m.json: metrics.photos[1].rms"));
  EXPECT_THAT(html, HasSubstr("m.json: metrics.cameras[0].p.fx.sigma"));
}

}  // namespace
}  // namespace glint
