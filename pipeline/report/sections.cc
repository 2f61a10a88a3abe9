#include "pipeline/report/sections.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "base/files/hash.h"
#include "base/formats/svbrdf_file.h"
#include "base/images/exr_rows.h"
#include "base/resampling/resampling.h"
#include "datasets/looks/looks_figures.h"
#include "pipeline/report/downloads_section.h"
#include "pipeline/report/figure.h"
#include "pipeline/report/guidance_section.h"
#include "pipeline/report/html.h"
#include "pipeline/report/looks_table.h"
#include "pipeline/report/metrics_html.h"
#include "pipeline/report/picture.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr char kOwnManifest[] = "manifest.json";
constexpr int kStagePicture_px = 1200;

std::string ManifestLink(const std::string& stage) { return "../" + stage + "/manifest.json"; }

std::string ViewsLink(const ReportInput& input) {
  return ManifestLink(input.set.manifest_file.parent_path().filename().string());
}

std::string Section(const std::string& title, const std::string& source, const std::string& body) {
  return "<section>\n" + (source.empty() ? "" : SourceLink(source)) + "<h2>" + HtmlText(title) +
         "</h2>\n" + body + "</section>\n";
}

std::string Figure(const std::string& uri, const std::string& caption,
                   const std::string& style = "") {
  return "<figure class=\"" + style + "\">" + ImageHtml(uri, caption) + "<figcaption>" +
         HtmlText(caption) + "</figcaption></figure>\n";
}

Image MapImage(const SvbrdfMaps& maps, int first_plane, const std::string& kind) {
  Image image(maps.width, maps.height, {"R", "G", "B"});
  for (int c = 0; c < 3; ++c) {
    const auto from = maps.plane(kind == "grey" ? first_plane : first_plane + c);
    std::transform(from.begin(), from.end(), image.channel(c).begin(), [&kind](float v) {
      if (kind == "normal") return 0.5f * v + 0.5f;
      return kind == "color" ? std::pow(std::clamp(v, 0.0f, 1.0f), 1 / 2.2f) : v;
    });
  }
  return image;
}

bool Used(const ReportInput& input, const RectifiedView& view) {
  return std::find(input.used_views.begin(), input.used_views.end(), view.name) !=
         input.used_views.end();
}

// By fit, since no maps explain it together with the others.
bool LeftOut(const ReportInput& input, const RectifiedView& view) {
  if (!input.Has("fit")) return false;
  const Json& metrics = input.manifests.at("fit").metrics;
  if (!metrics.contains("left_out")) return false;
  return std::any_of(metrics["left_out"].begin(), metrics["left_out"].end(),
                     [&](const Json& one) { return one.value("name", "") == view.name; });
}

// Where large photographs are compared at a smaller size: which.
std::string ComparedAt(const ReportInput& input) {
  const SamplePlane &whole = input.set.plane, &shown = input.shown.plane;
  if (shown.width == whole.width && shown.height == whole.height) return "";
  return " Compared at " + std::to_string(shown.width) + " × " + std::to_string(shown.height) +
         " texels.";
}

double Distance_mm(const Vec3d& point) {
  return std::sqrt(point[0] * point[0] + point[1] * point[1] + point[2] * point[2]);
}

// What a chart says of the colours; "" without one (a grey card says nothing of an error).
std::string ColourFigures(const ReportInput& input) {
  if (!input.Has("calib")) return "";
  const Json chart = input.manifests.at("calib").metrics.value("chart", Json::object());
  std::string figures;
  for (const auto& [name, label] :
       {std::pair{"delta_e_held_out_mean", "colour error, held-out chart patches (ΔE00, mean)"},
        std::pair{"delta_e_held_out_worst", "the same, worst patch (ΔE00)"}}) {
    if (!chart.contains(name) || !chart[name].is_number()) continue;
    figures += HeadFigure(label, chart[name],
                          {ManifestLink("calib"), std::string("metrics.chart.") + name});
  }
  return figures;
}

}  // namespace

Image RoughnessConfidence(const ReportInput& input, const fs::path& confidence_exr, int most_px) {
  const auto [width, height] = SizeAtMost(input.set.plane.width, input.set.plane.height, most_px);
  const Image image = ReadExrAveraged(confidence_exr, {"roughness.Y"}, width, height);
  return ColorMapped(image.channel(0), image.width, image.height, 0, 0.2f);
}

