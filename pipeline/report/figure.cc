#include "pipeline/report/figure.h"

#include "pipeline/report/html.h"

namespace glint {
namespace {

std::string ValueText(const Json& value) {
  if (value.is_number()) return NumberText(value.get<double>());
  if (value.is_string()) return value.get<std::string>();
  if (value.is_null()) return "–";
  if (value.is_array()) {
    std::string text;
    for (const Json& element : value) text += (text.empty() ? "" : ", ") + ValueText(element);
    return text.empty() ? "–" : text;
  }
  return value.dump();
}

}  // namespace

std::string FigureHtml(const Json& value, const Trace& trace) {
  return "<span title=\"" + HtmlText(trace.manifest + ": " + trace.field) + "\">" +
         HtmlText(ValueText(value)) + "</span>";
}

std::string HeadFigure(const std::string& label, const Json& value, const Trace& trace,
                       const std::string& unit) {
  return "<div><b>" + FigureHtml(value, trace) + (unit.empty() ? "" : " " + HtmlText(unit)) +
         "</b><span>" + HtmlText(label) + "</span></div>\n";
}

std::string SourceLink(const std::string& manifest) {
  return "<a class=\"source\" href=\"" + HtmlText(manifest) + "\">" + HtmlText(manifest) + "</a>";
}

}  // namespace glint
