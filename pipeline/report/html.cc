#include "pipeline/report/html.h"

#include <cmath>
#include <cstdio>

namespace glint {
namespace {

constexpr char kStyle[] = R"(
:root { --ink: #1d2129; --soft: #5b6472; --line: #e4e7ec; --paper: #ffffff; --ground: #f7f7f5; --mark: #b54708; --link: #175cd3; --stage: #24262b; color-scheme: light dark; }
@media (prefers-color-scheme: dark) { :root { --ink: #e8eaed; --soft: #a3abb8; --line: #33373e; --paper: #1c1f24; --ground: #131519; --mark: #f4a460; --link: #7fb0ff; --stage: #0c0d10; } }
* { box-sizing: border-box; }
body { margin: 0; background: var(--ground); color: var(--ink); font: 15px/1.5 system-ui, "Segoe UI", "DejaVu Sans", sans-serif; }
main { max-width: 1180px; margin: 0 auto; padding: 28px 20px 60px; }
h1 { font-size: 26px; margin: 0 0 4px; letter-spacing: -.01em; }
h2 { font-size: 19px; margin: 0 0 12px; }
h3 { font-size: 15px; margin: 18px 0 6px; }
p { margin: 0 0 10px; color: var(--soft); max-width: 80ch; }
section { background: var(--paper); border: 1px solid var(--line); border-radius: 8px; padding: 20px 22px; margin-top: 18px; }
a { color: var(--link); text-decoration: none; } a:hover { text-decoration: underline; }
.source { float: right; font-size: 12px; }
.figures { display: flex; flex-wrap: wrap; gap: 12px 34px; margin-top: 12px; }
.figures div { min-width: 110px; }
.figures b { display: block; font-size: 21px; font-weight: 600; font-variant-numeric: tabular-nums; }
.figures > div > span { color: var(--soft); font-size: 12.5px; }
.downloads { display: grid; grid-template-columns: repeat(auto-fit, minmax(220px, 1fr)); gap: 0 34px; }
.downloads h3 { margin: 0; font-size: 14px; }
.downloads ul { margin: 6px 0 0; padding: 0; list-style: none; }
.downloads small { color: var(--soft); }
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
.viewer { background: var(--paper); border: 1px solid var(--line); border-radius: 8px; margin-top: 14px; overflow: hidden; }
.viewer .stage { position: relative; background: var(--stage); height: min(68vh, 92vw, 720px); touch-action: none; }
.viewer canvas { width: 100%; height: 100%; display: block; outline-offset: -3px; }
.viewer #viewer-photograph { display: none; position: absolute; }
.viewer.comparing .stage { height: auto; display: grid; justify-items: center; touch-action: auto; }
.viewer.comparing canvas, .viewer.comparing #viewer-photograph { display: block; position: static; grid-area: 1 / 1; width: min(100%, 720px); height: auto; }
.viewer .controls { display: flex; flex-wrap: wrap; gap: 10px 18px; padding: 12px 16px; font-size: 13px; color: var(--soft); }
.viewer label { display: flex; align-items: center; gap: 6px; } .viewer select { font: inherit; max-width: 180px; padding: 5px; }
.viewer input[type=range] { width: 130px; } .viewer .compare { display: none; }
.viewer.comparing .compare { display: flex; } .viewer.comparing .relight, .viewer.failed .controls, .viewer.failed .stage { display: none; }
.viewer #viewer-note { margin: 0 16px 8px; } .viewer #viewer-note:empty { display: none; }
details.fold { margin-top: 18px; } details.fold > summary { font-size: 16px; padding: 8px 0; }
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