std::string OverviewSection(const ReportInput& input, const Json& own_metrics) {
  const Trace own{kOwnManifest, "metrics"};
  const Trace views{ViewsLink(input), "data"};
  std::string figures = "<div class=\"figures\">\n";
  figures += HeadFigure("photographs fitted", input.used_views.size(), own.Field("views[].fitted"));
  figures += HeadFigure("width of the maps", input.set.plane.width, views.Field("width"), "texels");
  figures += HeadFigure("a texel", input.set.plane.width_mm / input.set.plane.width,
                        views.Field("width_mm"), "mm");
  if (input.Has("calib")) {
    const Json& metrics = input.manifests.at("calib").metrics;
    for (const char* name : {"rms_px", "reprojection_rms_px"}) {
      if (!metrics.contains(name) || !metrics[name].is_number()) continue;
      figures += HeadFigure("reprojection error (RMS)", metrics[name],
                            {ManifestLink("calib"), std::string("metrics.") + name}, "px");
      break;
    }
    if (metrics.contains("sample_uncertainty") && metrics["sample_uncertainty"].is_object() &&
        metrics["sample_uncertainty"].contains("sigma_mm")) {
      figures += HeadFigure("position uncertainty on the sample (1σ)",
                            metrics["sample_uncertainty"]["sigma_mm"],
                            {ManifestLink("calib"), "metrics.sample_uncertainty.sigma_mm"}, "mm");
    }
  }
  figures += ColourFigures(input);
  for (const auto& [name, label] :
       {std::pair{"fitted", "fitted photographs"}, std::pair{"held_out", "held-out photographs"}}) {
    if (!own_metrics.contains(name)) continue;
    const Trace trace = own.Field(name);
    figures += HeadFigure(std::string("mean log error (0.02: 2 %), ") + label,
                          own_metrics[name]["log_l1"], trace.Field("log_l1"));
    figures += HeadFigure(std::string("mean RMSE, ") + label, own_metrics[name]["rmse"],
                          trace.Field("rmse"));
  }
  figures += "</div>\n" + LooksTable(own_metrics, own, ComparedAt(input));
  figures +=
      "<p>Hover over a number to see the manifest and the field it comes "
      "from.</p>\n";
  return Section("Fit quality", "", figures);
}

// Maps that nothing was fitted to must not pass for the result.
std::string FirstLookNote(const ReportInput& input) {
  if (input.Has("refine") || !input.Has("fit")) return "";
  if (input.manifests.at("fit").data.value("method", "") != "initial") return "";
  return "<p><strong>A first look:</strong> these maps are what a network estimates; they were not "
         "fitted to the photographs. <code>glint run</code> without <code>--quick</code> fits "
         "them.</p>\n";
}

std::string TitleSection(const ReportInput& input) {
  const Trace views{ViewsLink(input), "data"};
  return "<h1>" + HtmlText(MaterialName(input)) + "</h1>\n<p>" +
         FigureHtml(input.set.plane.width_mm, views.Field("width_mm")) + " × " +
         FigureHtml(input.set.plane.height_mm, views.Field("height_mm")) + " mm, " +
         FigureHtml(input.set.plane.width, views.Field("width")) + " × " +
         FigureHtml(input.set.plane.height, views.Field("height")) + " texels, from " +
         std::to_string(input.used_views.size()) +
         (input.used_views.size() == 1 ? " photograph" : " photographs") + ".</p>\n" +
         FirstLookNote(input);
}

std::string Folded(const std::string& title, const std::string& body) {
  return "<details class=\"fold\"><summary>" + HtmlText(title) + "</summary>\n" + body +
         "</details>\n";
}

std::string MapsSection(const ReportInput& input, const ReportOptions& options) {
  struct Shown {
    const char* name;
    int plane;
    const char* kind;
    const char* caption;
  };
  constexpr Shown kShown[] = {
      {"diffuse", kDiffuseR, "color", "diffuse albedo"},
      {"specular", kSpecularR, "color", "specular albedo (F0)"},
      {"roughness", kRoughness, "grey", "roughness, 0 black to 1 white"},
      {"normal", kNormalX, "normal", "normal, (n + 1)/2, +Y up"},
  };
  const SvbrdfMaps& whole = input.fit.maps;
  const auto [width, height] = SizeAtMost(whole.width, whole.height, options.picture_px);
  const SvbrdfMaps maps = ResampleSvbrdf(whole, width, height);
  std::string body = "<div class=\"pictures\">\n";
  for (const Shown& shown : kShown) {
    body += Figure(JpegUri(MapImage(maps, shown.plane, shown.kind), 92), shown.caption);
  }
  const fs::path confidence = input.work / "refine" / "confidence.exr";
  if (options.from == "refine" && fs::exists(confidence)) {
    body += Figure(PngUri(RoughnessConfidence(input, confidence, options.picture_px / 2)),
                   "standard deviation of the roughness, blue 0 to yellow 0.2");
  }
  body += "</div>\n";
  return Section("Maps (" + options.from + ")", ManifestLink(options.from), body);
}

