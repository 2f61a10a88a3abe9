#include "pipeline/report/guidance_section.h"

#include "base/files/files.h"
#include "base/images/image.h"
#include "pipeline/report/figure.h"
#include "pipeline/report/html.h"
#include "pipeline/report/metrics_html.h"
#include "pipeline/report/picture.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMaxSvgBytes = 4u << 20;

std::string PictureUri(const fs::path& file) {
  if (file.extension() == ".svg") {
    return "data:image/svg+xml;base64," + Base64(ReadTextFile(file, kMaxSvgBytes));
  }
  return PngUri(ReadPng(file));
}

std::string Caption(const std::string& name) {
  if (name == "guidance_views.svg") {
    return "directions of camera and flash: the distance from the centre is the tilt; the right of "
           "the plot is the right of the maps";
  }
  if (name == "guidance_coverage.png") {
    return "smallest angle between the surface normal and the half vector over all photographs";
  }
  return name;
}

std::string Pictures(const ReportInput& input, const Manifest& manifest) {
  std::string html;
  for (const ManifestOutput& output : manifest.outputs) {
    if (output.path.compare(0, sizeof(kGuidancePrefix) - 1, kGuidancePrefix) != 0) continue;
    const fs::path file = input.work / "calib" / output.path;
    if (file.extension() != ".svg" && file.extension() != ".png") continue;
    const std::string caption = Caption(output.path);
    html += "<figure>" + ImageHtml(PictureUri(file), caption) + "<figcaption>" + HtmlText(caption) +
            "</figcaption></figure>\n";
  }
  return html.empty() ? "" : "<div class=\"pictures\">\n" + html + "</div>\n";
}

std::string AdviceList(const Json& guidance, const Trace& trace) {
  const auto advice = guidance.find("advice");
  if (advice == guidance.end() || !advice->is_array() || advice->empty()) return "";
  std::string html = "<ul>\n";
  for (size_t i = 0; i < advice->size(); ++i) {
    if (!(*advice)[i].is_object()) continue;
    html += "<li>" +
            FigureHtml((*advice)[i].value("text", Json()),
                       trace.Field("advice").Index(i).Field("text")) +
            "</li>\n";
  }
  return html + "</ul>\n";
}

}  // namespace

std::string GuidanceSection(const ReportInput& input) {
  if (!input.Has("calib")) return "";
  const Manifest& manifest = input.manifests.at("calib");
  const auto found = manifest.metrics.find("guidance");
  if (found == manifest.metrics.end() || !found->is_object()) return "";
  const std::string link = "../calib/manifest.json";
  const Trace trace{link, "metrics.guidance"};
  std::string body = "<p>" + FigureHtml(found->value("summary", Json()), trace.Field("summary")) +
                     ".</p>\n" + AdviceList(*found, trace) + Pictures(input, manifest);
  const auto views = found->find("views");
  if (views != found->end() && views->is_array()) {
    body += "<details><summary>Photographs</summary>\n" +
            ObjectsTable(*views, trace.Field("views")) + "</details>\n";
  }
  return "<section>\n" + SourceLink(link) +
         "<h2>Capture: " + FigureHtml(found->value("verdict", Json()), trace.Field("verdict")) +
         "</h2>\n" + body + "</section>\n";
}

}  // namespace glint
