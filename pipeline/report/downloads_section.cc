#include "pipeline/report/downloads_section.h"

#include <fmt/format.h>

#include <algorithm>

#include "base/files/hash.h"
#include "pipeline/report/html.h"

namespace glint {
namespace {

namespace fs = std::filesystem;

// Whether `manifest` was made from the maps of `stage`.
bool MadeFrom(const Manifest& manifest, const fs::path& stage) {
  const fs::path file = stage / "manifest.json";
  if (!fs::exists(file)) return false;
  const std::string hash = HashFile(file);
  return std::any_of(manifest.inputs.begin(), manifest.inputs.end(),
                     [&](const ManifestInput& input) { return input.hash == hash; });
}

std::string SizeText(std::uintmax_t bytes) {
  constexpr double kMega = 1e6;
  const double mega = static_cast<double>(bytes) / kMega;
  return mega < 1 ? fmt::format("{} kB", (bytes + 999) / 1000) : fmt::format("{:.1f} MB", mega);
}

std::string Link(const fs::path& folder, const std::string& file, const std::string& label) {
  return "<li><a download href=\"../export/" + HtmlText(file) + "\">" + HtmlText(label) +
         "</a> <small>" + SizeText(fs::file_size(folder / file)) + "</small></li>\n";
}

}  // namespace

std::string MaterialName(const ReportInput& input) {
  if (input.Has("export")) {
    const std::string name = input.manifests.at("export").data.value("name", "");
    if (!name.empty()) return name;
  }
  return fs::weakly_canonical(input.work).parent_path().filename().string();
}

std::string DownloadsSection(const ReportInput& input, const ReportOptions& options) {
  if (!input.Has("export")) return "";
  const Manifest& manifest = input.manifests.at("export");
  if (!MadeFrom(manifest, input.work / options.from) && !MadeFrom(manifest, input.work / "tile")) {
    return "";
  }
  const fs::path folder = input.work / "export";
  std::string materials, maps;
  for (const Json& entry : manifest.data["materials"]) {
    const std::string file = entry["file"];
    materials += Link(folder, file, file);
  }
  for (const Json& entry : manifest.data["maps"]) {
    const std::string file = entry["file"];
    maps += Link(folder, file, file);
  }
  return "<section><h2>Download</h2>\n<div class=\"downloads\">"
         "<div><h3>Materials</h3><ul>\n" +
         materials + "</ul></div>\n<div><h3>Maps</h3><ul>\n" + maps +
         "</ul></div></div>\n</section>\n";
}

}  // namespace glint
