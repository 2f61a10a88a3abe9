#include "pipeline/report/corrections_section.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "pipeline/report/figure.h"
#include "pipeline/report/html.h"
#include "pipeline/report/picture.h"

namespace glint {
namespace {

constexpr int kEnvironment_px = 192;
constexpr char kLink[] = "../refine/manifest.json";

// The hemisphere above the sample, the zenith in the middle, angles from it along the radius.
Image EnvironmentPicture(const EnvironmentLighting& environment) {
  Image image(kEnvironment_px, kEnvironment_px, {"R", "G", "B"});
  float brightest = 0;
  for (int row = 0; row < kEnvironment_px; ++row) {
    for (int column = 0; column < kEnvironment_px; ++column) {
      const double x = 2 * (column + 0.5) / kEnvironment_px - 1,
                   y = 1 - 2 * (row + 0.5) / kEnvironment_px;
      const double radius = std::hypot(x, y);
      if (radius > 1) continue;
      const size_t pixel = static_cast<size_t>(row) * kEnvironment_px + static_cast<size_t>(column);
      const double polar = 0.5 * std::numbers::pi * radius;
      const double across = radius > 0 ? std::sin(polar) / radius : 0;
      const Vec3d rgb = environment.RadianceFrom({x * across, y * across, std::cos(polar)});
      for (size_t c = 0; c < 3; ++c) {
        const float value = static_cast<float>(std::max(0.0, rgb[c]));
        image.channel(static_cast<int>(c))[pixel] = value;
        brightest = std::max(brightest, value);
      }
    }
  }
  return DisplayImage(image.samples, kEnvironment_px, kEnvironment_px,
                      brightest > 0 ? 1 / brightest : 1);
}

std::string EnvironmentFigure(const EnvironmentLighting& environment) {
  const std::string caption =
      "the surroundings as seen from the sample: straight up in the middle, the horizon at the "
      "edge, x right, y up; brightest as white, gamma 2.2";
  return "<div class=\"pictures\"><figure>" +
         ImageHtml(PngUri(EnvironmentPicture(environment)), caption) + "<figcaption>" +
         HtmlText(caption) + "</figcaption></figure></div>\n";
}

std::string ViewsTable(const ReportInput& input) {
  std::string rows;
  const Json& entries = input.manifests.at("refine").data["corrections"];
  for (size_t i = 0; i < entries.size(); ++i) {
    const std::string name = entries[i]["name"];
    const ViewCorrection& correction = input.fit.corrections.at(name);
    const auto view = std::find_if(input.set.views.begin(), input.set.views.end(),
                                   [&](const RectifiedView& v) { return v.name == name; });
    if (view == input.set.views.end()) continue;
    const Trace trace = Trace{kLink, "data.corrections"}.Index(i);
    const auto cell = [&](double value, const char* field) {
      return "<td class=\"number\">" + FigureHtml(value, trace.Field(field)) + "</td>";
    };
    rows += "<tr><td>" + HtmlText(name) + "</td>" +
            cell(LightTurnedDeg(view->view, correction), "light_offset_mm") +
            cell(correction.exposure, "exposure") +
            cell(correction.shifts.rms(), "corner_columns_texel") + "</tr>\n";
  }
  return "<div class=\"scroll\"><table><tr><th>view</th><th class=\"number\">light turned °</th>"
         "<th class=\"number\">exposure ×</th><th class=\"number\">picture moved, texels</th></tr>"
         "\n" +
         rows + "</table></div>\n";
}

}  // namespace

std::string CorrectionsSection(const ReportInput& input) {
  const bool any = input.fit.environment.any() || !input.fit.corrections.empty();
  if (!input.Has("refine") || !any) return "";
  const Trace metrics{kLink, "metrics.correction"};
  const Json correction = input.manifests.at("refine").metrics.value("correction", Json::object());
  std::string body = "<p>These values were not stated; they were estimated from the photographs. ";
  if (input.fit.environment.any()) {
    body += "Ambient illumination of the sample is " +
            FigureHtml(correction.value("ambient_of_flash", Json()),
                       metrics.Field("ambient_of_flash")) +
            " of the flash's. ";
  }
  const bool moved = std::any_of(input.fit.corrections.begin(), input.fit.corrections.end(),
                                 [](const auto& view) { return !view.second.none(); });
  body += moved ? "Lights, exposures and pictures are corrected as in the table, and all views are "
                  "shown with these corrections.</p>\n"
                : "Lights, exposures and pictures are used as stated.</p>\n";
  if (input.fit.environment.degree() > 0) body += EnvironmentFigure(input.fit.environment);
  if (moved) body += ViewsTable(input);
  return "<section>\n" + SourceLink(kLink) + "<h2>Corrected</h2>\n" + body + "</section>\n";
}

}  // namespace glint
