#include "pipeline/report/looks_table.h"

#include <utility>

#include "pipeline/report/html.h"

namespace glint {
namespace {

struct ShownFigure {
  const char* name;
  const char* field;
  int index;  // in the field's list; below 0: it is no list
  const char* says;
};

constexpr ShownFigure kShownFigures[] = {
    {"free", "free", -1,
     "the log error that remains after the best factor of each colour channel: what is not "
     "exposure (0.02: 2 %)."},
    {"contrast (1–2)", "contrast", 0,
     "how strong fine detail is, rendering by photograph: below 1 the rendering is blurred, above "
     "1 harsh or noisy."},
    {"correlation (1–2)", "correlation", 0,
     "whether that detail is the photograph's: 1 all of it, 0 none."},
    {"SSIM", "ssim", -1, "structural similarity of the two as grey pictures: 1 the same picture."},
    {"highlight", "highlight", -1,
     "how bright the rendering is where the photograph is brightest (2 % of it), rendering by "
     "photograph: below 1 highlights are too dull."}};

}  // namespace

std::string LooksHeadCells() {
  std::string html;
  for (const ShownFigure& shown : kShownFigures) {
    html += "<th class=\"number\">" + HtmlText(shown.name) + "</th>";
  }
  return html;
}

std::string LooksCells(const Json& figures, const Trace& trace) {
  std::string html;
  for (const ShownFigure& shown : kShownFigures) {
    const Json& value = figures[shown.field];
    const Trace field = trace.Field(shown.field);
    const auto index = static_cast<size_t>(shown.index);
    html += "<td class=\"number\">" +
            (shown.index < 0 ? FigureHtml(value, field)
                             : FigureHtml(value[index], field.Index(index))) +
            "</td>";
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
  for (const ShownFigure& shown : kShownFigures) {
    says += "<br><b>" + HtmlText(shown.name) + "</b> " + HtmlText(shown.says) + "\n";
  }
  return "<div class=\"scroll\"><table><tr><th>photographs, mean</th>" + LooksHeadCells() +
         "</tr>\n" + rows +
         "</table></div>\n<p>How the renderings look beside the photographs, both as a screen "
         "shows "
         "them. Detail of (1–2) is 1 to 2 texels wide in a picture 256 texels across." +
         HtmlText(note) + "\n" + says + "</p>\n";
}

}  // namespace glint
