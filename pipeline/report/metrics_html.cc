#include "pipeline/report/metrics_html.h"

#include <algorithm>
#include <vector>

#include "pipeline/report/chart.h"
#include "pipeline/report/html.h"

namespace glint {
namespace {

constexpr size_t kCurveLength = 8;    // lists of at least so many numbers are curves
constexpr size_t kLongestTable = 60;  // lists of more objects are curves
constexpr size_t kMostChartPoints = 2000;
constexpr int kDeepest = 6;

bool IsNumberList(const Json& value) {
  return value.is_array() && !value.empty() &&
         std::all_of(value.begin(), value.end(),
                     [](const Json& v) { return v.is_number() || v.is_null(); });
}

bool IsObjectList(const Json& value) {
  return value.is_array() && !value.empty() &&
         std::all_of(value.begin(), value.end(), [](const Json& v) { return v.is_object(); });
}

// Objects under names: {"fx": {"value": 1, "sigma": 2}, …}.
bool IsObjectOfObjects(const Json& value) {
  return value.is_object() && !value.empty() &&
         std::all_of(value.begin(), value.end(), [](const Json& v) {
           return v.is_object() && std::none_of(v.begin(), v.end(), [](const Json& inner) {
                    return inner.is_object();
                  });
         });
}

bool IsMatrix(const Json& value) {
  return value.is_array() && !value.empty() &&
         std::all_of(value.begin(), value.end(), [](const Json& row) { return IsNumberList(row); });
}

// What fits into a cell of a table.
bool IsCell(const Json& value) {
  return !value.is_object() && !IsObjectList(value) && !IsMatrix(value) &&
         !(value.is_array() && value.size() >= kCurveLength);
}

double NumberOr(const Json& value, double fallback) {
  return value.is_number() ? value.get<double>() : fallback;
}

ChartLine IndexedLine(const std::string& name, const Json& list) {
  ChartLine line;
  line.name = name;
  const size_t stride = list.size() / kMostChartPoints + 1;
  for (size_t i = 0; i < list.size(); i += stride) {
    line.x.push_back(static_cast<double>(i));
    line.y.push_back(NumberOr(list[i], std::numeric_limits<double>::quiet_NaN()));
  }
  return line;
}

std::string TooltipOf(const Trace& trace) {
  return " title=\"" + HtmlText(trace.manifest + ": " + trace.field) + "\"";
}

std::string MatrixHtml(const std::string& name, const Json& matrix, const Trace& trace) {
  std::string html = "<details><summary>" + HtmlText(name) +
                     "</summary><div class=\"scroll\"><table" + TooltipOf(trace) + ">";
  for (const Json& row : matrix) {
    html += "<tr>";
    for (const Json& value : row) {
      html += "<td class=\"number\">" +
              (value.is_number() ? NumberText(value.get<double>()) : std::string("–")) + "</td>";
    }
    html += "</tr>\n";
  }
  return html + "</table></div></details>\n";
}

std::string NamedObjectsTable(const Json& objects, const Trace& trace) {
  std::string html;
  for (const auto& [name, object] : objects.items()) {
    const bool first = html.empty();
    std::string head = "<tr><th></th>", row = "<tr><td>" + HtmlText(name) + "</td>";
    for (const auto& [key, value] : object.items()) {
      head += "<th class=\"number\">" + HtmlText(key) + "</th>";
      row += "<td class=\"number\">" + FigureHtml(value, trace.Field(name).Field(key)) + "</td>";
    }
    if (first) html += "<table class=\"pairs\">" + head + "</tr>\n";
    html += row + "</tr>\n";
  }
  return html + "</table>\n";
}

std::string CurveHtml(const std::string& name, const Json& list, const Trace& trace) {
  Chart chart;
  chart.title = name;
  chart.x_label = name.find("loss") != std::string::npos ? "iteration" : "index";
  chart.lines = {IndexedLine(name, list)};
  return "<div" + TooltipOf(trace) + ">" + ChartSvg(chart) + "</div>";
}

// The key that counts along a long list of objects.
std::string CountingKey(const Json& first) {
  for (const char* key : {"iteration", "step", "i", "index"}) {
    if (first.contains(key)) return key;
  }
  return "";
}

// One chart for each numeric key of a long list of objects, over the key that counts.
std::string ObjectsCharts(const std::string& name, const Json& list, const Trace& trace) {
  const std::string along = CountingKey(list[0]);
  std::string html;
  for (const auto& [key, value] : list[0].items()) {
    if (!value.is_number() || key == along) continue;
    ChartLine line;
    line.name = key;
    const size_t stride = list.size() / kMostChartPoints + 1;
    for (size_t i = 0; i < list.size(); i += stride) {
      if (!list[i].contains(key)) continue;
      line.x.push_back(along.empty() ? static_cast<double>(i)
                                     : NumberOr(list[i].value(along, Json()), 0));
      line.y.push_back(NumberOr(list[i][key], std::numeric_limits<double>::quiet_NaN()));
    }
    Chart chart;
    chart.title = name + ": " + key;
    chart.x_label = along.empty() ? "index" : along;
    chart.lines = {line};
    html += "<div title=\"" + HtmlText(trace.manifest + ": " + trace.field + "[]." + key) + "\">" +
            ChartSvg(chart) + "</div>";
  }
  return html;
}

// Gathers what MetricsHtml shows.
struct Parts {
  Json pairs = Json::object();
  std::string charts, tables;
};

void Gather(const std::string& name, const Json& value, const Trace& trace, int depth,
            Parts* parts) {
  if (IsNumberList(value) && value.size() >= kCurveLength) {
    parts->charts += CurveHtml(name, value, trace);
  } else if (IsObjectList(value) && value.size() > kLongestTable) {
    parts->charts += ObjectsCharts(name, value, trace);
  } else if (IsObjectList(value)) {
    parts->tables += "<h3>" + HtmlText(name) + "</h3>\n" + ObjectsTable(value, trace);
    for (size_t i = 0; i < value.size() && depth < kDeepest; ++i) {
      for (const auto& [key, inner] : value[i].items()) {
        if (IsCell(inner)) continue;
        Gather(name + "[" + std::to_string(i) + "]." + key, inner, trace.Index(i).Field(key),
               depth + 1, parts);
      }
    }
  } else if (IsMatrix(value)) {
    parts->tables += MatrixHtml(name, value, trace);
  } else if (IsObjectOfObjects(value)) {
    parts->tables += "<h3>" + HtmlText(name) + "</h3>\n" + NamedObjectsTable(value, trace);
  } else if (value.is_object() && depth < kDeepest) {
    for (const auto& [key, inner] : value.items()) {
      Gather(name.empty() ? key : name + "." + key, inner, trace.Field(key), depth + 1, parts);
    }
  } else {
    parts->pairs[name] = value;
  }
}

}  // namespace

std::string PairsTable(const Json& object, const Trace& trace) {
  if (object.empty()) return "";
  std::string html = "<table class=\"pairs\">";
  for (const auto& [key, value] : object.items()) {
    html += "<tr><td>" + HtmlText(key) + "</td><td class=\"number\">" +
            FigureHtml(value, trace.Field(key)) + "</td></tr>\n";
  }
  return html + "</table>\n";
}

std::string ObjectsTable(const Json& list, const Trace& trace) {
  std::vector<std::string> columns;
  for (const Json& row : list) {
    for (const auto& [key, value] : row.items()) {
      if (IsCell(value) && std::find(columns.begin(), columns.end(), key) == columns.end()) {
        columns.push_back(key);
      }
    }
  }
  std::string html = "<div class=\"scroll\"><table><tr>";
  for (const std::string& column : columns) {
    const bool number = list[0].contains(column) && list[0][column].is_number();
    html += (number ? "<th class=\"number\">" : "<th>") + HtmlText(column) + "</th>";
  }
  html += "</tr>\n";
  for (size_t i = 0; i < list.size(); ++i) {
    html += "<tr>";
    for (const std::string& column : columns) {
      const bool present = list[i].contains(column);
      const bool number = present && list[i][column].is_number();
      html += number ? "<td class=\"number\">" : "<td>";
      if (present) html += FigureHtml(list[i][column], trace.Index(i).Field(column));
      html += "</td>";
    }
    html += "</tr>\n";
  }
  return html + "</table></div>\n";
}

std::string MetricsHtml(const Json& metrics, const Trace& trace) {
  Parts parts;
  Gather("", metrics, trace, 0, &parts);
  std::string html;
  if (!parts.charts.empty()) html += "<div class=\"charts\">" + parts.charts + "</div>\n";
  html += PairsTable(parts.pairs, trace);
  return html + parts.tables;
}

}  // namespace glint