std::string TileSection(const ReportInput& input, const ReportOptions& options) {
  if (!input.Has("tile")) return "";
  const Manifest& manifest = input.manifests.at("tile");
  const std::string maps = HashFile(input.work / options.from / "manifest.json");
  const bool of_these_maps = std::any_of(manifest.inputs.begin(), manifest.inputs.end(),
                                         [&](const ManifestInput& in) { return in.hash == maps; });
  if (!of_these_maps) return "";
  const Trace data{ManifestLink("tile"), "data"}, metrics{ManifestLink("tile"), "metrics"};
  const Image preview = ReadPng(input.work / "tile" / "preview.png");
  return Section("Repeated", ManifestLink("tile"),
                 "<p>A piece of " +
                     FigureHtml(manifest.data["size_mm"][0], data.Field("size_mm[0]")) + " × " +
                     FigureHtml(manifest.data["size_mm"][1], data.Field("size_mm[1]")) +
                     " mm repeats without visible borders; across its seams the maps change " +
                     FigureHtml(manifest.metrics["seam"]["worst"], metrics.Field("seam.worst")) +
                     " times as much as elsewhere. The material files hold this piece.</p>\n" +
                     Figure(JpegUri(Shrunk(preview, options.picture_px), 90),
                            "three by three pieces, lit", "wide"));
}

std::string ViewsSection(const ReportInput& input, const std::vector<ShownView>& shown,
                         Json* own_metrics) {
  Json views = Json::array();
  std::string rows;
  struct Mean {
    double log_l1 = 0, rmse = 0;
    int count = 0;
    std::vector<Looks> looks;
  } means[2];
  for (size_t i = 0; i < shown.size(); ++i) {
    const RectifiedView& view = input.set.views[i];
    const ViewError& error = shown[i].error;
    const bool used = Used(input, view);
    const Trace trace = Trace{kOwnManifest, "metrics.views"}.Index(i);
    views.push_back({{"name", view.name},
                     {"photo", view.photo},
                     {"fitted", used},
                     {"log_l1", error.log_l1},
                     {"rmse", error.rmse},
                     {"usable_texels", error.texels}});
    views.back().update(ToJson(shown[i].looks));
    const bool left_out = !used && LeftOut(input, view);
    if (error.texels > 0 && !left_out) {
      Mean& mean = means[used ? 0 : 1];
      mean.log_l1 += error.log_l1;
      mean.rmse += error.rmse;
      ++mean.count;
      mean.looks.push_back(shown[i].looks);
    }
    const Json& entry = views.back();
    rows += "<tr><td>" + HtmlText(view.name) + "<br><code>" + HtmlText(view.photo) + "</code>" +
            (used       ? ""
             : left_out ? "<br><span class=\"kept\">left out</span>"
                        : "<br><span class=\"kept\">held out</span>") +
            "</td>" + shown[i].cells + "<td class=\"number\">" +
            FigureHtml(entry["log_l1"], trace.Field("log_l1")) + "</td><td class=\"number\">" +
            FigureHtml(entry["rmse"], trace.Field("rmse")) + "</td>" + LooksCells(entry, trace) +
            "</tr>\n";
  }
  (*own_metrics)["views"] = views;
  for (const int i : {0, 1}) {
    if (means[i].count == 0) continue;
    Json& mean = (*own_metrics)[i == 0 ? "fitted" : "held_out"];
    mean = {{"photographs", means[i].count},
            {"log_l1", means[i].log_l1 / means[i].count},
            {"rmse", means[i].rmse / means[i].count}};
    mean.update(ToJson(MeanLooks(means[i].looks)));
  }
  const std::string body =
      "<p>Rectified photographs, the maps rendered under the same camera and light, and four times "
      "the absolute difference; gamma 2.2. log-L1: mean of |log(I + 0.01) − log(R + 0.01)|; RMSE: "
      "of linear radiance. The other columns are explained under Fit quality." +
      ComparedAt(input) +
      "</p>\n<div class=\"scroll\"><table class=\"views\">"
      "<tr><th>view</th><th>photograph</th><th>rendering</th><th>difference ×4</th>"
      "<th class=\"number\">log-L1</th><th class=\"number\">RMSE</th>" +
      LooksHeadCells() + "</tr>\n" + rows + "</table></div>\n";
  return Section("Photographs and re-renderings", kOwnManifest, body);
}

