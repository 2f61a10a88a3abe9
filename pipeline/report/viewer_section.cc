#include "pipeline/report/viewer_section.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include "base/colour/srgb.h"
#include "base/formats/svbrdf_file.h"
#include "base/parallel/parallel.h"
#include "base/reflectance/brdf.h"
#include "base/resampling/resampling.h"
#include "pipeline/report/html.h"
#include "pipeline/report/picture.h"
#include "pipeline/report/sections.h"
#include "pipeline/viewer/viewer_bundle.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

Image SrgbPicture(const SvbrdfMaps& maps, int first_plane) {
  Image image(maps.width, maps.height, kRgbChannels);
  for (int c = 0; c < 3; ++c) {
    const auto from = maps.plane(first_plane + c);
    std::transform(from.begin(), from.end(), image.channel(c).begin(), ClampedSrgb<float>);
  }
  return image;
}

// Normal x, normal y and roughness in 16 bits, high bytes in one picture and low bytes in another:
// 8 bits of a normal are half a degree, which a glossy highlight shows.
std::array<Image, 2> GeometryPictures(const SvbrdfMaps& maps) {
  std::array<Image, 2> bytes = {Image(maps.width, maps.height, kRgbChannels),
                                Image(maps.width, maps.height, kRgbChannels)};
  for (int c = 0; c < 3; ++c) {
    const auto from = maps.plane(c == 2 ? kRoughness : kNormalX + c);
    for (size_t i = 0; i < from.size(); ++i) {
      const float value = c == 2 ? from[i] : 0.5f * from[i] + 0.5f;
      const auto whole = static_cast<int>(std::lround(65535 * std::clamp(value, 0.0f, 1.0f)));
      bytes[0].channel(c)[i] = static_cast<float>(whole >> 8) / 255;
      bytes[1].channel(c)[i] = static_cast<float>(whole & 255) / 255;
    }
  }
  return bytes;
}

// The maps as the viewer draws them: at most so large, averaged as maps are.
SvbrdfMaps ShownMaps(const SvbrdfMaps& maps, int most_px) {
  const auto [width, height] = SizeAtMost(maps.width, maps.height, most_px);
  return ResampleSvbrdf(maps, width, height);
}

Json MapsJson(const ReportInput& input, const SvbrdfMaps& maps, const ReportOptions& options,
              int threads) {
  const auto geometry = GeometryPictures(maps);
  const std::array<std::pair<const char*, Image>, 4> pictures = {
      {{"diffuse", SrgbPicture(maps, kDiffuseR)},
       {"specular", SrgbPicture(maps, kSpecularR)},
       {"geometry_high", geometry[0]},
       {"geometry_low", geometry[1]}}};
  std::array<std::string, pictures.size()> uris;
  ForEachPiece(static_cast<int>(pictures.size()), threads, [&](int i) {
    uris[static_cast<size_t>(i)] = PngUri(pictures[static_cast<size_t>(i)].second);
  });
  Json json = Json::object();
  for (size_t i = 0; i < pictures.size(); ++i) json[pictures[i].first] = uris[i];
  const fs::path confidence = input.work / "refine" / "confidence.exr";
  if (options.from == "refine" && fs::exists(confidence)) {
    json["confidence"] = PngUri(RoughnessConfidence(input, confidence, options.picture_px));
  }
  return json;
}

Json ViewsJson(const ReportInput& input, const std::vector<ShownView>& shown) {
  Json views = Json::array();
  for (size_t i = 0; i < shown.size(); ++i) {
    const RectifiedView& view = input.set.views[i];
    const View lit = ViewOfFit(input.fit, view);
    const bool fitted = std::find(input.used_views.begin(), input.used_views.end(), view.name) !=
                        input.used_views.end();
    views.push_back({{"name", view.name},
                     {"photo", view.photo},
                     {"fitted", fitted},
                     {"camera_mm", lit.camera_in_sample_mm},
                     {"light_mm", lit.light_in_sample_mm},
                     {"light_rgb", lit.light_rgb},
                     {"ambient_rgb", lit.ambient_rgb},
                     {"exposure", lit.exposure},
                     {"beam", lit.beam},
                     {"photograph", shown[i].photograph_uri}});
  }
  return views;
}

Json LobesJson(const SpecularLobes& lobes) {
  const LobeMix<double> mix = LobeMixOf<double>(lobes);
  return {{"shares", mix.share},           {"scales", mix.scale},
          {"coat_f0", mix.coat_f0},        {"tail_exponent", mix.shape.exponent},
          {"anisotropy", mix.shape.ratio}, {"direction", mix.shape.direction}};
}

// JSON inside <script>: what could end it is escaped.
std::string ScriptJson(const Json& json) {
  std::string text = json.dump(-1, ' ', false, Json::error_handler_t::replace);
  for (size_t at = text.find('<'); at != std::string::npos; at = text.find('<', at + 6)) {
    text.replace(at, 1, "\\u003c");
  }
  return text;
}

constexpr char kElements[] = R"(<div id="viewer" class="viewer">
<div class="stage"><canvas id="viewer-canvas" tabindex="0" role="img" aria-label="The material, relit. Arrow keys move the light."></canvas>
<img id="viewer-photograph" alt=""></div>
<div class="controls">
<label>Show <select id="viewer-view"></select></label>
<label class="relight">Shape <select id="viewer-shape"></select></label>
<label class="relight">Channel <select id="viewer-channel"></select></label>
<label class="relight">Light <select id="viewer-light"></select></label>
<label class="relight">Drag moves <select id="viewer-drag"><option value="light">the light</option><option value="camera">the camera</option></select></label>
<label class="relight">Exposure <input id="viewer-exposure" type="range" min="-4" max="4" step="0.1" value="0"></label>
<label class="compare">Photograph | rendering <input id="viewer-slider" type="range" min="0" max="100" value="50"></label>
</div>
<p id="viewer-note"></p>
</div>
)";

}  // namespace

std::string ViewerSection(const ReportInput& input, const ReportOptions& options,
                          const std::vector<ShownView>& shown, int threads) {
  if (ViewerBundle().empty()) {
    return "<p>This build of Glint has no viewer (npm could not be reached when it was built): the "
           "pictures below show what it would show.</p>\n";
  }
  const SvbrdfMaps maps = ShownMaps(input.fit.maps, options.viewer_px);
  const Json material = {
      {"size_mm", {input.set.plane.width_mm, input.set.plane.height_mm}},
      {"size_texel", {maps.width, maps.height}},
      {"diffuse_whole", input.fit.convention.diffuse_weight == DiffuseWeight::kOne},
      {"lobes", LobesJson(input.fit.convention.lobes)},
      {"falls_off", input.set.convention.falloff == LightFalloff::kInverseSquare},
      {"maps", MapsJson(input, maps, options, threads)},
      {"views", ViewsJson(input, shown)}};
  return std::string(kElements) + "<script type=\"application/json\" id=\"viewer-material\">" +
         ScriptJson(material) + "</script>\n";
}

std::string ViewerScript() {
  const std::string_view bundle = ViewerBundle();
  if (bundle.empty()) return "";
  return "<script>" + std::string(bundle) + "</script>\n";
}

}  // namespace glint
