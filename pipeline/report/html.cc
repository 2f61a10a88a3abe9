#include "pipeline/report/html.h"

#include <cmath>
#include <cstdio>

namespace glint {
namespace {

constexpr char kStyle[] = R"(
:root { --ink: #1d2129; --soft: #667085; --line: #e4e7ec; --paper: #ffffff; --ground: #f7f7f5; --mark: #b54708; }
* { box-sizing: border-box; }
body { margin: 0; background: var(--ground); color: var(--ink); font: 15px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; }
main { max-width: 1180px; margin: 0 auto; padding: 28px 20px 60px; }
h1 { font-size: 26px; margin: 0 0 4px; letter-spacing: -.01em; }
h2 { font-size: 19px; margin: 0 0 12px; }
h3 { font-size: 15px; margin: 18px 0 6px; }
p { margin: 0 0 10px; color: var(--soft); max-width: 80ch; }
section { background: var(--paper); border: 1px solid var(--line); border-radius: 8px; padding: 20px 22px; margin-top: 18px; }
a { color: #175cd3; text-decoration: none; } a:hover { text-decoration: underline; }
.source { float: right; font-size: 12px; }
.figures { display: flex; flex-wrap: wrap; gap: 12px 34px; margin-top: 12px; }
.figures div { min-width: 110px; }
.figures b { display: block; font-size: 21px; font-weight: 600; font-variant-numeric: tabular-nums; }
.figures > div > span { color: var(--soft); font-size: 12.5px; }
.pictures { display: grid; grid-template-columns: repeat(auto-fill, minmax(250px, 1fr)); gap: 14px; }
figure { margin: 0; } figure img { width: 100%; display: block; border-radius: 4px; background: #eceef1; image-rendering: auto; }
figure.wide { margin-top: 14px; max-width: 900px; }
figcaption { font-size: 12.5px; color: var(--soft); margin-top: 4px; }
.scroll { overflow-x: auto; }
table { border-collapse: collapse; font-size: 13px; width: 100%; }
th { text-align: left; font-weight: 600; color: var(--soft); border-bottom: 1px solid var(--line); padding: 5px 12px 5px 0; white-space: nowrap; }
td { border-bottom: 1px solid var(--line); padding: 5px 12px 5px 0; font-variant-numeric: tabular-nums; vertical-align: top; }
td.number, th.number { text-align: right; } tr:last-child td { border-bottom: 0; }
.views td { vertical-align: middle; } .views code { white-space: nowrap; } .views img { width: 100%; max-width: 300px; min-width: 120px; display: block; border-radius: 4px; }
.kept { color: var(--mark); font-weight: 600; }
.charts { display: flex; flex-wrap: wrap; gap: 18px; } svg text { font: 11px system-ui, "DejaVu Sans", sans-serif; fill: #667085; }
details { margin-top: 8px; } summary { cursor: pointer; color: var(--soft); }
table.pairs { width: auto; min-width: 320px; } table + p { margin-top: 12px; } .scroll + p { margin-top: 12px; }
code { font: 12px ui-monospace, "DejaVu Sans Mono", monospace; overflow-wrap: anywhere; }
)";

}  // namespace

std::string HtmlText(std::string_view text) {
  std::string escaped;
  for (const char c : text) {
    switch (c) {
      case '&':
        escaped += "&amp;";
        break;
      case '<':
        escaped += "&lt;";
        break;
      case '>':
        escaped += "&gt;";
        break;
      case '"':
        escaped += "&quot;";
        break;
      case '\'':
        escaped += "&#39;";
        break;
      default:
        escaped += c;
    }
  }
  return escaped;
}

std::string Base64(std::string_view bytes) {
  constexpr char kDigits[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
  std::string text;
  text.reserve((bytes.size() + 2) / 3 * 4);
  for (size_t i = 0; i < bytes.size(); i += 3) {
    unsigned group = 0;
    for (size_t k = 0; k < 3; ++k) {
      group = group << 8 | (i + k < bytes.size() ? static_cast<unsigned char>(bytes[i + k]) : 0u);
    }
    for (size_t k = 0; k < 4; ++k) {
      text += i + k <= bytes.size() ? kDigits[group >> (18 - 6 * k) & 63u] : '=';
    }
  }
  return text;
}

std::string NumberText(double value) {
  char text[40];
  if (value == std::floor(value) && std::abs(value) < 1e9) {
    std::snprintf(text, sizeof(text), "%.0f", value);
  } else {
    std::snprintf(text, sizeof(text), std::abs(value) >= 100 ? "%.6g" : "%.4g", value);
  }
  return text;
}

std::string HtmlPage(const std::string& title, const std::string& body) {
  return "<!doctype html>\n<html lang=\"en\">\n<head>\n<meta charset=\"utf-8\">\n"
         "<meta name=\"viewport\" content=\"width=device-width, initial-scale=1\">\n<title>" +
         HtmlText(title) + "</title>\n<style>" + kStyle + "</style>\n</head>\n<body>\n<main>\n" +
         body + "</main>\n</body>\n</html>\n";
}

}  // namespace glint