std::string GeometrySection(const ReportInput& input) {
  const Trace trace{ViewsLink(input), "data.views"};
  std::string rows;
  for (size_t i = 0; i < input.set.views.size(); ++i) {
    const View& view = input.set.views[i].view;
    const Trace row = trace.Index(i);
    const double distance_mm = Distance_mm(view.camera_in_sample_mm);
    const double tilt_deg =
        std::acos(
            std::clamp(view.camera_in_sample_mm[2] / std::max(distance_mm, 1e-9), -1.0, 1.0)) *
        180 / std::numbers::pi;
    const auto cell = [](const Json& value, const Trace& from) {
      return "<td class=\"number\">" + FigureHtml(value, from) + "</td>";
    };
    rows += "<tr><td>" + HtmlText(input.set.views[i].name) + "</td>" +
            cell(Json(view.camera_in_sample_mm), row.Field("camera_in_sample_mm")) +
            cell(distance_mm, row.Field("camera_in_sample_mm")) +
            cell(tilt_deg, row.Field("camera_in_sample_mm")) +
            cell(Json(view.light_in_sample_mm), row.Field("light_in_sample_mm")) +
            cell(Json(view.light_rgb), row.Field("light_rgb")) +
            cell(Json(view.ambient_rgb), row.Field("ambient_rgb")) +
            cell(view.exposure, row.Field("exposure")) + "</tr>\n";
  }
  std::string body =
      "<p>Positions in the sample frame: millimetres from the sample's centre, x right, y up, z "
      "toward the viewer. Tilt: angle between the viewing direction of the sample's centre and its "
      "normal.</p>\n<div class=\"scroll\"><table><tr><th>view</th><th class=\"number\">camera "
      "mm</th><th class=\"number\">distance mm</th><th class=\"number\">tilt °</th><th "
      "class=\"number\">light mm</th><th class=\"number\">light power</th><th class=\"number\">"
      "ambient</th><th class=\"number\">exposure</th></tr>\n" +
      rows + "</table></div>\n";
  const Json scale = Json(input.fit.light_scale_rgb);
  const std::string from = input.Has("refine") ? "refine" : "fit";
  body += "<p>Light scale found with the maps: " +
          FigureHtml(scale, {ManifestLink(from), "data.light_scale_rgb"}) +
          ". Reflectance convention: <code>" + HtmlText(ToString(input.fit.convention)) +
          "</code>.</p>\n";
  return Section("Cameras and lights", ViewsLink(input), body);
}

std::string StageSection(const ReportInput& input, const std::string& stage) {
  const Manifest& manifest = input.manifests.at(stage);
  const std::string link = ManifestLink(stage);
  Json metrics = manifest.metrics;
  metrics.erase("guidance");
  std::string body = MetricsHtml(metrics, {link, "metrics"});
  std::string pictures;
  for (const ManifestOutput& output : manifest.outputs) {
    if (fs::path(output.path).extension() != ".png") continue;
    if (output.path.compare(0, sizeof(kGuidancePrefix) - 1, kGuidancePrefix) == 0) continue;
    const Image picture = ReadPng(input.work / stage / output.path);
    pictures += Figure(PngUri(Shrunk(picture, kStagePicture_px)), output.path, "wide");
  }
  body += pictures;
  std::string files;
  for (const auto& [label, list] :
       {std::pair{"read", ToJson(manifest)["inputs"]}, {"written", ToJson(manifest)["outputs"]}}) {
    for (const Json& entry : list) {
      files += "<tr><td>" + std::string(label) + "</td><td><code>" +
               HtmlText(entry["path"].get<std::string>()) + "</code></td><td><code>" +
               HtmlText(entry["hash"].get<std::string>()) + "</code></td></tr>\n";
    }
  }
  body += "<details><summary>Options, stage version " + std::to_string(manifest.stage_version) +
          "</summary>\n" + PairsTable(manifest.options, {link, "options"}) + "</details>\n";
  body += "<details><summary>Files</summary><div class=\"scroll\"><table>" + files +
          "</table></div></details>\n";
  return Section("Stage " + stage, link, body);
}

}  // namespace glint
