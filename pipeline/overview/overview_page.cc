#include "pipeline/overview/overview_page.h"

#include <fmt/format.h>

#include <algorithm>
#include <map>
#include <tuple>

#include "base/programs/run_progress.h"
#include "pipeline/report/html.h"

namespace glint {
namespace {

namespace fs = std::filesystem;
using State = CaptureSummary::State;

constexpr char kStyle[] = R"(<style>
.captures td { vertical-align: middle; } .captures td.number { white-space: nowrap; } .captures img { width: 96px; display: block; border-radius: 4px; }
.captures th button { all: unset; cursor: pointer; } .captures th button:focus-visible { outline: 2px solid var(--link); }
.captures th[aria-sort=ascending] button::after { content: " ▲"; } .captures th[aria-sort=descending] button::after { content: " ▼"; }
.captures .message { color: var(--soft); max-width: 44ch; overflow-wrap: anywhere; white-space: pre-line; }
</style>
)";

// Sorts rows by the data-value of a column's cells, as numbers where both are; what has no value
// goes last. The same column again turns the order round.
constexpr char kScript[] = R"(<script>
document.querySelectorAll(".captures th button").forEach((button) => {
  button.addEventListener("click", () => {
    const head = button.closest("th"), body = head.closest("table").tBodies[0];
    const column = [...head.parentNode.children].indexOf(head);
    const down = head.getAttribute("aria-sort") === "ascending";
    for (const other of head.parentNode.children) other.removeAttribute("aria-sort");
    head.setAttribute("aria-sort", down ? "descending" : "ascending");
    const value = (row) => row.cells[column].dataset.value;
    const rows = [...body.rows].sort((a, b) => {
      const x = value(a), y = value(b);
      if (x === "" || y === "") return (x === "") - (y === "");
      const numbers = !isNaN(x) && !isNaN(y);
      const order = numbers ? x - y : x.localeCompare(y);
      return down ? -order : order;
    });
    body.append(...rows);
  });
});
</script>
)";

struct Column {
  const char* title;
  bool number;
};
constexpr Column kColumns[] = {
    {"Capture", false}, {"State", false},   {"Photographs are", false}, {"Photographs", true},
    {"Texels", true},   {"Size, mm", true}, {"Reprojection, px", true}, {"Log error", true},
    {"Held out", true}, {"Time", true}};

std::string Cell(const std::string& html, const std::string& value, bool number) {
  return fmt::format("<td{} data-value=\"{}\">{}</td>", number ? " class=\"number\"" : "",
                     HtmlText(value), html);
}

std::string NumberCell(const std::optional<double>& number) {
  if (!number) return Cell("", "", true);
  return Cell(fmt::format("{:.3g}", *number), fmt::format("{}", *number), true);
}

std::string PairCell(const std::optional<double>& a, const std::optional<double>& b) {
  if (!a || !b) return Cell("", "", true);
  return Cell(fmt::format("{:g} × {:g}", *a, *b), fmt::format("{}", *a * *b), true);
}

// A path in a URL: everything but what never needs escaping is escaped.
std::string UrlPath(const fs::path& path) {
  std::string url;
  for (const char c : path.generic_string()) {
    const bool plain = (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ||
                       std::string_view("/-_.~").find(c) != std::string_view::npos;
    url += plain ? std::string(1, c) : fmt::format("%{:02X}", static_cast<unsigned char>(c));
  }
  return url;
}

std::string NameCell(const CaptureSummary& capture, const fs::path& page) {
  std::string html;
  if (!capture.thumbnail_jpeg.empty()) {
    html += "<img src=\"data:image/jpeg;base64," + Base64(capture.thumbnail_jpeg) + "\" alt=\"\">";
  }
  const std::string name = HtmlText(capture.name);
  if (capture.page.empty()) {
    html += name;
  } else {
    const fs::path from = fs::absolute(page).lexically_normal().parent_path();
    const fs::path link = fs::absolute(capture.page).lexically_normal().lexically_relative(from);
    html += "<a href=\"" + UrlPath(link) + "\">" + name + "</a>";
  }
  return Cell(html, capture.name, false);
}

// Its first line; the others unfold.
std::string MessageHtml(const std::string& message) {
  const size_t end = message.find('\n');
  std::string html = "<div class=\"message\">" + HtmlText(message.substr(0, end));
  if (end != std::string::npos) {
    html += "<details><summary>more</summary>" + HtmlText(message.substr(end + 1)) + "</details>";
  }
  return html + "</div>";
}

std::string StateCell(const CaptureSummary& capture) {
  std::string html = ToText(capture.state);
  if (!capture.stage.empty()) {
    html += (capture.state == State::kFailed ? " in " : ": ") + HtmlText(capture.stage);
  }
  if (capture.state != State::kDone) html = "<span class=\"kept\">" + html + "</span>";
  if (!capture.message.empty()) html += MessageHtml(capture.message);
  return Cell(html, std::to_string(static_cast<int>(capture.state)), false);
}

std::string Row(const CaptureSummary& capture, const fs::path& page) {
  std::string row = "<tr>" + NameCell(capture, page) + StateCell(capture);
  row += Cell(HtmlText(capture.verdict), capture.verdict, false);
  row += NumberCell(capture.photographs);
  row += PairCell(capture.texels_across, capture.texels_down);
  row += PairCell(capture.width_mm, capture.height_mm);
  row += NumberCell(capture.reprojection_px) + NumberCell(capture.log_l1) +
         NumberCell(capture.held_out_log_l1);
  row += capture.seconds ? Cell(HtmlText(DurationText(*capture.seconds)),
                                fmt::format("{}", *capture.seconds), true)
                         : Cell("", "", true);
  return row + "</tr>\n";
}

std::string Counts(const std::vector<CaptureSummary>& captures) {
  std::map<State, int> counts;
  for (const CaptureSummary& capture : captures) ++counts[capture.state];
  std::string text;
  for (const auto& [state, count] : counts) {
    text += (text.empty() ? "" : ", ") + fmt::format("{} {}", count, ToText(state));
  }
  return text;
}

}  // namespace

std::string OverviewPage(std::vector<CaptureSummary> captures, const fs::path& page) {
  std::sort(captures.begin(), captures.end(), [](const auto& a, const auto& b) {
    return std::tie(a.state, a.name, a.folder) < std::tie(b.state, b.name, b.folder);
  });
  std::string head, rows;
  for (const Column& column : kColumns) {
    head += fmt::format("<th{}><button>{}</button></th>", column.number ? " class=\"number\"" : "",
                        column.title);
  }
  for (const CaptureSummary& capture : captures) rows += Row(capture, page);
  const std::string title =
      fmt::format("{} capture{}", captures.size(), captures.size() == 1 ? "" : "s");
  return HtmlPage(title,
                  kStyle +
                      ("<h1>" + title + "</h1>\n<p>" + Counts(captures) +
                       ". Log error: between fitted photographs and their renderings (0.02: 2 %); "
                       "held out: of photographs that were not fitted.</p>\n") +
                      "<section class=\"scroll\"><table class=\"captures\"><thead><tr>" + head +
                      "</tr></thead>\n<tbody>\n" + rows + "</tbody></table></section>\n" + kScript);
}

}  // namespace glint
