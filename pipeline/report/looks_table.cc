#include "pipeline/report/looks_table.h"

#include <utility>

#include "datasets/looks/looks_figures.h"
#include "pipeline/report/html.h"

namespace glint {
namespace {

// Of a figure with bands the page has the finest.
std::string ShownHeading(const LooksFigure& figure) {
  if (figure.bands.empty()) return figure.heading;
  return std::string(figure.heading) + " (" + figure.bands[0].heading + ")";
}

std::string ShownFigure(const LooksFigure& figure, const Json& figures, const Trace& trace) {
  const Json& value = figures[figure.key];
  const Trace field = trace.Field(figure.key);
  return figure.bands.empty() ? FigureHtml(value, field) : FigureHtml(value[0], field.Index(0));
}

}  // namespace

std::string LooksHeadCells() {
  std::string html;
  for (const LooksFigure& figure : LooksFigures()) {
    html += "<th class=\"number\">" + HtmlText(ShownHeading(figure)) + "</th>";
  }
  return html;
}

std::string LooksCells(const Json& figures, const Trace& trace) {
  std::string html;
  for (const LooksFigure& figure : LooksFigures()) {
    html += "<td class=\"number\">" + ShownFigure(figure, figures, trace) + "</td>";
  }
  return html;
}

std::string LooksTable(const Json& own_metrics, const Trace& own, const std::string& note) {
  std::string rows;
  for (const auto& [name, label] :
       {std::pair{"fitted", "fitted"}, std::pair{"held_out", "held out"}}) {
    if (!own_metrics.contains(name)) continue;
    rows += "<tr><td>" + std::string(label) + "</td>" +
            LooksCells(own_metrics[name], own.Field(name)) + "</tr>\n";
  }
  if (rows.empty()) return "";
  std::string says;
  for (const LooksFigure& figure : LooksFigures()) {
    says += "<br><b>" + HtmlText(ShownHeading(figure)) + "</b> " + HtmlText(figure.says) + "\n";
  }
  return "<div class=\"scroll\"><table><tr><th>photographs, mean</th>" + LooksHeadCells() +
         "</tr>\n" + rows +
         "</table></div>\n<p>How the renderings look beside the photographs, both as a screen "
         "shows "
         "them. Detail of (1–2) is 1 to 2 texels wide in a picture 256 texels across." +
         HtmlText(note) + "\n" + says + "</p>\n";
}

}  // namespace glint
